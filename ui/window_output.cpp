// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/window_output.h"

#include "engine/base/error.h"
#include "engine/experiment/experiment.h"
#include "engine/files/output_file.h"
#include "engine/inspection/report/report.h"
#include "engine/inspection/studies/studies.h"
#include "engine/window/timestamps.h"
#include "ui/panels/facts/facts.h"
#include "ui/views/compare/compare_view.h"
#include "ui/views/report/report.h"

#include <algorithm>

namespace gpo {
namespace {

/// Returns what `info` finds, but does not search images for the board: the window would wait.
std::string found_quickly(const Recording& recording) {
  if (recording.board && !recording.truth)
    return "gpo-inspector info " + recording.path.string() +
           " searches the images for the board and describes the recording.";
  return to_text(describe(recording));
}

/// Returns the curves of the compared methods; no chart if the window is too short.
Figure curves_figure(WorkbenchState state) {
  const Settings& window = state.document.settings;
  if (window.frames < kFewestFramesForCurves) return {};
  state.results.experiment.reset();
  state.view.hidden_curves.clear();
  return with_single_windows(
      curve_facts(state).figure, state.document.recording->name, window.start);
}

std::string command_of(const WorkbenchState& state, const ReportSection& section) {
  const Recording& recording = *section.inspection->recording;
  const bool given = recording.path == state.files.given;
  std::vector<Configuration> compared;
  for (const Compared& one : section.methods) compared.push_back(one.configuration);
  return report_command(
      recording.path,
      opening_options(recording, {}, given ? state.files.given_topics : TopicChoices{}),
      section.inspection->settings,
      compared);
}

double movie_rate_hz(const MovieRequest& request, const Recording& recording) {
  constexpr double kUnknown_hz = 30;
  if (request.rate_hz > 0) return request.rate_hz;
  const double recorded = rate_hz(recording.timestamps_ns);
  return recorded > 0 ? recorded : kUnknown_hz;
}

cv::Size movie_size(const WorkbenchState& state) {
  const Recording& recording = *state.document.recording;
  if (!state.view.panes.compare) return even_size(shown_size(recording));
  return even_size(
      default_compare_size(static_cast<int>(compared_results(state).size()), recording));
}

}  // namespace

JobStatus report_status(const WorkbenchState& state) {
  const std::vector<Settings> wanted = wanted_inspections(state);
  const auto done = std::ranges::count_if(wanted, [&](const Settings& one) {
    return find_surveyed(state.results.surveyed.get(), one) != nullptr;
  });
  return {.busy = true,
          .stage = "report",
          .done = static_cast<int>(done),
          .of = static_cast<int>(wanted.size())};
}

std::vector<Screenshot> take_screenshots(WorkbenchState& state, const WorkerLink& link) {
  const bool waits = link.worker.busy || link.survey.busy || link.reading.busy;
  std::vector<Screenshot> ready, waiting;
  for (Screenshot& one : state.requests.screenshots)
    (waits && one.view == kReportView ? waiting : ready).push_back(std::move(one));
  state.requests.screenshots = std::move(waiting);
  return ready;
}

void write_window_report(const WorkbenchState& state, const fs::path& file, const DrawState& draw) {
  const auto& inspection = state.results.inspection;
  if (!inspection) throw InputError("report: no result to write yet");
  const Recording& recording = *inspection->recording;
  ReportSection section{.inspection = inspection};
  WorkbenchState shown = state;
  for (const int frame : report_frames(*inspection)) {
    shown.view.frame = frame;
    section.frames.push_back({frame, draw(shown, "picture", shown_size(recording))});
  }
  shown.view.frame = inspection->window->start;
  shown.view.theme = Theme::light;
  if (!shown.results.study || shown.results.study->window != inspection->window)
    shown.results.study = study_normals(*inspection);
  section.scene = draw(shown, "scene", {1120, 630});
  shown.view.frame = section.frames.back().frame;
  section.normals = draw(shown, "normals", {860, 780});
  for (const Compared& one : compared_results(state))
    if (one.inspection) section.methods.push_back(one);
  section.figures = {growth_figure(*inspection), curves_figure(state)};
  section.found = found_quickly(recording);
  section.command = command_of(state, section);
  write_file(file, report_page({.sections = {section}, .program = program_identity()}));
}

Movie::Movie(const MovieRequest& request, const WorkbenchState& state)
    : state_(state),
      view_(state.view.panes.compare ? "compare" : "picture"),
      size_(movie_size(state)),
      first_(state.document.settings.start),
      frames_(std::min(state.document.settings.frames,
                       state.frame_count() - state.document.settings.start)),
      video_(request.file, movie_rate_hz(request, *state.document.recording), size_) {}

void Movie::step(const DrawState& draw) {
  if (finished()) return;
  state_.view.frame = first_ + done_;
  video_.add(draw(state_, view_, size_));
  ++done_;
  if (finished()) video_.finish();
}

}  // namespace gpo
