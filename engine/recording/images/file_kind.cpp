// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/error.h"
#include "engine/files/byte_cursor.h"
#include "engine/recording/bags/containers/bag.h"
#include "engine/recording/images/images.h"
#include "engine/recording/images/libav.h"

#include <algorithm>
#include <array>
#include <bit>

namespace gpo {
namespace {

using Bytes = std::string_view;

constexpr std::size_t kHeadBytes = 1024;
constexpr Bytes kMatroskaMagic = "\x1A\x45\xDF\xA3";

enum class Container { other, movie, avi, matroska, mpeg };

/// A photo in the container of MP4 (HEIF, AVIF).
bool is_photo_brand(Bytes brand) {
  constexpr std::array<Bytes, 4> kBrands = {"heic", "heix", "mif1", "avif"};
  return std::ranges::find(kBrands, brand) != kBrands.end();
}

bool is_movie_box(Bytes kind) {
  constexpr std::array<Bytes, 7> kBoxes = {"ftyp", "moov", "mdat", "wide", "free", "skip", "pnot"};
  return std::ranges::find(kBoxes, kind) != kBoxes.end();
}

/// Returns whether MPEG-TS packets of `length` bytes begin with the sync byte at `first`.
bool has_packets(Bytes head, std::size_t first, std::size_t length) {
  for (std::size_t at = first; at < first + 4 * length; at += length)
    if (at >= head.size() || head[at] != 'G') return false;
  return true;
}

Container container_of(Bytes head) {
  if (head.size() < 12) return Container::other;
  if (head.starts_with(kMatroskaMagic)) return Container::matroska;
  if (head.starts_with("RIFF") && head.substr(8, 4) == "AVI ") return Container::avi;
  if (is_movie_box(head.substr(4, 4)))
    return is_photo_brand(head.substr(8, 4)) ? Container::other : Container::movie;
  const bool mpeg = head.starts_with(Bytes("\0\0\1\xBA", 4)) || has_packets(head, 0, 188) ||
                    has_packets(head, 4, 192) || has_packets(head, 0, 204);
  return mpeg ? Container::mpeg : Container::other;
}

/// Returns whether libavformat opens the file and finds a video in it, not only sound or a cover.
bool has_video(const fs::path& file) {
  const libav::Format format = libav::open_input(file, libav::kVideoContainers);
  if (!format) return false;
  if ((format->ctx_flags & AVFMTCTX_NOHEADER) != 0) return true;  // streams appear later
  const auto is_video = [](const AVStream* stream) {
    return stream->codecpar->codec_type == AVMEDIA_TYPE_VIDEO &&
           (stream->disposition & AV_DISPOSITION_ATTACHED_PIC) == 0;
  };
  return std::any_of(format->streams, format->streams + format->nb_streams, is_video);
}

/// TIFF is left to the names: raw photos beside JPEGs begin alike.
bool begins_as_image(Bytes head) {
  if (head.starts_with("II") || head.starts_with("MM")) return false;
  return head.starts_with("\xFF\xD8\xFF") || read_image_header(head).has_value();
}

FileKind kind_of_name(const fs::path& file) {
  if (is_image_name(file)) return FileKind::image;
  if (is_video_name(file)) return FileKind::video;
  return is_bag_name(file) ? FileKind::bag : FileKind::other;
}

std::optional<FileKind> kind_of_content(const fs::path& file) {
  try {
    const FileBytes bytes(file);
    const std::string head = bytes.read(0, kHeadBytes);
    if (is_bag(bytes)) return FileKind::bag;
    if (container_of(head) != Container::other && has_video(file)) return FileKind::video;
    if (begins_as_image(head)) return FileKind::image;
  } catch (const InputError&) {
    // Opening it will report the error.
  }
  return std::nullopt;
}

/// Returns the value of one of Matroska's numbers of variable length and moves `at` behind it.
std::optional<std::uint64_t> matroska_number(Bytes head, std::size_t& at) {
  const auto first = static_cast<unsigned char>(big_endian(head, at, 1));
  const auto length = static_cast<std::size_t>(std::countl_zero(first)) + 1;
  if (length > 8 || at + length > head.size()) return std::nullopt;
  const std::uint64_t mask = (std::uint64_t{1} << 7 * length) - 1;
  const std::uint64_t value = big_endian(head, at, length) & mask;
  at += length;
  return value == mask ? std::nullopt : std::optional(value);  // all bits: unknown
}

/// Returns the length in the file of the outermost element that begins with `head`; 0 if unknown.
std::uint64_t element_bytes(Container container, Bytes head) {
  if (container == Container::avi) {
    const std::uint64_t size = little_endian(head, 4, 4);
    return head.starts_with("RIFF") && size > 0 && size < 0xFFFFFFF0 ? size + 8 : 0;
  }
  if (container == Container::movie) {
    const std::uint64_t size = big_endian(head, 0, 4);
    return size == 1 ? big_endian(head, 8, 8) : size;
  }
  std::size_t at = 0;
  if (container != Container::matroska || !matroska_number(head, at)) return 0;
  const auto size = matroska_number(head, at);
  return size ? at + *size : 0;
}

}  // namespace

FileKind kind_of(const fs::path& file) {
  if (is_image_name(file)) return FileKind::image;
  return kind_of_content(file).value_or(kind_of_name(file));
}

std::vector<fs::path> files_of_kind(const fs::path& folder, FileKind kind) {
  std::vector<fs::path> files =
      files_of_kind(folder, [kind](const fs::path& file) { return kind_of_name(file) == kind; });
  if (!files.empty()) return files;
  return files_of_kind(folder, [kind](const fs::path& file) { return kind_of(file) == kind; });
}

bool ends_early(const fs::path& file) {
  const FileBytes bytes(file);
  const Container container = container_of(bytes.read(0, kHeadBytes));
  for (std::uint64_t place = 0; place < bytes.size();) {
    const std::uint64_t length = element_bytes(container, bytes.read(place, 16));
    if (length < 8) return false;
    if (length > bytes.size() - place) return true;
    place += length;
  }
  return false;
}

}  // namespace gpo
