// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/experiment/summary.h"

namespace gpo {

/// A recording, or all together, in a table of errors.
struct RecordingLine {
  std::string recording;
  bool all = false;                     ///< all recordings together
  int windows = 0;                      ///< tried
  int common = 0;                       ///< solved by all methods that solved any
  std::vector<int> solved;              ///< one per method
  std::vector<Cell> common_cells = {};  ///< one per method; without windows if it solved none
};

/// The errors of all methods in the windows of one length: a line per recording, and with several
/// recordings one of all.
struct RecordingTable {
  int frames = 0;
  std::vector<std::string> methods;  ///< keys
  std::vector<std::string> titles;   ///< titles of the methods
  std::vector<NumberColumn> errors;  ///< errors with values; without any, the residual's RMS
  std::vector<RecordingLine> lines = {};
};

/// Returns the table of a length. Medians and quartiles are over the windows of a line that all
/// methods solved (`on_common_windows`).
RecordingTable recording_table(std::span<const Row> rows, int frames);

/// Returns a table of medians and quartiles per error, for `timed_length`.
std::string recordings_markdown(std::span<const Row> rows);
/// Returns floats for LaTeX with the package booktabs, one per length of the overview, with blocks
/// of errors. The lowest median of a line is bold.
std::string recordings_latex(std::span<const Row> rows);
/// Returns a line per recording, length and method, for all lengths; the recording of all together
/// is `*`. Unknown values are empty.
std::string recordings_csv(std::span<const Row> rows);

/// Returns the text with LaTeX's special characters escaped.
std::string latex_text(const std::string& text);

/// Returns the figures of each recording, named "RECORDING_FIGURE".
std::vector<Figure> recording_figures(std::span<const Row> rows,
                                      const std::vector<Configuration>& configurations);

/// Returns the time offsets of other programs' results, recording minus result, estimated over
/// whole recordings, with their standard deviations and what is applied [ms]. Undetermined ones are
/// empty. No lines for results without times and for recordings without a clock reference.
/// `recordings` are those of the experiment, in its order.
Table time_offset_table(const Experiment& experiment,
                        std::span<const std::shared_ptr<const Recording>> recordings);

}  // namespace gpo
