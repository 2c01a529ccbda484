// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/panels/panels.h"
#include "ui/workbench/layout.h"

#include <string>

namespace gpo {

/// The scanned start whose column a frame is in; null: none, or it is not done.
const ScannedStart* start_at(const StartScan& scan, int frame);

/// What a column's height shows: the normal's error where truth tells any, else its standard
/// deviation [deg].
std::optional<double> ScannedStart::*shown_error(const StartScan& scan);

/// How high a column is, 0 to 1: the error's logarithm, 0.01 deg to 10 deg; one that is unknown or
/// of a failure fills it.
float column_height(const ScannedStart& start, std::optional<double> ScannedStart::*error);

/// "start 120: ready, normal ±0.20°, PNE 0.31°" and the reason, for people.
std::string scan_text(const ScannedStart& start);

/// A column a start over the time line's frames, in its verdict's color; a click starts there.
void scan_strip(const PanelInput& input, const Rectangle& place, Commands& commands);

}  // namespace gpo
