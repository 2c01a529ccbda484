// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace gpo {

/// Configurations, scripts: what a person writes.
constexpr std::size_t kMostBytesByHand = std::size_t{1} << 20;
/// Tables, sessions and pictures: what programs write.
constexpr std::size_t kMostBytesByProgram = std::size_t{256} << 20;

/// All bytes of a file. Throws InputError where it is missing, cannot be read, is no regular file
/// (a pipe or device might never end) or is larger than `most_bytes`.
std::string read_file(const std::filesystem::path& file,
                      std::size_t most_bytes = kMostBytesByProgram);

/// Without white space at both ends.
std::string_view trimmed(std::string_view text);
std::string lower_case(std::string_view text);
/// Takes a word off the front of a text that begins with it, and the blanks behind it.
std::string_view take_word(std::string_view& rest);

/// Takes lines off the front of a text, behind its byte order mark.
class TextLines {
 public:
  explicit TextLines(std::string_view text);

  /// The next one without blanks at its ends; nothing at the end.
  std::optional<std::string_view> next();
  int number() const { return number_; }  ///< of the last one, from 1
  bool ended() const { return ended_; }   ///< whether that had a line's end
  std::string_view rest() const { return rest_; }

 private:
  std::string_view rest_;
  int number_ = 0;
  bool ended_ = true;
};

/// A finite number that fills the whole text; nothing otherwise.
std::optional<double> parse_number(std::string_view text);
std::optional<std::int64_t> parse_integer(std::string_view text);
/// "640x480": two whole numbers, width and height, or columns and rows; nothing otherwise.
std::optional<std::pair<int, int>> parse_size(std::string_view text);
/// The number times 10^decimals, rounded, without the detour through a double that would cost the
/// nanoseconds of a time stamp: ("1403636579.763555584", 9) is 1403636579763555584.
std::optional<std::int64_t> parse_decimal(std::string_view text, int decimals);

}  // namespace gpo
