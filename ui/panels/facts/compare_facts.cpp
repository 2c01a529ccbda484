// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/experiment/summary.h"
#include "ui/panels/facts/facts.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include <fmt/format.h>

namespace gpo {
namespace {

using Value = std::optional<double>;

std::string ratio_text(double ratio) { return fmt::format("{:.4f}", ratio); }

constexpr ComparedColumn kMetrics[] = {
    {.title = "PNE",
     .meaning = "Plane normal error: angle to the true normal, in the reference camera",
     .unit = "deg",
     .text = angle_text,
     .evaluated = &Evaluation::pne_deg},
    {.title = "PNE aligned",
     .meaning = "Plane normal error after alignment of the camera paths, as in the paper",
     .unit = "deg",
     .text = angle_text,
     .evaluated = &Evaluation::pne_aligned_deg},
    {.title = "PDE",
     .meaning = "Plane distance error: from the reference camera, in the scale of the alignment",
     .unit = "m",
     .text = length_text,
     .evaluated = &Evaluation::pde_m},
    {.title = "ATE",
     .meaning =
         "Absolute trajectory error: RMS distance of the aligned camera centers to the true ones",
     .unit = "m",
     .text = length_text,
     .evaluated = &Evaluation::ate_m},
    {.title = "Path error",
     .meaning =
         "RMS distance of the camera centers to the true ones without alignment, in the axes "
         "of the reference camera and the scale by the plane's distance",
     .unit = "m",
     .text = length_text,
     .evaluated = &Evaluation::path_error_m},
    {.title = "Scale ratio",
     .meaning = "Scale of the alignment over that by the plane's distance: 1 if the length of the "
                "path is right beside the plane. The alignment hides this error from the ATE",
     .unit = "",
     .text = ratio_text,
     .evaluated = &Evaluation::scale_ratio,
     .less_is_better = false}};

std::string count_text(double value) { return fmt::format("{:.0f}", value); }
std::string px_text(double value) { return number_text(value, 3) + " px"; }

Value normal_sigma(const Inspection& inspection) {
  return inspection.initialization->uncertainty ? normal_sigma_deg(inspection) : std::nullopt;
}

Value iterations(const Inspection& inspection) {
  const int count = inspection.initialization->solver.iterations;
  return count > 0 ? Value(count) : std::nullopt;
}

std::vector<ComparedColumn> make_columns() {
  std::vector<ComparedColumn> columns{
      {.title = "Inliers",
       .meaning = "Tracks that agree with the homographies of the plane",
       .unit = "",
       .text = count_text,
       .value = [](const Inspection& i) -> Value { return i.window->inlier_count(0); },
       .less_is_better = false},
      {.title = "Transfer RMS",
       .meaning = "RMS of the inliers' residuals of the solution: distances from their reference "
                  "positions, transferred by plane and cameras",
       .unit = "px",
       .text = px_text,
       .value = [](const Inspection& i) -> Value { return i.initialization->transfer_rms_px; },
       .less_is_better = false},
      {.title = "Reprojection RMS",
       .meaning = "RMS distance of the inliers from their projected map points",
       .unit = "px",
       .text = px_text,
       .value = [](const Inspection& i) -> Value { return i.initialization->reprojection_rms_px; },
       .less_is_better = false},
      {.title = "Iterations",
       .meaning = "Iterations of the solver; a dash for methods without one",
       .unit = "",
       .text = count_text,
       .value = iterations,
       .less_is_better = false},
      {.title = "Initialize",
       .meaning = "The method, with its checks and the map points",
       .unit = "ms",
       .text = milliseconds_text,
       .value = [](const Inspection& i) -> Value { return i.timing.initialize; },
       .is_time = true}};
  columns.insert(columns.end(), metrics().begin(), metrics().end());
  columns.push_back(
      {.title = "Normal \u03c3",
       .meaning = "Normal uncertainty (1 sigma, first order), without ground truth",
       .unit = "deg",
       .text = [](double deg) { return deg <= 90 ? angle_text(deg) : "undetermined"; },
       .value = normal_sigma});
  return columns;
}

std::string why_unknown(const ComparedColumn& column, const Inspection& inspection, bool timings) {
  if (column.is_time && !timings) return kNoTimes;
  if (!inspection.initialization->ok) return "The initialization failed";
  if (column.evaluated == nullptr) return "This method does not compute it";
  if (!inspection.truth) return "The recording has no ground truth";
  return "The ground truth does not cover it, or the true path is a point or a line";
}

Value value_of(const ComparedColumn& column, const Inspection& inspection, bool timings) {
  if (!inspection.initialization->ok || (column.is_time && !timings)) return std::nullopt;
  if (column.evaluated == nullptr) return column.value(inspection);
  return inspection.evaluation ? *inspection.evaluation.*column.evaluated : std::nullopt;
}

std::string difference(double value, double first, std::string (*text)(double)) {
  std::string absolute = difference_text(value, first, text);
  if (absolute == "\u00b10" || !(first > 0)) return absolute;
  const double percent = 100 * (value - first) / first;
  if (std::abs(percent) <= 0.5) return absolute;  // would be shown as 0 %
  if (percent >= 1000) return fmt::format("{} \u00d7{:.0f}", absolute, value / first);
  return fmt::format("{} {}{:.0f} %", absolute, percent < 0 ? "\u2212" : "+", std::abs(percent));
}

ComparedNumber number(const ComparedColumn& column,
                      const Inspection& inspection,
                      const Inspection* first,
                      bool timings) {
  ComparedNumber number;
  const Value value = value_of(column, inspection, timings);
  number.value = value;
  number.text = value ? column.text(*value) : "\u2013";
  // By way of a variable: GCC 14 warns of a copy out of bounds otherwise.
  if (!value) {
    const std::string why_not = why_unknown(column, inspection, timings);
    number.why_not = why_not;
  }
  const Value reference = first ? value_of(column, *first, timings) : std::nullopt;
  if (!value || !reference) return number;
  number.difference = difference(*value, *reference, column.text);
  if (number.difference != "\u00b10" && column.less_is_better && *value > 0 && *reference > 0)
    number.worse = std::clamp(std::log2(*value / *reference), -1.0, 1.0);
  return number;
}

ComparedRow row_of(const Compared& one, const Inspection* first, bool timings) {
  const char* status = one.error.empty() ? "computing" : "not computed";
  ComparedRow row{one.configuration, one.settings, status, one.error};
  if (!one.inspection) return row;
  const Initialization& result = *one.inspection->initialization;
  row.status = result.ok ? "ok" : "failed";
  if (!result.ok) row.reason = result.reason;
  for (const ComparedColumn& column : compared_columns())
    row.numbers.push_back(number(column, *one.inspection, first, timings));
  return row;
}

/// Returns the finished inspections, the shortest windows first, and counts them in `facts`.
std::vector<Compared> samples_of(const WorkbenchState& state, CurveFacts& facts) {
  std::vector<Compared> samples;
  std::vector<int> lengths = curve_lengths(state.document.settings.frames);
  std::ranges::reverse(lengths);
  for (const int length : lengths) {
    Settings window = state.document.settings;
    window.frames = length;
    for (const Settings& settings : settings_with_current(state, window)) {
      ++facts.of;
      const Surveyed* found = find_surveyed(state.results.surveyed.get(), settings);
      if (found == nullptr) continue;
      ++facts.done;
      if (found->inspection)
        samples.push_back({name_among_compared(state, settings), settings, found->inspection});
    }
  }
  return samples;
}

std::vector<Configuration> shown_of(const WorkbenchState& state, std::vector<Configuration> all) {
  std::erase_if(all, [&](const Configuration& one) {
    return std::ranges::count(state.view.hidden_curves, key_of(one)) > 0;
  });
  return all;
}

Chart sigma_chart(const std::vector<Compared>& samples, const std::vector<Configuration>& shown) {
  Chart chart{"Normal uncertainty", "window [frames]", "\u03c3 [deg]", true, {}};
  for (const Configuration& configuration : shown) {
    Curve curve;
    curve.name = title_of(configuration);
    curve.rgb = color_of(configuration);
    for (const Compared& sample : samples) {
      if (sample.configuration != configuration) continue;
      curve.x.push_back(sample.inspection->settings.frames);
      curve.y.push_back(
          normal_sigma(*sample.inspection).value_or(std::numeric_limits<double>::quiet_NaN()));
    }
    if (!curve.x.empty()) chart.curves.push_back(std::move(curve));
  }
  return chart;
}

CurveFacts facts_of_survey(const WorkbenchState& state) {
  CurveFacts facts;
  for (const Settings& settings : settings_with_current(state, state.document.settings))
    facts.configurations.push_back(name_among_compared(state, settings));
  if (!state.document.recording) return facts;
  const std::vector<Compared> samples = samples_of(state, facts);
  if (samples.empty()) return facts;
  std::vector<Row> rows;
  for (const Compared& sample : samples) {
    rows.push_back(make_row(*sample.inspection));
    rows.back().configuration = key_of(sample.configuration);
  }
  const FigurePlan plan{"curves", "", shown_of(state, facts.configurations)};
  if (plan.configurations.empty()) return facts;
  const bool truth = std::ranges::any_of(
      samples, [](const Compared& one) { return one.inspection->truth != nullptr; });
  facts.figure = truth ? figure_over_length(rows, plan) : figure_without_truth(rows, plan);
  if (truth) return facts;
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

/// Counts the frames in which the track is an inlier of its plane, or of the leading one. The
/// reference frame does not count: nothing can be measured there.
int inlier_frames(const Window& window, int column, std::optional<int> plane) {
  const auto& of = plane && *plane != window.leader ? window.planes[*plane].inlier : window.inlier;
  return static_cast<int>(std::count_if(
      of.begin() + 1, of.end(), [column](const auto& frame) { return bool(frame[column]); }));
}

std::optional<double> value_of(const TrackRow& row, TrackColumn column) {
  const std::optional<double> values[] = {
      static_cast<double>(row.id), row.seen, row.inlier, row.plane, row.rms_px, row.depth, {}};
  return values[static_cast<std::size_t>(column)];
}

std::string cell(const std::optional<double>& value) {
  return value ? fmt::format("{:.6g}", *value) : "";
}

}  // namespace

std::span<const ComparedColumn> metrics() { return kMetrics; }

std::span<const ComparedColumn> compared_columns() {
  static const std::vector<ComparedColumn> columns = make_columns();
  return columns;
}

std::vector<ComparedRow> compared_rows(const std::vector<Compared>& results, bool timings) {
  std::vector<ComparedRow> rows;
  for (const Compared& one : results) {
    const Inspection* first = rows.empty() ? nullptr : results.front().inspection.get();
    rows.push_back(row_of(one, first, timings));
  }
  return rows;
}

std::vector<std::size_t> in_order(const std::vector<ComparedRow>& rows, const TableOrder& order) {
  std::vector<std::size_t> indices(rows.size());
  std::iota(indices.begin(), indices.end(), 0);
  if (order.column < 0) return indices;
  const auto value = [&](std::size_t i) {
    const auto& numbers = rows[i].numbers;
    return order.column < std::ssize(numbers) ? numbers[order.column].value : std::nullopt;
  };
  std::ranges::stable_sort(indices, [&](std::size_t a, std::size_t b) {
    const Value x = value(a), y = value(b);
    if (!x || !y) return x.has_value() && !y;
    return order.descending ? *x > *y : *x < *y;
  });
  return indices;
}

std::string to_csv(std::span<const ComparedRow> rows) {
  std::string text = "method,status";
  for (const ComparedColumn& column : compared_columns())
    text += fmt::format(
        ",{}{}", column.title, *column.unit == '\0' ? "" : fmt::format(" [{}]", column.unit));
  text += "\n";
  for (const ComparedRow& row : rows) {
    text += key_of(row.configuration) + "," + row.status;
    for (std::size_t k = 0; k < compared_columns().size(); ++k) {
      const bool known = k < row.numbers.size() && row.numbers[k].value;
      text += known ? fmt::format(",{}", *row.numbers[k].value) : ",";
    }
    text += "\n";
  }
  return text;
}

CurveFacts curve_facts(const WorkbenchState& state) {
  return state.results.experiment ? facts_of_file(state) : facts_of_survey(state);
}

std::vector<TrackRow> track_rows(const Inspection& inspection) {
  const Window& window = *inspection.window;
  std::vector<TrackRow> rows;
  for (const TrackLife& life : track_lives(inspection)) {
    const auto plane = window.plane_of(life.column);
    rows.push_back({.id = life.id,
                    .seen = static_cast<int>(std::ranges::count_if(
                        life.frames, [&](const auto& f) { return f.frame != window.start; })),
                    .inlier = inlier_frames(window, life.column, plane),
                    .plane = plane ? std::optional(*plane + 1) : std::nullopt,
                    .rms_px = rms_residual_px(life),
                    .depth = life.depth,
                    .verdict = life.verdict});
  }
  std::ranges::sort(rows, {}, &TrackRow::id);
  return rows;
}

void sort_tracks(std::vector<TrackRow>& rows, TrackColumn by, bool descending) {
  std::ranges::sort(rows, {}, &TrackRow::id);
  std::ranges::stable_sort(rows, [&](const TrackRow& a, const TrackRow& b) {
    if (by == TrackColumn::verdict)
      return descending ? b.verdict < a.verdict : a.verdict < b.verdict;
    const auto x = value_of(a, by), y = value_of(b, by);
    if (!x || !y) return x.has_value() && !y.has_value();
    return descending ? *y < *x : *x < *y;
  });
}

std::string to_csv(std::span<const TrackRow> rows) {
  std::string text = "track,frames seen,frames inlier,plane,residual [px],depth [d],verdict\n";
  for (const TrackRow& row : rows) {
    std::string verdict = row.verdict;
    std::ranges::replace(verdict, ',', ';');
    text += fmt::format("{},{},{},{},", row.id, row.seen, row.inlier, cell(row.plane));
    text += cell(row.rms_px) + "," + cell(row.depth) + "," + verdict + "\n";
  }
  return text;
}

const TrackLife& TrackLives::of(const Inspection& inspection, int column) {
  constexpr std::size_t kMost = 16;  // one frame of the window shows at most three
  const auto found = std::ranges::find_if(recent_, [&](const Entry& entry) {
    return entry.column == column && entry.tracks == inspection.tracks &&
           entry.window == inspection.window && entry.initialization == inspection.initialization;
  });
  if (found != recent_.end()) {
    recent_.splice(recent_.begin(), recent_, found);
    return recent_.front().life;
  }
  ++computed_;
  const auto& [tracks, window, result] =
      std::tie(inspection.tracks, inspection.window, inspection.initialization);
  recent_.push_front({tracks, window, result, column, track_life(inspection, column)});
  if (recent_.size() > kMost) recent_.pop_back();
  return recent_.front().life;
}

}  // namespace gpo
