// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/files/text_file.h"

#include "engine/base/stop.h"
#include "engine/files/refuse.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <fstream>
#include <sstream>
#include <system_error>

#include <nlohmann/json.hpp>

namespace gpo {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// from_chars does not accept a plus sign. "+-1" stays invalid.
std::string_view without_plus(std::string_view text) {
  const bool plus = text.size() > 1 && text[0] == '+' && text[1] != '-';
  return plus ? text.substr(1) : text;
}

template <class Number>
std::optional<Number> parse_whole(std::string_view text) {
  text = without_plus(text);
  Number value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = error == std::errc() && end == text.data() + text.size();
  return whole ? std::optional(value) : std::nullopt;
}

/// Returns the integer of the first `count` digits, padded with zeros or rounded by the next digit.
std::optional<std::int64_t> rounded_integer(const std::string& digits, std::int64_t count) {
  if (count < 0) return 0;
  std::string kept = digits.substr(0, static_cast<std::size_t>(count));
  const bool up = static_cast<std::size_t>(count) < digits.size() && digits[count] >= '5';
  if (count > 40) return std::nullopt;
  kept.append(static_cast<std::size_t>(count) - kept.size(), '0');
  const auto value = kept.empty() ? std::optional<std::int64_t>(0) : parse_integer(kept);
  if (!value || *value >= INT64_MAX / 2) return std::nullopt;  // differences must not overflow
  return *value + (up ? 1 : 0);
}

/// Returns whether the name is the temporary one of `AtomicFile`: a killed program leaves it.
bool is_partial(const fs::path& file) {
  constexpr std::string_view kMark = ".partial", kHexDigits = "0123456789abcdef";
  constexpr std::size_t kDigits = 8;
  const std::string name = file.filename().string();
  const std::size_t at = name.rfind(kMark);
  if (at == std::string::npos || at < kDigits + 1 || name[at - kDigits - 1] != '.') return false;
  return std::string_view(name).substr(at - kDigits, kDigits).find_first_not_of(kHexDigits) ==
         std::string_view::npos;
}

}  // namespace

std::string read_file(const fs::path& file, std::uint64_t most_bytes) {
  using fs::file_type;
  std::error_code error;
  const auto type = fs::status(file, error).type();
  if (type == file_type::not_found) refuse(file, "no such file");
  if (type == file_type::none) fail_at(file, error.message(), "a file");
  if (type == file_type::directory) fail_at(file, "a folder", "a file");
  if (type != file_type::regular) fail_at(file, "a pipe or device", "a regular file");
  errno = 0;
  std::ifstream stream(file, std::ios::binary);
  if (!stream) fail_at(file, std::generic_category().message(errno), "a file that can be read");
  std::string content;
  constexpr std::size_t kLargestChunk = std::size_t{16} << 20;
  for (std::size_t chunk = std::size_t{1} << 16; stream;
       chunk = std::min(content.size(), kLargestChunk)) {
    check_stop();
    const std::size_t before = content.size();
    content.resize(std::min<std::uint64_t>(before + chunk, most_bytes + 1));
    stream.read(content.data() + before, static_cast<std::streamsize>(content.size() - before));
    content.resize(before + static_cast<std::size_t>(stream.gcount()));
    if (content.size() > most_bytes)
      refuse_size(file, fmt::format("more than {} MiB", most_bytes >> 20), "a smaller file");
  }
  if (stream.bad()) fail_at(file, "a read error", "a file that can be read");
  note_read(file);
  return content;
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kSpace = " \t\r\n";
  const auto first = text.find_first_not_of(kSpace);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kSpace) - first + 1);
}

std::string lower_case(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, separator);) parts.push_back(part);
  return parts;
}

std::string_view take_word(std::string_view& rest) {
  constexpr std::string_view kBlanks = " \t";
  const std::string_view word = rest.substr(0, rest.find_first_of(kBlanks));
  rest.remove_prefix(word.size());
  rest.remove_prefix(std::min(rest.find_first_not_of(kBlanks), rest.size()));
  return word;
}

TextLines::TextLines(std::string_view text) : rest_(text) {
  if (rest_.starts_with("\xEF\xBB\xBF")) rest_.remove_prefix(3);
}

std::optional<std::string_view> TextLines::next() {
  check_stop();
  if (rest_.empty()) return std::nullopt;
  const std::size_t end = rest_.find('\n');
  ended_ = end != std::string_view::npos;
  const std::string_view line = rest_.substr(0, end);
  rest_.remove_prefix(ended_ ? end + 1 : rest_.size());
  ++number_;
  return trimmed(line);
}

