// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/recording/recording.h"

namespace gpo {

/// Reads the poses of a data set's images into the recording's truth, if it has none: those of
/// KITTI odometry, 7-Scenes, Replica, a COLMAP project or nerfstudio. Files that cannot be read are
/// reported with the reason.
void add_data_set_truth(Recording& recording, const fs::path& folder);

}  // namespace gpo
