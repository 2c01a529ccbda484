// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/experiment/runner.h"

#include "engine/base/error.h"
#include "engine/base/parallel.h"
#include "engine/experiment/window_files.h"
#include "engine/files/text_file.h"
#include "engine/inspection/inspection.h"
#include "engine/inspection/inspector.h"

#include <fstream>
#include <mutex>
#include <numeric>
#include <ranges>

#include <fmt/format.h>
#include <sys/utsname.h>

namespace gpo {
namespace {

namespace fs = std::filesystem;

/// Returns the name of the processor, e.g. "AMD EPYC 7B13", or else its architecture.
std::string processor_name() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    const std::size_t colon = line.find(':');
    if (colon == std::string::npos || !line.starts_with("model name")) continue;
    return std::string(trimmed(std::string_view(line).substr(colon + 1)));
  }
  utsname system{};
  return uname(&system) == 0 ? system.machine : "unknown";
}

void forget_images(const Recording& recording) {
  if (recording.images) recording.images->forget();
}

/// Windows that are computed in the same way.
struct Pass {
  std::vector<ExperimentTask> tasks;
  int jobs = 1;
  bool timed = false;  ///< each window decodes its images anew
};

/// The state that the threads of a run share.
class Run {
 public:
  Run(const Experiment& experiment,
      std::span<const std::shared_ptr<const Recording>> recordings,
      const fs::path& folder,
      const RunOptions& options)
      : experiment_(experiment), recordings_(recordings), folder_(folder), options_(options) {
    const auto all = tasks_of(experiment, options.shard);
    const auto tasks = windows_where(all, [&](const ExperimentTask& task, int frames) {
      return !load_window(folder, experiment, task, frames).rows;
    });
    const int timed = timed_length(experiment.lengths);
    const auto with_length = [&](bool equal) {
      return windows_where(
          tasks, [&](const ExperimentTask&, int frames) { return (frames == timed) == equal; });
    };
    passes_ = {{with_length(false), options.jobs, false},
               {with_length(true), options.timing_jobs, true}};
    progress_.of = window_count(all);
    progress_.done = progress_.of - window_count(tasks);
    for (const ExperimentTask& task : tasks)
      frames_ += std::accumulate(task.lengths.begin(), task.lengths.end(), 0.0);
    progress_.share = tasks.empty() ? 1 : 0;
    if (options_.progress) options_.progress(progress_);
  }

  bool finish() {
    const std::stop_callback forward(options_.stop, [this] { stop_.request_stop(); });
    for (const Pass& pass : passes_) {
      left_.assign(recordings_.size(), 0);
      for (const ExperimentTask& task : pass.tasks) ++left_[task.recording];
      in_parallel(static_cast<int>(pass.tasks.size()), pass.jobs, [&](int i) {
        if (!stop_.stop_requested()) work(pass.tasks[i], pass);
      });
    }
    return progress_.done == progress_.of;
  }

 private:
  void work(const ExperimentTask& task, const Pass& pass) {
    try {
      compute(task, pass);
    } catch (...) {
      stop_.request_stop();
      throw;
    }
    // Many recordings may be open, so finished ones must not hold images.
    const std::scoped_lock lock(mutex_);
    if (--left_[task.recording] == 0) forget_images(*recordings_[task.recording]);
  }

  void compute(const ExperimentTask& task, const Pass& pass) {
    const auto& recording = recordings_[task.recording];
    if (pass.timed) forget_images(*recording);
    Inspector inspector(recording);
    // The longest window comes first: the Inspector caches its tracks for the others.
    for (const int frames : task.lengths | std::views::reverse) {
      std::vector<Row> rows = compute_window(
          inspector,
          *recording,
          {.start = task.start, .frames = frames, .options = {.seed = experiment_.seed}});
      if (stop_.stop_requested()) return;
      for (Row& row : rows) {
        row.jobs = pass.jobs;
        row.processor = processor_;
      }
      save_window(folder_, experiment_, rows);
      report(frames);
    }
  }

  /// Returns the rows of one window, fewer than configurations if stopped.
  std::vector<Row> compute_window(Inspector& inspector,
                                  const Recording& recording,
                                  const Settings& window) const {
    std::vector<Row> rows;
    for (const Configuration& configuration : experiment_.configurations) {
      const Settings settings = apply(configuration, window);
      try {
        const auto inspection = inspector.inspect(settings, stop_.get_token());
        if (!inspection) break;
        rows.push_back(make_row(*inspection));
      } catch (const InputError& error) {
        rows.push_back(refused_row(recording.name, settings, error.what()));
      }
    }
    return rows;
  }

  void report(int frames) {
    const std::scoped_lock lock(mutex_);
    ++progress_.done;
    progress_.share += frames / frames_;
    if (options_.progress) options_.progress(progress_);
  }

  const Experiment& experiment_;
  std::span<const std::shared_ptr<const Recording>> recordings_;
  const fs::path& folder_;
  const RunOptions& options_;
  const std::string processor_ = processor_name();
  std::vector<Pass> passes_;
  double frames_ = 0;  ///< in all windows of this run
  std::stop_source stop_;
  std::mutex mutex_;
  std::vector<int> left_;  ///< unfinished tasks of the pass, by recording
  ExperimentProgress progress_;
};

}  // namespace

bool run_experiment(const Experiment& experiment,
                    std::span<const std::shared_ptr<const Recording>> recordings,
                    const fs::path& folder,
                    const RunOptions& options) {
  const std::vector<std::string> differing = begin_experiment(folder, experiment);
  if (!differing.empty() && options.note)
    options.note(fmt::format("{}: {} from the earlier run; the affected windows are recomputed",
                             folder.string(),
                             differ_text(differing)));
  return Run(experiment, recordings, folder, options).finish();
}

}  // namespace gpo
