// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/layouts/metadata_field_of_view.h"

#include "engine/base/error.h"
#include "engine/files/text_file.h"
#include "engine/recording/file_kinds.h"
#include "engine/recording/loggers/gpmf.h"
#include "engine/recording/loggers/telemetry_track.h"
#include "engine/recording/images/libav.h"

#include <array>
#include <cmath>
#include <exception>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

#include <exiv2/exiv2.hpp>
#include <fmt/format.h>

namespace gpo {
namespace {

namespace fs = std::filesystem;

/// Of a tag; 0: not there, which to EXIF is "unknown" as well.
double number(const Exiv2::ExifData& data, const char* tag) {
  const auto found = data.findKey(Exiv2::ExifKey(tag));
  if (found == data.end() || found->count() < 1) return 0;
  const double value = static_cast<double>(found->toFloat());
  return std::isfinite(value) ? value : 0;
}

/// How long the unit of the sensor's resolution is [mm]; 0: not told. The standard knows inches,
/// which are the default, and centimeters; cameras two more.
double resolution_unit_mm(double unit) {
  constexpr std::array<std::pair<int, double>, 5> kUnits = {
      {{0, 25.4}, {2, 25.4}, {3, 10}, {4, 1}, {5, 1e-3}}};
  for (const auto& [number, mm] : kUnits)
    if (unit == number) return mm;
  return 0;
}

std::optional<MetadataFieldOfView> view_of(const Exiv2::ExifData& data) {
  const double equivalent_mm = number(data, "Exif.Photo.FocalLengthIn35mmFilm");
  if (auto view =
          view_of_equivalent(equivalent_mm, fmt::format("EXIF: {:g} mm equivalent", equivalent_mm)))
    return view;
  const double focal_mm = number(data, "Exif.Photo.FocalLength");
  const double unit_mm = resolution_unit_mm(number(data, "Exif.Photo.FocalPlaneResolutionUnit"));
  const double pixels_a_unit = number(data, "Exif.Photo.FocalPlaneXResolution");
  const double diagonal_px = std::hypot(number(data, "Exif.Photo.PixelXDimension"),
                                        number(data, "Exif.Photo.PixelYDimension"));
  const double diagonal_mm = diagonal_px * unit_mm / pixels_a_unit;
  if (!(focal_mm > 0 && diagonal_mm > 0 && std::isfinite(diagonal_mm))) return std::nullopt;
  return view_of_focal(
      focal_mm / diagonal_mm,
      fmt::format("EXIF: {:.4g} mm on a sensor of {:.3g} mm", focal_mm, diagonal_mm));
}

/// Apple's, of a video's track: "26", "50.00mm", or a number.
constexpr const char* kEquivalent = "com.apple.quicktime.camera.focal_length.35mm_equivalent";

std::optional<double> millimeters(std::string_view text) {
  if (text.ends_with("mm")) text.remove_suffix(2);
  return parse_number(trimmed(text));
}

/// What FFmpeg knows: of the whole file, and of tracks in other containers than QuickTime's.
std::optional<std::string> found_by_ffmpeg(const fs::path& video, const char* key) {
  const libav::Format format = libav::open_input(video, "mov,matroska");
  if (!format) return std::nullopt;
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

std::optional<MetadataFieldOfView> view_of_device(const GpmfItem& device, const std::string& source) {
  double diagonal_deg = 0;
  bool linear = false;
  GpmfItems items(device.data, source);
  while (const auto item = items.next()) {
    if (item->key == "VFOV") linear = gpmf_text(*item) == "L";
    if (item->key != "ZFOV") continue;
    const auto numbers = gpmf_numbers(*item, source);
    if (!numbers.empty()) diagonal_deg = numbers[0];
  }
  return view_of_angle(diagonal_deg,
                       !linear,
                       fmt::format("GoPro's settings: {:.0f} degrees along the diagonal{}",
                                   diagonal_deg,
                                   linear ? "" : " of a fisheye"));
}

}  // namespace

std::optional<MetadataFieldOfView> metadata_field_of_view(const std::filesystem::path& file) {
  if (!is_video_name(file)) return view_of_exif(file);
  const auto gopro = view_of_gpmf(gopro_settings(file));
  return gopro ? gopro : view_of_metadata(file);
}

std::optional<MetadataFieldOfView> view_of_exif(const fs::path& photo) {
  static std::mutex one_at_a_time;  // its reader of XMP wants it
  const std::scoped_lock lock(one_at_a_time);
  Exiv2::LogMsg::setLevel(Exiv2::LogMsg::mute);
  try {
    // From the root on, or a name that begins like an address would be taken for one.
    const auto image = Exiv2::ImageFactory::open(fs::absolute(photo).string(), false);
    image->readMetadata();
    return view_of(image->exifData());
  } catch (const std::exception&) {  // what it cannot read tells nothing
    return std::nullopt;
  }
}

std::optional<MetadataFieldOfView> view_of_metadata(const fs::path& video) {
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

std::optional<MetadataFieldOfView> view_of_gpmf(std::string_view settings) {
  const std::string source = "settings";
  try {
    GpmfItems devices(settings, source);
    while (const auto device = devices.next()) {
      if (device->key != "DEVC" || device->type != 0) continue;
      if (auto view = view_of_device(*device, source)) return view;
    }
  } catch (const InputError&) {  // cut: nothing is known
  }
  return std::nullopt;
}

}  // namespace gpo
