// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// From the data of three SLAM systems to frames for `gpo::initialize` and `gpo::save_window`.
// Templates, so that this header includes none of them; their types are named beside.
#include <cmath>
#include <cstdint>
#include <map>

#include <gpo/initialize.h>

namespace slam {

inline void add(std::int64_t id, double x, double y, gpo::Frame& frame) {
  frame.ids.push_back(id);
  frame.raw_px.conservativeResize(2, frame.raw_px.cols() + 1);
  frame.raw_px.rightCols<1>() << x, y;
}

inline std::int64_t nanoseconds(double seconds) { return std::llround(1e9 * seconds); }

/// ORB-SLAM3, in Tracking::MonocularInitialization, once for each frame after
/// SearchForInitialization: Frame `current`, the vector `matches` (mvIniMatches). The first frame
/// matches itself.
template <class Frame, class Matches>
gpo::Frame orb_slam3_frame(const Frame& current, const Matches& matches) {
  gpo::Frame frame{.timestamp_ns = nanoseconds(current.mTimeStamp)};
  for (std::size_t i = 0; i < matches.size(); ++i)
    if (matches[i] >= 0)
      add(i, current.mvKeys[matches[i]].pt.x, current.mvKeys[matches[i]].pt.y, frame);
  return frame;
}

/// VINS-Fusion, in Estimator::initialStructure: f_manager.feature, Headers, frame_count + 1.
template <class Features, class Headers>
std::vector<gpo::Frame> vins_fusion_frames(const Features& features,
                                           const Headers& headers,
                                           int count) {
  std::vector<gpo::Frame> frames(count);
  for (int i = 0; i < count; ++i) frames[i].timestamp_ns = nanoseconds(headers[i]);
  for (const auto& feature : features)
    for (std::size_t k = 0; k < feature.feature_per_frame.size(); ++k)
      add(feature.feature_id,
          feature.feature_per_frame[k].uv.x(),
          feature.feature_per_frame[k].uv.y(),
          frames[feature.start_frame + k]);
  return frames;
}

/// OpenVINS, in InertialInitializer::initialize: _db->get_internal_data(), the camera's number.
template <class Features>
std::vector<gpo::Frame> open_vins_frames(const Features& features, std::size_t camera = 0) {
  std::map<double, gpo::Frame> by_time;
  for (const auto& [id, feature] : features) {
    if (!feature->uvs.contains(camera)) continue;
    const auto& times = feature->timestamps.at(camera);
    for (std::size_t k = 0; k < times.size(); ++k)
      add(id, feature->uvs.at(camera)[k](0), feature->uvs.at(camera)[k](1), by_time[times[k]]);
  }
  std::vector<gpo::Frame> frames;
  for (auto& [seconds, frame] : by_time) {
    frame.timestamp_ns = nanoseconds(seconds);
    frames.push_back(std::move(frame));
  }
  return frames;
}

}  // namespace slam
