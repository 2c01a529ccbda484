// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/work/extrapolator.h"

#include "engine/base/error.h"
#include "ui/workbench/state.h"

#include <algorithm>
#include <exception>
#include <utility>

namespace gpo {
namespace {

/// Returns the last frame of a window, counted in the recording.
int last_frame(const Inspection& inspection) {
  return inspection.window->start + inspection.window->frame_count() - 1;
}

/// Returns the cameras; without any and with the reason if they cannot be located. Null if stopped.
std::shared_ptr<const Extrapolation> located(const std::shared_ptr<const Inspection>& inspection,
                                             int frames,
                                             const std::stop_token& stop,
                                             const Progress& progress) {
  try {
    return extrapolate(inspection, frames, stop, progress);
  } catch (const std::exception& error) {
    Extrapolation failed{inspection};
    failed.end = message_of(error);
    return std::make_shared<const Extrapolation>(std::move(failed));
  }
}

/// Returns the extended window with the cubes where they are now.
std::shared_ptr<const Inspection> with_cubes_of(const Inspection& current,
                                                const std::shared_ptr<const Inspection>& extended) {
  if (extended->cube == current.cube && extended->other_cubes == current.other_cubes)
    return extended;
  Inspection shown = *extended;
  shown.cube = current.cube;
  shown.other_cubes = current.other_cubes;
  if (shown.truth) shown.true_cube = current.true_cube;
  return std::make_shared<const Inspection>(std::move(shown));
}

}  // namespace

Extrapolator::Extrapolator(std::function<void()> changed)
    : job_([this] { return next(); }, std::move(changed)) {}

void Extrapolator::want(const std::shared_ptr<const Inspection>& inspection, int frame) {
  const auto lock = job_.lock();
  if (inspection != wanted_) {
    job_.cancel();
    wanted_ = inspection;
    latest_ = nullptr;
    frames_ = 0;
  }
  if (!wanted_ || !wanted_->initialization || !wanted_->initialization->ok) return;
  const int needed = frame - last_frame(*wanted_);
  const bool known = latest_ && (!latest_->end.empty() || latest_->last_frame() >= frame);
  if (needed <= 0 || needed <= frames_ || known) return;
  job_.cancel();
  frames_ = std::max(2 * needed, wanted_->window->frame_count());
  job_.wake();
}

BackgroundJob::Job Extrapolator::next() {
  const int known = latest_ ? static_cast<int>(latest_->cameras.size()) : 0;
  if (!wanted_ || frames_ <= known || (latest_ && !latest_->end.empty())) return nullptr;
  return [this, inspection = wanted_, frames = frames_](const std::stop_token& stop) {
    auto found =
        located(inspection, frames, stop, [&](const std::string& /*stage*/, int done, int of) {
          job_.report(stop, "after the window", done, of);
        });
    if (found) job_.publish(stop, [&] { latest_ = std::move(found); });
  };
}

JobStatus follow_window(WorkbenchState& state,
                        const std::shared_ptr<const Inspection>& published,
                        Extrapolator& extrapolator) {
  ComputedResults& results = state.results;
  extrapolator.want(published, state.view.frame);
  const JobStatus status = extrapolator.status();
  const auto before = std::exchange(results.after, extrapolator.latest());
  const auto& current = results.inspection;
  const bool extends = results.after && results.after->extended && current &&
                       results.after->inspection->window == current->window;
  if (!extends)
    results.extended.reset();
  else if (results.after != before || !results.extended || results.extended_of != current.get())
    results.extended = with_cubes_of(*current, results.after->extended);
  results.extended_of = current.get();
  const bool ended = results.after && results.after != before && !results.after->end.empty();
  if (ended && state.view.frame > results.after->last_frame())
    say(state, "no camera after the window: " + results.after->end, Severity::warning);
  return status;
}

}  // namespace gpo
