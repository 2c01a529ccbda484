// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/internal/background_job.h"
#include "engine/inspection/inspection.h"
#include "engine/inspection/inspector.h"
#include "ui/workbench/state.h"
#include "ui/workbench/work/survey.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>

namespace gpo {

/// The published results of the worker, immutable. `generation` grows with each publication.
struct Published {
  std::shared_ptr<const Recording> recording;    ///< null until one is open
  std::shared_ptr<const Inspection> inspection;  ///< for `recording`; null until it is finished
  std::uint64_t generation = 0;
};

/// Opens recordings and computes inspections in the background. The latest request wins: it stops
/// the running one. All functions may be called from any thread and return at once.
class Worker {
 public:
  using Inspect = std::function<std::shared_ptr<const Inspection>(
      const Settings&, std::stop_token, const Progress&)>;
  struct Opened;
  /// Returns the same recording with a camera estimated from its images; without a recording if it
  /// was stopped. Throws InputError with the reason if the camera cannot be estimated.
  using Calibrate = std::function<Opened(const std::stop_token&, const Progress&)>;
  struct Opened {
    std::shared_ptr<const Recording> recording;
    Inspect inspect;
    Calibrate calibrate = {};  ///< null: impossible
  };
  /// Runs on the worker and may throw. If it was stopped, its result is dropped.
  using Open =
      std::function<Opened(const std::filesystem::path&, const std::stop_token&, const Progress&)>;

  /// `changed` is called on the worker's thread after each change of status or publication.
  explicit Worker(Open open, std::function<void()> changed = {});

  /// Opens a recording and publishes it. If that fails, the last one stays.
  void open(const std::filesystem::path& path);
  /// Publishes the open recording with a camera estimated from its images, if that is possible.
  void calibrate();
  /// Inspects the open recording, if there is one. Another recording that is being opened discards
  /// the request.
  void request(const Settings& settings);
  /// Stops the running job and discards waiting requests.
  void cancel();

  JobStatus status() const;
  Published latest() const;

  /// Creates an Inspector of the recording.
  static Opened with_inspector(std::shared_ptr<const Recording> recording);

 private:
  using Opening = std::function<Opened(const std::stop_token&)>;

  BackgroundJob::Job next();
  void open_by(Opening opening);
  void do_inspect(const Settings& settings, const std::stop_token& stop);
  Progress progress(const std::stop_token& stop, const std::string& prefix = "");

  Open open_;
  Opening next_opening_;  ///< null: none waiting
  std::optional<Settings> next_settings_;
  bool opening_ = false;  ///< waiting or running
  Published published_;
  Inspect inspect_;      ///< for the open recording
  Calibrate calibrate_;  ///< for the open recording
  BackgroundJob job_;
};

/// The requests of the workbench to worker, survey and scan, and their progress.
struct WorkerLink {
  std::filesystem::path example;                ///< the recording shipped with the program
  Settings requested;                           ///< the last ones
  std::shared_ptr<const Inspection> published;  ///< before its cube was moved
  std::optional<Eigen::Vector3d> cube_ray;      ///< to which it was moved
  JobStatus worker;
  SurveyStatus survey;
  SurveyStatus scan;
  std::string error;              ///< the last error of the worker that was shown
  std::filesystem::path opening;  ///< being opened; remembered once it is open
  bool remembers_files = false;   ///< in the user's list of recent files
  bool calibrating = false;       ///< until it finishes, fails or is replaced
  bool calibrates = false;        ///< every recording opened with a guessed camera
  bool finding_start = false;     ///< until the scan has found one or is replaced
  bool survey_canceled = false;   ///< and the scan; until something else is computed
  /// Called before a session is read: adds its methods to the table of the state. May throw
  /// InputError; null: none are added.
  std::function<void(const std::filesystem::path& session, WorkbenchState& state)> add_methods;

  bool busy() const { return worker.busy || survey.busy() || scan.busy(); }
};

/// Passes new settings and requests (open, open_example, compute, calibrate, find_start, cancel) to
/// the worker and the needs of the open views to survey and scan, and takes over their results.
/// Returns at once.
void synchronize(
    WorkbenchState& state, WorkerLink& link, Worker& worker, Survey& survey, Scan& scan);

}  // namespace gpo
