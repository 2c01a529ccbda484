// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/files/refuse.h"
#include "engine/inspection/inspector.h"
#include "engine/methods/recording_method.h"
#include "engine/recording/board/board.h"
#include "engine/recording/images/frame_faults.h"
#include "engine/tracking/tracker.h"

#include <algorithm>

namespace gpo {
namespace {

const Plane kBoardPlane{-Eigen::Vector3d::UnitZ(), 0};  // z = 0

std::optional<Plane> plane_of_board(const Recording& recording,
                                    int frame,
                                    const std::optional<Pose>& T_truth_camera) {
  if (!recording.board || !recording.images || !T_truth_camera) return std::nullopt;
  const auto found = board_truth(recording, std::vector{frame}).poses.front();
  if (!found) return std::nullopt;
  return plane_in_camera(kBoardPlane, *found * inverse(*T_truth_camera));
}

std::vector<Eigen::Matrix3d> true_rotations(const WindowTruth* truth, int start) {
  std::vector<Eigen::Matrix3d> R_wc;
  for (std::size_t i = 0; truth != nullptr && i < truth->cameras.size(); ++i) {
    const auto& reference = truth->cameras.front();
    if (!reference || !truth->cameras[i])
      refuse_setting("rotations",
                     "truth: frame {} has no ground truth ({})",
                     start + static_cast<int>(reference ? i : 0),
                     truth->source);
    R_wc.push_back(reference->R_wc.transpose() * truth->cameras[i]->R_wc);
  }
  if (R_wc.empty()) refuse_setting("rotations", "truth: the window has no ground truth");
  return R_wc;
}

ClockReference clock_of_truth(const Recording& recording) {
  ClockReference reference{.source = "the ground truth", .timestamps_ns = {}, .R_wc = {}};
  if (!recording.truth) return reference;
  const auto& poses = recording.truth->poses;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (!poses[i]) continue;
    reference.timestamps_ns.push_back(recording.timestamps_ns[i]);
    reference.R_wc.push_back(poses[i]->R_wc);
  }
  return reference;
}

ClockReference clock_of_rates(const Gyroscope& gyroscope) {
  ClockReference reference{
      .source = "the gyroscope", .timestamps_ns = {}, .R_wc = {}, .rates_are_biased = true};
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  const auto& times_ns = gyroscope.timestamps_ns;
  for (std::size_t i = 0; i < times_ns.size(); ++i) {
    if (i > 0) {
      const double dt_s = 1e-9 * static_cast<double>(times_ns[i] - times_ns[i - 1]);
      const Eigen::Vector3d mean = 0.5 * (gyroscope.rates_rad_s[i - 1] + gyroscope.rates_rad_s[i]);
      R = R * so3_exp(gyroscope.R_gyro_camera.transpose() * (mean - gyroscope.bias_rad_s) * dt_s);
    }
    reference.timestamps_ns.push_back(times_ns[i] - gyroscope.time_offset_ns);
    reference.R_wc.push_back(R);
  }
  return reference;
}

}  // namespace

double milliseconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin)
      .count();
}

Tracked chosen_tracks(const Recording& recording, const FrameSpan& span) {
  const auto begin = std::chrono::steady_clock::now();
  Tracks tracks = select_tracks(recording.tracks, span.start, span.frames);
  return {std::make_shared<const Tracks>(std::move(tracks)),
          std::vector<double>(span.frames, milliseconds_since(begin))};
}

std::optional<Tracked> followed_tracks(const Recording& recording,
                                       const FrameSpan& span,
                                       Tracking tracking,
                                       const std::stop_token& stop,
                                       const Progress& progress) {
  if (!recording.images) refuse(recording.name, "no images and no tracks; add a file of tracks");
  Tracked tracked;
  const auto begin = std::chrono::steady_clock::now();
  const auto report = [&](int done, int of) {
    tracked.milliseconds.push_back(milliseconds_since(begin));
    if (progress) progress("tracking", done, of);
  };
  ImagesAhead images(*recording.images, span.start, span.start + span.frames);
  std::vector<cv::Mat> thumbnails(span.frames);
  auto tracks = track_window(
      [&](int frame) {
        cv::Mat gray = images.gray(frame);
        thumbnails[frame - span.start] = thumbnail_of(gray);
        return gray;
      },
      recording.camera,
      span,
      tracking,
      {stop, report});
  if (!tracks) return std::nullopt;
  tracked.tracks = std::make_shared<const Tracks>(std::move(*tracks));
  tracked.faults = faults_of(thumbnails);
  return tracked;
}

