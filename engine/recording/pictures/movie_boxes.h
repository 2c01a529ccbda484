// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>

namespace gpo {

/// Where a box of an MP4 or MOV holds what it holds [bytes of the file].
struct MovieBox {
  std::uint64_t begin = 0, end = 0;
};

/// The boxes of an MP4 or MOV that FFmpeg passes over. Any other file has none.
class MovieFile {
 public:
  explicit MovieFile(const std::filesystem::path& file);

  MovieBox all() const { return all_; }
  /// The first box of that kind inside of another one.
  std::optional<MovieBox> box_in(MovieBox outer, std::string_view kind);
  /// By the kinds of the boxes that hold each other, from the outermost on.
  std::optional<MovieBox> box_at(std::initializer_list<std::string_view> kinds);
  /// Empty where it is larger than 1 MiB, or cannot be read.
  std::string bytes_of(MovieBox box);

 private:
  std::ifstream file_;
  MovieBox all_;
};

/// A value, by its key, of what a box `meta` holds (QuickTime File Format, "Metadata"); a number as
/// text. Nothing where it has none, or cannot be read.
std::optional<std::string> metadata_value(std::string_view meta, std::string_view key);

}  // namespace gpo
