// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inspection/window/window_truth.h"

#include "engine/recording/board/board.h"

#include <algorithm>
#include <optional>
#include <utility>

namespace gpo {
namespace {

/// The plane z = 0 of a board.
const Plane kBoardPlane{-Eigen::Vector3d::UnitZ(), 0};

/// The board's plane in the truth's world, as the reference picture shows it.
std::optional<Plane> plane_of_board(const Recording& recording,
                                    int frame,
                                    const std::optional<Pose>& T_truth_camera) {
  if (!recording.board || !recording.images || !T_truth_camera) return std::nullopt;
  const auto corners = find_board(recording.images->gray(frame), *recording.board);
  const auto found = board_pose(corners, *recording.board, recording.camera);
  if (!found) return std::nullopt;
  return plane_in_camera(kBoardPlane, found->pose * inverse(*T_truth_camera));
}

}  // namespace

std::shared_ptr<const WindowTruth> window_truth(const Recording& recording,
                                                int start,
                                                int frames,
                                                const std::stop_token& stop,
                                                const Progress& progress) {
  if (recording.truth) {
    const auto begin = recording.truth->poses.begin() + start;
    WindowTruth truth{recording.truth->source, {begin, begin + frames}, recording.plane};
    truth.upright = recording.truth->upright;
    if (!truth.plane) truth.plane = plane_of_board(recording, start, truth.cameras.front());
    return std::make_shared<const WindowTruth>(std::move(truth));
  }
  if (!recording.board || !recording.images) return nullptr;
  const auto told = [&](int done, int of) {
    if (progress) progress("finding the board", done, of);
  };
  GroundTruth found = board_truth(recording, start, frames, stop, told);
  return std::make_shared<const WindowTruth>(WindowTruth{
      found.source, std::move(found.poses), kBoardPlane, std::move(found.uncertainties)});
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

}  // namespace gpo
