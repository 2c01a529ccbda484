// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/examples/slam_windows.h"

#include "tests/engine/pipeline/simulated_frames.h"

#include <list>
#include <memory>
#include <numeric>
#include <unordered_map>

#include <gtest/gtest.h>
#include <opencv2/core/types.hpp>

namespace gpo::test {
namespace {

// The members of the SLAM systems' types that the converters read, under their names.
struct OrbFrame {
  double mTimeStamp = 0;
  std::vector<cv::KeyPoint> mvKeys = {};
};
struct VinsFeaturePerFrame {
  Eigen::Vector2d uv;
};
struct VinsFeaturePerId {
  int feature_id = 0;
  int start_frame = 0;
  std::vector<VinsFeaturePerFrame> feature_per_frame = {};
};
struct OpenVinsFeature {
  std::unordered_map<std::size_t, std::vector<Eigen::VectorXf>> uvs = {};
  std::unordered_map<std::size_t, std::vector<double>> timestamps = {};
};

double seconds(std::int64_t ns) { return 1e-9 * static_cast<double>(ns); }

/// Fails if times, ids or pixels differ by more than single precision.
void expect_frames(const std::vector<Frame>& found, const std::vector<Frame>& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_NEAR(static_cast<double>(found[i].timestamp_ns - expected[i].timestamp_ns), 0, 1);
    ASSERT_EQ(found[i].ids.size(), expected[i].ids.size());
    for (std::size_t k = 0; k < found[i].ids.size(); ++k) {
      const auto at = std::ranges::find(expected[i].ids, found[i].ids[k]);
      ASSERT_NE(at, expected[i].ids.end());
      const Eigen::Index column = at - expected[i].ids.begin();
      EXPECT_LT((found[i].raw_px.col(static_cast<int>(k)) - expected[i].raw_px.col(column)).norm(),
                1e-4);
    }
  }
}

TEST(SlamWindows, ConvertTheDataOfThreeSystems) {
  const std::vector<Frame> frames = frames_of(simulate({.frames = 5}).window);
  std::vector<Frame> of_orb;
  std::list<VinsFeaturePerId> of_vins;
  std::unordered_map<std::size_t, std::shared_ptr<OpenVinsFeature>> of_open_vins;
  std::vector<double> headers;
  for (const Frame& frame : frames) {
    OrbFrame orb{seconds(frame.timestamp_ns)};
    std::vector<int> matches(frame.ids.size());
    std::iota(matches.begin(), matches.end(), 0);
    headers.push_back(seconds(frame.timestamp_ns));
    for (std::size_t k = 0; k < frame.ids.size(); ++k) {
      const Eigen::Vector2d px = frame.raw_px.col(static_cast<int>(k));
      orb.mvKeys.emplace_back(static_cast<float>(px.x()), static_cast<float>(px.y()), 1.F);
      auto& feature = of_open_vins[frame.ids[k]];
      if (!feature) feature = std::make_shared<OpenVinsFeature>();
      feature->uvs[0].emplace_back(px.cast<float>());
      feature->timestamps[0].push_back(headers.back());
    }
    of_orb.push_back(slam::orb_slam3_frame(orb, matches));
  }
  for (std::size_t k = 0; k < frames[0].ids.size(); ++k) {
    VinsFeaturePerId feature{static_cast<int>(frames[0].ids[k])};
    for (const Frame& frame : frames)
      feature.feature_per_frame.push_back({frame.raw_px.col(static_cast<int>(k))});
    of_vins.push_back(std::move(feature));
  }
  expect_frames(of_orb, frames);
  expect_frames(slam::vins_fusion_frames(of_vins, headers, 5), frames);
  expect_frames(slam::open_vins_frames(of_open_vins), frames);
}

}  // namespace
}  // namespace gpo::test
