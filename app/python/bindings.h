// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/settings/settings.h"
#include "engine/recording/recording.h"

#include <memory>
#include <string>
#include <variant>

#include <pybind11/pybind11.h>

namespace gpo {

using SharedRecording = std::shared_ptr<const Recording>;
/// Python's Recording; its holders do not know constants.
struct OpenRecording {
  SharedRecording shared;
};
/// What `run`, `evaluate` and `snapshot` take: one that is open, or where one lies.
using RecordingOrPath = std::variant<OpenRecording, std::string>;

SharedRecording opened(const RecordingOrPath& recording);

/// The settings by their names on the command line, with `_`: frames=20, planes="one",
/// ransac=False, and preset="paper". Throws InputError.
Settings settings_of(const pybind11::kwargs& given);

void bind_solved(pybind11::module_& module);
void bind_recording(pybind11::module_& module);
void bind_initialize(pybind11::module_& module);
void bind_results(pybind11::module_& module);

}  // namespace gpo
