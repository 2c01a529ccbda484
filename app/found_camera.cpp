// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "app/found_camera.h"

#include "app/interrupt.h"
#include "app/output.h"
#include "app/progress_bar.h"
#include "engine/base/error.h"
#include "engine/geometry/camera_guess.h"
#include "engine/recording/camera_source.h"
#include "engine/recording/content.h"
#include "engine/recording/layouts/calibration_file.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <fmt/format.h>

namespace gpo {
namespace {

namespace fs = std::filesystem;

/// To be raised whenever another camera is found in the same pictures.
constexpr int kAlgorithm = 2;

/// FNV-1a.
std::uint64_t hash(std::string_view bytes) {
  std::uint64_t value = 14695981039346656037U;
  for (const char byte : bytes) value = (value ^ static_cast<unsigned char>(byte)) * 1099511628211U;
  return value;
}

/// Where the camera of these pictures is kept.
fs::path kept_file(const Recording& recording) {
  const std::string pictures =
      content_of(recording).at("pictures") + fs::absolute(recording.path).string();
  return recording.cache_folder / "cameras" /
         fmt::format("{}-{:016x}.yaml", kAlgorithm, hash(pictures));
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
  // Without its axes a gyroscope tells nothing of the camera.
  const bool with_gyroscope = recording.gyroscope && recording.T_body_camera;
  SelfCalibration found =
      calibrate_from_plane(*recording.pictures,
                           camera_of_view(recording.camera.width, recording.camera.height),
                           with_gyroscope ? &*recording.gyroscope : nullptr,
                           recording.timestamps_ns,
                           {},
                           progress,
                           interrupt.token());
  bar.reset();
  interrupt.check("nothing was written");
  return found;
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
  if (!found.lens.ok) {
    recording.notes.push_back("calibration from the plane failed: " + found.lens.reason);
    return;
  }
  write_output(file, to_yaml(found, recording.name));
  // As it will be read the next time.
  set_camera(recording,
             kept_camera(file).value_or(found.lens.camera),
             CameraSource::self_calibrated,
             "kept in " + file.string());
}

}  // namespace gpo