std::optional<double> parse_number(std::string_view text) {
  const auto value = parse_whole<double>(text);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

bool is_not_finite(std::string_view word) {
  std::string name = lower_case(word);
  if (name.starts_with('-') || name.starts_with('+')) name.erase(0, 1);
  return name.starts_with("nan") || name == "inf" || name == "infinity" || name.starts_with("1.#");
}

std::optional<std::int64_t> parse_integer(std::string_view text) {
  return parse_whole<std::int64_t>(text);
}

std::optional<std::pair<int, int>> parse_size(std::string_view text) {
  const std::size_t cross = text.find('x');
  if (cross == std::string_view::npos) return std::nullopt;
  const auto width = parse_integer(text.substr(0, cross));
  const auto height = parse_integer(text.substr(cross + 1));
  if (!width || !height || !std::in_range<int>(*width) || !std::in_range<int>(*height))
    return std::nullopt;
  return std::pair(static_cast<int>(*width), static_cast<int>(*height));
}

std::optional<std::int64_t> parse_decimal(std::string_view text, int decimals) {
  constexpr std::size_t kLongest = 1000;  // beyond any number; its digits are copied
  if (text.size() > kLongest) return std::nullopt;
  const bool negative = !text.empty() && text[0] == '-';
  text = negative ? text.substr(1) : without_plus(text);
  std::string digits;
  std::int64_t before_point = -1;
  std::size_t i = 0;
  for (; i < text.size() && (is_digit(text[i]) || (text[i] == '.' && before_point < 0)); ++i) {
    if (text[i] == '.') {
      before_point = static_cast<std::int64_t>(digits.size());
    } else {
      digits += text[i];
    }
  }
  if (digits.empty()) return std::nullopt;
  if (before_point < 0) before_point = static_cast<std::int64_t>(digits.size());
  std::int64_t exponent = 0;
  if (i < text.size()) {
    if (text[i] != 'e' && text[i] != 'E') return std::nullopt;
    const auto parsed = parse_integer(text.substr(i + 1));
    if (!parsed || std::abs(*parsed) > 100) return std::nullopt;
    exponent = *parsed;
  }
  const std::size_t zeros = std::min(digits.find_first_not_of('0'), digits.size());
  digits.erase(0, zeros);
  before_point -= static_cast<std::int64_t>(zeros);
  if (digits.empty()) return 0;
  const auto value = rounded_integer(digits, before_point + exponent + decimals);
  return value && negative ? std::optional(-*value) : value;
}

bool is_file(const fs::path& path) {
  std::error_code none;
  return fs::is_regular_file(path, none);
}

bool is_folder(const fs::path& path) {
  std::error_code none;
  return fs::is_directory(path, none);
}

std::optional<fs::path> if_file(const fs::path& path) {
  return is_file(path) ? std::optional(path) : std::nullopt;
}

std::optional<fs::path> first_file(std::initializer_list<fs::path> paths) {
  const auto* file = std::ranges::find_if(paths, is_file);
  return file == paths.end() ? std::nullopt : std::optional(*file);
}

fs::path folder_of(const fs::path& file) {
  return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

std::vector<fs::path> files_in(const fs::path& folder) {
  std::error_code error;
  std::vector<fs::path> files;
  fs::directory_iterator entry(folder, error);
  for (; !error && entry != fs::directory_iterator(); entry.increment(error)) {
    check_stop();
    std::error_code none;
    if (entry->is_regular_file(none) && !is_partial(entry->path())) files.push_back(entry->path());
  }
  if (error) refuse(folder, "cannot be read ({})", error.message());
  return files;
}

std::string json_text(const nlohmann::ordered_json& json, int indent) {
  return json.dump(indent, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

nlohmann::ordered_json optional_json(const std::optional<double>& value) {
  return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
}

nlohmann::ordered_json parse_json(std::string_view text) {
  using Json = nlohmann::ordered_json;
  constexpr int kMaxDepth = 16;
  bool too_deep = false;
  const auto keep = [&](int depth, Json::parse_event_t, const Json&) {
    too_deep |= depth > kMaxDepth;
    return depth <= kMaxDepth;
  };
  Json json = Json::parse(text, keep, false);
  return too_deep ? Json(Json::value_t::discarded) : json;
}

nlohmann::ordered_json read_json(const fs::path& file) {
  return parse_json(read_file(file, limits().json_bytes));
}

std::string to_base64(std::string_view bytes) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    for (std::size_t k = 0; k < 3; ++k)
      bits = bits << 8 | (k < count ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k)
      text += k <= count ? kDigits[bits >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

}  // namespace gpo
