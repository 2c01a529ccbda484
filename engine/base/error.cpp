// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/error.h"

#include "engine/base/choice.h"

#include <filesystem>
#include <new>
#include <system_error>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gpo {
namespace {

constexpr std::size_t kMaxMessage = 1000;
constexpr std::size_t kMaxEscape = 4;  // "\\x1B"

unsigned byte_at(std::string_view text, std::size_t i) {
  return i < text.size() ? static_cast<unsigned char>(text[i]) : 0;
}

/// Returns the length of the printable character at a position; 0 if there is none.
std::size_t printable_length(std::string_view text, std::size_t i) {
  const unsigned first = byte_at(text, i);
  if (first < 0x80) return first >= 0x20 && first != 0x7F ? 1 : 0;
  const std::size_t length = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
  if (first < 0xC2 || first > 0xF4) return 0;
  for (std::size_t k = 1; k < length; ++k)
    if ((byte_at(text, i + k) & 0xC0) != 0x80) return 0;
  const unsigned second = byte_at(text, i + 1);
  const bool c1_control = first == 0xC2 && second < 0xA0;
  const bool overlong = (first == 0xE0 && second < 0xA0) || (first == 0xF0 && second < 0x90);
  const bool no_character = (first == 0xED && second >= 0xA0) || (first == 0xF4 && second >= 0x90);
  return c1_control || overlong || no_character ? 0 : length;
}

/// Keeps the beginning, which names the file, and the end, which has the expected value.
std::string shortened(const std::string& text) {
  constexpr std::size_t kEnd = 300;
  if (text.size() <= kMaxMessage) return text;
  std::size_t end = text.size() - kEnd;
  while ((byte_at(text, end) & 0xC0) == 0x80) ++end;  // do not split a character
  return legible(text, kMaxMessage - kEnd - 3) + text.substr(end);
}

}  // namespace

std::string legible(std::string_view text, std::size_t max_bytes) {
  std::string result;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = printable_length(text, i);
    const std::string next = length > 0        ? std::string(text.substr(i, length))
                             : text[i] == '\n' ? "\\n"
                             : text[i] == '\r' ? "\\r"
                             : text[i] == '\t' ? "\\t"
                                               : fmt::format("\\x{:02X}", byte_at(text, i));
    if (result.size() + next.size() > max_bytes) return result + "...";
    result += next;
    i += length > 0 ? length : 1;
  }
  return result;
}

InputError::InputError(std::string_view message)
    : std::runtime_error(shortened(legible(message, message.size() * kMaxEscape))) {}

SettingError::SettingError(const std::string& named, std::string_view message)
    : InputError(fmt::format("{}: {}", named, message)), name(named) {}

void refuse_choice(const char* name, const std::string& key, std::span<const char* const> known) {
  throw SettingError(
      name, fmt::format("unknown value '{}', expected one of {}", key, fmt::join(known, ", ")));
}

std::string message_of(const std::exception& error) {
  using std::filesystem::filesystem_error;
  if (dynamic_cast<const InputError*>(&error) != nullptr) return error.what();
  if (const auto* refused = dynamic_cast<const filesystem_error*>(&error))
    return InputError(fmt::format("{}: {}", refused->path1().string(), refused->code().message()))
        .what();
  if (dynamic_cast<const std::system_error*>(&error) != nullptr)
    return InputError(error.what()).what();
  if (dynamic_cast<const std::bad_alloc*>(&error) != nullptr) return "not enough memory";
  return legible(fmt::format("internal error, please report it: {}", error.what()), kMaxMessage);
}

}  // namespace gpo
