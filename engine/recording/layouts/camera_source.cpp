// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/error.h"
#include "engine/files/refuse.h"
#include "engine/files/text_file.h"
#include "engine/recording/companions/companion_files.h"
#include "engine/recording/images/images.h"
#include "engine/recording/images/libav.h"
#include "engine/recording/layouts/open_recording.h"
#include "engine/recording/loggers/logs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <string_view>

#include <exiv2/exiv2.hpp>
#include <fmt/format.h>

namespace gpo {
namespace {

constexpr double kLeastView_deg = 10, kMostView_deg = 170;
constexpr double kLeastFocal_mm = 5, kMostFocal_mm = 500;

constexpr std::string_view kGuess = "no calibration: ";
constexpr std::string_view kSelfCalibrated = "self-calibrated camera";

bool is_within(double value, double least, double most) { return value >= least && value <= most; }

std::optional<FieldOfView> view_of_focal(double focal_diagonals, const std::string& source) {
  const double view_deg = degrees(2 * std::atan2(0.5, focal_diagonals));
  if (!is_within(view_deg, kLeastView_deg, kMostView_deg)) return std::nullopt;
  return FieldOfView{focal_diagonals, false, source};
}

/// `focal_mm` has the same diagonal angle on film of 36 x 24 mm.
std::optional<FieldOfView> view_of_equivalent(double focal_mm, const std::string& source) {
  if (!is_within(focal_mm, kLeastFocal_mm, kMostFocal_mm)) return std::nullopt;
  return view_of_focal(focal_mm / std::hypot(36, 24), source);
}

std::optional<FieldOfView> view_of_angle(double diagonal_deg,
                                         bool fisheye,
                                         const std::string& source) {
  if (!is_within(diagonal_deg, kLeastView_deg, kMostView_deg)) return std::nullopt;
  const double half_rad = radians(diagonal_deg) / 2;
  return FieldOfView{0.5 / (fisheye ? half_rad : std::tan(half_rad)), fisheye, source};
}

/// Returns an image's EXIF; empty if it is missing or unreadable. The kind of a file follows from
/// its content: of Exiv2's other readers, that of RIFF videos writes beyond its buffers.
Exiv2::ExifData exif_of(const fs::path& photo) {
  static std::mutex one_at_a_time;  // required by Exiv2's XMP reader
  const std::scoped_lock lock(one_at_a_time);
  Exiv2::LogMsg::setLevel(Exiv2::LogMsg::mute);
  try {
    // An absolute path cannot be mistaken for a URL.
    const auto image = Exiv2::ImageFactory::open(fs::absolute(photo).string(), false);
    constexpr std::array<std::string_view, 4> kRead = {
        "image/jpeg", "image/png", "image/tiff", "image/webp"};
    if (std::ranges::find(kRead, image->mimeType()) == kRead.end()) return {};
    image->readMetadata();
    return image->exifData();
  } catch (const std::exception&) {
    return {};
  }
}

/// Returns 0 for a missing tag; EXIF itself uses it for "unknown".
double number(const Exiv2::ExifData& data, const char* tag) {
  const auto found = data.findKey(Exiv2::ExifKey(tag));
  if (found == data.end() || found->count() < 1) return 0;
  const double value = static_cast<double>(found->toFloat());
  return std::isfinite(value) ? value : 0;
}

/// Unit of the sensor's resolution [mm]: inches, centimeters, and two of cameras; 0 if unknown.
double resolution_unit_mm(double unit) {
  static const std::map<double, double> kUnits = {{0, 25.4}, {2, 25.4}, {3, 10}, {4, 1}, {5, 1e-3}};
  const auto found = kUnits.find(unit);
  return found == kUnits.end() ? 0 : found->second;
}

std::optional<FieldOfView> view_of(const Exiv2::ExifData& data) {
  const double film_mm = number(data, "Exif.Photo.FocalLengthIn35mmFilm");
  if (auto view = view_of_equivalent(film_mm, fmt::format("EXIF ({:g} mm equivalent)", film_mm)))
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
      fmt::format("EXIF ({:.4g} mm on a sensor of {:.3g} mm)", focal_mm, diagonal_mm));
}

/// Apple's key in a video's track: "26", "50.00mm", or a number.
constexpr const char* kEquivalent = "com.apple.quicktime.camera.focal_length.35mm_equivalent";

std::optional<double> millimeters(std::string_view text) {
  if (text.ends_with("mm")) text.remove_suffix(2);
  return parse_number(trimmed(text));
}

std::optional<std::string> ffmpeg_metadata(const fs::path& video, const char* key) {
  const libav::Format format = libav::open_input(video, "mov,matroska");
  if (!format) return std::nullopt;
  const AVDictionaryEntry* entry = libav::av_dict_get(format->metadata, key, nullptr, 0);
  for (unsigned i = 0; i < format->nb_streams && entry == nullptr; ++i)
    entry = libav::av_dict_get(format->streams[i]->metadata, key, nullptr, 0);
  return entry == nullptr ? std::nullopt : std::optional<std::string>(entry->value);
}

std::optional<std::string> track_metadata(const fs::path& video, const char* key) {
  constexpr int kMostTracks = 100;
  const FileBytes movie(video);
  const auto all = box_at(movie, {"moov"});
  auto track = all ? box_in(movie, *all, "trak") : std::nullopt;
  for (int k = 0; track && k < kMostTracks; ++k) {
    if (const auto meta = box_in(movie, *track, "meta"))
      if (auto value = metadata_value(bytes_of(movie, *meta), key)) return value;
    track = box_in(movie, {track->end, all->end}, "trak");
  }
  return std::nullopt;
}

std::optional<FieldOfView> view_of_device(const GpmfItem& device) {
  double diagonal_deg = 0;
  bool linear = false;
  GpmfItems items(device.data, *device.source);
  while (const auto item = items.next()) {
    if (item->key == "VFOV") linear = gpmf_text(*item) == "L";
    if (item->key != "ZFOV") continue;
    const auto numbers = gpmf_numbers(*item);
    if (!numbers.empty()) diagonal_deg = numbers[0];
  }
  return view_of_angle(
      diagonal_deg,
      !linear,
      fmt::format(
          "the GoPro's settings ({:.0f} deg diagonal{})", diagonal_deg, linear ? "" : ", fisheye"));
}

}  // namespace

