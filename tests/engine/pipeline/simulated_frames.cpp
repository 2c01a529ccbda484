// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/engine/pipeline/simulated_frames.h"

#include "engine/inspection/inspection.h"

#include <numeric>

#include <gtest/gtest.h>

namespace gpo::test {
namespace {

Frame frame_of(const Eigen::Matrix2Xd& px, const std::vector<std::int64_t>& ids, std::int64_t ns) {
  Frame frame{.timestamp_ns = ns, .ids = {}, .raw_px = {}};
  std::vector<int> seen;
  for (int j = 0; j < px.cols(); ++j)
    if (px.col(j).allFinite()) seen.push_back(j);
  for (const int j : seen) frame.ids.push_back(ids[j]);
  frame.raw_px = px(Eigen::all, seen);
  return frame;
}

}  // namespace

std::vector<Frame> frames_of(const Window& window) {
  std::vector<std::int64_t> ids(window.track_count());
  std::iota(ids.begin(), ids.end(), 0);
  std::vector<Frame> frames;
  for (int i = 0; i < window.frame_count(); ++i)
    frames.push_back(frame_of(window.points_px[i], ids, window.timestamps_ns[i]));
  return frames;
}

std::vector<Frame> frames_of(const Inspection& inspection) {
  const Tracks& tracks = *inspection.tracks;
  std::vector<Frame> frames;
  for (int i = 0; i < tracks.frame_count(); ++i)
    frames.push_back(frame_of(
        tracks.raw_px[i], tracks.ids, inspection.recording->timestamps_ns[tracks.start + i]));
  return frames;
}

Camera camera_of(const Window& window) {
  return {.width = 640,
          .height = 480,
          .fx = window.K(0, 0),
          .fy = window.K(1, 1),
          .cx = window.K(0, 2),
          .cy = window.K(1, 2),
          .sigmas = {0, 0, 0, 0}};
}

void expect_same(const Initialization& one, const Initialization& other) {
  ASSERT_EQ(one.ok, other.ok) << one.reason << " / " << other.reason;
  EXPECT_EQ(one.reason, other.reason);
  EXPECT_EQ(one.plane.normal, other.plane.normal);
  EXPECT_EQ(one.rms_px, other.rms_px);
  ASSERT_EQ(one.cameras.size(), other.cameras.size());
  for (std::size_t i = 0; i < one.cameras.size(); ++i) {
    EXPECT_EQ(one.cameras[i].R_wc, other.cameras[i].R_wc) << i;
    EXPECT_EQ(one.cameras[i].p_wc, other.cameras[i].p_wc) << i;
  }
  ASSERT_EQ(one.points.size(), other.points.size());
  for (std::size_t k = 0; k < one.points.size(); ++k) {
    EXPECT_EQ(one.points[k].track, other.points[k].track) << k;
    EXPECT_EQ(one.points[k].position, other.points[k].position) << k;
  }
  ASSERT_EQ(one.planes.size(), other.planes.size());
  for (std::size_t k = 0; k < one.planes.size(); ++k) {
    EXPECT_EQ(one.planes[k].plane.normal, other.planes[k].plane.normal) << k;
    EXPECT_EQ(one.planes[k].plane.distance, other.planes[k].plane.distance) << k;
  }
  ASSERT_EQ(one.uncertainty.has_value(), other.uncertainty.has_value());
  if (one.uncertainty) {
    EXPECT_EQ(one.uncertainty->normal_covariance, other.uncertainty->normal_covariance);
  }
  ASSERT_EQ(one.verdict.has_value(), other.verdict.has_value());
  if (!one.verdict) return;
  EXPECT_EQ(one.verdict->readiness, other.verdict->readiness);
  EXPECT_EQ(one.verdict->reason, other.verdict->reason);
  EXPECT_EQ(one.verdict->normal_sigma_deg, other.verdict->normal_sigma_deg);
}

}  // namespace gpo::test
