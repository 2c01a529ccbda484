// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/pictures/exif_view.h"

#include <array>
#include <cmath>
#include <exception>
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

std::optional<ToldView> view_of(const Exiv2::ExifData& data) {
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

}  // namespace

std::optional<ToldView> view_of_exif(const fs::path& picture) {
  static std::mutex one_at_a_time;  // its reader of XMP wants it
  const std::scoped_lock lock(one_at_a_time);
  Exiv2::LogMsg::setLevel(Exiv2::LogMsg::mute);
  try {
    // From the root on, or a name that begins like an address would be taken for one.
    const auto image = Exiv2::ImageFactory::open(fs::absolute(picture).string(), false);
    image->readMetadata();
    return view_of(image->exifData());
  } catch (const std::exception&) {  // what it cannot read tells nothing
    return std::nullopt;
  }
}

}  // namespace gpo
