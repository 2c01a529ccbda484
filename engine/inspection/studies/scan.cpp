// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inspection/studies/scan.h"

#include "engine/base/error.h"
#include "engine/inspection/inspector.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <exception>
#include <limits>
#include <mutex>
#include <thread>
#include <tuple>
#include <utility>

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
  if (result.uncertainty) start.sigma_deg = result.uncertainty->normal_sigma_deg;
  if (inspection.evaluation) start.pne_deg = inspection.evaluation->pne_deg;
  start.reason = result.ok && result.verdict ? result.verdict->reason : result.reason;
  return start;
}

/// Returns nullopt if stopped.
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

std::string number_cell(const std::optional<double>& value) {
  return value ? fmt::format("{:.6g}", *value) : "";
}

}  // namespace

std::string to_text(const ScannedStart& start) {
  if (!start.ok) return fmt::format("{} (failed: {})", start.start, start.reason);
  std::string text = fmt::format("{} ({}", start.start, to_string(start.readiness));
  if (start.sigma_deg) text += fmt::format(", normal +- {:.2g} deg", *start.sigma_deg);
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
  std::vector<std::jthread> threads;
  for (int i = 0; i < options.jobs; ++i) threads.emplace_back(work);
}

std::string to_csv(std::span<const ScannedStart> starts, const Recording& recording) {
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
                        number_cell(one.sigma_deg),
                        number_cell(one.pne_deg),
                        reason);
  }
  return text;
}

}  // namespace gpo
