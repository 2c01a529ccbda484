// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/map.h"

#include <fmt/format.h>

namespace gpo {

std::map<std::int64_t, Eigen::Vector3d> points_by_id(const WindowResult& result) {
  std::map<std::int64_t, Eigen::Vector3d> points;
  for (const auto& [track, position] : result.initialization.points)
    points.emplace(result.ids[track], position);
  return points;
}

std::vector<std::int64_t> inlier_ids(const WindowResult& result, int frame) {
  std::vector<std::int64_t> ids;
  for (const int track : result.window.inlier_tracks(frame)) ids.push_back(result.ids[track]);
  return ids;
}

std::optional<PosePrior> pose_prior(const WindowResult& result) {
  const Initialization& found = result.initialization;
  if (!found.ok || !found.uncertainty || found.uncertainty->pose_covariance.size() == 0)
    return std::nullopt;
  PosePrior prior{found.cameras, found.uncertainty->pose_covariance, {}};
  for (std::size_t i = 1; i < prior.cameras.size(); ++i)
    for (const char* part : {"rotation", "center"})
      for (const char axis : {'x', 'y', 'z'})
        prior.rows.push_back(fmt::format("camera {} {} {}", i, part, axis));
  return prior;
}

}  // namespace gpo
