// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/layouts/told_view.h"

#include "engine/recording/loggers/gpmf_view.h"
#include "engine/recording/loggers/telemetry_track.h"
#include "engine/recording/pictures/exif_view.h"
#include "engine/recording/pictures/video_file.h"
#include "engine/recording/pictures/video_metadata.h"

namespace gpo {

std::optional<ToldView> told_view(const std::filesystem::path& file) {
  if (!is_video_name(file)) return view_of_exif(file);
  const auto gopro = view_of_gpmf(gopro_settings(file));
  return gopro ? gopro : view_of_metadata(file);
}

}  // namespace gpo
