// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/workbench/state.h"
#include "ui/workbench/work/task_queue.h"

#include <functional>
#include <stop_token>

namespace gpo {

/// Computes inspections and normal studies of a recording in order and caches them. Thread-safe.
class Survey {
 public:
  /// Makes the study of a window on the survey's thread; null if it was stopped. May throw.
  using Study =
      std::function<std::shared_ptr<const NormalStudy>(const Inspection&, const std::stop_token&)>;

  /// `changed` is called on the survey's thread after each result.
  explicit Survey(std::function<void()> changed = {}, Study study = study_normals);

  /// Changes the recording (null: none) and discards all results.
  void open(std::shared_ptr<const Recording> recording);
  /// Requests these inspections in this order instead of earlier ones; stops a running earlier one.
  void want(std::vector<Settings> settings);
  /// Adds a result that was computed elsewhere.
  void add(const std::shared_ptr<const Inspection>& inspection);
  /// Requests a study of a window's normals before all inspections; null: none. None is repeated.
  void study(std::shared_ptr<const Inspection> inspection);

  JobStatus status() const;
  /// Never null.
  std::shared_ptr<const SurveyResults> results() const { return locked(job_, results_); }
  /// Null: none yet; see its `error`.
  std::shared_ptr<const NormalStudy> latest_study() const { return locked(job_, study_); }

 private:
  BackgroundJob::Job next();
  void store(Surveyed result);
  bool is_done(const Settings& settings) const;
  const Settings* next_wanted() const;  ///< the first requested without a result; null: none

  Study make_study_;
  std::shared_ptr<const Recording> recording_;
  std::shared_ptr<Inspector> inspector_;  ///< caches the tracks of the recording
  std::vector<Settings> wanted_;
  std::shared_ptr<const SurveyResults> results_ = std::make_shared<const SurveyResults>();
  std::shared_ptr<const Inspection> to_study_;  ///< null: none
  std::shared_ptr<const NormalStudy> study_;
  bool studying_ = false;      ///< the last job studies `to_study_`
  Settings running_settings_;  ///< otherwise it computes these
  BackgroundJob job_;
};

/// Scans for start frames on all cores at low priority. Caches earlier scans. Thread-safe.
class Scan {
 public:
  /// `changed` is called on other threads after each start.
  explicit Scan(std::function<void()> changed = {})
      : job_([this] { return next(); }, std::move(changed), BackgroundJob::Priority::low) {}

  /// Requests a scan instead of the last one; null: none. The start of `settings` is ignored.
  void want(std::shared_ptr<const Recording> recording, std::optional<Settings> settings);

  JobStatus status() const;
  /// For the request; null: none.
  std::shared_ptr<const StartScan> latest() const { return locked(job_, latest_); }

 private:
  BackgroundJob::Job next();

  std::shared_ptr<const Recording> recording_;
  std::optional<Settings> wanted_;
  std::shared_ptr<const StartScan> latest_;
  std::vector<std::shared_ptr<const StartScan>> cache_;  ///< the one requested last is the last one
  BackgroundJob job_;
};

/// Locates cameras after a window in the background. Thread-safe.
class Extrapolator {
 public:
  /// `changed` is called on the job's thread after a result.
  explicit Extrapolator(std::function<void()> changed = {})
      : job_([this] { return next(); }, std::move(changed)) {}

  /// Requests the cameras after a window up to a frame of the recording; null: none. A result that
  /// reaches the frame or ends before it is kept. Otherwise twice as many frames are located,
  /// because the front end follows its tracks from the start of the window again.
  void want(const std::shared_ptr<const Inspection>& inspection, int frame);

  JobStatus status() const { return locked_status(job_); }
  /// For the requested inspection; null: none.
  std::shared_ptr<const Extrapolation> latest() const { return locked(job_, latest_); }

 private:
  BackgroundJob::Job next();

