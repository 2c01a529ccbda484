// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/bags/message_cursor.h"

namespace gpo {
namespace {

constexpr std::size_t kCdrHead = 4;

}  // namespace

MessageCursor::MessageCursor(std::string_view bytes, MessageEncoding encoding)
    : bytes_(bytes), encoding_(encoding) {
  known_ = encoding != MessageEncoding::unknown;
  if (encoding != MessageEncoding::cdr) return;
  const std::string_view head = bytes_.take(kCdrHead);
  if (!bytes_.ok()) return;
  // Plain CDR, the only one that ROS 2 writes; 0 is big-endian, 1 little-endian.
  known_ = head[0] == 0 && (head[1] == 0 || head[1] == 1);
  swapped_ = head[1] == 0;
}

void MessageCursor::align(std::size_t size) {
  if (encoding_ != MessageEncoding::cdr) return;
  const std::size_t beyond = (bytes_.place() - kCdrHead) % size;
  if (bytes_.ok() && beyond != 0) bytes_.take(size - beyond);
}

std::string MessageCursor::text() {
  std::string text(bytes());
  if (!ros1() && text.ends_with('\0')) text.pop_back();
  return text;
}

std::string_view MessageCursor::bytes() { return bytes_.take(number<std::uint32_t>()); }

std::vector<double> MessageCursor::doubles() {
  const auto count = number<std::uint32_t>();
  constexpr std::uint32_t kMost = 1000;
  if (count > kMost) known_ = false;
  return count == 0 || count > kMost ? std::vector<double>() : doubles(count);
}

std::vector<double> MessageCursor::doubles(std::size_t count) {
  std::vector<double> values;
  for (std::size_t i = 0; i < count && ok(); ++i) values.push_back(number<double>());
  values.resize(count);
  return values;
}

Eigen::Vector3d MessageCursor::vector() {
  const double x = number<double>();
  const double y = number<double>();
  return {x, y, number<double>()};
}

}  // namespace gpo
