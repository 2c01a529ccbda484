// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/panels/facts/compare_facts.h"

#include "ui/look/numbers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>

#include <fmt/format.h>

namespace gpo {
namespace {

using Value = std::optional<double>;

std::string count_text(double value) { return fmt::format("{:.0f}", value); }
std::string pixel_text(double value) { return number_text(value, 3) + " px"; }

enum class Better { less, more, neither };

/// How a column reads an inspection whose initialization is ok.
struct Reading {
  ComparedColumn column;
  Value (*value)(const Inspection&);
  std::string (*text)(double);
  Better better;
  bool needs_truth = false;
  bool is_time = false;
};

Evaluation evaluation_of(const Inspection& inspection) {
  return inspection.evaluation.value_or(Evaluation{});
}

Value normal_sigma(const Inspection& inspection) {
  const auto& uncertainty = inspection.initialization->uncertainty;
  return uncertainty ? Value(uncertainty->normal_sigma_deg) : std::nullopt;
}

Value iterations(const Inspection& inspection) {
  const int count = inspection.initialization->solver.iterations;
  return count > 0 ? Value(count) : std::nullopt;
}

constexpr std::array kReadings{
    Reading{{"Inliers", "Tracks that agree with the plane's homographies", ""},
            [](const Inspection& i) -> Value { return i.window->inlier_count(0); },
            count_text,
            Better::neither},
    Reading{
        {"RMS", "Root mean square reprojection error of the observations that it used [px]", "px"},
        [](const Inspection& i) -> Value { return i.initialization->rms_px; },
        pixel_text,
        Better::less},
    Reading{{"Iterations", "Of the solver; a dash where the method does not optimize", ""},
            iterations,
            count_text,
            Better::neither},
    Reading{{"Initialize", "The method, with checks and map points [ms]", "ms"},
            [](const Inspection& i) -> Value { return i.timing.initialize; },
            milliseconds_text,
            Better::less,
            false,
            true},
    Reading{{"PNE",
             "Plane normal error: angle to the true normal, in the reference camera [deg]",
             "deg"},
            [](const Inspection& i) { return evaluation_of(i).pne_deg; },
            angle_text,
            Better::less,
            true},
    Reading{{"PNE aligned",
             "Plane normal error after aligning the camera paths, the paper's way [deg]",
             "deg"},
            [](const Inspection& i) { return evaluation_of(i).pne_aligned_deg; },
            angle_text,
            Better::less,
            true},
    Reading{{"PDE", "Plane distance error, in the scale of the alignment [mm]", "m"},
            [](const Inspection& i) { return evaluation_of(i).pde_m; },
            length_text,
            Better::less,
            true},
    Reading{
        {"ATE", "Absolute trajectory error, root mean square over the aligned cameras [mm]", "m"},
        [](const Inspection& i) { return evaluation_of(i).ate_m; },
        length_text,
        Better::less,
        true},
    Reading{{"Normal \u03c3",
             "Standard deviation of the plane's normal, first order; needs no truth [deg]",
             "deg"},
            normal_sigma,
            angle_text,
            Better::less},
};

std::string why_not_known(const Reading& reading, const Inspection& inspection, bool timings) {
  if (reading.is_time && !timings)
    return "Timings are left out of pictures, so that pictures can be compared";
  if (!inspection.initialization->ok) return "The initialization failed";
  if (reading.needs_truth && !inspection.truth) return "The recording has no ground truth";
  if (reading.needs_truth)
    return "The ground truth does not cover it, or the true path is a point or a line";
  return "This method does not tell";
}

Value value_of(const Reading& reading, const Inspection& inspection, bool timings) {
  if (!inspection.initialization->ok || (reading.is_time && !timings)) return std::nullopt;
  return reading.value(inspection);
}

/// log2 of the ratio, within -1..1.
double worse_by(double value, double first, Better better) {
  if (better == Better::neither || value <= 0 || first <= 0) return 0;
  return std::clamp(std::log2(value / first), -1.0, 1.0);
}

std::string difference(double value, double first, std::string (*text)(double)) {
  std::string absolute = difference_text(value, first, text);
  if (absolute == "\u00b10" || !(first > 0)) return absolute;
  const double percent = 100 * (value - first) / first;
  if (percent >= 1000) return fmt::format("{} \u00d7{:.0f}", absolute, value / first);
  return fmt::format("{} {}{:.0f} %", absolute, percent < 0 ? "\u2212" : "+", std::abs(percent));
}

ComparedNumber number(const Reading& reading,
                      const Inspection& inspection,
                      const Inspection* first,
                      bool timings) {
  ComparedNumber number;
  const Value value = value_of(reading, inspection, timings);
  number.value = value;
  number.text = value ? reading.text(*value) : "\u2013";
  // Not assigned as it is returned: GCC 14 sees a copy out of bounds in that.
  if (!value) {
    const std::string why_not = why_not_known(reading, inspection, timings);
    number.why_not = why_not;
  }
  const Value reference = first ? value_of(reading, *first, timings) : std::nullopt;
  if (!value || !reference) return number;
  number.difference = difference(*value, *reference, reading.text);
  if (number.difference != "\u00b10") number.worse = worse_by(*value, *reference, reading.better);
  return number;
}

ComparedRow row_of(const Compared& one, const Inspection* first, bool timings) {
  ComparedRow row{one.configuration, one.settings, "computing", "", {}};
  if (!one.error.empty()) {
    row.status = "not computed";
    row.reason = one.error;
  }
  if (!one.inspection) return row;
  const Initialization& result = *one.inspection->initialization;
  row.status = result.ok ? "ok" : "failed";
  if (!result.ok) row.reason = result.reason;
  for (const Reading& reading : kReadings)
    row.numbers.push_back(number(reading, *one.inspection, first, timings));
  return row;
}

}  // namespace

std::span<const ComparedColumn> compared_columns() {
  static const auto columns = [] {
    std::array<ComparedColumn, kReadings.size()> all{};
    std::ranges::transform(kReadings, all.begin(), &Reading::column);
    return all;
  }();
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
    const bool there = order.column < static_cast<int>(numbers.size());
    return there ? numbers[order.column].value : std::nullopt;
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

}  // namespace gpo
