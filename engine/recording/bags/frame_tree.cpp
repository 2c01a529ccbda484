// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/bags/frame_tree.h"

#include <deque>
#include <map>
#include <utility>

namespace gpo {
namespace {

/// Once ROS' names of frames began with a slash.
std::string plain(const std::string& frame) {
  return frame.starts_with('/') ? frame.substr(1) : frame;
}

}  // namespace

std::optional<Pose> transform_between(const std::vector<PoseMessage>& transforms,
                                      const std::string& from,
                                      const std::string& to) {
  std::multimap<std::string, std::pair<std::string, Pose>> neighbors;
  for (const PoseMessage& one : transforms) {
    const auto T_parent_child = one.pose();
    if (!T_parent_child) continue;
    const std::string parent = plain(one.header.frame_id);
    const std::string child = plain(one.child_frame_id);
    neighbors.emplace(parent, std::pair(child, *T_parent_child));
    neighbors.emplace(child, std::pair(parent, inverse(*T_parent_child)));
  }
  std::map<std::string, Pose> reached = {{plain(from), Pose{}}};  // T_from_frame
  std::deque<std::string> open = {plain(from)};
  while (!open.empty()) {
    const std::string frame = open.front();
    open.pop_front();
    if (frame == plain(to)) return reached[frame];
    const auto [first, last] = neighbors.equal_range(frame);
    for (auto i = first; i != last; ++i) {
      const auto& [next, T_frame_next] = i->second;
      if (reached.emplace(next, reached[frame] * T_frame_next).second) open.push_back(next);
    }
  }
  return std::nullopt;
}

}  // namespace gpo
