// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/results/result_method.h"

#include "engine/base/error.h"
#include "engine/external_methods/own_method.h"
#include "engine/files/text_file.h"
#include "engine/geometry/statistics.h"
#include "engine/methods/common/method_options.h"
#include "engine/window/timestamps.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <mutex>
#include <set>

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

std::vector<MaybeIndex> found_by_time(const ResultPoses& result, const Window& window) {
  const std::int64_t most_ns = median_period_ns(window.timestamps_ns) / 2;
  std::vector<MaybeIndex> found;
  for (const std::int64_t time : window.timestamps_ns)
    found.push_back(nearest(result.timestamps_ns, time, most_ns));
  return found;
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

/// Camera of each frame in the result's world, nullopt if none is within half a frame or named
/// alike. Throws InputError if T_BS is unknown for body poses or two images have a frame's name.
std::vector<std::optional<Pose>> found_cameras(const ResultPoses& result,
                                               PosedFrame frame,
                                               const Window& window,
                                               const Sources& sources) {
  if (frame == PosedFrame::body && !sources.T_body_camera)
    throw InputError(
        "its poses are body poses, but the recording has no camera extrinsics (T_BS); add "
        ",frame=camera if they are camera poses");
  const Pose T_posed_camera = frame == PosedFrame::body ? *sources.T_body_camera : Pose{};
  const auto found = result.by == FoundBy::time     ? found_by_time(result, window)
                     : result.by == FoundBy::number ? found_by_number(result, window)
                                                    : found_by_name(result, window, sources);
  std::vector<std::optional<Pose>> cameras;
  for (const MaybeIndex& index : found)
    cameras.push_back(index ? std::optional(result.poses[*index] * T_posed_camera) : std::nullopt);
  return cameras;
}

struct Coverage {
  int count = 0;
  int first = 0;  ///< frames of the window
  int last = 0;
};

Coverage coverage_of(const std::vector<std::optional<Pose>>& cameras) {
  Coverage coverage;
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

/// Median angle between the rotations of cameras and those of the window [deg].
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

class Reader {
 public:
  Reader(const ProgramResult& result, ResultLog log)
      : name_(result.name),
        log_(std::move(log)),
        poses_(read_result_poses(result.poses)),
        frame_(result.frame.value_or(poses_.frame)),
        chosen_frame_(result.frame.has_value()) {
    if (!result.points.empty())
      points_ = read_result_points(result.points);
    else if (is_folder(result.poses) && has_points(result.poses))
      points_ = read_result_points(result.poses);
  }

  Initialization initialize(const Window& window, const Sources& sources) {
    try {
      Initialization result = initialization(window, sources);
      if (!result.ok) result.reason = fmt::format("{}: {}", name_, result.reason);
      return result;
    } catch (const std::exception& error) {
      return failed(fmt::format("{}: {}", name_, message_of(error)));
    }
  }

 private:
  Initialization initialization(const Window& window, const Sources& sources) {
    Answer answer;
    answer.cameras = found_cameras(poses_, frame_, window, sources);
    propose_frame(answer.cameras, window, sources);
    const Coverage covered = coverage_of(answer.cameras);
    constexpr int kMinCovered = 3;
    const int least = std::min(kMinCovered, window.frame_count());
    if (covered.count < least || 2 * (covered.last - covered.first) < window.frame_count() - 1)
      return failed(
          fmt::format("has {} of the window's {} frames, expected at least {} over half of it{}",
                      covered.count,
                      window.frame_count(),
                      least,
                      span_text(poses_, window)));
    if (!answer.cameras.front())
      answer.cameras.front() = resected(window, triangulated(window, answer.cameras), 0);
    if (!answer.cameras.front())
      return failed("has no pose of the window's first frame and too few points to resect it");
    answer.plane = plane_in_view(points_, *answer.cameras.front(), window);
    report(covered, window, answer.plane.has_value());
    return initialization_of(window, answer);
  }

  /// Reports that the poses fit the window's rotations far better in the other frame, unless the
  /// user chose it.
  void propose_frame(const std::vector<std::optional<Pose>>& cameras,
                     const Window& window,
                     const Sources& sources) {
    constexpr double kFarBetter = 1.0 / 3, kLeast_deg = 0.5;
    if (chosen_frame_ || !sources.T_body_camera) return;
    const PosedFrame other = frame_ == PosedFrame::body ? PosedFrame::camera : PosedFrame::body;
    const double now_deg = rotation_misfit_deg(cameras, window);
    const double other_deg =
        rotation_misfit_deg(found_cameras(poses_, other, window, sources), window);
    if (now_deg > kLeast_deg && other_deg < kFarBetter * now_deg)
      report(
          fmt::format("add ,frame={}: as {} poses its rotations are {:.2f} deg from the "
                      "window's, as {} poses {:.2f} deg",
                      to_string(other),
                      to_string(other),
                      other_deg,
                      to_string(frame_),
                      now_deg));
  }

  void report(const std::string& message) {
    if (!log_) return;
    constexpr std::size_t kMaxMessages = 20;
    const std::lock_guard lock(mutex_);
    if (messages_.size() < kMaxMessages && messages_.insert(message).second) log_(name_, message);
  }

  void report(const Coverage& covered, const Window& window, bool plane_of_points) {
    report(fmt::format("{}, {} poses{}{}; {} of the window's {} frames{}; plane through {}",
                       poses_.layout,
                       to_string(frame_),
                       frame_ == PosedFrame::body ? ", with T_BS" : "",
                       poses_.repeats > 0
                           ? fmt::format(", {} left out", counted(poses_.repeats, "repeated row"))
                           : "",
                       covered.count,
                       window.frame_count(),
                       covered.count < window.frame_count() ? ", the others resected" : "",
                       plane_of_points ? "its points" : "points triangulated from its cameras"));
  }

  const std::string name_;
  const ResultLog log_;
  const ResultPoses poses_;
  const PosedFrame frame_;
  const bool chosen_frame_;
  Eigen::Matrix3Xd points_;
  std::mutex mutex_;
  std::set<std::string> messages_;
};

std::string identity_of(const ProgramResult& result) {
  std::string identity = "result";
  for (const fs::path& path : {result.poses, result.points}) {
    if (path.empty()) continue;
    identity += fmt::format(" {}", path.filename().string());
    auto files = is_folder(path) ? files_in(path) : std::vector{path};
    std::ranges::sort(files);
    for (const fs::path& file : files) identity += fmt::format(" {}", checksum_of(file));
  }
  return identity + (result.frame ? fmt::format(" {}", to_string(*result.frame)) : "");
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

ProgramResult parse_program_result(const std::string& text) {
  constexpr const char* kExpected = "NAME=FILE[,POINTS][,frame=camera|body]";
  const auto [name, files] = parse_named(text, "--result", kExpected);
  ProgramResult result{name, {}, {}};
  for (const std::string& part : split(files, ',')) {
    if (part.starts_with("frame=")) {
      result.frame = choice<PosedFrame>(part.substr(part.find('=') + 1));
    } else if (result.poses.empty()) {
      result.poses = part;
    } else if (result.points.empty()) {
      result.points = part;
    } else {
      throw InputError(fmt::format("--result: '{}', expected {}", text, kExpected));
    }
  }
  if (result.poses.empty())
    throw InputError(fmt::format("--result: '{}' names no file, expected {}", text, kExpected));
  return result;
}

Method result_method(const ProgramResult& result, const ResultLog& log, int number) {
  const auto reader = std::make_shared<Reader>(result, log);
  return own_method(
      result.name,
      number,
      [reader](const Window& window, const Sources& sources, const Watch& /*watch*/) {
        return reader->initialize(window, sources);
      },
      identity_of(result));
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
