// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/panels/panels.h"

struct ImDrawList;

namespace gpo {

/// Maps frames to slots of equal width from `left` to `right` [screen px].
struct TimeAxis {
  float left = 0, right = 0;
  int frames = 1;      ///< length of the recording
  TimeSpan span = {};  ///< the shown ones

  /// Returns where the slot of a frame begins, possibly outside of the bar.
  float slot_begin(int frame) const {
    return left + slot_width() * static_cast<float>(frame - span.first);
  }
  float slot_middle(int frame) const { return (slot_begin(frame) + slot_begin(frame + 1)) / 2; }
  /// Returns the frame at x, clamped to the recording.
  int frame_at(float x) const;

 private:
  float slot_width() const {
    return (right - left) / static_cast<float>(span.count > 0 ? span.count : frames);
  }
};

struct BarArea {
  ImDrawList& list;
  TimeAxis axis;
  float top, bottom;  ///< [screen px]
  float scale;        ///< text scale
};

/// Returns the tooltip of a frame's bar: inliers, motion, verdict on the window that ends there.
std::string bar_text(const Inspection& inspection, int frame);

/// A bar per frame: inliers, colored by the verdict on the window that ends there; others above.
void draw_tracks(const BarArea& area, const Inspection& inspection);

/// Marks each change of verdict by a sign, for those who cannot distinguish the colors.
void draw_verdict_signs(const BarArea& area, const Inspection& inspection);

/// A mark of the ruler with its text, "1.5 s · 45".
struct RulerTick {
  int frame = 0;  ///< the first one at or after the time
  std::string text;
};

/// Returns marks at round times since the first frame, at least `apart_px` apart, in the span.
std::vector<RulerTick> ruler_ticks(const TimeAxis& axis,
                                   std::span<const std::int64_t> timestamps_ns,
                                   double apart_px);

/// Draws the ruler between the area's top and bottom.
void draw_ruler(const BarArea& area, std::span<const std::int64_t> timestamps_ns);

/// One line at the area's `top` that explains the bars, with fewer words if it would pass `right`.
void draw_verdict_legend(const BarArea& area, const Inspection& shown, float left, float right);

/// Lines of parallax and angular rate over the bars, each scaled to its own maximum.
void draw_motion(const BarArea& area, const Inspection& inspection);

/// Marks the frame from which on the window determines the metric scale, if any.
void draw_scale_mark(const BarArea& area, const Inspection& inspection);

/// Returns the jumps of the recording's ground truth, else those of a computed truth in the window.
std::vector<TruthJump> shown_jumps(const WorkbenchState& state, const Inspection* inspection);

/// Returns the first frame after a jump.
int frame_after(const TruthJump& jump, const Recording& recording);

/// Crosses at the upper edge, where the ground truth jumps.
void draw_jumps(const BarArea& area, const Recording& recording, std::span<const TruthJump> jumps);

void draw_bookmarks(const BarArea& area, std::span<const Bookmark> bookmarks);

/// Returns the scanned start whose column contains a frame; null if none, or not scanned yet.
const ScannedStart* start_at(const StartScan& scan, int frame);

/// Returns the error that columns show: the PNE, or without truth the normal uncertainty [deg].
std::optional<double> ScannedStart::*shown_error(const StartScan& scan);

/// Returns a column's height 0..1, logarithmic from 0.01 to 10 deg; 1 if unknown or failed.
float column_height(const ScannedStart& start, std::optional<double> ScannedStart::*error);

/// "start 120: ready, normal ±0.20°, PNE 0.31°" and the reason.
std::string scan_text(const ScannedStart& start);

/// A column for each scanned start in the color of its verdict; a click starts the window there. At
/// its right, in the gutter, is what the columns show, or the progress of the scan.
void scan_strip(const PanelContext& ui,
                const TimeAxis& axis,
                const Rectangle& place,
                float gutter_px);

}  // namespace gpo
