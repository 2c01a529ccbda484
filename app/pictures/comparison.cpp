// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "app/pictures/comparison.h"

#include "engine/base/error.h"
#include "engine/experiment/figures.h"
#include "engine/experiment/ranges.h"
#include "engine/experiment/summary.h"
#include "engine/inspection/inspector.h"

#include <algorithm>

#include <fmt/format.h>

namespace gpo {
namespace {

/// Descending.
std::vector<int> lengths_of(const ComparisonRequest& request) {
  const std::string text = request.lengths.value_or("5:end:5");
  std::vector<int> lengths = numbers_in(parse_ranges(text, "lengths"), request.window.frames);
  if (lengths.empty() || lengths.front() < 2) {
    throw InputError(fmt::format("--lengths: '{}' with --frames {}: a window has at least 2 frames",
                                 text,
                                 request.window.frames));
  }
  std::ranges::reverse(lengths);
  return lengths;
}

}  // namespace

std::vector<Configuration> configurations_of(const ComparisonRequest& request) {
  if (request.methods) return parse_configurations(*request.methods, request.table);
  std::vector<Configuration> all;
  for (const MethodChoice& method : request.table.all()) all.push_back({.method = method});
  return all;
}

std::vector<std::shared_ptr<const Inspection>> inspect_each(
    const std::shared_ptr<const Recording>& recording, const ComparisonRequest& request) {
  Inspector inspector(recording);
  const std::vector<Configuration> configurations = configurations_of(request);
  const Settings base = base_of(configurations, request.window);
  std::vector<std::shared_ptr<const Inspection>> inspections;
  inspections.reserve(configurations.size());
  for (const Configuration& configuration : configurations)
    inspections.push_back(inspector.inspect(apply(configuration, base)));
  return inspections;
}

LengthCurves curves_over_length(const std::shared_ptr<const Recording>& recording,
                                const ComparisonRequest& request) {
  const std::vector<Configuration> configurations = configurations_of(request);
  Settings window = base_of(configurations, request.window);
  FigurePlan plan{"curves", "", {}};
  for (const Configuration& configuration : configurations)
    plan.configurations.push_back(configuration_of(apply(configuration, window)));
  std::vector<Row> rows;
  std::vector<std::shared_ptr<const Inspection>> longest;
  Inspector inspector(recording);
  // The longest window first: the Inspector keeps its tracks for the others.
  for (const int length : lengths_of(request)) {
    window.frames = length;
    for (const Configuration& configuration : configurations) {
      const auto inspection = inspector.inspect(apply(configuration, window));
      if (!inspection->truth) {
        throw InputError(fmt::format(
            "--view curves: {} has no ground truth to measure errors against", recording->name));
      }
      rows.push_back(make_row(*inspection));
      if (longest.size() < configurations.size()) longest.push_back(inspection);
    }
  }
  std::ranges::reverse(rows);
  LengthCurves curves{figure_over_length(rows, plan), longest, {}, false};
  // One window a length is what was asked for here, not few of many.
  for (Chart& chart : curves.figure.charts)
    for (Curve& curve : chart.curves) curve.counts.clear();
  curves.figure.title =
      fmt::format("{}: windows from frame {}, by their length", recording->name, window.start);
  for (const Configuration& configuration : plan.configurations) {
    const auto own = rows_of(rows, {&configuration, 1});
    if (std::ranges::any_of(own, &Row::ok)) {
      curves.any_ok = true;
    } else {
      curves.failures.push_back(fmt::format("{}: {}", own.back().configuration, own.back().reason));
    }
  }
  return curves;
}

}  // namespace gpo
