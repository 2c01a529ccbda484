// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/work/worker.h"

#include "engine/base/error.h"
#include "engine/experiment/row.h"
#include "ui/workbench/session/session_file.h"

#include <utility>

namespace gpo {
namespace {

void show_results(WorkbenchState& state, const ReadFile& results) {
  const fs::path& file = results.file;
  state.results.experiment = results.rows;
  state.results.experiment_name = (file.parent_path().filename() / file.filename()).string();
  state.view.panes.drawer = find_pane("curves", drawers());
  say(state, counted(state.results.experiment->size(), "result") + " in " + file.string());
}

/// Returns whether the first frames of a recording must not be shown alone: a session or settings
/// of another window apply to the whole.
bool needs_all(const WorkbenchState& state, const Recording& first) {
  const Document& document = state.document;
  const auto earlier = document.earlier.find(first.path);
  const Settings settings = earlier != document.earlier.end() ? earlier->second
                            : document.recording              ? Settings{}
                                                              : document.settings;
  return state.files.waiting_session || settings.start + settings.frames > first.frame_count();
}

/// Shows a recording that was opened. Returns whether it is another one, and complete.
bool show_recording(WorkbenchState& state,
                    const WorkerLink& link,
                    const Published& published,
                    Survey& survey) {
  const auto& recording = published.recording;
  if (!recording || recording == state.document.recording) return false;
  if (!recording->complete && needs_all(state, *recording)) return false;
  apply_recording(state, recording);
  if (state.view.tour == 1) state.view.tour = 2;  // the first step is to open one
  state.results.calibration = published.calibration;
  survey.open(recording);
  if (!recording->complete) return false;
  if (published.calibration) state.view.panes.drawer = find_pane("camera", drawers());
  if (link.remembers_files && !link.opening.empty()) {
    remember_file(link.opening);
    state.files.recent = recent_files();
  }
  return true;
}

/// Takes over published results. Returns whether there is another recording.
bool receive(WorkbenchState& state, WorkerLink& link, Worker& worker, Survey& survey) {
  // Read before the results, so that an idle status implies that they are complete.
  link.worker = worker.status();
  link.survey = survey.status();
  const Published published = worker.latest();
  const bool opened = show_recording(state, link, published, survey);
  const Document& document = state.document;
  const bool shown = published.recording == document.recording;
  // The rest of a recording that needs to be shown as a whole could not be opened.
  if (!shown && published.recording && !published.recording->complete && !link.worker.busy)
    worker.cancel(document.recording);
  const auto inspection = shown ? published.inspection : link.published;
  if (inspection && inspection != link.published) survey.add(inspection);
  if (inspection != link.published || document.cube_ray != link.cube_ray ||
      document.other_cube_rays != link.other_cube_rays)
    state.results.inspection = with_cube(inspection, document.cube_ray, document.other_cube_rays);
  link.published = inspection;
  link.cube_ray = document.cube_ray;
  link.other_cube_rays = document.other_cube_rays;
  state.results.surveyed = survey.results();
  const auto study = survey.latest_study();
  if (study && study != state.results.study && !study->error.empty())
    say(state, "cannot study the normals of the window: " + study->error, Severity::error);
  state.results.study = study;
  if (link.worker.error != link.error) {
    retract_error(state, link.error);
    link.error = link.worker.error;
    if (!link.error.empty()) say(state, link.error, Severity::error);
  }
  return opened;
}

/// Returns whether to calibrate, on request or because the opened recording has a guessed camera.
bool wants_calibration(WorkbenchState& state, WorkerLink& link, bool opened) {
  if (opened && std::exchange(link.undoing_calibration, false)) return false;
  const bool requested = std::exchange(state.requests.calibrate, false);
  const bool guessed = state.document.recording && state.document.recording->images &&
                       state.document.recording->camera_source == CameraSource::guess;
  return requested || (opened && link.calibrates && guessed);
}

/// Moves the window to the first ready start or, after the scan, to the best. Returns if it did.
bool go_to_found_start(WorkbenchState& state, WorkerLink& link) {
  if (!link.finding_start || !state.results.scan) return false;
  const StartScan& scan = *state.results.scan;
  const ScannedStart* best = first_ready(scan);
  if (best == nullptr && !scan.finished()) return false;
  if (best == nullptr) best = best_start(scan.starts);
  link.finding_start = false;
  if (best == nullptr) {
    say(state,
        "Initialization fails at every start frame. The strip above the time line shows why",
        Severity::warning);
    return false;
  }
  Settings settings = state.document.settings;
  settings.start = best->start;
  change_settings(state, settings);
  go_to_frame(state, settings.start + settings.frames - 1);
  say(state, "starts at " + to_text(*best));
  return true;
}

/// Returns whether the list of frames of the shown recording is still being read.
bool is_read_on(const WorkbenchState& state, const WorkerLink& link) {
  return link.loading && state.document.recording && !state.document.recording->complete;
}

bool scan_for_starts(WorkbenchState& state, WorkerLink& link, Scan& scan) {
  // A scan that was switched on after something else was canceled has no results yet.
  if (state.view.toggles.scan && !state.results.scan) link.survey_canceled = false;
  const bool wanted = state.view.toggles.scan && !link.survey_canceled && !is_read_on(state, link);
  if (!state.view.toggles.scan || !state.document.recording) {
    state.results.scan.reset();
    link.finding_start = false;
  }
  // A canceled scan keeps its results so far.
  scan.want(wanted ? state.document.recording : nullptr, state.document.settings);
  link.scan = scan.status();
  if (wanted) state.results.scan = scan.latest();
  return go_to_found_start(state, link);
}

/// Returns the task that reads results of `evaluate` or a session. Without `read_methods` only
/// `methods` are known.
FileReader::Task reading_of(const fs::path& file,
                            const MethodTable& methods,
                            const ReadMethods& read_methods) {
  return [file, known = SessionMethods{methods}, read_methods](const Progress& progress) {
    progress("reading " + file.filename().string(), 0, 0);
    ReadFile read{file};
    try {
      // By its name, too: then the error names the missing column, not a video.
      if (file.filename() == "results.csv" || is_results(file)) {
        read.rows = std::make_shared<const std::vector<Row>>(read_results(file, known.table));
      } else if (is_session(file)) {
        const SessionMethods of_session = read_methods ? read_methods(file) : known;
        read.session = read_session(file, of_session.table);
        read.add_methods = of_session.add;
      }
    } catch (const std::exception& error) {
      read.error = message_of(error);
    }
    return read;
  };
}

/// Stops reading a file, and drops one that has been read.
void stop_reading(WorkerLink& link) {
  link.reader->cancel();
  link.reader->take();
}

/// Opens a recording, or first reads a file that may be something else. Returns whether the worker
/// has something to do.
bool open_path(WorkbenchState& state, WorkerLink& link, Worker& worker, const fs::path& path) {
  std::error_code none;
  const bool readable = path.extension() == ".json" || path.extension() == ".csv";
  stop_reading(link);
  if (readable && fs::is_regular_file(path, none)) {
    link.reader->add(reading_of(path, state.methods, link.read_methods));
    return false;
  }
  auto& waiting = state.files.waiting_session;
  if (waiting && waiting->recording.filename() != path.filename()) waiting.reset();
  link.opening = path;
  worker.cancel(state.document.recording);
  worker.open(path);
  return true;
}

/// Continues with a file that was read. Returns whether the worker has something to do.
bool open_read(WorkbenchState& state, WorkerLink& link, Worker& worker, ReadFile read) {
  if (!read.error.empty()) {
    say(state, read.error, Severity::error);
    return false;
  }
  if (read.rows) {
    show_results(state, read);
    return false;
  }
  if (read.add_methods) read.add_methods(state);
  const fs::path recording = read.session ? read.session->recording : read.file;
  state.files.waiting_session = std::move(read.session);
  std::error_code none;
  if (state.files.waiting_session && !fs::exists(recording, none)) {
    say(state,
        recording.string() + " has moved. Open it at its new location to continue the session",
        Severity::error);
    return false;
  }
  link.opening = read.file;
  worker.cancel(state.document.recording);
  worker.open(recording);
  return true;
}

/// Returns whether a report was waiting, which is the last one that the user asked for.
bool cancel_report(WorkbenchState& state) {
  const auto is_report = [](const Screenshot& one) { return one.view == kReportView; };
  if (std::erase_if(state.requests.screenshots, is_report) == 0) return false;
  say(state, "Report canceled. No file was written");
  return true;
}

void cancel(WorkbenchState& state, WorkerLink& link, Worker& worker) {
  worker.cancel(state.document.recording);
  stop_reading(link);
  link.finding_start = false;
  const bool loading = std::exchange(link.loading, false) || link.reading.busy;
  if (loading) state.files.waiting_session.reset();
  const bool calibrating = std::exchange(link.calibrating, false);
  link.survey_canceled = (!loading && !calibrating) || link.survey.busy || link.scan.busy;
  say(state,
      loading       ? "Opening canceled"
      : calibrating ? "Calibration canceled, nothing was saved"
                    : "Canceled. Press F5 to compute again");
}

}  // namespace

Worker::Opened Worker::with_inspector(std::shared_ptr<const Recording> recording) {
  const auto inspector = std::make_shared<Inspector>(recording);
  return {
      std::move(recording),
      [inspector](const Settings& settings, const std::stop_token& stop, const Progress& progress) {
        return inspector->inspect(settings, stop, progress);
      }};
}

Worker::Worker(Open open, std::function<void()> changed)
    : open_(std::move(open)), job_([this] { return next(); }, std::move(changed)) {}

void Worker::open_by(Opening opening) {
  job_.cancel();
  next_opening_ = std::move(opening);
  next_settings_.reset();
  opening_ = true;
  job_.wake();
}

void Worker::open(const fs::path& path) {
  const auto lock = job_.lock();
  open_by([this, path](const std::stop_token& stop) {
    const Progress report = progress(stop);
    report("opening " + path.filename().string(), 0, 0);
    return open_(path, stop, report);
  });
}

void Worker::show(Opened opened) {
  const auto lock = job_.lock();
  open_by([opened = std::move(opened)](const std::stop_token& /*stop*/) { return opened; });
}

void Worker::calibrate() {
  const auto lock = job_.lock();
  if (!current_.published.recording || next_opening_ || !current_.calibrate) return;
  open_by([this, calibrate = current_.calibrate](const std::stop_token& stop) {
    const Progress report = progress(stop, "calibrating: ");
    report("opening the images", 0, 0);
    return calibrate(stop, report);
  });
}

void Worker::undo_calibration() {
  const auto lock = job_.lock();
  if (!current_.undo_calibration || next_opening_) return;
  open_by([undo = current_.undo_calibration](const std::stop_token& /*stop*/) { return undo(); });
}

void Worker::request(const Settings& settings) {
  const auto lock = job_.lock();
  if (!current_.published.recording) return;
  if (!opening_) job_.cancel();
  next_settings_ = settings;
  job_.wake();
}

void Worker::cancel(const std::shared_ptr<const Recording>& shown) {
  const auto lock = job_.lock();
  job_.cancel();
  next_opening_ = nullptr;
  next_settings_.reset();
  opening_ = false;
  if (before_ && current_.published.recording != shown) {
    const std::uint64_t generation = current_.published.generation;
    current_ = *std::exchange(before_, {});
    current_.published.generation = generation + 1;
  }
}

/// Called with the lock.
void Worker::publish(Opened opened) {
  Current next{{std::move(opened.recording),
                nullptr,
                current_.published.generation + 1,
                std::move(opened.calibration)},
               std::move(opened.inspect),
               std::move(opened.calibrate),
               std::move(opened.undo_calibration)};
  std::swap(current_, next);
  before_.reset();
  next_settings_.reset();
  if (!opened.rest) return;
  before_ = std::move(next);
  next_opening_ = [this, rest = std::move(opened.rest)](const std::stop_token& stop) {
    return rest(stop, progress(stop));
  };
  opening_ = true;
  job_.wake();
}

BackgroundJob::Job Worker::next() {
  opening_ = next_opening_ != nullptr;
  if (opening_)
    return [this, opening = std::exchange(next_opening_, nullptr)](const std::stop_token& stop) {
      Opened opened = opening(stop);
      job_.publish(stop, [&] { publish(std::move(opened)); });
    };
  if (!next_settings_) return nullptr;
  return [this, inspect = current_.inspect, settings = *std::exchange(next_settings_, {})](
             const std::stop_token& stop) {
    auto inspection = inspect(settings, stop, progress(stop));
    if (!inspection) return;
    job_.publish(stop, [&] {
      current_.published.inspection = std::move(inspection);
      ++current_.published.generation;
    });
  };
}

Progress Worker::progress(const std::stop_token& stop, const std::string& prefix) {
  return [this, stop, prefix](const std::string& stage, int done, int of) {
    job_.report(stop, prefix + stage, done, of);
  };
}

void synchronize(
    WorkbenchState& state, WorkerLink& link, Worker& worker, Survey& survey, Scan& scan) {
  const bool opened = receive(state, link, worker, survey);
  if (opened) link.loading = false;
  const bool open_example = std::exchange(state.requests.open_example, false);
  const auto open = std::exchange(state.requests.open, {});
  const bool calibrate = wants_calibration(state, link, opened);
  const bool find_start = std::exchange(state.requests.find_start, false);
  const bool again = std::exchange(state.requests.compute, false);
  if (std::exchange(state.requests.cancel, false) && !cancel_report(state)) {
    if (link.busy())
      cancel(state, link, worker);
    else
      close_next(state);
  }
  const bool compute =
      state.document.recording && (opened || again || state.document.settings != link.requested);
  if (open_example) {
    stop_reading(link);
    link.opening.clear();
    worker.cancel(state.document.recording);
    worker.open(link.example);
  }
  link.reading = link.reader->status();  // before `take`, so that idle implies that it was taken
  auto read = link.reader->take();
  bool opening = open && open_path(state, link, worker, *open);
  if (!open && !read.empty()) opening = open_read(state, link, worker, std::move(read.front()));
  link.loading = open_example || opening || (link.loading && link.worker.busy && !opened);
  if (calibrate) worker.calibrate();
  const bool undo = std::exchange(state.requests.undo_calibration, false);
  if (undo) worker.undo_calibration();
  link.undoing_calibration = link.undoing_calibration || undo;
  link.calibrating = calibrate || (link.calibrating && link.worker.busy && !opening);
  if (compute) {
    worker.request(state.document.settings);
    link.requested = state.document.settings;
  }
  if (opened) link.finding_start = false;
  if (find_start) link.finding_start = true;
  if (compute || find_start || wants_report(state)) link.survey_canceled = false;
  const bool waits = link.survey_canceled || is_read_on(state, link);
  survey.want(waits ? std::vector<Settings>{} : wanted_inspections(state));
  const bool studies = (needs_of(state.view.panes).study || wants_report(state)) && !waits;
  survey.study(studies ? state.results.inspection : nullptr);
  link.survey = survey.status();
  const JobStatus after =
      follow_window(state, waits ? nullptr : link.published, *link.extrapolator);
  if (!link.survey.busy) link.survey = after;
  if (open) link.reading = link.reader->status();
  const bool found = scan_for_starts(state, link, scan);
  // Busy at least until the next call.
  if (open_example || opening || calibrate || undo || compute || found)
    link.worker = {.busy = true};
}

}  // namespace gpo