std::optional<FieldOfView> stored_view(const fs::path& file) {
  if (kind_of(file) != FileKind::video) return view_of_exif(file);
  const auto gopro = view_of_gpmf(gopro_settings(file));
  return gopro ? gopro : view_of_metadata(file);
}

std::optional<FieldOfView> view_of_exif(const fs::path& photo) { return view_of(exif_of(photo)); }

int quarter_turns_of_exif(std::span<const fs::path> image_files) {
  if (image_files.empty() || kind_of(image_files.front()) != FileKind::image) return 0;
  // Mirrored images (2, 4, 5, 7) are turned until they only lack the mirroring.
  constexpr std::array kTurns = {0, 0, 0, 2, 2, 1, 1, 3, 3};
  const double orientation = number(exif_of(image_files.front()), "Exif.Image.Orientation");
  return is_within(orientation, 1, 8) ? kTurns[static_cast<std::size_t>(orientation)] : 0;
}

std::optional<FieldOfView> view_of_metadata(const fs::path& video) {
  for (const auto find : {track_metadata, ffmpeg_metadata}) {
    const auto text = find(video, kEquivalent);
    const auto focal_mm = text ? millimeters(*text) : std::nullopt;
    if (!focal_mm) continue;
    return view_of_equivalent(
        *focal_mm,
        fmt::format("the video's metadata ({:.4g} mm equivalent, before any crop by stabilization)",
                    *focal_mm));
  }
  return std::nullopt;
}

std::optional<FieldOfView> view_of_gpmf(std::string_view settings) {
  const std::string source = "settings";
  try {
    GpmfItems devices(settings, source);
    while (const auto device = devices.next()) {
      if (device->key != "DEVC" || device->type != 0) continue;
      if (auto view = view_of_device(*device)) return view;
    }
  } catch (const InputError&) {
    // Truncated settings are unusable.
  }
  return std::nullopt;
}

void set_camera(Recording& recording,
                const Camera& camera,
                CameraSource source,
                const std::string& detail) {
  recording.camera = camera;
  recording.camera_source = source;
  std::erase_if(recording.notes, [](const std::string& note) {
    return note.starts_with(kGuess) || note.starts_with(kSelfCalibrated);
  });
  if (source == CameraSource::file) return;
  const std::string note = source == CameraSource::guess
                               ? fmt::format("{}{}", kGuess, detail)
                               : fmt::format("{} ({})", kSelfCalibrated, detail);
  recording.notes.insert(recording.notes.begin(), note);
}

void take_source(Recording& recording, const Calibration& calibration) {
  if (calibration.source == CameraSource::file) return;
  const bool guess = calibration.source == CameraSource::guess;
  const std::string detail =
      guess ? calibration.name + " has a guess; run `calibrate`" : calibration.name;
  set_camera(recording, recording.camera, calibration.source, detail);
}

void check_image_size(const Recording& recording, const fs::path& calibration_file) {
  if (recording.camera.width == 0)
    refuse(calibration_file,
           "key `image_width`: found no value, expected a number of pixels, since there are no "
           "images");
}

void guess_camera(Recording& recording,
                  const std::optional<FieldOfView>& view,
                  double pixel_aspect) {
  const int height = recording.camera.height;
  const int width = static_cast<int>(std::lround(pixel_aspect * recording.camera.width));
  Camera camera =
      view ? camera_of_focal(width, height, view->focal_diagonals) : camera_of_view(width, height);
  if (view && view->fisheye) {
    camera.distortion = Distortion::equidistant;
    camera.coefficients.assign(4, 0.0);
  }
  camera.width = recording.camera.width;
  camera.fx /= pixel_aspect;
  camera.cx = camera_of_view(camera.width, height).cx;
  camera.readout_direction = recording.camera.readout_direction;
  std::string detail =
      view ? "field of view from " + view->source
           : fmt::format("assuming a {:.0f} deg diagonal field of view", kUsualView_deg);
  if (pixel_aspect != 1)
    detail += fmt::format(", pixels {:.4g} times as wide as high", pixel_aspect);
  set_camera(recording, camera, CameraSource::guess, detail + "; run `calibrate`");
}

}  // namespace gpo
