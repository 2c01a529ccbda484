// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/experiment/experiment.h"
#include "engine/experiment/row.h"

#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace gpo {

/// A table for people: a caption, a header and lines of cells.
struct Table {
  std::string caption;
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> lines;
};

/// The paper's running times: medians over the solved windows of 30 frames, or of the longest
/// length below, or where all are longer of the shortest. The caption says how they were measured:
/// only what was computed one window at a time is called one thread's.
Table running_time_table(std::span<const Row> rows);

/// How many windows each configuration solved, and its median errors over them, at 10, 30 and 60
/// frames; where these are not all there, at the shortest, a middle and the longest length.
Table overview_table(std::span<const Row> rows);
/// The same for programs: each cell a number, or nothing.
Table overview_numbers(std::span<const Row> rows);

std::string to_markdown(const Table& table);
/// Without the caption.
std::string to_csv(const Table& table);
/// In columns, for a terminal.
std::string to_text(const Table& table);

/// summary.json: the experiment; on what its times were measured; per configuration and length over
/// all windows; the same for each recording; and for each of the figures over the windows that all
/// of its configurations solved.
nlohmann::ordered_json to_json(const Experiment& experiment, std::span<const Row> rows);

}  // namespace gpo
