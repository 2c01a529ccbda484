// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/calibration/plane/plane_selection.h"

#include "engine/geometry/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gpo {
namespace {

constexpr int kLeastSights = 3;             // of a point
constexpr int kLeastPoints = 8;             // of a sight
constexpr int kFewSights = 16;              // of a plane, where starts are compared
constexpr int kFewPoints = 70;              // the same
constexpr double kDisagrees = 3;            // medians of all sights, beyond which one is left out
constexpr double kMedianOfNormal = 0.6745;  // of the absolute value of a standard normal one

/// The sight's observations that `is_kept(column)` says.
template <typename Predicate>
PlaneSight part_of(const PlaneSight& sight, const Predicate& is_kept) {
  std::vector<int> columns, points;
  for (int k = 0; k < static_cast<int>(sight.points.size()); ++k) {
    if (!is_kept(k)) continue;
    columns.push_back(k);
    points.push_back(sight.points[k]);
  }
  return {sight.frame,
          std::move(points),
          sight.raw_px(Eigen::all, columns),
          sight.flow_px(Eigen::all, columns)};
}

PlaneSight emptied(const PlaneSight& sight) { return {sight.frame, {}, Eigen::Matrix2Xd(2, 0)}; }

/// How many sights show each point.
std::vector<int> counts_of(const SightedPlane& plane) {
  std::vector<int> counts(plane.points, 0);
  for (const PlaneSight& sight : plane.sights)
    for (const int j : sight.points) ++counts[j];
  return counts;
}

void clean(SightedPlane& plane) {
  for (bool changed = true; changed;) {
    changed = false;
    const std::vector<int> counts = counts_of(plane);
    for (PlaneSight& sight : plane.sights) {
      const std::size_t before = sight.points.size();
      sight = part_of(sight, [&](int k) { return counts[sight.points[k]] >= kLeastSights; });
      if (std::ssize(sight.points) < kLeastPoints) sight = emptied(sight);
      changed |= sight.points.size() != before;
    }
  }
}

double median_of(const Eigen::VectorXd& errors) {
  return errors.size() == 0 ? 0 : median(std::vector<double>(errors.begin(), errors.end()));
}

}  // namespace

std::vector<SightedPlane> cleaned(std::vector<SightedPlane> planes) {
  std::ranges::for_each(planes, clean);
  std::erase_if(planes, [](const SightedPlane& plane) { return observation_count({plane}) == 0; });
  return planes;
}

SightedPlane placed_part(const SightedPlane& plane, const PlaneMosaic& mosaic) {
  SightedPlane placed = plane;
  for (std::size_t i = 0; i < plane.sights.size(); ++i) {
    const PlaneSight& sight = plane.sights[i];
    placed.sights[i] = part_of(sight, [&](int k) {
      return mosaic.H_i_m[i].allFinite() && mosaic.points.col(sight.points[k]).allFinite();
    });
  }
  clean(placed);
  return placed;
}

std::vector<SightedPlane> visible_part(std::vector<SightedPlane> planes,
                                       const SightErrors& errors) {
  for (std::size_t p = 0; p < planes.size(); ++p) {
    for (std::size_t i = 0; i < planes[p].sights.size(); ++i)
      planes[p].sights[i] =
          part_of(planes[p].sights[i], [&](int k) { return std::isfinite(errors[p][i][k]); });
    clean(planes[p]);
  }
  return planes;
}

std::vector<SightedPlane> thinned(const std::vector<SightedPlane>& planes) {
  std::vector<SightedPlane> few = planes;
  for (SightedPlane& plane : few) {
    std::erase_if(plane.sights, [](const PlaneSight& sight) { return sight.points.empty(); });
    const auto count = std::ssize(plane.sights);
    const auto wanted = std::min<std::ptrdiff_t>(count, kFewSights);
    std::vector<PlaneSight> sights;
    for (std::ptrdiff_t k = 0; k < wanted; ++k)
      sights.push_back(plane.sights[k * (count - 1) / std::max<std::ptrdiff_t>(1, wanted - 1)]);
    plane.sights = std::move(sights);
    const std::vector<int> counts = counts_of(plane);
    std::vector<int> often;
    for (int j = 0; j < plane.points; ++j)
      if (counts[j] >= kLeastSights) often.push_back(j);
    const std::size_t step = std::max<std::size_t>(1, often.size() / kFewPoints);
    std::vector<bool> chosen(plane.points, false);
    for (std::size_t k = 0; k < often.size(); k += step) chosen[often[k]] = true;
    for (PlaneSight& sight : plane.sights)
      sight = part_of(sight, [&](int k) { return chosen[sight.points[k]]; });
  }
  return cleaned(std::move(few));
}

std::vector<SightedPlane> without_far(const std::vector<SightedPlane>& planes,
                                      const SightErrors& errors,
                                      double most_px,
                                      std::vector<int>& left_out) {
  std::vector<double> medians;
  for (const auto& sights : errors)
    for (const Eigen::VectorXd& sight : sights)
      if (sight.size() > 0) medians.push_back(median_of(sight));
  if (medians.empty()) return planes;
  const double most_median_px = kDisagrees * median(medians);
  std::vector<SightedPlane> kept = planes;
  for (std::size_t p = 0; p < planes.size(); ++p) {
    for (std::size_t i = 0; i < planes[p].sights.size(); ++i) {
      PlaneSight& sight = kept[p].sights[i];
      if (median_of(errors[p][i]) > most_median_px) {
        left_out.push_back(sight.frame);
        sight = emptied(sight);
      } else {
        sight = part_of(planes[p].sights[i], [&](int k) { return errors[p][i][k] <= most_px; });
      }
    }
    clean(kept[p]);
  }
  return kept;
}

std::vector<double> finite(const SightErrors& errors) {
  std::vector<double> all;
  for (const auto& sights : errors)
    for (const Eigen::VectorXd& sight : sights)
      for (const double e : sight)
        if (std::isfinite(e)) all.push_back(e);
  return all;
}

double noise_of(const SightErrors& errors) {
  const std::vector<double> all = finite(errors);
  return all.empty() ? 1 : median(all) / kMedianOfRayleigh;
}

double height_of(const std::vector<SightedPlane>& planes, const Adjustment& adjustment) {
  std::vector<double> heights;
  for (std::size_t p = 0; p < planes.size(); ++p) {
    const std::vector<int> counts = counts_of(planes[p]);
    for (int j = 0; j < planes[p].points; ++j)
      if (counts[j] > 0) heights.push_back(std::abs(adjustment.planes[p].points(2, j)));
  }
  return heights.empty() ? 0 : median(heights) / kMedianOfNormal;
}

int observation_count(const std::vector<SightedPlane>& planes) {
  std::size_t count = 0;
  for (const SightedPlane& plane : planes)
    for (const PlaneSight& sight : plane.sights) count += sight.points.size();
  return static_cast<int>(count);
}

int sight_count(const std::vector<SightedPlane>& planes) {
  std::ptrdiff_t count = 0;
  for (const SightedPlane& plane : planes)
    count += std::ranges::count_if(plane.sights,
                                   [](const PlaneSight& sight) { return !sight.points.empty(); });
  return static_cast<int>(count);
}

int point_count(const std::vector<SightedPlane>& planes) {
  std::ptrdiff_t count = 0;
  for (const SightedPlane& plane : planes)
    count += std::ranges::count_if(counts_of(plane), [](int sights) { return sights > 0; });
  return static_cast<int>(count);
}

}  // namespace gpo
