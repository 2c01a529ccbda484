// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace gpo {

/// The kinds of records in a ROS 1 bag.
enum class Ros1Op : std::uint8_t {
  message = 2,
  bag_header = 3,
  index = 4,
  chunk = 5,
  chunk_info = 6,
  connection = 7
};

/// A record of a ROS 1 bag: fields with names, then data, which need not be there to its end.
struct Ros1Record {
  std::string fields;
  std::uint64_t data_place = 0;
  std::uint32_t data_size = 0;

  std::uint64_t end() const { return data_place + data_size; }
  /// What "name=" is followed by; nothing where there is no such field.
  std::optional<std::string_view> field(std::string_view name) const;
  std::uint32_t number(std::string_view name) const;    ///< 0 where there is none
  std::int64_t time_ns(std::string_view name) const;    ///< the same
  std::uint64_t position(std::string_view name) const;  ///< the same
  bool is(Ros1Op op) const;
};

/// So many bytes from a place on, fewer where there are no more.
using ReadBytes = std::function<std::string(std::uint64_t place, std::uint64_t count)>;

/// The one that begins at `place`; nothing where its fields are cut or no fields.
std::optional<Ros1Record> ros1_record(const ReadBytes& read, std::uint64_t place);

/// Seconds and nanoseconds, of 4 bytes each.
std::int64_t ros1_time_ns(std::uint32_t seconds, std::uint32_t nanoseconds);

/// The first of fields, each with its length before it, that has this name.
std::optional<std::string_view> ros1_field(std::string_view fields, std::string_view name);

}  // namespace gpo
