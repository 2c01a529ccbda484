// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/calibration/plane/plane_lens.h"
#include "engine/recording/images/frame_faults.h"
#include "engine/recording/layouts/open_recording.h"
#include "engine/recording/live/live_recording.h"
#include "ui/workbench/work/worker.h"

namespace gpo {

/// Replaces each recipe (NAME.yaml or NAME.yml) by the folder of its recording, synthesized if
/// missing, with a progress bar on standard error. Other paths stay. Throws InputError.
std::vector<fs::path> resolve_recordings(const std::vector<fs::path>& paths);

/// Opens a recording, or the one of a recipe, under the path that the user gave. A recording
/// without calibration gets the camera that an earlier self-calibration cached; if there is none
/// and `calibrates`, it is calibrated now. Frames with faults are left out, of a long recording
/// only the `searched` ones. Throws InputError.
std::shared_ptr<const Recording> open_given(const fs::path& path,
                                            const OpenOptions& options = {},
                                            bool calibrates = false,
                                            const SearchedFrames& searched = {});

/// A recording on the command line, and what its options say about it.
struct GivenRecording {
  fs::path path;  ///< empty: none
  TopicChoices topics = {};
  SearchedFrames searched = {};  ///< frames to search for faults
};

/// Returns the source of live images that the user named; a file is opened. Throws InputError.
SourceAddress live_source(const std::string& address);

/// Returns the camera of a live source: that of its recording, or the one that was calibrated for
/// this device and size; nullopt if there is none.
std::optional<LiveCamera> camera_of_source(const SourceAddress& address,
                                           const std::string& device,
                                           cv::Size size);

/// Makes a recording one of the window's, with a calibration on request. The camera of a frozen
/// live source is cached for its device and size.
Worker::Opened opened_for_window(const std::shared_ptr<const Recording>& recording);

/// Returns what opens recordings for the window's worker, as `open_given` does, with a calibration
/// on request; other recordings than the given one have no options.
Worker::Open opener_for_window(std::size_t cache_mib, const GivenRecording& given);

/// Returns the file of the program that runs commands which draw.
std::filesystem::path drawing_program();

/// Returns the bundled recording, from the source tree or from share/gpo-inspector.
fs::path example_recording();

/// Calibrates the camera from a plane in view, with a progress bar on standard error. Starts from
/// the recording's guess, else from a field of view of 70 deg.
PlaneLens self_calibrate(const Recording& recording);

}  // namespace gpo
