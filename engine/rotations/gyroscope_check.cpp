// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/rotations/gyroscope_check.h"

#include "engine/geometry/pose.h"
#include "engine/geometry/statistics.h"
#include "engine/rotations/gyroscope_alignment.h"
#include "engine/window/timestamps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include <Eigen/LU>
#include <fmt/format.h>

namespace gpo {
namespace {

using Eigen::Matrix3d;
using Eigen::Matrix3Xd;
using Eigen::Vector3d;
using enum GyroscopeMisfit;

constexpr double kSpan_s = 0.1;  // images determine rates over it far better than over frames
constexpr int kSteps = 80;       // offsets of the clock that are tried, in both directions
constexpr double kStep_s = 0.0025, kWindow_s = kSteps * kStep_s;
constexpr double kFarBetter = 0.35;  // scatter of the differences, relative to the recorded one
constexpr double kExplained = 0.15;  // share of the images' own scatter
constexpr double kLeastImages_rad_s = 0.05;
constexpr double kMostError = 0.5;  // error of the images' rotations, share of their scatter

Vector3d medians_of(const Matrix3Xd& all) {
  Vector3d middle;
  for (int axis = 0; axis < 3; ++axis) {
    const auto row = all.row(axis);
    middle[axis] = median({row.begin(), row.end()});
  }
  return middle;
}

/// Median distance of columns from their median [rad/s].
double scatter_of(const Matrix3Xd& all) {
  const Eigen::RowVectorXd norms = (all.colwise() - medians_of(all)).colwise().norm();
  return median({norms.begin(), norms.end()});
}

double apart_deg(const Matrix3d& R_a, const Matrix3d& R_b) {
  return degrees(so3_log(R_a.transpose() * R_b).norm());
}

double difference(const Pairs& pairs, const Matrix3d& R_gyro_camera) {
  return scatter_of(pairs.gyroscope - R_gyro_camera * pairs.images);
}

/// Rates to compare, with the gyroscope's in rad/s.
struct Compared {
  const RateIntegral& integral;
  const std::vector<Interval>& intervals;
  double rad_s_per_unit;
  Matrix3d R_gyro_camera;
  double offset_s;

