// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/error.h"
#include "engine/recording/layouts/open_recording.h"
#include "engine/window/timestamps.h"
#include "ui/panels/facts/facts.h"
#include "ui/views/overlay/overlay.h"

#include <algorithm>

#include <fmt/format.h>

namespace gpo {
namespace {

/// From the first time stamps only: this runs in every frame of the window.
double rate_at_start_hz(std::span<const std::int64_t> timestamps_ns) {
  constexpr std::size_t kEnough = 200;
  return rate_hz(timestamps_ns.first(std::min(timestamps_ns.size(), kEnough)));
}

}  // namespace

std::vector<std::string> recording_facts(const Recording& recording) {
  std::vector<std::string> facts = {
      recording.name,
      fmt::format("{}\u00d7{}", recording.camera.width, recording.camera.height),
      counted(recording.frame_count(), "frame")};
  const double frames_hz = rate_at_start_hz(recording.timestamps_ns);
  if (frames_hz > 0) facts.back() += fmt::format(" at {:.3g} Hz", frames_hz);
  const double gyro_hz =
      recording.gyroscope ? rate_at_start_hz(recording.gyroscope->timestamps_ns) : 0;
  facts.push_back(gyro_hz > 0           ? fmt::format("gyro {:.3g} Hz", gyro_hz)
                  : recording.gyroscope ? "gyro"
                                        : "no gyro");
  facts.push_back(recording.truth   ? "ground truth"
                  : recording.board ? "ground truth from the board"
                                    : "no ground truth");
  if (recording.camera_source == CameraSource::guess) facts.emplace_back("not calibrated");
  if (recording.camera_source == CameraSource::self_calibrated)
    facts.emplace_back("self-calibrated");
  return facts;
}

std::string bar_text(const Inspection& inspection, int frame) {
  const Window& window = *inspection.window;
  const int in_window = frame - window.start;
  std::string text = fmt::format("frame {}", frame);
  if (in_window < 0 || in_window >= window.frame_count()) return text;
  text += ": " + counted(window.inlier_count(in_window), "inlier");
  if (in_window < static_cast<int>(inspection.motion.size())) {
    const FrameMotion& motion = inspection.motion[in_window];
    text += fmt::format("\nparallax {:.1f} px, angular rate {:.0f}\u00b0/s",
                        motion.parallax_px,
                        motion.rotation_rate_deg_s);
  }
  if (in_window == 0) return text + ". Reference frame: the window starts here";
  const std::vector<Verdict>& growth = shown_growth(inspection);
  if (in_window > static_cast<int>(growth.size())) return text;
  const Verdict& verdict = growth[in_window - 1];
  text += fmt::format("\nwindow of {} frames, {} to {}: ", in_window + 1, window.start, frame);
  text += verdict_text(verdict) + "\n" + verdict.reason;
  const bool whole = in_window + 1 == window.frame_count();
  if (whole && inspection.initialization && inspection.initialization->verdict) return text;
  text += "\n(estimated by GPO with the given rotations; ";
  text += inspection.comparable_growth.empty() ? "image regions are not compared)"
                                               : "at least as wide as the whole window's)";
  return text;
}

}  // namespace gpo
