// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/window_report.h"

#include "engine/base/error.h"
#include "engine/experiment/program_identity.h"
#include "engine/files/output_file.h"
#include "engine/inspection/report/report.h"
#include "engine/inspection/studies/studies.h"
#include "ui/views/report/report.h"

namespace gpo {
namespace {

/// Returns what `info` finds, but does not search images for the board: the window would wait.
std::string found_quickly(const Recording& recording) {
  if (recording.board && !recording.truth)
    return "gpo-inspector info " + recording.path.string() +
           " searches the images for the board and describes the recording.";
  return to_text(describe(recording));
}

std::string methods_text(const std::vector<Compared>& methods) {
  std::string text;
  for (const Compared& one : methods) text += (text.empty() ? "" : ",") + key_of(one.configuration);
  return text;
}

}  // namespace

void write_window_report(const WorkbenchState& state, const fs::path& file, const DrawState& draw) {
  const auto& inspection = state.results.inspection;
  if (!inspection) throw InputError("report: no result to write yet");
  const Recording& recording = *inspection->recording;
  ReportSection section{.inspection = inspection};
  WorkbenchState shown = state;
  for (const int frame : report_frames(*inspection)) {
    shown.view.frame = frame;
    section.frames.push_back(
        {frame, draw(shown, "picture", {recording.camera.width, recording.camera.height})});
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
  section.figures = {growth_figure(*inspection)};
  section.found = found_quickly(recording);
  section.command =
      report_command({recording.path}, inspection->settings, methods_text(section.methods));
  write_file(file, report_page({.sections = {section}, .program = program_identity()}));
}

}  // namespace gpo