  std::shared_ptr<const Inspection> wanted_;  ///< null: none
  int frames_ = 0;                            ///< after the window; 0: none are requested
  std::shared_ptr<const Extrapolation> latest_;
  BackgroundJob job_;
};

/// Requests the cameras after the current window if the current frame is there, takes over those
/// that are known, and returns the progress. `published` is the window before its cubes were moved;
/// null: none is requested.
JobStatus follow_window(WorkbenchState& state,
                        const std::shared_ptr<const Inspection>& published,
                        Extrapolator& extrapolator);

/// The published results of the worker, immutable. `generation` grows with each publication.
struct Published {
  std::shared_ptr<const Recording> recording;    ///< null until one is open
  std::shared_ptr<const Inspection> inspection;  ///< for `recording`; null until it is finished
  std::uint64_t generation = 0;
  /// The calibration that `recording` has its camera from; null: none since it was opened.
  std::shared_ptr<const CalibrationResult> calibration = {};
};

/// Opens and inspects recordings in the background; the latest request wins. Thread-safe.
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
    Calibrate calibrate = {};                                   ///< null: impossible
    std::shared_ptr<const CalibrationResult> calibration = {};  ///< null: not calibrated
    /// Discards the calibration and returns the recording as it was before. Null: impossible.
    std::function<Opened()> undo_calibration = {};
    /// If `recording` is incomplete: opens all of it, right after this is published.
    std::function<Opened(const std::stop_token&, const Progress&)> rest = {};
  };
  /// Runs on the worker and may throw. If it was stopped, its result is dropped.
  using Open = std::function<Opened(const fs::path&, const std::stop_token&, const Progress&)>;

  /// `changed` is called on the worker's thread after each change of status or publication.
  explicit Worker(Open open, std::function<void()> changed = {});

  /// Opens a recording and publishes it. If that fails, the last one stays.
  void open(const fs::path& path);
  /// Publishes a recording that was opened otherwise.
  void show(Opened opened);
  /// Publishes the open recording with a camera estimated from its images, if that is possible.
  void calibrate();
  /// Publishes the open recording as it was before its calibration, if it was calibrated.
  void undo_calibration();
  /// Inspects the open recording, if any, unless another one is opened meanwhile.
  void request(const Settings& settings);
  /// Stops the running job and discards waiting requests. If the open recording is incomplete and
  /// not `shown`, returns to the one before.
  void cancel(const std::shared_ptr<const Recording>& shown);

  JobStatus status() const { return locked_status(job_); }
  Published latest() const { return locked(job_, current_.published); }

  static Opened with_inspector(std::shared_ptr<const Recording> recording);

 private:
  using Opening = std::function<Opened(const std::stop_token&)>;
  /// The open recording and its functions.
  struct Current {
    Published published;
    Inspect inspect;
    Calibrate calibrate;
    std::function<Opened()> undo_calibration;  ///< null: not calibrated
  };

  BackgroundJob::Job next();
  void open_by(Opening opening);
  void publish(Opened opened);
  Progress progress(const std::stop_token& stop, const std::string& prefix = "");

  Open open_;
  Opening next_opening_;  ///< null: none waiting
  std::optional<Settings> next_settings_;
  bool opening_ = false;  ///< waiting or running
  Current current_;
  std::optional<Current> before_;  ///< the recording before, while `current_` is incomplete
  BackgroundJob job_;
};

/// The methods of a session, with those that were known before.
struct SessionMethods {
  MethodTable table;
  /// Adds them to the state on the window's thread; may ask the user. Null: nothing to add.
  std::function<void(WorkbenchState& state)> add = {};
};

/// A file that was given to be opened.
struct ReadFile {
  fs::path file;
  std::shared_ptr<const std::vector<Row>> rows = nullptr;       ///< null: no results.csv
  std::optional<SavedSession> session = {};                     ///< nullopt: no session
  std::function<void(WorkbenchState& state)> add_methods = {};  ///< null: no methods to add
  std::string error = {};                                       ///< why it cannot be read, one line
};

using FileReader = TaskQueue<ReadFile>;

/// Reads the methods of a session; may throw InputError.
using ReadMethods = std::function<SessionMethods(const fs::path& session)>;

/// Returns the earliest ready start of a recording; null if none, or if an earlier one may come.
const ScannedStart* first_ready(const StartScan& scan);

/// The requests of the workbench to worker, survey and scan, and their progress.
struct WorkerLink {
  fs::path example;                             ///< the recording shipped with the program
  Settings requested;                           ///< the last ones
  std::shared_ptr<const Inspection> published;  ///< before its cube was moved
  std::optional<Vector3d> cube_ray;             ///< to which it was moved
  std::unique_ptr<FileReader> reader = std::make_unique<FileReader>();
  std::unique_ptr<Extrapolator> extrapolator = std::make_unique<Extrapolator>();
  std::map<int, Vector3d> other_cube_rays;  ///< like `UndoStep::other_cube_rays`
  JobStatus worker, survey, scan, reading;
  std::string error;                 ///< the last error of the worker that was shown
  fs::path opening;                  ///< being opened; remembered once it is open
  bool remembers_files = false;      ///< in the user's list of recent files
  bool loading = false;              ///< a recording, until it is complete, fails or is replaced
  bool calibrating = false;          ///< until it finishes, fails or is replaced
  bool undoing_calibration = false;  ///< until the recording is opened as it was before
  bool calibrates = false;           ///< every recording opened with a guessed camera
  bool finding_start = false;        ///< until the scan has found one or is replaced
  bool survey_canceled = false;      ///< and the scan; until something else is computed
  ReadMethods read_methods;          ///< null: sessions add none

  bool busy() const { return worker.busy || survey.busy || scan.busy || reading.busy; }
};

/// Passes requests to worker, survey and scan, and takes over their results. Returns at once.
void synchronize(
    WorkbenchState& state, WorkerLink& link, Worker& worker, Survey& survey, Scan& scan);

}  // namespace gpo
