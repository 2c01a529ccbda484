// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/bags/containers/ros1_record.h"

#include "engine/files/byte_cursor.h"

namespace gpo {
namespace {

/// Enough for the fields of any record that this program needs, and for most messages after them.
constexpr std::uint64_t kFirstLook = 512;
/// Callers and topics have names, no more.
constexpr std::uint32_t kMostFieldBytes = 1 << 20;

template <class T>
T number_in(std::optional<std::string_view> field) {
  if (!field || field->size() != sizeof(T)) return 0;
  return ByteCursor(*field).number<T>();
}

}  // namespace

std::optional<std::string_view> ros1_field(std::string_view fields, std::string_view name) {
  ByteCursor cursor(fields);
  while (cursor.more()) {
    const std::string_view field = cursor.text();
    if (field.starts_with(name) && field.substr(name.size()).starts_with('='))
      return field.substr(name.size() + 1);
  }
  return std::nullopt;
}

std::optional<std::string_view> Ros1Record::field(std::string_view name) const {
  return ros1_field(fields, name);
}

std::uint32_t Ros1Record::number(std::string_view name) const {
  return number_in<std::uint32_t>(field(name));
}

std::uint64_t Ros1Record::position(std::string_view name) const {
  return number_in<std::uint64_t>(field(name));
}

std::int64_t Ros1Record::time_ns(std::string_view name) const {
  const std::uint64_t both = position(name);
  return ros1_time_ns(static_cast<std::uint32_t>(both), static_cast<std::uint32_t>(both >> 32));
}

bool Ros1Record::is(Ros1Op op) const {
  const auto value = field("op");
  return value && value->size() == 1 && static_cast<Ros1Op>(value->front()) == op;
}

std::int64_t ros1_time_ns(std::uint32_t seconds, std::uint32_t nanoseconds) {
  return std::int64_t{seconds} * 1'000'000'000 + nanoseconds;
}

std::optional<Ros1Record> ros1_record(const ReadBytes& read, std::uint64_t place) {
  std::string bytes = read(place, kFirstLook);
  const auto length = ByteCursor(bytes).number<std::uint32_t>();
  if (length == 0 || length > kMostFieldBytes) return std::nullopt;
  const std::uint64_t head = std::uint64_t{length} + 8;
  if (head > bytes.size() && bytes.size() == kFirstLook) bytes = read(place, head);
  ByteCursor cursor(bytes);
  Ros1Record record;
  record.fields = cursor.text();
  record.data_size = cursor.number<std::uint32_t>();
  record.data_place = place + head;
  if (!cursor.ok()) return std::nullopt;
  return record;
}

}  // namespace gpo
