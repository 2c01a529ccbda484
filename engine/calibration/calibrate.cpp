// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/calibration/calibrate.h"

#include "engine/base/parallel.h"
#include "engine/geometry/pose.h"
#include "engine/geometry/statistics.h"
#include "engine/recording/board/board_pose.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <set>
#include <thread>
#include <utility>

#include <fmt/format.h>
#include <opencv2/calib3d.hpp>

namespace gpo {

namespace {

using Views = std::vector<CalibrationView>;

constexpr int kLeastViews = 8;
constexpr int kBlocks = 10;
constexpr double kMostTimesMedian = 2;  // the RMS of a view that is kept
const cv::TermCriteria kEnough(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 50, 1e-9);
constexpr double kLeastSlantDeg = 10;
constexpr double kMostFocalSigma = 0.05;  // of the focal length

/// One least squares.
struct Solution {
  Camera camera;
  double rms_px = 0;
  std::vector<double> sigmas;       ///< the least squares' own; empty where it tells none
  std::vector<double> view_rms_px;  ///< one a view
  std::vector<double> slant_deg;    ///< one a view
};

/// Corners that are seen, one list a view, as OpenCV wants them.
struct Correspondences {
  std::vector<std::vector<cv::Point3f>> points;
  std::vector<std::vector<cv::Point2f>> pixels;
};

Correspondences correspondences(const Views& views, const Board& board) {
  const auto all = board_points(board);
  Correspondences result;
  for (const CalibrationView& view : views) {
    auto& points = result.points.emplace_back();
    auto& pixels = result.pixels.emplace_back();
    for (std::size_t i = 0; i < all.size(); ++i) {
      const Eigen::Vector2f px = view.corners[i].cast<float>();
      if (!px.allFinite()) continue;
      points.emplace_back(static_cast<float>(all[i].x()), static_cast<float>(all[i].y()), 0.0F);
      pixels.emplace_back(px.x(), px.y());
    }
  }
  return result;
}

cv::Matx33d intrinsics_of(const Camera& camera) {
  return {camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1};
}

/// Takes over what OpenCV found.
void set_parameters(Camera& camera, const cv::Matx33d& K, const cv::Mat& coefficients) {
  camera.fx = K(0, 0);
  camera.fy = K(1, 1);
  camera.cx = K(0, 2);
  camera.cy = K(1, 2);
  for (std::size_t i = 0; i < camera.coefficients.size(); ++i) {
    camera.coefficients[i] = coefficients.at<double>(static_cast<int>(i));
  }
}

double slant_deg(const cv::Mat& rotation_vector) {
  const cv::Mat_<double> v(rotation_vector);
  const Eigen::Matrix3d R = so3_exp({v(0), v(1), v(2)});
  return degrees(std::acos(std::clamp(std::abs(R(2, 2)), 0.0, 1.0)));
}

/// From which camera, whether it is one already, and whether the least squares' own standard
/// deviations are wanted, which takes longer than all the rest.
struct Start {
  Camera camera;
  bool known = false;
  bool with_sigmas = true;
};

Solution solve_radial_tangential(const Correspondences& seen, const Start& start) {
  Camera camera = start.camera;
  Solution solution;
  cv::Mat K(intrinsics_of(camera));
  cv::Mat coefficients(camera.coefficients, true);
  std::vector<cv::Mat> rotations;
  std::vector<cv::Mat> translations;
  cv::Mat sigmas;
  // By LU: OpenCV's singular value decomposition of all views' unknowns takes seconds.
  int flags = cv::CALIB_USE_LU | (start.known ? cv::CALIB_USE_INTRINSIC_GUESS : 0);
  if (camera.coefficients.size() == 4) flags |= cv::CALIB_FIX_K3;
  if (camera.coefficients.size() == 8) flags |= cv::CALIB_RATIONAL_MODEL;
  solution.rms_px = cv::calibrateCamera(seen.points,
                                        seen.pixels,
                                        {camera.width, camera.height},
                                        K,
                                        coefficients,
                                        rotations,
                                        translations,
                                        start.with_sigmas ? cv::OutputArray(sigmas) : cv::noArray(),
                                        cv::noArray(),
                                        solution.view_rms_px,
                                        flags,
                                        kEnough);
  set_parameters(camera, K, coefficients);
  solution.camera = camera;
  for (std::size_t i = 0; start.with_sigmas && i < 4 + camera.coefficients.size(); ++i) {
    solution.sigmas.push_back(sigmas.at<double>(static_cast<int>(i)));
  }
  for (const auto& rotation : rotations) solution.slant_deg.push_back(slant_deg(rotation));
  return solution;
}

Solution solve_equidistant(const Correspondences& seen, const Start& start) {
  Camera camera = start.camera;
  Solution solution;
  cv::Mat K(intrinsics_of(camera));
  cv::Mat coefficients(camera.coefficients, true);
  std::vector<cv::Mat> rotations;
  std::vector<cv::Mat> translations;
  int flags = cv::fisheye::CALIB_RECOMPUTE_EXTRINSIC | cv::fisheye::CALIB_FIX_SKEW;
  if (start.known) flags |= cv::fisheye::CALIB_USE_INTRINSIC_GUESS;
  solution.rms_px = cv::fisheye::calibrate(seen.points,
                                           seen.pixels,
                                           {camera.width, camera.height},
                                           K,
                                           coefficients,
                                           rotations,
                                           translations,
                                           flags,
                                           kEnough);
  set_parameters(camera, K, coefficients);
  solution.camera = camera;
  for (std::size_t i = 0; i < rotations.size(); ++i) {
    std::vector<cv::Point2f> projected;
    cv::fisheye::projectPoints(
        seen.points[i], projected, rotations[i], translations[i], K, coefficients);
    const double norm = cv::norm(projected, seen.pixels[i]);
    solution.view_rms_px.push_back(norm / std::sqrt(static_cast<double>(projected.size())));
    solution.slant_deg.push_back(slant_deg(rotations[i]));
  }
  return solution;
}

bool plausible(const Camera& camera) {
  const double largest = 20.0 * std::max(camera.width, camera.height);
  const auto all = parameters(camera);
  return std::all_of(all.begin(), all.end(), [](double p) { return std::isfinite(p); }) &&
         camera.fx > 0 && camera.fy > 0 && camera.fx < largest && camera.fy < largest &&
         camera.cx > 0 && camera.cx < camera.width && camera.cy > 0 && camera.cy < camera.height;
}

/// Nothing where the least squares come to nothing sensible.
std::optional<Solution> solve(const Views& views, const Board& board, const Start& start) {
  try {
    const Correspondences seen = correspondences(views, board);
    Solution solution = start.camera.distortion == Distortion::equidistant
                            ? solve_equidistant(seen, start)
                            : solve_radial_tangential(seen, start);
    if (plausible(solution.camera)) return solution;
  } catch (const cv::Exception&) {
    // OpenCV's word for views that fix no camera.
  }
  return std::nullopt;
}

/// Leaves out the views that fit far worse than the others and solves again, while there are such.
std::optional<Solution> solve_without_bad(Views& views, const Board& board, const Camera& start) {
  constexpr int kRounds = 4;
  auto solution = solve(views, board, {start});
  for (int round = 0; solution && round < kRounds; ++round) {
    const double most = kMostTimesMedian * median(solution->view_rms_px);
    Views good;
    for (std::size_t i = 0; i < views.size(); ++i) {
      if (solution->view_rms_px[i] <= most) good.push_back(views[i]);
    }
    if (good.size() == views.size() || good.size() < kLeastViews) break;
    views = std::move(good);
    solution = solve(views, board, {solution->camera, true});
  }
  return solution;
}

/// sigma^2 = (g - 1) / g sum (theta_i - mean)^2 over the solutions without one of g blocks of time.
/// Nothing where one of them fails.
std::optional<std::vector<double>> jackknife_sigmas(const Views& views,
                                                    const Board& board,
                                                    const Camera& camera) {
  const int count = static_cast<int>(views.size());
  const int blocks = std::min(kBlocks, count);
  std::vector<std::optional<Solution>> solutions(blocks);
  in_parallel(blocks, static_cast<int>(std::thread::hardware_concurrency()), [&](int block) {
    Views others;
    for (int i = 0; i < count; ++i) {
      if (i * blocks / count != block) others.push_back(views[i]);
    }
    solutions[block] = solve(others, board, {camera, true, false});
  });
  const std::size_t unknowns = parameters(camera).size();
  std::vector<double> mean(unknowns, 0);
  std::vector<double> sigmas(unknowns, 0);
  for (const auto& solution : solutions) {
    if (!solution) return std::nullopt;
    const auto values = parameters(solution->camera);
    for (std::size_t k = 0; k < unknowns; ++k) mean[k] += values[k] / blocks;
  }
  for (const auto& solution : solutions) {
    const auto values = parameters(solution->camera);
    for (std::size_t k = 0; k < unknowns; ++k) sigmas[k] += std::pow(values[k] - mean[k], 2);
  }
  for (double& sigma : sigmas) sigma = std::sqrt(sigma * (blocks - 1) / blocks);
  return sigmas;
}

/// Share of 8 x 6 cells of the picture that hold a corner.
double coverage(const Views& views, cv::Size size) {
  constexpr int kColumns = 8;
  constexpr int kRows = 6;
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
  if (result.coverage < 0.6) {
    warnings.push_back(
        fmt::format("the board was seen in {:.0f} % of the picture only: the lens is not known in "
                    "the rest; move the board into the corners",
                    100 * result.coverage));
  }
  if (result.slant_deg < 25) {
    warnings.push_back(
        fmt::format("the board was hardly slanted (up to {:.0f} deg): the focal length is little "
                    "certain; look at it from the side",
                    result.slant_deg));
  }
  if (result.sigmas[0] > 0.01 * result.camera.fx) {
    warnings.push_back(fmt::format("the focal length is known to {:.1f} % only",
                                   100 * result.sigmas[0] / result.camera.fx));
  }
  if (result.rms_px > 1) {
    warnings.push_back(
        fmt::format("corners are {:.2f} px off (RMS): blur, a board that is not flat, or another "
                    "lens model",
                    result.rms_px));
  }
  return warnings;
}

CameraCalibration failed(CameraCalibration result, std::string reason) {
  result.reason = std::move(reason);
  return result;
}

Camera unknown_camera(cv::Size size, const CalibrationOptions& options) {
  Camera camera;
  camera.width = size.width;
  camera.height = size.height;
  // What a fisheye of 180 degrees has; the other model finds its own start.
  camera.fx = camera.fy = size.width / std::numbers::pi;
  camera.cx = 0.5 * (size.width - 1);
  camera.cy = 0.5 * (size.height - 1);
  camera.distortion = options.distortion;
  const bool equidistant = options.distortion == Distortion::equidistant;
  camera.coefficients.assign(equidistant ? 4 : options.coefficients, 0.0);
  return camera;
}

}  // namespace

std::vector<std::string> parameter_names(const Camera& camera) {
  std::vector<std::string> names = {"fx", "fy", "cx", "cy", "k1", "k2"};
  if (camera.distortion == Distortion::equidistant) {
    names.insert(names.end(), {"k3", "k4"});
  } else {
    names.insert(names.end(), {"p1", "p2", "k3", "k4", "k5", "k6"});
  }
  names.resize(4 + camera.coefficients.size());
  return names;
}

std::vector<double> parameters(const Camera& camera) {
  std::vector<double> values = {camera.fx, camera.fy, camera.cx, camera.cy};
  values.insert(values.end(), camera.coefficients.begin(), camera.coefficients.end());
  return values;
}

CameraCalibration calibrate_camera(const BoardSearch& search,
                                   const Board& board,
                                   const CalibrationOptions& options) {
  CameraCalibration result;
  result.examined = search.examined;
  result.found = static_cast<int>(search.views.size());
  Views views = choose_views(search, board, options.most_views);
  if (views.size() < kLeastViews) {
    return failed(
        result,
        fmt::format("the board was found, and sharp, in {} of {} pictures; at least {} are needed",
                    views.size(),
                    result.examined,
                    kLeastViews));
  }
  const auto solution = solve_without_bad(views, board, unknown_camera(search.size, options));
  if (!solution) return failed(result, "the views fix no camera; show the board from more sides");
  std::vector<double> slants_deg = solution->slant_deg;
  std::ranges::sort(slants_deg);
  const double slant = quantile(slants_deg, 0.9);
  if (slant < kLeastSlantDeg) {
    return failed(
        result,
        fmt::format("the board is never slanted by more than {:.0f} deg, so that nothing tells the "
                    "focal length from the distance; look at it from the side",
                    slant));
  }
  const auto sigmas = jackknife_sigmas(views, board, solution->camera);
  if (!sigmas || (*sigmas)[0] > kMostFocalSigma * solution->camera.fx) {
    return failed(result,
                  "the focal length depends on single views by more than 5 %; show the board from "
                  "more sides");
  }
  result.ok = true;
  result.camera = solution->camera;
  result.sigmas = *sigmas;
  for (std::size_t k = 0; k < solution->sigmas.size(); ++k) {
    result.sigmas[k] = std::max(result.sigmas[k], solution->sigmas[k]);
  }
  result.rms_px = solution->rms_px;
  for (const auto& view : views) result.frames.push_back(view.frame);
  result.coverage = coverage(views, search.size);
  result.slant_deg = slant;
  result.warnings = warnings_of(result);
  return result;
}

}  // namespace gpo
