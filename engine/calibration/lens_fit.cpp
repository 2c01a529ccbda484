// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/calibration/lens_fit.h"

#include "engine/base/stop.h"
#include "engine/geometry/decompositions.h"
#include "engine/geometry/pose.h"
#include "engine/recording/board/board.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <opencv2/calib3d.hpp>

namespace gpo {
namespace {

const cv::TermCriteria kConverged(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 50, 1e-9);

struct Correspondences {
  std::vector<std::vector<cv::Point3f>> points;
  std::vector<std::vector<cv::Point2f>> pixels;
};

Correspondences correspondences(const std::vector<CalibrationView>& views,
                                const Board& board,
                                const LensStart& start) {
  const auto all = board_points(board);
  Correspondences result;
  for (const CalibrationView& view : views) {
    const bool moved = start.readout_s != 0 && !view.velocities_px_s.empty();
    const auto corners =
        moved ? at_time_stamp(view.corners, view.velocities_px_s, start.camera, start.readout_s)
              : view.corners;
    auto& points = result.points.emplace_back();
    auto& pixels = result.pixels.emplace_back();
    for (std::size_t i = 0; i < all.size(); ++i) {
      const Eigen::Vector2f px = corners[i].cast<float>();
      if (!px.allFinite()) continue;
      points.emplace_back(static_cast<float>(all[i].x()), static_cast<float>(all[i].y()), 0.0F);
      pixels.emplace_back(px.x(), px.y());
    }
  }
  return result;
}

double slant_deg(const cv::Mat& rotation_vector) {
  const cv::Mat_<double> v(rotation_vector);
  const Eigen::Matrix3d R = so3_exp({v(0), v(1), v(2)});
  return degrees(std::acos(std::clamp(std::abs(R(2, 2)), 0.0, 1.0)));
}

constexpr std::array<LensCoefficient, 8> kRadialTangential = {{{2, cv::CALIB_FIX_K1},
                                                               {4, cv::CALIB_FIX_K2},
                                                               {1, cv::CALIB_ZERO_TANGENT_DIST},
                                                               {1, cv::CALIB_ZERO_TANGENT_DIST},
                                                               {6, cv::CALIB_FIX_K3},
                                                               {2, cv::CALIB_FIX_K4},
                                                               {4, cv::CALIB_FIX_K5},
                                                               {6, cv::CALIB_FIX_K6}}};
constexpr std::array<LensCoefficient, 4> kEquidistant = {{{2, cv::fisheye::CALIB_FIX_K1},
                                                          {4, cv::fisheye::CALIB_FIX_K2},
                                                          {6, cv::fisheye::CALIB_FIX_K3},
                                                          {8, cv::fisheye::CALIB_FIX_K4}}};

int flags_of(const LensStart& start) {
  int flags = 0;
  for (const std::size_t k : start.held) flags |= coefficients_of(start.camera.distortion)[k].hold;
  return flags;
}

double bend_of(const cv::Mat& points) {
  Eigen::Matrix3Xd all(3, points.total());
  for (int i = 0; i < all.cols(); ++i) {
    const auto& p = points.at<cv::Point3f>(i);
    all.col(i) << p.x, p.y, p.z;
  }
  all.colwise() -= all.rowwise().mean().eval();
  const Eigen::Vector3d normal = symmetric_eigen(all * all.transpose()).vectors.col(0);
  return (normal.transpose() * all).cwiseAbs().maxCoeff();
}

struct CvSolution {
  explicit CvSolution(const Camera& camera)
      : K(cv::Matx33d(camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1)),
        coefficients(camera.coefficients, true) {}

  void take(LensFit& fit) const {
    fit.camera.fx = K.at<double>(0, 0);
    fit.camera.fy = K.at<double>(1, 1);
    fit.camera.cx = K.at<double>(0, 2);
    fit.camera.cy = K.at<double>(1, 2);
    for (std::size_t i = 0; i < fit.camera.coefficients.size(); ++i)
      fit.camera.coefficients[i] = coefficients.at<double>(static_cast<int>(i));
    for (const cv::Mat& rotation : rotations) fit.slant_deg.push_back(slant_deg(rotation));
  }

