// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/calibration/self_calibration.h"
#include "engine/recording/layouts/open_recording.h"
#include "engine/recording/recording.h"
#include "ui/workbench/work/worker.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

namespace gpo {

/// Where a command may be given a recording, it may be given a recipe (a file NAME.yaml or
/// NAME.yml): replaces recipes by the folders of their recordings in the build tree, which are
/// synthesized when first needed, with a progress bar where standard error is a terminal. Other
/// paths stay as they are. Throws InputError.
std::vector<std::filesystem::path> resolve_recordings(
    const std::vector<std::filesystem::path>& paths);

/// Opens a recording, or that of a recipe; its path stays what the user gave. One without a
/// calibration has the camera that was found from a plane in it before and is kept in the user's
/// cache; where there is none, it is calibrated now if `calibrates`.
std::shared_ptr<const Recording> open_given(const std::filesystem::path& path,
                                            const OpenOptions& options = {},
                                            bool calibrates = false);

/// The same for the window's worker. The topics are those of one recording, of others they are
/// found. Where there is no calibration, it can find one.
Worker::Open opener_for_window(std::size_t cache_mib,
                               const std::optional<std::filesystem::path>& recording = {},
                               const TopicChoices& topics = {});

/// The bundled recording: in the source tree, or beside the program as it was installed
/// (share/gpo-inspector).
std::filesystem::path example_recording();

/// With a progress bar on standard error; from the recording's guess, or a field of view of 70
/// degrees where it has another camera, which is not to be believed. Throws Interrupted.
SelfCalibration self_calibrate(const Recording& recording);

}  // namespace gpo
