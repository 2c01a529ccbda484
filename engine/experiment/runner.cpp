// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/experiment/runner.h"

#include "engine/base/error.h"
#include "engine/experiment/window_files.h"
#include "engine/files/text_file.h"
#include "engine/inspection/inspection.h"
#include "engine/inspection/inspector.h"

#include <atomic>
#include <exception>
#include <fstream>
#include <mutex>
#include <numeric>
#include <thread>

#include <fmt/format.h>
#include <sys/utsname.h>

namespace gpo {
namespace {

namespace fs = std::filesystem;

/// What running times were measured on, as the system calls it: "AMD EPYC 7B13".
std::string processor_name() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    const std::size_t colon = line.find(':');
    if (colon == std::string::npos || !line.starts_with("model name")) continue;
    return std::string(trimmed(std::string_view(line).substr(colon + 1)));
  }
  utsname system{};  // not all kinds of processors have a model's name
  return uname(&system) == 0 ? system.machine : "unknown";
}

/// The tasks with the lengths that no earlier run has finished.
std::vector<ExperimentTask> unfinished(const Experiment& experiment,
                                       const fs::path& folder,
                                       std::vector<ExperimentTask> tasks) {
  for (ExperimentTask& task : tasks) {
    std::erase_if(task.lengths, [&](int frames) {
      return load_window(folder, experiment, task, frames).rows.has_value();
    });
  }
  std::erase_if(tasks, [](const ExperimentTask& task) { return task.lengths.empty(); });
  return tasks;
}

/// Of the tasks' windows those of one length, or all others.
std::vector<ExperimentTask> with_length(std::vector<ExperimentTask> tasks, int frames, bool with) {
  for (ExperimentTask& task : tasks)
    std::erase_if(task.lengths, [&](int length) { return (length == frames) != with; });
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

/// Windows that are computed one as the other.
struct Pass {
  std::vector<ExperimentTask> tasks;
  int jobs = 1;
  bool timed = false;  ///< each decodes its own pictures
};

/// What the threads of a run share.
class Run {
 public:
  Run(const Experiment& experiment,
      std::span<const std::shared_ptr<const Recording>> recordings,
      const fs::path& folder,
      const RunOptions& options)
      : experiment_(experiment), recordings_(recordings), folder_(folder), options_(options) {
    const auto all = tasks_of(experiment, options.shard);
    const auto tasks = unfinished(experiment, folder, all);
    const int timed = timed_length(experiment.lengths);
    passes_ = {{with_length(tasks, timed, false), options.jobs, false},
               {with_length(tasks, timed, true), options.timing_jobs, true}};
    progress_.of = window_count(all);
    progress_.done = progress_.of - window_count(tasks);
    for (const ExperimentTask& task : tasks) {
      frames_ += std::accumulate(task.lengths.begin(), task.lengths.end(), 0.0);
    }
    progress_.share = tasks.empty() ? 1 : 0;
    if (options_.progress) options_.progress(progress_);
  }

  bool finish() {
    const std::stop_callback forward(options_.stop, [this] { stop_.request_stop(); });
    for (const Pass& pass : passes_) finish(pass);
    return progress_.done == progress_.of;
  }

 private:
  void finish(const Pass& pass) {
    next_ = 0;
    left_.assign(recordings_.size(), 0);
    for (const ExperimentTask& task : pass.tasks) ++left_[task.recording];
    {
      std::vector<std::jthread> threads;
      threads.reserve(pass.jobs);
      for (int i = 0; i < pass.jobs; ++i) threads.emplace_back([this, &pass] { work(pass); });
    }
    if (error_) std::rethrow_exception(error_);
  }

  void work(const Pass& pass) {
    try {
      for (std::size_t i = next_++; i < pass.tasks.size() && !stop_.stop_requested(); i = next_++) {
        compute(pass.tasks[i], pass);
        end(pass.tasks[i]);
      }
    } catch (...) {
      const std::scoped_lock lock(mutex_);
      error_ = std::current_exception();
      stop_.request_stop();
    }
  }

  /// The longest window first: the Inspector keeps its tracks for the others.
  void compute(const ExperimentTask& task, const Pass& pass) {
    const auto& recording = recordings_[task.recording];
    if (pass.timed) forget_images(*recording);
    Inspector inspector(recording);
    for (auto length = task.lengths.rbegin(); length != task.lengths.rend(); ++length) {
      const int frames = *length;
      const Settings window{
          .start = task.start, .frames = frames, .options = {.seed = experiment_.seed}};
      std::vector<Row> rows =
          compute_window(experiment_, *recording, inspector, window, stop_.get_token());
      if (stop_.stop_requested()) return;
      for (Row& row : rows) {
        row.jobs = pass.jobs;
        row.processor = processor_;
      }
      save_window(folder_, experiment_, rows);
      tell(frames);
    }
  }

  static void forget_images(const Recording& recording) {
    if (recording.images) recording.images->forget();
  }

  /// Many recordings are open; the pictures of those that are done are not needed any more.
  void end(const ExperimentTask& task) {
    const std::scoped_lock lock(mutex_);
    if (--left_[task.recording] == 0) forget_images(*recordings_[task.recording]);
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
  const std::string processor_ = processor_name();
  std::vector<Pass> passes_;
  double frames_ = 0;  ///< in all windows of this run
  std::atomic<std::size_t> next_ = 0;
  std::stop_source stop_;
  std::mutex mutex_;
  std::vector<int> left_;  ///< tasks of the pass that are not done, by recording
  ExperimentProgress progress_;
  std::exception_ptr error_;
};

}  // namespace

bool run_experiment(const Experiment& experiment,
                    std::span<const std::shared_ptr<const Recording>> recordings,
                    const fs::path& folder,
                    const RunOptions& options) {
  const std::vector<std::string> differing = begin_experiment(folder, experiment);
  if (!differing.empty() && options.note) {
    options.note(fmt::format("{}: of the earlier run {}; the windows concerned are computed anew",
                             folder.string(),
                             differ_text(differing)));
  }
  return Run(experiment, recordings, folder, options).finish();
}

}  // namespace gpo
