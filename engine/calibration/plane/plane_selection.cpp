// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/calibration/plane/plane_lens.h"
#include "engine/geometry/statistics.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <utility>

namespace gpo {
namespace {

constexpr int kLeastViewsOfPoint = 3;
constexpr int kLeastPoints = 8;             // in a view
constexpr int kFewViews = 16;               // per plane, to compare starts
constexpr int kFewPoints = 70;              // the same
constexpr double kMostViewMedian = 3;       // relative to the median of all views
constexpr double kMedianOfNormal = 0.6745;  // median absolute value of a standard normal variable

/// Returns the observations of a view in the columns for which `is_kept`.
PlaneView part_of(const PlaneView& view, const auto& is_kept) {
  std::vector<int> columns, points;
  for (int k = 0; k < static_cast<int>(view.points.size()); ++k) {
    if (!is_kept(k)) continue;
    columns.push_back(k);
    points.push_back(view.points[k]);
  }
  return {view.frame,
          std::move(points),
          view.raw_px(Eigen::all, columns),
          view.flow_px(Eigen::all, columns)};
}

void clean(ObservedPlane& plane) {
  for (bool changed = true; changed;) {
    changed = false;
    const std::vector<int> counts = views_of_points(plane);
    for (PlaneView& view : plane.views) {
      const std::size_t before = view.points.size();
      view = part_of(view, [&](int k) { return counts[view.points[k]] >= kLeastViewsOfPoint; });
      if (std::ssize(view.points) < kLeastPoints) view = {view.frame, {}, Eigen::Matrix2Xd(2, 0)};
      changed |= view.points.size() != before;
    }
  }
}

double median_of(const Eigen::VectorXd& errors) {
  return errors.size() == 0 ? 0 : median(std::vector<double>(errors.begin(), errors.end()));
}

}  // namespace

std::vector<ObservedPlane> cleaned(std::vector<ObservedPlane> planes) {
  std::ranges::for_each(planes, clean);
  std::erase_if(planes,
                [](const ObservedPlane& plane) { return counts_of({plane}).observations == 0; });
  return planes;
}

std::vector<ObservedPlane> filtered(
    std::vector<ObservedPlane> planes,
    const std::function<bool(std::size_t, std::size_t, int)>& is_kept) {
  for (std::size_t p = 0; p < planes.size(); ++p) {
    for (std::size_t i = 0; i < planes[p].views.size(); ++i)
      planes[p].views[i] = part_of(planes[p].views[i], [&](int k) { return is_kept(p, i, k); });
    clean(planes[p]);
  }
  return planes;
}

std::vector<ObservedPlane> thinned(const std::vector<ObservedPlane>& planes) {
  std::vector<ObservedPlane> few = planes;
  std::vector<std::vector<bool>> chosen;  // points of each plane
  for (ObservedPlane& plane : few) {
    std::erase_if(plane.views, [](const PlaneView& view) { return view.points.empty(); });
    const auto count = std::ssize(plane.views);
    const auto wanted = std::min<std::ptrdiff_t>(count, kFewViews);
    std::vector<PlaneView> views;
    for (std::ptrdiff_t k = 0; k < wanted; ++k)
      views.push_back(plane.views[k * (count - 1) / std::max<std::ptrdiff_t>(1, wanted - 1)]);
    plane.views = std::move(views);
    const std::vector<int> counts = views_of_points(plane);
    std::vector<int> often;
    for (int j = 0; j < plane.points; ++j)
      if (counts[j] >= kLeastViewsOfPoint) often.push_back(j);
    const std::size_t step = std::max<std::size_t>(1, often.size() / kFewPoints);
    chosen.emplace_back(plane.points, false);
    for (std::size_t k = 0; k < often.size(); k += step) chosen.back()[often[k]] = true;
  }
  return cleaned(filtered(few, [&](std::size_t p, std::size_t i, int k) {
    return chosen[p][few[p].views[i].points[k]];
  }));
}

std::vector<ObservedPlane> without_far(const std::vector<ObservedPlane>& planes,
                                       const ViewErrors& errors,
                                       double most_px,
                                       std::vector<int>& left_out) {
  std::vector<double> medians;
  for (const auto& views : errors)
    for (const Eigen::VectorXd& view : views)
      if (view.size() > 0) medians.push_back(median_of(view));
  if (medians.empty()) return planes;
  const double most_median_px = kMostViewMedian * median(medians);
  std::set<std::pair<std::size_t, std::size_t>> far;
  for (std::size_t p = 0; p < planes.size(); ++p) {
    for (std::size_t i = 0; i < planes[p].views.size(); ++i) {
      if (median_of(errors[p][i]) <= most_median_px) continue;
      left_out.push_back(planes[p].views[i].frame);
      far.emplace(p, i);
    }
  }
  return filtered(planes, [&](std::size_t p, std::size_t i, int k) {
    return !far.contains({p, i}) && errors[p][i][k] <= most_px;
  });
}

std::vector<double> finite(const ViewErrors& errors) {
  std::vector<double> all;
  for (const auto& views : errors)
    for (const Eigen::VectorXd& view : views)
      std::ranges::copy_if(
          view, std::back_inserter(all), [](double e) { return std::isfinite(e); });
  return all;
}

double noise_of(const ViewErrors& errors) {
  const std::vector<double> all = finite(errors);
  return all.empty() ? 1 : median(all) / kMedianOfRayleigh;
}

double height_of(const std::vector<ObservedPlane>& planes, const Adjustment& adjustment) {
  std::vector<double> heights;
  for (std::size_t p = 0; p < planes.size(); ++p) {
    const std::vector<int> counts = views_of_points(planes[p]);
    for (int j = 0; j < planes[p].points; ++j)
      if (counts[j] > 0) heights.push_back(std::abs(adjustment.planes[p].points(2, j)));
  }
  return heights.empty() ? 0 : median(heights) / kMedianOfNormal;
}

std::vector<int> views_of_points(const ObservedPlane& plane) {
  std::vector<int> counts(plane.points, 0);
  for (const PlaneView& view : plane.views)
    for (const int j : view.points) ++counts[j];
  return counts;
}

PlaneCounts counts_of(const std::vector<ObservedPlane>& planes) {
  PlaneCounts counts;
  for (const ObservedPlane& plane : planes) {
    for (const PlaneView& view : plane.views) {
      counts.observations += static_cast<int>(view.points.size());
      counts.views += view.points.empty() ? 0 : 1;
    }
    for (const int views : views_of_points(plane)) counts.points += views > 0 ? 1 : 0;
  }
  return counts;
}

}  // namespace gpo
