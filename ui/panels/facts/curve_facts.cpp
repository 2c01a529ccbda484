// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/panels/facts/curve_facts.h"

#include "engine/experiment/figures.h"

#include <algorithm>
#include <limits>
#include <tuple>

namespace gpo {
namespace {

struct Sample {
  Configuration configuration;
  std::shared_ptr<const Inspection> inspection;
};

/// Returns the finished inspections, the shortest windows first, and counts them in `facts`.
std::vector<Sample> samples_of(const WorkbenchState& state, CurveFacts& facts) {
  std::vector<Sample> samples;
  std::vector<int> lengths = curve_lengths(state.document.settings.frames);
  std::ranges::reverse(lengths);
  for (const int length : lengths) {
    Settings window = state.document.settings;
    window.frames = length;
    for (const Settings& settings : compared_settings(state, window)) {
      ++facts.of;
      const Surveyed* found = find_surveyed(state.results.surveyed.get(), settings);
      if (found == nullptr) continue;
      ++facts.done;
      if (found->inspection)
        samples.push_back({called_among_compared(state, settings), found->inspection});
    }
  }
  return samples;
}

std::vector<Configuration> shown_of(const WorkbenchState& state,
                                    const std::vector<Configuration>& all) {
  std::vector<Configuration> shown;
  std::ranges::copy_if(all, std::back_inserter(shown), [&](const Configuration& one) {
    return std::ranges::find(state.view.hidden_curves, key_of(one)) ==
           state.view.hidden_curves.end();
  });
  return shown;
}

Chart sigma_chart(const std::vector<Sample>& samples, const std::vector<Configuration>& shown) {
  Chart chart{"Normal uncertainty", "window [frames]", "\u03c3 [deg]", true, {}};
  for (const Configuration& configuration : shown) {
    Curve curve;
    curve.name = title_of(configuration);
    curve.rgb = color_of(configuration);
    for (const Sample& sample : samples) {
      if (sample.configuration != configuration) continue;
      const auto& uncertainty = sample.inspection->initialization->uncertainty;
      curve.x.push_back(sample.inspection->settings.frames);
      curve.y.push_back(uncertainty ? uncertainty->normal_sigma_deg
                                    : std::numeric_limits<double>::quiet_NaN());
    }
    if (!curve.x.empty()) chart.curves.push_back(std::move(curve));
  }
  return chart;
}

CurveFacts facts_of_survey(const WorkbenchState& state) {
  CurveFacts facts;
  for (const Settings& settings : compared_settings(state, state.document.settings))
    facts.configurations.push_back(called_among_compared(state, settings));
  if (!state.document.recording) return facts;
  const std::vector<Sample> samples = samples_of(state, facts);
  if (samples.empty()) return facts;
  std::vector<Row> rows;
  for (const Sample& sample : samples) {
    rows.push_back(make_row(*sample.inspection));
    rows.back().configuration = key_of(sample.configuration);
  }
  const FigurePlan plan{"curves", "", shown_of(state, facts.configurations)};
  if (plan.configurations.empty()) return facts;
  const bool truth = std::ranges::any_of(
      samples, [](const Sample& one) { return one.inspection->truth != nullptr; });
  if (truth) {
    facts.figure = figure_over_length(rows, plan);
    return facts;
  }
  facts.figure = figure_without_truth(rows, plan);
  facts.figure.charts.push_back(sigma_chart(samples, plan.configurations));
  facts.note = "The recording has no ground truth: RMS and normal uncertainty instead of errors";
  return facts;
}

CurveFacts facts_of_file(const WorkbenchState& state) {
  CurveFacts facts;
  bool truth = false;
  std::vector<std::string> keys;
  for (const Row& row : *state.results.experiment) {
    truth = truth || row.pne_deg || row.ate_m;
    if (std::ranges::find(keys, row.configuration) != keys.end()) continue;
    keys.push_back(row.configuration);
    facts.configurations.push_back(parse_configuration(row.configuration, state.methods));
  }
  const FigurePlan plan{"curves", "", shown_of(state, facts.configurations)};
  if (plan.configurations.empty()) return facts;
  facts.figure = truth ? figure_over_length(*state.results.experiment, plan)
                       : figure_without_truth(*state.results.experiment, plan);
  if (!truth) facts.note = "These results have no ground truth, so no errors";
  return facts;
}

}  // namespace

CurveFacts curve_facts(const WorkbenchState& state) {
  return state.results.experiment ? facts_of_file(state) : facts_of_survey(state);
}

const CurveFacts& CachedCurveFacts::of(const WorkbenchState& state) {
  const auto inputs = std::tie(state.results.surveyed,
                               state.results.experiment,
                               state.results.inspection,
                               state.document.settings,
                               state.document.compared,
                               state.view.hidden_curves);
  auto cached = std::tie(surveyed_, experiment_, inspection_, settings_, compared_, hidden_);
  if (cached == inputs) return facts_;
  cached = inputs;
  return facts_ = curve_facts(state);
}

}  // namespace gpo
