// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/files/budget.h"

#include <cstdint>
#include <functional>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace gpo {

/// Called many times a second while a file is read, with the share that has been read, 0 to 1. May
/// throw to stop.
using ReadProgress = std::function<void(double share)>;

/// Returns all bytes of a file. Throws InputError if it is missing, unreadable, no regular file (a
/// pipe or device might never end) or larger than `most_bytes`.
std::string read_file(const fs::path& file, std::uint64_t most_bytes = limits().file_bytes);

std::string_view trimmed(std::string_view text);
std::string lower_case(std::string_view text);
/// Returns the parts between separators. A separator at the end starts no further part.
std::vector<std::string> split(const std::string& text, char separator);
/// Removes a word and the blanks after it from the front of `rest`. Returns the word.
std::string_view take_word(std::string_view& rest);

/// Reads a text line by line, without its byte order mark.
class TextLines {
 public:
  explicit TextLines(std::string_view text);

  /// Returns the next line, trimmed; nullopt at the end.
  std::optional<std::string_view> next();
  int number() const { return number_; }  ///< last line's number, from 1
  bool ended() const { return ended_; }   ///< whether it ended with a line break
  std::string_view rest() const { return rest_; }

 private:
  std::string_view rest_;
  int number_ = 0;
  bool ended_ = true;
};

/// Parses a finite number. Returns nullopt if the text has anything else.
std::optional<double> parse_number(std::string_view text);
/// Returns whether a word is a number that is not finite, as printf writes it: "-nan", "inf",
/// "-1.#IND", "nan(ind)".
bool is_not_finite(std::string_view word);
std::optional<std::int64_t> parse_integer(std::string_view text);
/// Parses two integers, width and height or columns and rows: "640x480".
std::optional<std::pair<int, int>> parse_size(std::string_view text);
/// Parses a number times 10^decimals, rounded. Exact to the nanosecond, unlike a double:
/// ("1403636579.763555584", 9) is 1403636579763555584.
std::optional<std::int64_t> parse_decimal(std::string_view text, int decimals);

/// Returns false also on errors, such as a loop of links or a folder without permission.
bool is_file(const fs::path& path);
bool is_folder(const fs::path& path);

std::optional<fs::path> if_file(const fs::path& path);
/// Returns the first path that is a file.
std::optional<fs::path> first_file(std::initializer_list<fs::path> paths);

/// Returns the folder of a file, "." if its path has none.
fs::path folder_of(const fs::path& file);

/// Returns the files of a folder without those that a killed program left unfinished. Throws
/// InputError.
std::vector<fs::path> files_in(const fs::path& folder);

/// Serializes JSON with a newline at the end. Invalid UTF-8, e.g. in file names, becomes the
/// replacement character.
std::string json_text(const nlohmann::ordered_json& json, int indent);

nlohmann::ordered_json optional_json(const std::optional<double>& value);

/// Parses JSON. Returns a discarded value (`is_discarded`) if it is invalid or deeper than 16
/// levels.
nlohmann::ordered_json parse_json(std::string_view text);

nlohmann::ordered_json read_json(const fs::path& file);

std::string to_base64(std::string_view bytes);

/// Returns the 64-bit FNV-1a hash for names of cache files, the same on every machine.
constexpr std::uint64_t fnv1a(std::string_view bytes) {
  std::uint64_t value = 14695981039346656037U;
  for (const char byte : bytes) value = (value ^ static_cast<unsigned char>(byte)) * 1099511628211U;
  return value;
}

}  // namespace gpo