  Pairs pairs(double shift_s = 0) const {
    Pairs pairs = pairs_at(integral, intervals, offset_s + shift_s);
    pairs.gyroscope *= rad_s_per_unit;
    return pairs;
  }
};

/// Scatter of the differences by the best other clock and by the best other axes [rad/s].
struct Alternatives {
  double by_clock, by_axes;
  double late_s = 0, apart_deg = 0;
};

Alternatives alternatives_to(double recorded, const Compared& given) {
  Alternatives best{recorded, recorded};
  const auto covered = given.pairs().images.cols();
  for (int step = -kSteps; step <= kSteps; ++step) {
    const double shift_s = step * kStep_s;
    const Pairs pairs = given.pairs(shift_s);
    if (pairs.images.cols() < covered) continue;
    if (const double one = difference(pairs, given.R_gyro_camera); one < best.by_clock) {
      best.by_clock = one;
      best.late_s = shift_s;
    }
    if (covered < std::ptrdiff_t{kLeastIntervals}) continue;
    const Matrix3d R = aligned(pairs).R;
    if (const double one = difference(pairs, R); one < best.by_axes) {
      best.by_axes = one;
      best.apart_deg = apart_deg(R, given.R_gyro_camera);
    }
  }
  return best;
}

/// All 48 axes of the rates with other names and signs, the recorded ones first, then by the number
/// of changes.
std::vector<Matrix3d> signed_permutations() {
  std::vector<Matrix3d> all;
  std::array<int, 3> order{0, 1, 2};
  do {
    for (int signs = 0; signs < 8; ++signs) {
      Matrix3d P = Matrix3d::Zero();
      for (int k = 0; k < 3; ++k) P(k, order[k]) = (signs >> k) % 2 == 1 ? -1 : 1;
      all.push_back(P);
    }
  } while (std::ranges::next_permutation(order).found);
  std::ranges::stable_sort(
      all, std::ranges::greater(), [](const Matrix3d& P) { return P.trace(); });
  return all;
}

/// Named axes that fit best.
struct NamedAxes {
  Matrix3d axes = Matrix3d::Identity();
  double scatter = std::numeric_limits<double>::infinity();
};

/// Returns the best right-handed and left-handed ones that differ from the recorded ones; among
/// nearly equal ones, that with the fewest changes.
std::pair<NamedAxes, NamedAxes> named_axes(const Pairs& now, const Matrix3d& R_gyro_camera) {
  constexpr double kNearly = 0.8;
  std::pair<NamedAxes, NamedAxes> best;
  for (const Matrix3d& P : signed_permutations()) {
    if (P.isIdentity()) continue;
    NamedAxes& of_hand = P.determinant() > 0 ? best.first : best.second;
    const double scatter = difference({P * now.gyroscope, now.images}, R_gyro_camera);
    if (scatter < kNearly * of_hand.scatter) of_hand = {P, scatter};
  }
  return best;
}

/// Factors from units that files have by mistake to rad/s: degrees, thousandths of radians and of
/// degrees, and radians that were converted from degrees twice.
constexpr double kDegree = std::numbers::pi / 180;
constexpr std::array kUnits{kDegree, 1e-3, 1e-3 * kDegree, 1 / kDegree};

/// Returns the unit whose size explains that of the rates; 1 if none does. A gyroscope that fits
/// has 0.5 to 2 of the images' rates in 140 windows of real recordings.
double likely_unit(double share) {
  constexpr double kMostRatio = 1.6;
  for (const double unit : kUnits)
    if (std::abs(std::log(share * unit)) < std::log(kMostRatio)) return unit;
  return 1;
}

/// Returns how the sizes of the rates contradict each other.
GyroscopeMisfit misfit_of_size(const Pairs& now,
                               const Matrix3d& R_gyro_camera,
                               double by_clock,
                               double sigma_rad) {
  constexpr double kUnexplained = 0.75;  // by the recorded axes, share of the larger scatter
  constexpr double kStabilized = 0.55;   // scatter of the images, share of the gyroscope's
  constexpr double kLeastRotation_rad_s = 0.15;
  // In 140 windows of real recordings, a gyroscope that fits has a share of 0.5 and more, or the
  // images' error is 0.8 of their rotation and more.
  constexpr double kHardly = 0.25;  // scatter of the gyroscope, share of the images'
  constexpr double kHalf = 0.62, kBetter = 0.5;
  const double of_images = scatter_of(now.images), of_gyroscope = scatter_of(now.gyroscope);
  const double share = of_gyroscope / of_images;
  const bool images_rotate = of_images > kLeastImages_rad_s;
  if (images_rotate && share < kHardly && sigma_rad < kMostError * kSpan_s * of_images)
    return hardly_rotates;
  if (images_rotate && share < kHalf &&
      difference({now.gyroscope / share, now.images}, R_gyro_camera) < kBetter * by_clock)
    return scale;
  if (of_gyroscope <= kLeastRotation_rad_s) return none;
  if (of_images < kStabilized * of_gyroscope && by_clock > kStabilized * of_gyroscope)
    return stabilized;
  return by_clock < kUnexplained * std::max(of_images, of_gyroscope) ? none : unrelated;
}

/// Returns rates over 0.1 s or a frame, whichever is longer; they overlap.
std::vector<Interval> long_intervals_of(std::span<const ImageRotations> windows, double period_s) {
  const auto span = static_cast<std::size_t>(std::max(1L, std::lround(kSpan_s / period_s)));
  return intervals_of({windows.begin(), windows.end()}, span);
}

/// Compares axes, then the clock, then sizes, of rates in the likely unit. Few intervals determine
/// only named axes.
GyroscopeCheck check_axes(const Compared& given,
                          double of_images,
                          double half_frame_s,
                          double sigma_rad) {
  constexpr double kLeast_rad_s = 0.001;  // smaller differences are noise of the images
  constexpr double kLeastAxes_deg = 20;
  const Matrix3d& R = given.R_gyro_camera;
  const Pairs now = given.pairs();
  const double recorded = difference(now, R);
  if (recorded < kLeast_rad_s) return {};
  const Alternatives other = alternatives_to(recorded, given);
  const double far_better = std::min(kFarBetter * other.by_clock, kExplained * of_images);
  const auto [turned, mirror] = named_axes(now, R);
  const double by_inverse = difference(now, R.transpose());
  if (by_inverse < far_better && by_inverse < 3 * other.by_axes)
    return {.misfit = inverted, .apart_deg = apart_deg(R, R.transpose())};
  if (mirror.scatter < far_better && mirror.scatter < 2 * other.by_axes)
    return {.misfit = mirrored,
            .axes = mirror.axes,
            .apart_deg = other.by_axes < far_better ? other.apart_deg : 0};
  if (now.images.cols() < std::ptrdiff_t{kLeastIntervals}) return {};
  if (other.by_axes < far_better && other.apart_deg > kLeastAxes_deg)
    return {.misfit = axes, .apart_deg = other.apart_deg};
  if (other.by_clock < kFarBetter * recorded && std::abs(other.late_s) > half_frame_s)
    return {.misfit = clock, .late_s = other.late_s};
  return {.misfit = misfit_of_size(now, R, other.by_clock, sigma_rad)};
}

std::string unit_name(double rad_s_per_unit) {
  if (rad_s_per_unit == kUnits[0]) return "degrees per second";
  if (rad_s_per_unit == kUnits[1]) return "milliradians per second";
  if (rad_s_per_unit == kUnits[2]) return "millidegrees per second";
  return "radians that were converted from degrees twice";
}

/// Returns "-y" for a row of signed axes.
std::string axis_name(const Eigen::RowVector3d& row) {
  Eigen::Index axis = 0;
  row.cwiseAbs().maxCoeff(&axis);
  return fmt::format("{}{}", row[axis] < 0 ? "-" : "", "xyz"[axis]);
}

/// Returns the change of left-handed axes in words.
std::string change_of(const Matrix3d& axes) {
  const auto name = [&](int k) { return axis_name(axes.row(k)); };
  const std::string all = fmt::format("({}, {}, {})", name(0), name(1), name(2));
  if (axes.trace() == 1 && axes.isDiagonal())
    for (int k = 0; k < 3; ++k)
      if (axes(k, k) < 0) return fmt::format("its {} axis is negated", "xyz"[k]);
  for (int k = 0; k < 3; ++k)
    if (axes(k, k) == 1 && axes.sum() == 3)
      return fmt::format("its {} and {} axes are swapped", "yxx"[k], "zzy"[k]);
  return fmt::format("its axes are taken as {}", all);
}

/// Returns what changes the rates, as a command for a file of comma-separated values.
std::string change_of_file(const GyroscopeCheck& check, const std::filesystem::path& file) {
  const bool scaled = check.rad_s_per_unit != 1, turned = !check.axes.isIdentity();
  if (file.extension() != ".csv")
    return fmt::format(
        "correct the rates where they are recorded{}",
        scaled ? fmt::format(": multiply them by {:.9g}", check.rad_s_per_unit) : "");
  std::string change;
  if (scaled) change = fmt::format("for (i = 2; i < 5; ++i) $i *= {:.9g}; ", check.rad_s_per_unit);
  if (turned) change += "x = $2; y = $3; z = $4; ";
  for (int k = 0; k < 3; ++k)
    if (turned && check.axes(k, k) != 1)
      change += fmt::format("${} = {}; ", k + 2, axis_name(check.axes.row(k)));
  return fmt::format("correct the rates: awk -F, -v OFS=, '/^[0-9]/ {{ {}}} 1' '{}' > rates.csv",
                     change,
                     file.string());
}

bool is_wrong_file(GyroscopeMisfit misfit) { return misfit == unit || misfit == mirrored; }

}  // namespace

GyroscopeCheck check_gyroscope_against(std::span<const ImageRotations> windows,
                                       const Gyroscope& gyroscope,
                                       double sigma_rad) {
  constexpr Eigen::Index kLeast = 5;
  constexpr double kFits = 0.7;
  if (windows.empty()) return {};
  const double period_s =
      1e-9 * static_cast<double>(median_period_ns(windows.front().timestamps_ns));
  const std::vector<Interval> intervals = long_intervals_of(windows, period_s);
  const std::int64_t margin_ns = to_ns(kWindow_s + 0.1);
  const Gyroscope samples =
      samples_between(gyroscope,
                      windows.front().timestamps_ns.front() + gyroscope.time_offset_ns - margin_ns,
                      windows.back().timestamps_ns.back() + gyroscope.time_offset_ns + margin_ns);
  if (samples.timestamps_ns.size() < 2) return {};
  const RateIntegral integral(samples);
  Compared compared{integral,
                    intervals,
                    1,
                    gyroscope.R_gyro_camera,
                    1e-9 * static_cast<double>(gyroscope.time_offset_ns)};
  const Pairs now = compared.pairs();
  if (now.images.cols() < kLeast) return {};
  const double of_images = scatter_of(now.images);
  const double share = scatter_of(now.gyroscope) / of_images;
  const auto checked = [&](double rad_s_per_unit) {
    compared.rad_s_per_unit = rad_s_per_unit;
    GyroscopeCheck check = check_axes(compared, of_images, 0.5 * period_s, sigma_rad);
    check.share = share;
    check.correlation = correlation_of(now);
    return check;
  };
  const double unit = sigma_rad < kMostError * kSpan_s * of_images ? likely_unit(share) : 1;
  if (unit == 1) return checked(1);
  GyroscopeCheck check = checked(unit);
  const bool named = check.misfit == mirrored || check.misfit == inverted || check.misfit == axes;
  if (!named && difference(compared.pairs(), compared.R_gyro_camera) > kFits * of_images)
    return checked(1);
  check.rad_s_per_unit = unit;
  if (check.misfit != mirrored) check.misfit = GyroscopeMisfit::unit;
  check.late_s.reset();
  return check;
}

std::string sentence_of(const GyroscopeCheck& check) {
  std::string sentence;
  if (check.rad_s_per_unit != 1)
    sentence = fmt::format("its rates are {:.3g} times those of the images, as in {}",
                           check.share,
                           unit_name(check.rad_s_per_unit));
  switch (check.misfit) {
    case none:
    case unit:
      return sentence;
    case mirrored:
      if (!sentence.empty()) sentence += ", and ";
      sentence += fmt::format("it fits if {}: its axes are left-handed", change_of(check.axes));
      if (check.apart_deg > 0)
        sentence += fmt::format(", or about {:.0f} deg off", check.apart_deg);
      return sentence;
    case inverted:
      return "it fits if the rotation between camera and gyroscope is inverted";
    case axes:
      return fmt::format("its axes are about {:.0f} deg off", check.apart_deg);
    case clock:
      return fmt::format("its clock is about {:+.0f} ms off", 1e3 * *check.late_s);
    case hardly_rotates:
      return "the images rotate, but it hardly does";
    case scale:
      return fmt::format("its rates are about {:.2f} of those of the images", check.share);
    case stabilized:
      return "the images rotate less than it does, as stabilized images do";
    case unrelated:
      return fmt::format("their rates have a correlation of {:.2f}", check.correlation);
  }
  return sentence;
}

std::string advice_of(const GyroscopeCheck& check, const Gyroscope& gyroscope) {
  if (check.misfit == none) return "";
  if (check.misfit == inverted)
    return "invert the rotation of T_BS, or run `calibrate --gyroscope`";
  return is_wrong_file(check.misfit) ? change_of_file(check, gyroscope.file)
                                     : "run `calibrate --gyroscope`";
}

std::string why_wrong_rates(std::span<const ImageRotations> windows, const Gyroscope& gyroscope) {
  const GyroscopeCheck check = check_gyroscope_against(windows, gyroscope, 0);
  return is_wrong_file(check.misfit) ? fmt::format("the gyroscope does not fit the images: {}; {}",
                                                   sentence_of(check),
                                                   advice_of(check, gyroscope))
                                     : "";
}

}  // namespace gpo
