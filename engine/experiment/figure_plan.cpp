// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/experiment/figure_plan.h"

#include <algorithm>
#include <array>

namespace gpo {
namespace {

bool is_plain(const Configuration& c) { return c == Configuration{.method = c.method}; }

bool is_gpo(const Configuration& c) { return is_plain(c) && c.method == "gpo"; }

bool is_of(const Configuration& c, MethodFamily family) {
  return is_gpo(c) || (is_plain(c) && c.method.row().family == family);
}

/// The method as it is, or with nothing but that setting changed.
bool varies(const Configuration& c, const char* method, const char* setting) {
  const bool only = c.changes.size() == 1 && c.names(setting);
  return c.method == method && (c.changes.empty() || only);
}

/// A figure of the paper, and which configurations are in it. Of two of them its title is true, if
/// one is what it names.
struct PaperFigure {
  const char* name;
  const char* title;
  bool (*shows)(const Configuration& configuration);
  bool names_gpo;  ///< beside others
};

constexpr std::array kPaperFigures{
    PaperFigure{"aggregation",
                "GPO and aggregation-based methods",
                [](const Configuration& c) { return is_of(c, MethodFamily::aggregation); },
                true},
    PaperFigure{"optimization",
                "GPO and optimization-based methods",
                [](const Configuration& c) { return is_of(c, MethodFamily::optimization); },
                true},
    PaperFigure{"gpo_ransac",
                "GPO with and without RANSAC",
                [](const Configuration& c) { return varies(c, "gpo", "ransac"); },
                false},
    PaperFigure{"rotation_sources",
                "GPO by the source of its rotations",
                [](const Configuration& c) { return varies(c, "gpo", "rotations"); },
                false},
    PaperFigure{"ba_ransac",
                "BA with and without RANSAC",
                [](const Configuration& c) { return varies(c, "ba", "ransac"); },
                false},
};

}  // namespace

std::vector<FigurePlan> figure_plans(const std::vector<Configuration>& configurations) {
  std::vector<FigurePlan> plans;
  std::vector<Configuration> shown;
  for (const PaperFigure& figure : kPaperFigures) {
    FigurePlan plan{figure.name, figure.title, {}};
    std::ranges::copy_if(configurations, std::back_inserter(plan.configurations), figure.shows);
    if (plan.configurations.size() < 2) continue;
    if (figure.names_gpo && std::ranges::none_of(plan.configurations, is_gpo)) continue;
    shown.insert(shown.end(), plan.configurations.begin(), plan.configurations.end());
    plans.push_back(std::move(plan));
  }
  const bool all_shown = std::ranges::all_of(configurations, [&](const Configuration& c) {
    return std::ranges::find(shown, c) != shown.end();
  });
  if (!all_shown) plans.push_back({"configurations", "All configurations", configurations});
  return plans;
}

}  // namespace gpo
