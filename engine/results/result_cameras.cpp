// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/results/result_cameras.h"

#include "engine/base/error.h"
#include "engine/files/text_file.h"
#include "engine/geometry/statistics.h"
#include "engine/results/time_offset.h"
#include "engine/window/timestamps.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>
#include <fmt/format.h>

namespace gpo {
namespace {

using Index = std::ptrdiff_t;
using MaybeIndex = std::optional<Index>;

/// Returns the index of the nearest time within a limit, the last of equal ones.
MaybeIndex nearest(const std::vector<std::int64_t>& times_ns,
                   std::int64_t time_ns,
                   std::int64_t most_ns) {
  MaybeIndex best;
  for (Index i = 0; i < std::ssize(times_ns); ++i) {
    const std::int64_t off = std::abs(times_ns[i] - time_ns);
    if (off > most_ns) continue;
    most_ns = off;
    best = i;
  }
  return best;
}

std::vector<MaybeIndex> found_by_number(const ResultPoses& result, const Window& window) {
  std::vector<MaybeIndex> found;
  for (int i = 0; i < window.frame_count(); ++i) {
    const Index number = window.start + i;
    found.push_back(number < std::ssize(result.poses) ? MaybeIndex(number) : std::nullopt);
  }
  return found;
}

std::string_view file_name(std::string_view path) {
  return path.substr(path.find_last_of('/') + 1);  // npos + 1 is 0
}

std::size_t same_end(std::string_view a, std::string_view b) {
  const auto [at, none] = std::ranges::mismatch(a.rbegin(), a.rend(), b.rbegin(), b.rend());
  return static_cast<std::size_t>(at - a.rbegin());
}

/// Returns the image with the frame's file name. If several folders have one, the paths decide.
MaybeIndex of_name(const ResultPoses& result, const std::string& path) {
  MaybeIndex best;
  bool unique = true;
  std::size_t most = 0;
  for (Index i = 0; i < std::ssize(result.names); ++i) {
    if (file_name(result.names[i]) != file_name(path)) continue;
    const std::size_t same = same_end(result.names[i], path);
    if (best && same == most) unique = false;
    if (best && same <= most) continue;
    unique = true;
    best = i;
    most = same;
  }
  if (!unique)
    throw InputError(fmt::format(
        "two of its images are named {}, and no folder matches this recording", file_name(path)));
  return best;
}

/// Returns the time stamp [ns] that an image is named after; far from every frame if there is none.
std::int64_t time_in_name(std::string_view name) {
  constexpr std::int64_t kNone = INT64_MAX / 2;
  name = file_name(name);
  const auto time = parse_integer(name.substr(0, name.find_last_of('.')));
  return time && *time >= 0 && *time < kNone ? *time : kNone;
}

std::vector<MaybeIndex> found_by_name(const ResultPoses& result,
                                      const Window& window,
                                      const Sources& sources) {
  const bool named = std::ssize(sources.images) == window.frame_count();
  const std::int64_t most_ns = median_period_ns(window.timestamps_ns) / 2;
  std::vector<std::int64_t> times_ns;
  for (const std::string& name : result.names) times_ns.push_back(time_in_name(name));
  std::vector<MaybeIndex> found;
  for (int i = 0; i < window.frame_count(); ++i) {
    MaybeIndex one;
    if (named) one = of_name(result, sources.images[i].generic_string());
    if (!one) one = nearest(times_ns, window.timestamps_ns[i], most_ns);
    found.push_back(one);
  }
  return found;
}

/// Returns the poses at the times of the frames. Frames within 1 % of a frame period of a pose have
/// that pose, so that rounded times of a result do not matter.
void interpolate(const ResultPoses& result,
                 const Window& window,
                 std::int64_t offset_ns,
                 ResultCameras& found) {
  const std::int64_t period_ns = median_period_ns(window.timestamps_ns);
  const std::int64_t most_ns = period_ns * 3 / 2;
  const std::int64_t rounding_ns = std::max<std::int64_t>(1000, period_ns / 100);
  for (const std::int64_t frame_ns : window.timestamps_ns) {
    const std::int64_t time_ns = frame_ns - offset_ns;
    std::optional<Pose>& camera = found.cameras.emplace_back();
    if (const MaybeIndex same = nearest(result.timestamps_ns, time_ns, rounding_ns)) {
      camera = result.poses[*same];
      continue;
    }
    camera = pose_at(result, time_ns, most_ns);
    // Near a pose the error of an interpolation over a gap is small.
    if (!camera && nearest(result.timestamps_ns, time_ns, period_ns / 10))
      camera = pose_at(result, time_ns, INT64_MAX);
    if (camera) ++found.interpolated;
    const auto after = std::ranges::upper_bound(result.timestamps_ns, time_ns);
    const bool between =
        after != result.timestamps_ns.begin() && after != result.timestamps_ns.end();
    if (!camera && between) {
      ++found.in_gaps;
      found.longest_gap_s =
          std::max(found.longest_gap_s, 1e-9 * static_cast<double>(*after - *std::prev(after)));
    }
  }
}

Eigen::Matrix3Xd inlier_rays(const Window& window) {
  const Eigen::Matrix3d K_inverse = window.K.inverse();
  const std::vector<int> tracks = window.inlier_tracks(0);
  Eigen::Matrix3Xd rays(3, std::ssize(tracks));
  for (Eigen::Index k = 0; k < rays.cols(); ++k)
    rays.col(k) = (K_inverse * window.points_px[0].col(tracks[k]).homogeneous()).normalized();
  return rays;
}

}  // namespace

ResultCameras found_cameras(const ResultPoses& result,
                            PosedFrame frame,
                            const Window& window,
                            const Sources& sources,
                            double offset_s) {
  const Pose T_posed_camera = pose_of_camera(frame, sources.T_body_camera);
  ResultCameras found;
  if (result.by == FoundBy::time) {
    interpolate(result, window, std::llround(1e9 * offset_s), found);
  } else {
    const auto indices = result.by == FoundBy::number ? found_by_number(result, window)
                                                      : found_by_name(result, window, sources);
    for (const MaybeIndex& index : indices)
      found.cameras.push_back(index ? std::optional(result.poses[*index]) : std::nullopt);
  }
  for (std::optional<Pose>& camera : found.cameras)
    if (camera) camera = *camera * T_posed_camera;
  return found;
}

Pose pose_of_camera(PosedFrame frame, const std::optional<Pose>& T_body_camera) {
  if (frame == PosedFrame::camera) return {};
  if (T_body_camera) return *T_body_camera;
  throw InputError(
      "its poses are body poses, but the recording has no camera extrinsics (T_BS); add "
      ",frame=camera if they are camera poses");
}

ResultCoverage coverage_of(const std::vector<std::optional<Pose>>& cameras) {
  ResultCoverage coverage;
  for (int i = 0; i < std::ssize(cameras); ++i) {
    if (!cameras[i]) continue;
    if (coverage.count++ == 0) coverage.first = i;
    coverage.last = i;
  }
  return coverage;
}

std::string span_text(const ResultPoses& poses, const Window& window) {
  constexpr double kSecond = 1e9;
  if (poses.by == FoundBy::number) return fmt::format("; it has {} lines", poses.poses.size());
  if (poses.by == FoundBy::name)
    return fmt::format("; it has {} images, the first is {}",
                       poses.names.size(),
                       legible(poses.names.front(), 60));
  return fmt::format("; it is from {:.3f} to {:.3f} s, the window from {:.3f} to {:.3f} s",
                     static_cast<double>(poses.timestamps_ns.front()) / kSecond,
                     static_cast<double>(poses.timestamps_ns.back()) / kSecond,
                     static_cast<double>(window.timestamps_ns.front()) / kSecond,
                     static_cast<double>(window.timestamps_ns.back()) / kSecond);
}

double rotation_misfit_deg(const std::vector<std::optional<Pose>>& cameras, const Window& window) {
  const auto first = std::ranges::find_if(cameras, [](const auto& one) { return one.has_value(); });
  std::vector<double> apart_deg;
  for (auto camera = first; camera != cameras.end(); ++camera) {
    if (!*camera || camera == first) continue;
    const Eigen::Matrix3d& R_w0 = window.R_wc[first - cameras.begin()];
    const Eigen::Matrix3d expected = R_w0.transpose() * window.R_wc[camera - cameras.begin()];
    const Eigen::Matrix3d found = (*first)->R_wc.transpose() * (*camera)->R_wc;
    apart_deg.push_back(degrees(so3_log(expected.transpose() * found).norm()));
  }
  return apart_deg.empty() ? 0 : median(std::move(apart_deg));
}

std::optional<Plane> plane_in_view(const Eigen::Matrix3Xd& points,
                                   const Pose& reference,
                                   const Window& window) {
  constexpr double kNear_deg = 2;
  constexpr int kMinPoints = 10;
  const Eigen::Matrix3Xd rays = inlier_rays(window);
  if (rays.cols() == 0) return std::nullopt;
  const double near = std::cos(radians(kNear_deg));
  const Eigen::Vector3d middle = rays.rowwise().sum().normalized();
  const double widest = std::acos(std::min(1.0, (middle.transpose() * rays).minCoeff()));
  const double in_cone = std::cos(std::min(widest + radians(kNear_deg), M_PI));
  Eigen::Matrix3Xd seen(3, points.cols());
  int count = 0;
  for (const auto& point : points.colwise()) {
    const Eigen::Vector3d P = to_camera(reference, point);
    const double distance = P.norm();
    if (!(P.z() > 0) || middle.dot(P) < in_cone * distance) continue;
    if ((P.transpose() * rays).maxCoeff() >= near * distance) seen.col(count++) = P;
  }
  if (count < kMinPoints) return std::nullopt;
  const auto plane = fit_plane(seen.leftCols(count));
  if (!plane) return std::nullopt;
  return plane_in_camera(*plane, inverse(reference));
}

}  // namespace gpo
