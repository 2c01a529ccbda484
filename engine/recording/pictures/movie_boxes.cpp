// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/pictures/movie_boxes.h"

#include "engine/files/byte_cursor.h"

#include <array>
#include <bit>

#include <fmt/format.h>

namespace gpo {
namespace {

using Bytes = std::string_view;

constexpr std::uint64_t kMostBoxBytes = 1 << 20;
constexpr int kMostBoxes = 10'000;

std::uint64_t big_endian(Bytes bytes) { return gpo::big_endian(bytes, 0, bytes.size()); }

/// Its length and its kind, or of a key its namespace, go before what a box holds.
struct MemoryBox {
  Bytes kind;
  Bytes data;
};

/// Takes a box off the front of what holds it; nothing at the end, and where it is cut.
std::optional<MemoryBox> take_box(Bytes& rest) {
  constexpr std::size_t kHead = 8;
  if (rest.size() < kHead) return std::nullopt;
  const std::uint64_t length = big_endian(rest.substr(0, 4));
  if (length < kHead || length > rest.size()) return std::nullopt;
  const MemoryBox box{rest.substr(4, 4), rest.substr(kHead, length - kHead)};
  rest.remove_prefix(length);
  return box;
}

/// Empty where there is none.
Bytes data_in(Bytes outer, Bytes kind) {
  while (const auto box = take_box(outer))
    if (box->kind == kind) return box->data;
  return {};
}

/// Whose place in the list of keys, counted from 1, is the kind of its value's box; 0: not there.
std::uint64_t place_of(Bytes keys, Bytes key) {
  constexpr std::size_t kVersionAndCount = 8;
  if (keys.size() < kVersionAndCount) return 0;
  keys.remove_prefix(kVersionAndCount);
  for (std::uint64_t place = 1; const auto found = take_box(keys); ++place)
    if (found->kind == "mdta" && found->data == key) return place;
  return 0;
}

/// By the table of "well-known types".
std::optional<std::string> text_of(std::uint64_t type, Bytes value) {
  enum { kUtf8 = 1, kSigned = 21, kUnsigned = 22, kFloat = 23, kDouble = 24 };
  const std::uint64_t bits = big_endian(value.substr(0, 8));
  const bool is_number = !value.empty() && value.size() <= 8;
  if (type == kUtf8) return std::string(value.substr(0, value.find('\0')));
  if (type == kUnsigned && is_number) return std::to_string(bits);
  if (type == kSigned && is_number) {
    const auto unused = static_cast<int>(64 - 8 * value.size());
    return std::to_string(static_cast<std::int64_t>(bits << unused) >> unused);
  }
  if (type == kFloat && value.size() == 4)
    return fmt::format("{}", std::bit_cast<float>(static_cast<std::uint32_t>(bits)));
  if (type == kDouble && value.size() == 8) return fmt::format("{}", std::bit_cast<double>(bits));
  return std::nullopt;
}

}  // namespace

MovieFile::MovieFile(const std::filesystem::path& file) : file_(file, std::ios::binary) {
  std::error_code error;
  const std::uint64_t size = std::filesystem::file_size(file, error);
  if (!error && file_) all_.end = size;
}

std::optional<MovieBox> MovieFile::box_in(MovieBox outer, std::string_view kind) {
  std::array<char, 16> head{};
  for (int k = 0; k < kMostBoxes && outer.begin + 8 <= outer.end; ++k) {
    file_.clear();
    file_.seekg(static_cast<std::streamoff>(outer.begin));
    if (!file_.read(head.data(), 8)) return std::nullopt;
    std::uint64_t length = big_endian({head.data(), 4});
    std::uint64_t head_length = 8;
    if (length == 1 && file_.read(head.data() + 8, 8)) {
      length = big_endian({head.data() + 8, 8});
      head_length = 16;
    }
    if (length == 0) length = outer.end - outer.begin;
    if (length < head_length || length > outer.end - outer.begin) return std::nullopt;
    if (std::string_view(head.data() + 4, 4) == kind)
      return MovieBox{outer.begin + head_length, outer.begin + length};
    outer.begin += length;
  }
  return std::nullopt;
}

std::optional<MovieBox> MovieFile::box_at(std::initializer_list<std::string_view> kinds) {
  std::optional<MovieBox> box = all_;
  for (const std::string_view kind : kinds)
    if (box) box = box_in(*box, kind);
  return box;
}

std::string MovieFile::bytes_of(MovieBox box) {
  if (box.end - box.begin > kMostBoxBytes) return "";
  std::string bytes(box.end - box.begin, '\0');
  file_.clear();
  file_.seekg(static_cast<std::streamoff>(box.begin));
  return file_.read(bytes.data(), static_cast<std::streamsize>(bytes.size())) ? bytes : "";
}

std::optional<std::string> metadata_value(Bytes meta, Bytes key) {
  // QuickTime's begins with its first box, MPEG's with a version.
  if (meta.size() >= 12 && meta.substr(4, 4) != "hdlr" && meta.substr(8, 4) == "hdlr")
    meta.remove_prefix(4);
  const std::uint64_t place = place_of(data_in(meta, "keys"), key);
  Bytes values = data_in(meta, "ilst");
  while (const auto value = place > 0 ? take_box(values) : std::nullopt) {
    if (big_endian(value->kind) != place) continue;
    const Bytes data = data_in(value->data, "data");
    constexpr std::size_t kTypeAndLocale = 8;
    if (data.size() < kTypeAndLocale) return std::nullopt;
    return text_of(big_endian(data.substr(0, 4)), data.substr(kTypeAndLocale));
  }
  return std::nullopt;
}

}  // namespace gpo
