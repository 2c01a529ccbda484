// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "app/recordings/found_camera.h"

#include "app/terminal/interrupt.h"
#include "app/terminal/output.h"
#include "app/terminal/progress_bar.h"
#include "engine/base/error.h"
#include "engine/base/hash.h"
#include "engine/geometry/camera_guess.h"
#include "engine/recording/camera_source.h"
#include "engine/recording/companions/calibration_file.h"
#include "engine/recording/content.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace gpo {
namespace {

namespace fs = std::filesystem;

/// To be raised whenever another camera is found in the same pictures.
constexpr int kAlgorithm = 2;

/// Where the camera of these pictures is kept.
fs::path kept_file(const Recording& recording) {
  const std::string pictures =
      content_of(recording).at("pictures") + fs::absolute(recording.path).string();
  return recording.cache_folder / "cameras" /
         fmt::format("{}-{:016x}.yaml", kAlgorithm, fnv1a(pictures));
}

/// What was kept may have been cut, or be another program's.
std::optional<Camera> kept_camera(const fs::path& file) {
  try {
    if (!fs::exists(file)) return std::nullopt;
    return read_calibration(file).camera;
  } catch (const InputError&) {
    return std::nullopt;
  }
}

/// A guess may rest on what the camera wrote; any other camera is not to be believed here.
Camera start_of(const Recording& recording) {
  const Camera& camera = recording.camera;
  return recording.camera_source == CameraSource::guess
             ? camera
             : camera_of_view(camera.width, camera.height);
}

SelfCalibration calibrate(const Recording& recording,
                          const CalibrationProgress& progress,
                          const std::stop_token& stop) {
  // Without its axes a gyroscope tells nothing of the camera.
  const bool with_gyroscope = recording.gyroscope && recording.T_body_camera;
  return calibrate_from_plane(*recording.pictures,
                              start_of(recording),
                              with_gyroscope ? &*recording.gyroscope : nullptr,
                              recording.timestamps_ns,
                              {},
                              progress,
                              stop);
}

/// Keeps what was found, and gives it to the recording as it will be read the next time.
void keep(const SelfCalibration& found, Recording& recording) {
  const fs::path file = kept_file(recording);
  write_output(file, to_yaml(found, recording.name));
  set_camera(recording,
             kept_camera(file).value_or(found.lens.camera),
             CameraSource::self_calibrated,
             "kept in " + file.string());
}

std::string why_not(const SelfCalibration& found) {
  return "calibration from the plane failed: " + found.lens.reason;
}

}  // namespace

SelfCalibration self_calibrate(const Recording& recording) {
  const Interrupt interrupt;
  std::optional<ProgressBar> bar;
  std::string shown;
  const auto progress = [&](const char* what, int done, int of) {
    interrupt.check("nothing was written");
    if (shown != what) bar.emplace(what);
    shown = what;
    bar->show(done, of);
  };
  SelfCalibration found = calibrate(recording, progress, interrupt.token());
  bar.reset();
  interrupt.check("nothing was written");
  return found;
}

std::shared_ptr<const Recording> self_calibrated(const Recording& recording,
                                                 const std::stop_token& stop,
                                                 const CalibrationProgress& progress) {
  const SelfCalibration found = calibrate(recording, progress, stop);
  if (stop.stop_requested()) return nullptr;
  if (!found.lens.ok) throw InputError(why_not(found));
  Recording calibrated = recording;
  keep(found, calibrated);
  return std::make_shared<const Recording>(std::move(calibrated));
}

void use_found_camera(Recording& recording, bool calibrates) {
  if (!recording.pictures) return;
  const fs::path file = kept_file(recording);
  if (const auto camera = kept_camera(file)) {
    set_camera(recording, *camera, CameraSource::self_calibrated, "kept in " + file.string());
    return;
  }
  if (!calibrates) return;
  const SelfCalibration found = self_calibrate(recording);
  if (found.lens.ok)
    keep(found, recording);
  else
    recording.notes.push_back(why_not(found));
}

}  // namespace gpo