std::shared_ptr<const Tracks> beginning(const std::shared_ptr<const Tracks>& whole, int frames) {
  if (whole->frame_count() == frames) return whole;
  Tracks tracks = *whole;
  tracks.raw_px.resize(frames);
  if (!tracks.sigma_px.empty()) tracks.sigma_px.resize(frames);
  if (!tracks.forward_backward_px.empty()) tracks.forward_backward_px.resize(frames);
  if (tracks.repetition) tracks.repetition->margins.resize(frames);
  for (std::optional<TrackEnd>& end : tracks.ends)
    if (end && end->frame >= frames) end.reset();
  return std::make_shared<const Tracks>(std::move(tracks));
}

std::shared_ptr<const WindowTruth> window_truth(const Recording& recording,
                                                const FrameSpan& span,
                                                const std::stop_token& stop,
                                                const Progress& progress) {
  if (recording.truth) {
    const auto begin = recording.truth->poses.begin() + span.start;
    WindowTruth truth{recording.truth->source, {begin, begin + span.frames}, recording.plane};
    truth.upright = recording.truth->upright;
    truth.R_measured_camera = recording.truth->R_measured_camera;
    if (!truth.plane) truth.plane = plane_of_board(recording, span.start, truth.cameras.front());
    return std::make_shared<const WindowTruth>(std::move(truth));
  }
  if (!recording.board || !recording.images) return nullptr;
  const auto report = [&](int done, int of) {
    if (progress) progress("finding the board", done, of);
  };
  GroundTruth found = board_truth(recording, span.start, span.frames, stop, report);
  WindowTruth truth{
      found.source, std::move(found.poses), kBoardPlane, std::move(found.uncertainties)};
  truth.estimated_readout = found.estimated_readout;
  return std::make_shared<const WindowTruth>(std::move(truth));
}

std::shared_ptr<const WindowTruth> beginning(const std::shared_ptr<const WindowTruth>& whole,
                                             int frames) {
  if (!whole || static_cast<int>(whole->cameras.size()) == frames) return whole;
  WindowTruth truth = *whole;
  truth.cameras.resize(frames);
  if (!truth.uncertainties.empty()) truth.uncertainties.resize(frames);
  return std::make_shared<const WindowTruth>(std::move(truth));
}

std::vector<Eigen::Vector2d> corners_in(const Recording& recording, int frame) {
  if (!recording.board || !recording.images) return {};
  auto corners = find_board(recording.images->gray(frame), *recording.board);
  const auto hidden = [](const Eigen::Vector2d& corner) { return !corner.allFinite(); };
  if (std::ranges::none_of(corners, hidden)) return corners;
  const auto found = board_pose(corners, *recording.board, recording.camera);
  if (!found) return {};
  const auto whole = project_board(*recording.board, recording.camera, found->pose);
  std::ranges::transform(corners, whole, corners.begin(), [&](const auto& seen, const auto& put) {
    return hidden(seen) ? put : seen;
  });
  return corners;
}

RotationSource rotation_source_used(const Recording& recording, RotationSource requested) {
  const RotationSource first = first_source(requested, recording.gyroscope.has_value());
  if (first != requested) return first;
  if (const std::string why_not = why_no_rotations(recording, requested); !why_not.empty())
    refuse_setting("rotations", "{}: {}", to_string(requested), why_not);
  return requested;
}

std::string automatic_rotations(const Recording& recording) {
  return recording.gyroscope ? to_string(RotationSource::gyro_calibrated)
                             : fmt::format("{} or {}",
                                           to_string(RotationSource::five_point),
                                           to_string(RotationSource::averaging));
}

WindowRotations window_rotations(const Recording& recording,
                                 const Window& window,
                                 const WindowTruth* truth,
                                 const InitializeOptions& options,
                                 const std::stop_token& stop) {
  const RotationSource first = rotation_source_used(recording, options.rotations);
  std::vector<Eigen::Matrix3d> R_wc_true;
  if (first == RotationSource::truth) R_wc_true = true_rotations(truth, window.start);
  const Gyroscope* gyroscope = recording.gyroscope ? &*recording.gyroscope : nullptr;
  return window_rotations(window, {gyroscope, R_wc_true, options.seed}, options.rotations, stop);
}

RecordingFacts facts_for_results(const Recording& recording) {
  constexpr std::ptrdiff_t kLeastRotations = 10;
  RecordingFacts facts{.name = recording.name, .T_body_camera = recording.T_body_camera};
  ClockReference reference = clock_of_truth(recording);
  if (std::ssize(reference.R_wc) < kLeastRotations && recording.gyroscope)
    reference = clock_of_rates(*recording.gyroscope);
  if (std::ssize(reference.R_wc) >= kLeastRotations)
    facts.clock = std::make_shared<const ClockReference>(std::move(reference));
  return facts;
}

}  // namespace gpo
