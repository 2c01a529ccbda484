// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/chart.h"
#include "ui/workbench/state.h"

#include <cstddef>
#include <list>
#include <tuple>
#include <utility>

namespace gpo {

/// One row of the results. An unknown value is a dash, and the tooltip says why.
struct ResultRow {
  std::string label = {};
  std::string value = {};    ///< with its unit
  std::string note = {};     ///< beside the value, dim
  std::string tooltip = {};  ///< explains the value
  Role color = Role::text;
};
inline ResultRow dash(std::string label, std::string why) {
  return {std::move(label), "\u2013", "", std::move(why), Role::text_dim};
}

struct ResultGroup {
  std::string title;
  std::vector<ResultRow> rows;
};
/// Returns whether any row has a value; the others have dashes.
bool has_values(const ResultGroup& group);
/// Returns the titles of a group and its rows with the reasons why their values are unknown.
std::string why_no_values(const ResultGroup& group);
/// Splits "0.912 ±0.004 rad/s" into "0.912" and "±0.004 rad/s"; either may be empty.
std::pair<std::string, std::string> value_and_uncertainty(const std::string& value);

constexpr const char* kMotionTitle = "MOTION";
constexpr const char* kTimeTitle = "TIME";
constexpr const char* kNoTimes = "Screenshots omit times to remain comparable";

/// Returns name, image size, frames and rate, gyroscope, ground truth and calibration.
std::vector<std::string> recording_facts(const Recording& recording);

/// Returns camera, gyroscope, times and truth of a recording with their uncertainties. Reads all
/// time stamps.
std::vector<ResultGroup> recording_groups(const Recording& recording);
/// Returns each parameter of a calibrated camera before and after, and its change. One that the
/// camera did not have was 0.
std::vector<ResultRow> calibration_changes(const Camera& before, const Camera& after);
/// Returns the lines of a regular grid in the undistorted image, as recorded [raw px]; the image's
/// longer side has `cells`.
std::vector<std::vector<Vector2d>> distortion_grid(const Camera& camera, int cells);

/// Returns the results (null: none yet), times only with `timings`. `side`: cube's; 0: default.
std::vector<ResultGroup> result_groups(const Inspection* inspection, bool timings, double side = 0);

/// One row of the findings on a window.
struct FindingRow {
  Finding finding;
  std::string word = {};  ///< its level, or "ignored"
  Role color = Role::text;
  std::string title = {};  ///< title of its check
  bool may_be_ignored = false;
};
/// Returns the findings (null: none yet), the heaviest first.
std::vector<FindingRow> finding_rows(const Inspection* inspection);
/// Returns whether a row has the same text as the verdict's reason.
bool is_said_by(std::span<const FindingRow> rows, const std::string& reason);

/// The normal uncertainty beside the verdict.
struct NormalSigma {
  std::string text = {};   ///< empty if unknown
  bool of_result = false;  ///< else of the window alone, which is no answer
};
/// Returns that of the result, or of the window if the result failed or is degenerate.
NormalSigma shown_normal_sigma(const Initialization& result);

/// Returns a solver's iterations; with those of discarded attempts, which no curve shows: "42 of
/// 110".
std::string iterations_text(const SolverReport& solver);

struct TrackRow {
  std::int64_t id = 0;
  int seen = 0;                       ///< frames that see it, without the reference frame
  int inlier = 0;                     ///< number of these in which it is an inlier of its plane
  std::optional<int> plane = {};      ///< counts from 1; nullopt if it is on none
  std::optional<double> rms_px = {};  ///< residuals as an inlier of the leading plane
  std::optional<double> depth = {};   ///< in the reference camera [d]
  std::string verdict = {};           ///< one sentence
};

enum class TrackColumn { track, seen, inlier, plane, residual, depth, verdict };

/// Returns the rows in the order of the ids.
std::vector<TrackRow> track_rows(const Inspection& inspection);

/// Sorts; unknown values come last either way, and of equal ones the smaller id first.
void sort_tracks(std::vector<TrackRow>& rows, TrackColumn by, bool descending);

std::string to_csv(std::span<const TrackRow> rows);

/// Caches the lives of the tracks that were requested last.
class TrackLives {
 public:
  /// Returns the life of a track by its column of the window; valid until the next call.
  const TrackLife& of(const Inspection& inspection, int column);
  std::size_t computed() const { return computed_; }

