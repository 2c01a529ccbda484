// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/loggers/gpmf_items.h"

#include "engine/base/error.h"
#include "engine/files/byte_cursor.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include <fmt/format.h>

namespace gpo {
namespace {

using Bytes = std::string_view;

/// A key of letters, digits and blanks as it stands, anything else as its bytes.
std::string printable(Bytes key) {
  const bool plain = std::ranges::all_of(key, [](char c) { return c >= ' ' && c <= '~'; });
  return plain ? std::string(key) : fmt::format("bytes 0x{:08x}", big_endian(key, 0, 4));
}

double number_at(const GpmfItem& item, std::size_t index) {
  const int size = gpmf_size(item.type);
  const std::uint64_t bits = big_endian(item.data, index * static_cast<std::size_t>(size), size);
  switch (item.type) {
    case 'b':
      return static_cast<std::int8_t>(bits);
    case 's':
      return static_cast<std::int16_t>(bits);
    case 'l':
      return static_cast<std::int32_t>(bits);
    case 'j':
      return static_cast<double>(static_cast<std::int64_t>(bits));
    case 'f':
      return static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(bits)));
    case 'd':
      return std::bit_cast<double>(bits);
    default:
      return static_cast<double>(bits);
  }
}

}  // namespace

std::optional<GpmfItem> GpmfItems::next() {
  constexpr std::size_t kHead = 8;
  if (rest_.size() < kHead || rest_.starts_with(Bytes("\0\0\0\0", 4))) return std::nullopt;
  GpmfItem item{rest_.substr(0, 4),
                rest_[4],
                static_cast<int>(big_endian(rest_, 5, 1)),
                static_cast<int>(big_endian(rest_, 6, 2)),
                {}};
  const std::size_t length = static_cast<std::size_t>(item.size) * item.count;
  const std::size_t left = rest_.size() - kHead;
  if (length > left) {
    gpmf_fail(source_, item, fmt::format("{} bytes (cut)", left), std::to_string(length));
  }
  item.data = rest_.substr(kHead, length);
  rest_.remove_prefix(std::min(rest_.size(), kHead + (length + 3) / 4 * 4));
  return item;
}

int gpmf_size(char type) {
  switch (type) {
    case 'b':
    case 'B':
      return 1;
    case 's':
    case 'S':
      return 2;
    case 'l':
    case 'L':
    case 'f':
      return 4;
    case 'd':
    case 'j':
    case 'J':
      return 8;
    default:
      return 0;
  }
}

std::vector<double> gpmf_numbers(const GpmfItem& item, const std::string& source) {
  const int size = gpmf_size(item.type);
  if (size == 0 || item.size % size != 0)
    gpmf_fail(source, item, "no numbers that are known", "numbers");
  std::vector<double> numbers(item.data.size() / static_cast<std::size_t>(size));
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    numbers[i] = number_at(item, i);
    if (!std::isfinite(numbers[i]))
      gpmf_fail(source, item, "a number that is not finite", "numbers");
  }
  return numbers;
}

std::string gpmf_text(const GpmfItem& item) {
  return std::string(item.data.substr(0, item.data.find('\0')));
}

void gpmf_fail(const std::string& source,
               const GpmfItem& item,
               const std::string& found,
               const std::string& expected) {
  throw InputError(
      fmt::format("{}: {}: found {}, expected {}", source, printable(item.key), found, expected));
}

}  // namespace gpo
