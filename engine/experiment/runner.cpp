// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/experiment/runner.h"

#include "engine/base/error.h"
#include "engine/experiment/window_files.h"
#include "engine/inspection/inspection.h"

#include <atomic>
#include <exception>
#include <mutex>
#include <numeric>
#include <thread>

namespace gpo {
namespace {

namespace fs = std::filesystem;

/// The tasks with the lengths that no earlier run has finished.
std::vector<ExperimentTask> unfinished(const Experiment& experiment,
                                       const fs::path& folder,
                                       std::vector<ExperimentTask> tasks) {
  for (ExperimentTask& task : tasks) {
    std::erase_if(task.lengths, [&](int frames) {
      return load_window(folder, experiment, task, frames).has_value();
    });
  }
  std::erase_if(tasks, [](const ExperimentTask& task) { return task.lengths.empty(); });
  return tasks;
}

/// The rows of one window; fewer than configurations where it was stopped.
std::vector<Row> compute_window(const Experiment& experiment,
                                const Recording& recording,
                                Inspector& inspector,
                                const Settings& window,
                                const std::stop_token& stop) {
  std::vector<Row> rows;
  for (const Configuration& configuration : experiment.configurations) {
    const Settings settings = apply(configuration, window);
    try {
      const auto inspection = inspector.inspect(settings, stop);
      if (!inspection) break;
      rows.push_back(make_row(*inspection));
    } catch (const InputError& error) {
      rows.push_back(refused_row(recording.name, settings, error.what()));
    }
  }
  return rows;
}

/// What the threads of a run share.
class Run {
 public:
  Run(const Experiment& experiment,
      std::span<const std::shared_ptr<const Recording>> recordings,
      const fs::path& folder,
      const RunOptions& options)
      : experiment_(experiment),
        recordings_(recordings),
        folder_(folder),
        options_(options),
        tasks_(unfinished(experiment, folder, tasks_of(experiment, options.shard))) {
    progress_.of = window_count(tasks_of(experiment, options.shard));
    progress_.done = progress_.of - window_count(tasks_);
    for (const ExperimentTask& task : tasks_) {
      frames_ += std::accumulate(task.lengths.begin(), task.lengths.end(), 0.0);
    }
    progress_.share = tasks_.empty() ? 1 : 0;
    if (options_.progress) options_.progress(progress_);
  }

  bool finish() {
    const std::stop_callback forward(options_.stop, [this] { stop_.request_stop(); });
    {
      std::vector<std::jthread> threads;
      threads.reserve(options_.jobs);
      for (int i = 0; i < options_.jobs; ++i) threads.emplace_back([this] { work(); });
    }
    if (error_) std::rethrow_exception(error_);
    return progress_.done == progress_.of;
  }

 private:
  void work() {
    try {
      for (std::size_t i = next_++; i < tasks_.size() && !stop_.stop_requested(); i = next_++) {
        compute(tasks_[i]);
      }
    } catch (...) {
      const std::scoped_lock lock(mutex_);
      error_ = std::current_exception();
      stop_.request_stop();
    }
  }

  /// The longest window first: the Inspector keeps its tracks for the others.
  void compute(const ExperimentTask& task) {
    const auto& recording = recordings_[task.recording];
    Inspector inspector(recording);
    for (auto length = task.lengths.rbegin(); length != task.lengths.rend(); ++length) {
      const int frames = *length;
      const Settings window{.start = task.start, .frames = frames, .seed = experiment_.seed};
      const std::vector<Row> rows =
          compute_window(experiment_, *recording, inspector, window, stop_.get_token());
      if (stop_.stop_requested()) return;
      save_window(folder_, rows);
      tell(frames);
    }
  }

  void tell(int frames) {
    const std::scoped_lock lock(mutex_);
    ++progress_.done;
    progress_.share += frames / frames_;
    if (options_.progress) options_.progress(progress_);
  }

  const Experiment& experiment_;
  std::span<const std::shared_ptr<const Recording>> recordings_;
  const fs::path& folder_;
  const RunOptions& options_;
  const std::vector<ExperimentTask> tasks_;
  double frames_ = 0;  ///< in all windows of this run
  std::atomic<std::size_t> next_ = 0;
  std::stop_source stop_;
  std::mutex mutex_;
  ExperimentProgress progress_;
  std::exception_ptr error_;
};

}  // namespace

bool run_experiment(const Experiment& experiment,
                    std::span<const std::shared_ptr<const Recording>> recordings,
                    const fs::path& folder,
                    const RunOptions& options) {
  begin_experiment(folder, experiment);
  return Run(experiment, recordings, folder, options).finish();
}

}  // namespace gpo
