// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/pictures/video_metadata.h"

#include "engine/files/text_file.h"
#include "engine/recording/pictures/libav.h"
#include "engine/recording/pictures/movie_boxes.h"

#include <memory>
#include <string>
#include <string_view>

#include <fmt/format.h>

namespace gpo {
namespace {

namespace fs = std::filesystem;

/// Apple's, of a video's track: "26", "50.00mm", or a number.
constexpr const char* kEquivalent = "com.apple.quicktime.camera.focal_length.35mm_equivalent";

std::optional<double> millimeters(std::string_view text) {
  if (text.ends_with("mm")) text.remove_suffix(2);
  return parse_number(trimmed(text));
}

/// What FFmpeg knows: of the whole file, and of tracks in other containers than QuickTime's.
std::optional<std::string> found_by_ffmpeg(const fs::path& video, const char* key) {
  AVFormatContext* opened = nullptr;
  AVDictionary* options = nullptr;
  av_dict_set(&options, "format_whitelist", "mov,matroska", 0);
  const std::string address = "file:" + video.string();
  const int error = avformat_open_input(&opened, address.c_str(), nullptr, &options);
  av_dict_free(&options);
  if (error < 0) return std::nullopt;
  const std::unique_ptr<AVFormatContext, libav::Closer<avformat_close_input>> format(opened);
  const AVDictionaryEntry* entry = av_dict_get(format->metadata, key, nullptr, 0);
  for (unsigned i = 0; i < format->nb_streams && entry == nullptr; ++i)
    entry = av_dict_get(format->streams[i]->metadata, key, nullptr, 0);
  return entry == nullptr ? std::nullopt : std::optional<std::string>(entry->value);
}

/// The boxes `meta` of tracks, which FFmpeg does not read.
std::optional<std::string> found_in_tracks(const fs::path& video, const char* key) {
  constexpr int kMostTracks = 100;
  MovieFile movie(video);
  const auto all = movie.box_at({"moov"});
  auto track = all ? movie.box_in(*all, "trak") : std::nullopt;
  for (int k = 0; track && k < kMostTracks; ++k) {
    if (const auto meta = movie.box_in(*track, "meta"))
      if (auto value = metadata_value(movie.bytes_of(*meta), key)) return value;
    track = movie.box_in({track->end, all->end}, "trak");
  }
  return std::nullopt;
}

}  // namespace

std::optional<ToldView> view_of_metadata(const fs::path& video) {
  for (const auto find : {found_in_tracks, found_by_ffmpeg}) {
    const auto text = find(video, kEquivalent);
    const auto focal_mm = text ? millimeters(*text) : std::nullopt;
    if (!focal_mm) continue;
    return view_of_equivalent(
        *focal_mm,
        fmt::format("the video's metadata: {:.4g} mm equivalent, less what steadying it cuts off",
                    *focal_mm));
  }
  return std::nullopt;
}

}  // namespace gpo
