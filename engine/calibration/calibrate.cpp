// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/calibration/calibrate.h"

#include "engine/calibration/lens_estimate.h"
#include "engine/geometry/statistics.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

namespace gpo {

namespace {

using Views = std::vector<CalibrationView>;

constexpr int kMostViews = 60;
constexpr double kLeastSlantDeg = 10;
constexpr double kMostFocalSigma = 0.05;  // share of the focal length

/// "the focal length (fx)", ...: the first that is not determined; empty if all are.
std::string undetermined_intrinsics(const LensEstimate& estimate) {
  if (estimate.sigmas.empty()) return "the focal length";
  const Camera& camera = estimate.solution->camera;
  for (int k = 0; k < 4; ++k)
    if (estimate.sigmas[k] > kMostFocalSigma * camera.fx)
      return fmt::format(
          "the {} ({})", k < 2 ? "focal length" : "principal point", parameter_names(camera)[k]);
  return "";
}

double coverage(const Views& views, cv::Size size) {
  constexpr int kColumns = 8, kRows = 6;
  std::set<std::pair<int, int>> cells;
  for (const CalibrationView& view : views) {
    for (const auto& corner : view.corners) {
      if (!corner.allFinite()) continue;
      cells.emplace(
          std::clamp(static_cast<int>(corner.x() * kColumns / size.width), 0, kColumns - 1),
          std::clamp(static_cast<int>(corner.y() * kRows / size.height), 0, kRows - 1));
    }
  }
  return static_cast<double>(cells.size()) / (kColumns * kRows);
}

std::vector<std::string> warnings_of(const CameraCalibration& result) {
  std::vector<std::string> warnings;
  if (result.coverage < 0.6)
    warnings.push_back(
        fmt::format("The board covers only {:.0f} % of the image, the lens is unknown in the rest: "
                    "move the board into the corners",
                    100 * result.coverage));
  if (result.slant_deg < 25)
    warnings.push_back(
        fmt::format("The board was slanted by only {:.0f} deg, so the focal length is uncertain: "
                    "film the board from the side",
                    result.slant_deg));
  if (result.camera.sigmas[0] > 0.01 * result.camera.fx)
    warnings.push_back(fmt::format("The uncertainty of the focal length is {:.1f} %",
                                   100 * result.camera.sigmas[0] / result.camera.fx));
  if (result.rms_px > 1)
    warnings.push_back(
        fmt::format("The reprojection error is {:.2f} px RMS: blur, a board that is not flat, or "
                    "another lens model",
                    result.rms_px));
  return warnings;
}

std::string why_too_few(const BoardSearch& search, std::size_t sharp) {
  std::string why =
      fmt::format("found the board in {} of {} images", search.views.size(), search.examined);
  if (sharp < search.views.size())
    why += fmt::format(", but only {} are sharp and show it from a usable side", sharp);
  why += fmt::format("; at least {} are needed", kLeastViews);
  if (const auto& other = search.other_counts)
    why +=
        fmt::format(". The images show a chessboard of {0}x{1} inner corners; use --board {0}x{1}",
                    other->width,
                    other->height);
  return why;
}

Camera unknown_camera(cv::Size size, const CalibrationOptions& options) {
  // That of a fisheye of 180 degrees; the other model finds its own start.
  const double focal_px = size.width / std::numbers::pi;
  const bool equidistant = options.distortion == Distortion::equidistant;
  return {.width = size.width,
          .height = size.height,
          .fx = focal_px,
          .fy = focal_px,
          .cx = 0.5 * (size.width - 1),
          .cy = 0.5 * (size.height - 1),
          .distortion = options.distortion,
          .coefficients = std::vector<double>(equidistant ? 4 : options.coefficients),
          .readout = options.readout,
          .readout_direction = options.readout_direction};
}

}  // namespace

CameraCalibration calibrate_camera(const BoardSearch& search,
                                   const Board& board,
                                   const CalibrationOptions& options) {
  CameraCalibration result;
  result.examined = search.examined;
  result.found = static_cast<int>(search.views.size());
  const Views views = choose_views(search, board, kMostViews);
  const auto failed = [&](std::string reason) {
    result.reason = std::move(reason);
    return result;
  };
  if (views.size() < kLeastViews) return failed(why_too_few(search, views.size()));
  std::vector<std::string> left_at_0;
  const LensEstimate estimate =
      estimate_lens(views, board, unknown_camera(search.size, options), left_at_0);
  const auto& solution = estimate.solution;
  if (!solution)
    return failed("the views do not determine a camera; film the board from more sides");
  std::vector<double> slants_deg = solution->slant_deg;
  std::ranges::sort(slants_deg);
  result.slant_deg = quantile(slants_deg, 0.9);
  if (result.slant_deg < kLeastSlantDeg)
    return failed(
        fmt::format("the board is never slanted by more than {:.0f} deg, so focal length "
                    "and distance cannot be separated; film the board from the side",
                    result.slant_deg));
  if (const std::string unknown = undetermined_intrinsics(estimate); !unknown.empty())
    return failed(unknown +
                  " changes by more than 5 % with single views; film the board from more sides");
  result.ok = true;
  result.camera = solution->camera;
  result.camera.readout = estimate.readout;
  set_lens_covariance(result.camera, estimate.covariance);
  result.rms_px = solution->rms_px;
  result.bend_m = solution->bend_m;
  for (const auto& view : estimate.views) result.frames.push_back(view.frame);
  result.coverage = coverage(estimate.views, search.size);
  result.warnings = warnings_of(result);
  result.warnings.insert(result.warnings.end(), left_at_0.begin(), left_at_0.end());
  return result;
}

}  // namespace gpo
