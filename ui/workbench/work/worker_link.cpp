// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/work/worker_link.h"

#include "engine/base/error.h"
#include "engine/experiment/row.h"
#include "engine/inspection/inspection.h"
#include "ui/workbench/compared.h"
#include "ui/workbench/playing.h"
#include "ui/workbench/session/recent_files.h"
#include "ui/workbench/session/session_file.h"
#include "ui/workbench/undo.h"
#include "ui/workbench/work/apply_recording.h"

#include <utility>

namespace gpo {
namespace {

/// The inspection with its cube where the ray points; itself where nobody moved it.
std::shared_ptr<const Inspection> with_cube(std::shared_ptr<const Inspection> inspection,
                                            const std::optional<Eigen::Vector3d>& ray_c) {
  if (!inspection || !ray_c) return inspection;
  Inspection moved = *inspection;
  move_cubes(moved, *ray_c);
  return std::make_shared<const Inspection>(std::move(moved));
}

/// Takes over what was published. Whether that is another recording.
bool receive(WorkbenchState& state, WorkerLink& link, Worker& worker, Survey& survey) {
  // The status first: one that says "idle" then never comes with a result that is not there yet.
  link.worker = worker.status();
  link.survey = survey.status();
  const Published published = worker.latest();
  const bool opened = published.recording && published.recording != state.document.recording;
  if (opened) {
    apply_recording(state, published.recording);
    survey.open(published.recording);
    if (link.remembers_files && !link.opening.empty()) {
      remember_file(link.opening);
      state.files.recent = recent_files();
    }
  }
  if (published.inspection && published.inspection != link.published)
    survey.add(published.inspection);
  if (published.inspection != link.published || state.document.cube_ray != link.cube_ray)
    state.results.inspection = with_cube(published.inspection, state.document.cube_ray);
  link.published = published.inspection;
  link.cube_ray = state.document.cube_ray;
  state.results.surveyed = survey.results();
  const auto study = survey.latest_study();
  if (study && study != state.results.study && !study->error.empty())
    say(state, "the window's normals could not be studied: " + study->error, Severity::error);
  state.results.study = study;
  if (link.worker.error != link.error) {
    link.error = link.worker.error;
    if (!link.error.empty()) say(state, link.error, Severity::error);
  }
  return opened;
}

/// Whether a camera is to be found, because the user wants it or wants it for all that is opened.
bool wants_calibration(WorkbenchState& state, const WorkerLink& link, bool opened) {
  const bool requested = std::exchange(state.requests.calibrate, false);
  const bool guessed = state.document.recording && state.document.recording->images &&
                       state.document.recording->camera_source == CameraSource::guess;
  return requested || (opened && link.calibrates && guessed);
}

/// Whose normals the open pane shows; null: none does.
std::shared_ptr<const Inspection> to_study(const WorkbenchState& state) {
  return needs_of(state.view.panes).study ? state.results.inspection : nullptr;
}

/// Starts where the scan found the first window that is ready, once all is scanned where the best
/// one is. Whether it did.
bool go_to_found_start(WorkbenchState& state, WorkerLink& link) {
  if (!link.finding_start || !state.results.scan) return false;
  const ScannedStart* best = best_start(state.results.scan->starts);
  const bool ready = best != nullptr && best->readiness == Readiness::ready;
  if (!ready && !state.results.scan->finished()) return false;
  link.finding_start = false;
  if (best == nullptr) {
    say(state,
        "no start can be initialized; the strip above the time line says why",
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

/// Whether there is a start that was asked for.
bool scan_for_starts(WorkbenchState& state, WorkerLink& link, Scan& scan) {
  const bool wanted = state.view.toggles.scan && !link.survey_canceled;
  if (!state.view.toggles.scan || !state.document.recording) {
    state.results.scan.reset();
    link.finding_start = false;
  }
  // One that is canceled stays as far as it came.
  scan.want(wanted ? state.document.recording : nullptr, state.document.settings);
  link.scan = scan.status();
  if (wanted) state.results.scan = scan.latest();
  return go_to_found_start(state, link);
}

/// Shows the figures of a results.csv.
void open_results(WorkbenchState& state, const std::filesystem::path& file) {
  try {
    state.results.experiment =
        std::make_shared<const std::vector<Row>>(read_results(file, state.methods));
  } catch (const InputError& error) {
    return say(state, error.what(), Severity::error);
  }
  state.results.experiment_name = (file.parent_path().filename() / file.filename()).string();
  state.view.panes.drawer = find_drawer("curves");
  say(state, std::to_string(state.results.experiment->size()) + " results in " + file.string());
}

/// A session's recording is opened first; one that has moved is asked for. Whether the worker has
/// something to do.
bool open_path(WorkbenchState& state,
               const WorkerLink& link,
               Worker& worker,
               const std::filesystem::path& path) {
  if (is_results(path)) {
    open_results(state, path);
    return false;
  }
  auto& waiting = state.files.waiting_session;
  if (waiting && waiting->recording.filename() != path.filename()) waiting.reset();
  std::filesystem::path recording = path;
  try {
    if (is_session(path)) {
      if (link.add_methods) link.add_methods(path, state);
      state.files.waiting_session = read_session(path, state.methods);
      recording = state.files.waiting_session->recording;
    }
  } catch (const InputError& error) {
    say(state, error.what(), Severity::error);
    return false;
  }
  std::error_code none;
  if (is_session(path) && !std::filesystem::exists(recording, none)) {
    say(state,
        recording.string() + " has moved: open it where it is now, and the session goes on",
        Severity::warning);
    return false;
  }
  worker.open(recording);
  return true;
}

}  // namespace

void synchronize(WorkbenchState& state,
                 WorkerLink& link,
                 Worker& worker,
                 Survey& survey,
                 Scan& scan,
                 const std::filesystem::path& example) {
  const bool opened = receive(state, link, worker, survey);
  const bool open_example = std::exchange(state.requests.open_example, false);
  const auto open = std::exchange(state.requests.open, {});
  const bool calibrate = wants_calibration(state, link, opened);
  const bool find_start = std::exchange(state.requests.find_start, false);
  const bool again = std::exchange(state.requests.compute, false);
  if (std::exchange(state.requests.cancel, false) && link.busy()) {
    worker.cancel();
    link.survey_canceled = true;
    link.finding_start = false;
    say(state,
        std::exchange(link.calibrating, false) ? "the calibration was canceled; nothing was kept"
                                               : "canceled; F5 computes again");
  }
  const bool compute =
      state.document.recording && (opened || again || state.document.settings != link.requested);
  if (open_example) worker.open(example);
  const bool opening = open && open_path(state, link, worker, *open);
  if (open_example || opening) link.opening = opening ? *open : std::filesystem::path();
  if (calibrate) worker.calibrate();
  link.calibrating = calibrate || (link.calibrating && link.worker.busy && !opening);
  if (compute) {
    worker.request(state.document.settings);
    link.requested = state.document.settings;
  }
  if (opened) link.finding_start = false;
  if (find_start) link.finding_start = true;
  if (compute || find_start) link.survey_canceled = false;
  survey.want(link.survey_canceled ? std::vector<Settings>{} : wanted_inspections(state));
  survey.study(link.survey_canceled ? nullptr : to_study(state));
  link.survey = survey.status();
  const bool found = scan_for_starts(state, link, scan);
  // Busy until the next call has seen what became of it.
  if (open_example || opening || calibrate || compute || found) link.worker = {true, "", 0, 0, ""};
}

}  // namespace gpo
