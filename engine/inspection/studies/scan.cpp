// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/error.h"
#include "engine/base/parallel.h"
#include "engine/diagnosis/window_evidence.h"
#include "engine/geometry/decompositions.h"
#include "engine/inspection/inspector.h"
#include "engine/inspection/studies/studies.h"
#include "engine/window/timestamps.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include <Eigen/LU>
#include <fmt/format.h>

namespace gpo {
namespace {

constexpr int kMostStarts = 100;

ScannedStart scanned(const Inspection& inspection) {
  const Initialization& result = *inspection.initialization;
  ScannedStart start{.start = inspection.settings.start, .ok = result.ok};
  if (result.verdict) {
    start.readiness = result.verdict->readiness;
    start.sigma_deg = result.verdict->normal_sigma_deg;
  }
  if (inspection.evaluation) start.pne_deg = inspection.evaluation->pne_deg;
  start.reason = result.ok && result.verdict ? result.verdict->reason : result.reason;
  return start;
}

std::optional<ScannedStart> scan_one(Inspector& inspector,
                                     const Settings& settings,
                                     const std::stop_token& stop) {
  try {
    const auto inspection = inspector.inspect(settings, stop);
    return inspection ? std::optional(scanned(*inspection)) : std::nullopt;
  } catch (const std::exception& error) {
    return ScannedStart{.start = settings.start, .reason = message_of(error)};
  }
}

constexpr double kWindow_s = 0.3;
constexpr int kFewestFrames = 5;
constexpr int kMostFrames = 20;
constexpr double kOnlyRotates = 1.45;  // residual of rotations to that of homographies

int window_frames(const Recording& recording) {
  const double period_s = 1e-9 * static_cast<double>(median_period_ns(recording.timestamps_ns));
  const int frames = 1 + static_cast<int>(std::lround(kWindow_s / period_s));
  return std::clamp(frames, kFewestFrames, kMostFrames);
}

/// Returns R_wc with K R_cw K^-1 nearest to each homography; empty if one is missing.
std::vector<Eigen::Matrix3d> rotations_of_homographies(const Window& window) {
  std::vector<Eigen::Matrix3d> R_wc{Eigen::Matrix3d::Identity()};
  for (int i = 1; i < window.frame_count(); ++i) {
    if (!window.H_i1[i].allFinite()) return {};
    Eigen::Matrix3d M = window.K.inverse() * window.H_i1[i] * window.K;
    if (M.determinant() < 0) M = -M;
    R_wc.emplace_back(nearest_rotation(M).transpose());
  }
  return R_wc;
}

std::vector<Eigen::Matrix3d> rotations_of(const Inspection& inspection) {
  const Window& window = *inspection.window;
  const Initialization& result = *inspection.initialization;
  const bool of_all_tracks = inspection.rotations_used == RotationSource::five_point;
  if (result.ok && !of_all_tracks) {
    std::vector<Eigen::Matrix3d> R_wc;
    for (const Pose& camera : result.cameras)
      R_wc.emplace_back(result.cameras[0].R_wc.transpose() * camera.R_wc);
    return R_wc;
  }
  // Rotations that could not be determined are I in all frames.
  const bool determined =
      std::ranges::any_of(window.R_wc, [](const auto& R) { return !R.isIdentity(0); });
  if (determined) return window.R_wc;
  const WindowEvidence evidence = evidence_of(window);
  if (evidence.rotation_rms_px() < kOnlyRotates * evidence.noise_px())
    return rotations_of_homographies(window);
  return {};
}

}  // namespace

std::string to_text(const ScannedStart& start) {
  if (!start.ok) return fmt::format("{} (failed: {})", start.start, start.reason);
  std::string text = fmt::format("{} ({}", start.start, to_string(start.readiness));
  constexpr double kUndetermined_deg = 90;
  if (start.sigma_deg)
    text += *start.sigma_deg > kUndetermined_deg
                ? ", normal undetermined"
                : fmt::format(", normal +- {:.2g} deg", *start.sigma_deg);
  if (start.pne_deg) text += fmt::format(", PNE {:.2g} deg", *start.pne_deg);
  return text + ")";
}

const ScannedStart* best_start(std::span<const ScannedStart> starts) {
  const auto rank = [](const ScannedStart& start) {
    const int readiness = start.readiness == Readiness::ready  ? 0
                          : start.readiness == Readiness::weak ? 1
                                                               : 2;
    return std::tuple(
        !start.ok, readiness, start.sigma_deg.value_or(std::numeric_limits<double>::infinity()));
  };
  const auto best = std::ranges::min_element(starts, {}, rank);
  return best != starts.end() && best->ok ? &*best : nullptr;
}

int scan_step(int recorded_frames, int window_frames) {
  return std::max(0, recorded_frames - window_frames) / kMostStarts + 1;
}

std::vector<int> starts_to_scan(int recorded_frames, int window_frames, int step) {
  const int last = recorded_frames - window_frames;
  if (last < 0) return {};
  const auto count = static_cast<unsigned>(last / step + 1);
  std::vector<int> starts;
  // 0, then every odd multiple of the largest power of two, of its half, ... of one.
  starts.push_back(0);
  for (unsigned stride = std::bit_ceil(count) / 2; stride > 0; stride /= 2)
    for (unsigned i = stride; i < count; i += 2 * stride)
      starts.push_back(static_cast<int>(i) * step);
  return starts;
}

void scan_starts(const std::shared_ptr<const Recording>& recording,
                 const Settings& settings,
                 const ScanOptions& options,
                 const std::function<void(ScannedStart)>& found) {
  const std::span<const int> starts = options.starts;
  const std::stop_token& stop = options.stop;
  std::atomic<std::size_t> next = 0;
  std::mutex mutex;
  const auto work = [&] {
    Inspector inspector(recording);
    Settings window = settings;
    for (std::size_t i = next++; i < starts.size() && !stop.stop_requested(); i = next++) {
      window.start = starts[i];
      auto start = scan_one(inspector, window, stop);
      const std::scoped_lock lock(mutex);
      if (start && !stop.stop_requested()) found(*std::move(start));
    }
  };
  in_parallel(options.jobs, options.jobs, [&](int) { work(); });
}

std::string to_csv(std::span<const ScannedStart> starts, const Recording& recording) {
  const auto cell = [](const std::optional<double>& value) {
    return value ? fmt::format("{:.6g}", *value) : "";
  };
  std::string text = "start,time_s,status,verdict,sigma_deg,pne_deg,reason\n";
  for (const ScannedStart& one : starts) {
    const auto since_first = recording.timestamps_ns[one.start] - recording.timestamps_ns.front();
    std::string reason = one.reason;
    std::ranges::replace(reason, ',', ';');
    text += fmt::format("{},{:.6f},{},{},{},{},{}\n",
                        one.start,
                        static_cast<double>(since_first) * 1e-9,
                        one.ok ? "ok" : "failed",
                        to_string(one.readiness),
                        cell(one.sigma_deg),
                        cell(one.pne_deg),
                        reason);
  }
  return text;
}

std::vector<ImageRotations> rotations_over_recording(
    const std::shared_ptr<const Recording>& recording,
    int most_windows,
    const std::function<void(int, int)>& progress,
    const std::stop_token& stop) {
  auto images_only = std::make_shared<Recording>(*recording);
  images_only->gyroscope.reset();
  images_only->truth.reset();
  images_only->board.reset();
  Inspector inspector(images_only);
  Settings settings;
  settings.frames = std::min(window_frames(*recording), recording->frame_count());
  const int step = settings.frames - 1;
  const int fit = std::max(1, (recording->frame_count() - 1) / std::max(1, step));
  const int count = std::min(fit, most_windows);
  std::vector<ImageRotations> windows;
  for (int w = 0; w < count && !stop.stop_requested(); ++w) {
    settings.start = step * static_cast<int>(static_cast<std::int64_t>(w) * fit / count);
    const auto inspection = inspector.inspect(settings, stop);
    if (!inspection) break;
    auto R_wc = rotations_of(*inspection);
    if (!R_wc.empty()) windows.push_back({inspection->window->timestamps_ns, std::move(R_wc)});
    if (progress) progress(w + 1, count);
  }
  return windows;
}

}  // namespace gpo
