// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/error.h"
#include "ui/workbench/work/worker.h"

#include <algorithm>
#include <exception>
#include <thread>
#include <utility>

namespace gpo {
namespace {

/// Enough for ten methods at some tens of lengths, about half a megabyte each.
constexpr std::size_t kMostResults = 300;

/// A scan of a hundred starts takes some kilobytes.
constexpr std::size_t kMostScans = 50;

Surveyed inspect(Inspector& inspector, const Settings& settings, const std::stop_token& stop) {
  try {
    return {settings, inspector.inspect(settings, stop), ""};
  } catch (const std::exception& error) {
    return {settings, nullptr, message_of(error)};
  }
}

/// Null if it was stopped. A failed study contains the reason, so that it is not requested again.
std::shared_ptr<const NormalStudy> study_of(const Survey::Study& study,
                                            const Inspection& inspection,
                                            const std::stop_token& stop) {
  try {
    return study(inspection, stop);
  } catch (const std::exception& error) {
    NormalStudy failed;
    failed.window = inspection.window;
    failed.error = message_of(error);
    return std::make_shared<const NormalStudy>(std::move(failed));
  }
}

JobStatus status_of(const char* stage, std::ptrdiff_t done, std::ptrdiff_t of) {
  return {done < of, stage, static_cast<int>(done), static_cast<int>(of)};
}

StartScan empty_scan(const Settings& settings, const Recording& recording) {
  const int last = recording.frame_count() - settings.frames;
  const int step = scan_step(recording.frame_count(), settings.frames);
  return {.settings = settings, .step = step, .of = last < 0 ? 0 : last / step + 1, .starts = {}};
}

std::vector<int> starts_left(const StartScan& scan, const Recording& recording) {
  auto starts = starts_to_scan(recording.frame_count(), scan.settings.frames, scan.step);
  std::erase_if(starts, [&](int start) {
    return std::ranges::binary_search(scan.starts, start, {}, &ScannedStart::start);
  });
  return starts;
}

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

Survey::Survey(std::function<void()> changed, Study study)
    : make_study_(std::move(study)), job_([this] { return next(); }, std::move(changed)) {}

void Survey::open(std::shared_ptr<const Recording> recording) {
  const auto lock = job_.lock();
  if (recording == recording_) return;
  job_.cancel();
  recording_ = std::move(recording);
  inspector_.reset();
  wanted_.clear();
  to_study_.reset();
  study_.reset();
  results_ = std::make_shared<const SurveyResults>();
}

void Survey::want(std::vector<Settings> settings) {
  const auto lock = job_.lock();
  if (settings == wanted_) return;
  wanted_ = std::move(settings);
  const bool inspecting = job_.running() && !studying_;
  if (inspecting && std::ranges::find(wanted_, running_settings_) == wanted_.end()) job_.cancel();
  job_.wake();
}

void Survey::add(const std::shared_ptr<const Inspection>& inspection) {
  const auto lock = job_.lock();
  if (inspection->recording != recording_) return;
  if (!is_done(inspection->settings)) store({inspection->settings, inspection, ""});
}

void Survey::study(std::shared_ptr<const Inspection> inspection) {
  const auto lock = job_.lock();
  if (inspection &&
      (inspection->recording != recording_ || (study_ && study_->window == inspection->window)))
    inspection.reset();
  if (!inspection && !to_study_) return;
  if (inspection && to_study_ && to_study_->window == inspection->window) return;
  if (studying_) job_.cancel();
  to_study_ = std::move(inspection);
  job_.wake();
}

void Survey::store(Surveyed result) {
  SurveyResults results = *results_;
  results.push_back(std::move(result));
  if (results.size() > kMostResults) {
    const auto oldest = std::ranges::find_if(results, [&](const Surveyed& one) {
      return std::ranges::find(wanted_, one.settings) == wanted_.end();
    });
    if (oldest != results.end()) results.erase(oldest);
  }
  results_ = std::make_shared<const SurveyResults>(std::move(results));
}

bool Survey::is_done(const Settings& settings) const {
  return find_surveyed(results_.get(), settings) != nullptr;
}

const Settings* Survey::next_wanted() const {
  if (!recording_) return nullptr;
  const auto found =
      std::ranges::find_if(wanted_, [&](const Settings& settings) { return !is_done(settings); });
  return found == wanted_.end() ? nullptr : &*found;
}

JobStatus Survey::status() const {
  const auto lock = job_.lock();
  const auto done =
      std::ranges::count_if(wanted_, [&](const Settings& settings) { return is_done(settings); });
  return status_of("comparing", done, std::ssize(wanted_) + (to_study_ ? 1 : 0));
}

BackgroundJob::Job Survey::next() {
  studying_ = to_study_ != nullptr;
  if (studying_)
    return [this, inspection = to_study_](const std::stop_token& stop) {
      auto study = study_of(make_study_, *inspection, stop);
      job_.publish(stop, [&] {
        study_ = std::move(study);
        to_study_.reset();
      });
    };
  const Settings* settings = next_wanted();
  if (settings == nullptr) return nullptr;
  running_settings_ = *settings;
  if (!inspector_) inspector_ = std::make_shared<Inspector>(recording_);
  return [this, inspector = inspector_, settings = *settings](const std::stop_token& stop) {
    Surveyed result = inspect(*inspector, settings, stop);
    job_.publish(stop, [&] { store(std::move(result)); });
  };
}

void Scan::want(std::shared_ptr<const Recording> recording, std::optional<Settings> settings) {
  const auto lock = job_.lock();
  if (settings) {
    settings->start = 0;
    // They belong to one reference frame, see `change_settings`.
    settings->exclude.clear();
    settings->mask = {};
  }
  if (!recording) settings.reset();
  if (recording == recording_ && settings == wanted_) return;
  job_.cancel();
  if (recording != recording_) cache_.clear();
  recording_ = std::move(recording);
  wanted_ = std::move(settings);
  latest_ = nullptr;
  if (!wanted_) return;
  const auto found =
      std::ranges::find_if(cache_, [&](const auto& one) { return one->settings == *wanted_; });
  if (found == cache_.end())
    cache_.push_back(std::make_shared<const StartScan>(empty_scan(*wanted_, *recording_)));
  else
    std::rotate(found, found + 1, cache_.end());
  if (cache_.size() > kMostScans) cache_.erase(cache_.begin());
  latest_ = cache_.back();
  job_.wake();
}

JobStatus Scan::status() const {
  const auto lock = job_.lock();
  return latest_ ? status_of("scanning", std::ssize(latest_->starts), latest_->of) : JobStatus{};
}

BackgroundJob::Job Scan::next() {
  if (!latest_ || latest_->finished()) return nullptr;
  return [this,
          recording = recording_,
          settings = *wanted_,
          starts = starts_left(*latest_, *recording_)](const std::stop_token& stop) {
    const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    const auto add = [&](ScannedStart found) {
      StartScan scan = *latest_;
      const auto at = std::ranges::lower_bound(scan.starts, found.start, {}, &ScannedStart::start);
      scan.starts.insert(at, std::move(found));
      latest_ = cache_.back() = std::make_shared<const StartScan>(std::move(scan));
    };
    scan_starts(recording, settings, {starts, cores, stop}, [&](ScannedStart found) {
      if (job_.publish(stop, [&] { add(std::move(found)); })) job_.notify();
    });
  };
}

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

const ScannedStart* first_ready(const StartScan& scan) {
  const auto ready = std::ranges::find_if(scan.starts, [](const ScannedStart& start) {
    return start.ok && start.readiness == Readiness::ready;
  });
  const auto earlier = ready - scan.starts.begin();  // that are scanned
  return ready != scan.starts.end() && ready->start <= earlier * scan.step ? &*ready : nullptr;
}

}  // namespace gpo