  cv::Mat K, coefficients;
  std::vector<cv::Mat> rotations, translations;
};

void add_residuals(LensFit& fit,
                   const std::vector<cv::Point2f>& pixels,
                   const std::vector<cv::Point2f>& projected) {
  auto& view = fit.residuals_px.emplace_back(4, std::ssize(pixels));
  for (Eigen::Index i = 0; i < view.cols(); ++i) {
    const cv::Point2f error = pixels[i] - projected[i];
    view.col(i) << pixels[i].x, pixels[i].y, error.x, error.y;
  }
}

/// OpenCV's object releasing method (Strobl and Hirzinger 2011); `columns` of corners.
LensFit fit_radial_tangential(const Correspondences& seen, const LensStart& start, int columns) {
  LensFit fit;
  fit.camera = start.camera;
  CvSolution solution(start.camera);
  cv::Mat sigmas, points;
  // LU, since a singular value decomposition of all views' unknowns takes seconds.
  int flags = cv::CALIB_USE_LU | (start.known ? cv::CALIB_USE_INTRINSIC_GUESS : 0);
  if (start.camera.coefficients.size() == 4) flags |= cv::CALIB_FIX_K3;
  if (start.camera.coefficients.size() == 8) flags |= cv::CALIB_RATIONAL_MODEL;
  fit.rms_px = cv::calibrateCameraRO(seen.points,
                                     seen.pixels,
                                     {start.camera.width, start.camera.height},
                                     start.bent ? columns - 1 : -1,
                                     solution.K,
                                     solution.coefficients,
                                     solution.rotations,
                                     solution.translations,
                                     start.bent ? cv::OutputArray(points) : cv::noArray(),
                                     start.with_sigmas ? cv::OutputArray(sigmas) : cv::noArray(),
                                     cv::noArray(),
                                     cv::noArray(),
                                     fit.view_rms_px,
                                     flags | flags_of(start),
                                     kConverged);
  if (start.bent) fit.bend_m = bend_of(points);
  solution.take(fit);
  for (std::size_t i = 0; i < seen.pixels.size(); ++i) {
    std::vector<cv::Point2f> projected;
    cv::projectPoints(start.bent ? points : cv::Mat(seen.points[i]),
                      solution.rotations[i],
                      solution.translations[i],
                      solution.K,
                      solution.coefficients,
                      projected);
    add_residuals(fit, seen.pixels[i], projected);
  }
  for (std::size_t i = 0; start.with_sigmas && i < 4 + fit.camera.coefficients.size(); ++i)
    fit.sigmas.push_back(sigmas.at<double>(static_cast<int>(i)));
  return fit;
}

LensFit fit_equidistant(const Correspondences& seen, const LensStart& start) {
  LensFit fit;
  fit.camera = start.camera;
  CvSolution solution(start.camera);
  auto& [K, coefficients, rotations, translations] = solution;
  const int flags = cv::fisheye::CALIB_RECOMPUTE_EXTRINSIC | cv::fisheye::CALIB_FIX_SKEW |
                    cv::fisheye::CALIB_USE_INTRINSIC_GUESS;
  fit.rms_px = cv::fisheye::calibrate(seen.points,
                                      seen.pixels,
                                      {start.camera.width, start.camera.height},
                                      K,
                                      coefficients,
                                      rotations,
                                      translations,
                                      flags | flags_of(start),
                                      kConverged);
  solution.take(fit);
  for (std::size_t i = 0; i < rotations.size(); ++i) {
    std::vector<cv::Point2f> projected;
    cv::fisheye::projectPoints(
        seen.points[i], projected, rotations[i], translations[i], K, coefficients);
    add_residuals(fit, seen.pixels[i], projected);
    const double norm = cv::norm(projected, seen.pixels[i]);
    fit.view_rms_px.push_back(norm / std::sqrt(static_cast<double>(projected.size())));
  }
  return fit;
}

bool plausible(const LensFit& fit) {
  const Camera& camera = fit.camera;
  const double largest = 20.0 * std::max(camera.width, camera.height);
  const auto all = parameters(camera);
  return std::ranges::all_of(all, [](double p) { return std::isfinite(p); }) &&
         std::isfinite(fit.rms_px) && camera.fx > 0 && camera.fy > 0 && camera.fx < largest &&
         camera.fy < largest && camera.cx > 0 && camera.cx < camera.width && camera.cy > 0 &&
         camera.cy < camera.height;
}

/// OpenCV's fit of an equidistant lens does not leave a start that is too far away: with its own
/// start, a fisheye of 180 degrees, that of a lens of 70 degrees stays there at 100 px RMS.
std::vector<LensStart> starts_of(const LensStart& start) {
  if (start.known || start.camera.distortion != Distortion::equidistant) return {start};
  std::vector<LensStart> starts;
  for (const double share : {1 / std::numbers::pi, 0.5, 1.0, 2.0}) {
    LensStart& next = starts.emplace_back(start);
    next.camera.fx = next.camera.fy = share * std::max(start.camera.width, start.camera.height);
  }
  return starts;
}

/// Returns nullopt if the views do not determine a camera.
std::optional<LensFit> fit_from(const LensStart& start, const Correspondences& seen, int columns) {
  try {
    LensFit solution = start.camera.distortion == Distortion::equidistant
                           ? fit_equidistant(seen, start)
                           : fit_radial_tangential(seen, start, columns);
    if (plausible(solution)) return solution;
  } catch (const cv::Exception&) {
    return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace

std::vector<std::string> parameter_names(const Camera& camera) {
  std::vector<std::string> names{"fx", "fy", "cx", "cy", "k1", "k2"};
  if (camera.distortion == Distortion::equidistant)
    names.insert(names.end(), {"k3", "k4"});
  else
    names.insert(names.end(), {"p1", "p2", "k3", "k4", "k5", "k6"});
  names.resize(4 + camera.coefficients.size());
  return names;
}

std::vector<double> parameters(const Camera& camera) {
  std::vector<double> values = {camera.fx, camera.fy, camera.cx, camera.cy};
  values.insert(values.end(), camera.coefficients.begin(), camera.coefficients.end());
  return values;
}

std::span<const LensCoefficient> coefficients_of(Distortion distortion) {
  if (distortion == Distortion::equidistant) return kEquidistant;
  return kRadialTangential;
}

bool bend_is_observable(const std::vector<CalibrationView>& views, Distortion distortion) {
  const auto complete = [](const CalibrationView& view) {
    return std::ranges::all_of(view.corners, [](const auto& px) { return px.allFinite(); });
  };
  return distortion != Distortion::equidistant && std::ranges::all_of(views, complete);
}

std::optional<LensFit> fit_lens(const std::vector<CalibrationView>& views,
                                const Board& board,
                                const LensStart& start) {
  check_stop();
  const Correspondences seen = correspondences(views, board, start);
  std::optional<LensFit> best;
  for (const LensStart& one : starts_of(start)) {
    auto fit = fit_from(one, seen, board.columns);
    if (fit && (!best || fit->rms_px < best->rms_px)) best = std::move(fit);
  }
  return best;
}

}  // namespace gpo