 private:
  /// A life depends on these only, not on the cube.
  struct Entry {
    std::shared_ptr<const Tracks> tracks;
    std::shared_ptr<const Window> window;
    std::shared_ptr<const Initialization> initialization;
    int column;
    TrackLife life;
  };
  std::list<Entry> recent_;  ///< the last requested one first
  std::size_t computed_ = 0;
};

/// A column, and its value for an inspection whose initialization succeeded.
struct ComparedColumn {
  const char* title;
  const char* meaning;  ///< for the tooltip of the header
  const char* unit;     ///< for `ComparedNumber::value`; empty: a count
  std::string (*text)(double);
  std::optional<double> (*value)(const Inspection&) = nullptr;  ///< null: that of the evaluation
  std::optional<double> Evaluation::*evaluated = nullptr;
  bool less_is_better = true;  ///< false: neither is better
  bool is_time = false;
};

/// Returns the errors against ground truth.
std::span<const ComparedColumn> metrics();

/// Returns the columns of numbers, from the left; before them stand method and status.
std::span<const ComparedColumn> compared_columns();

struct ComparedNumber {
  std::optional<double> value;
  std::string text;        ///< with its unit; a dash if unknown
  std::string difference;  ///< from the first row: "+0.12° +63 %"; empty if there is none
  /// How much worse (positive) or better than the first row: log2 of the ratio within -1..1.
  double worse = 0;
  std::string why_not;  ///< why the value is unknown; empty if it is known
};

struct ComparedRow {
  Configuration configuration;
  Settings settings;                         ///< that make the configuration the current one
  std::string status;                        ///< "ok", "failed", "computing", "not computed"
  std::string reason;                        ///< why there is no result; empty if there is one
  std::vector<ComparedNumber> numbers = {};  ///< one for each column; empty without an inspection
};

/// Returns one row per result, compared with the first. Without `timings` times are dashes.
std::vector<ComparedRow> compared_rows(const std::vector<Compared>& results, bool timings);

struct TableOrder {
  int column = -1;  ///< index in `compared_columns()`; -1: unsorted
  bool descending = false;
};
/// Returns the rows' indices in order; unknown values come last either way.
std::vector<std::size_t> in_order(const std::vector<ComparedRow>& rows, const TableOrder& order);

/// Returns a header with units and a line for each row; unknown values are empty.
std::string to_csv(std::span<const ComparedRow> rows);

struct CurveFacts {
  std::vector<Configuration> configurations;  ///< also hidden ones
  Figure figure;     ///< ATE, PNE and PDE; without ground truth RMS and normal uncertainty
  std::string note;  ///< one line: why errors are missing; empty if they are not
  int done = 0;      ///< finished windows of the survey
  int of = 0;        ///< all of them; 0: the rows come from a file
};

/// Returns the curves of the open results.csv, else of the compared configurations so far.
CurveFacts curve_facts(const WorkbenchState& state);

/// A value computed from `of`, and computed again only if that changes.
template <class Key, class Value>
struct Cached {
  Key of{};
  Value value{};

  /// Returns whether the value had to be computed.
  bool update(const Key& key, auto&& compute) {
    if (of == key) return false;
    of = key;
    value = compute();
    return true;
  }
};

inline auto curve_inputs(const WorkbenchState& state) {
  const ComputedResults& r = state.results;
  const Document& d = state.document;
  return std::tuple(
      r.surveyed, r.experiment, r.inspection, d.settings, d.compared, state.view.hidden_curves);
}
using CurveInputs = decltype(curve_inputs({}));

}  // namespace gpo
