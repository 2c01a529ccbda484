// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <nlohmann/json.hpp>

namespace gpo {

/// Returns the JSON schema of one of Foxglove's types with all its fields, as in
/// https://docs.foxglove.dev/docs/sdk/schemas: CompressedImage, CameraCalibration, FrameTransform,
/// PosesInFrame, ImageAnnotations, SceneUpdate. Throws std::out_of_range for others.
nlohmann::ordered_json foxglove_schema(const std::string& type);

}  // namespace gpo
