// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// What `evaluate` finds in a folder to go on with: its definition, up to a line of dashes, and the
// file of one window.
#include "engine/experiment/window_files.h"
#include "tests/fuzz/fuzzed_folder.h"
#include "tests/fuzz/targets.h"

void gpo::fuzz::fuzz_experiment(std::string_view bytes) {
  const gpo::fuzz::Folder folder(bytes, {"experiment.json", "windows/desk-0-30.json"});
  gpo::fuzz::parse([&] {
    gpo::Experiment experiment = gpo::read_experiment(folder.path());
    if (experiment.recordings.empty()) return;
    experiment.recordings[0].name = "desk";
    gpo::load_window(folder.path(), experiment, {.recording = 0, .start = 0, .lengths = {30}}, 30);
  });
}
