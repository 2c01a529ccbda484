// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/files/paths.h"
#include "engine/inspection/inspection.h"
#include "engine/inspection/report/report.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace gpo {

/// Choices of a user for an export.
struct ExportChoices {
  bool metric = false;   ///< see `export_world`
  double cube_side = 0;  ///< [unit of the estimate]; 0: `default_cube_side`
};

/// Remarks on a written export, one line each: what it contains, what was left out and why.
using ExportNotes = std::vector<std::string>;

// The content of all exports, in the world and unit of the export.

/// A color, red first.
using Rgb = std::array<std::uint8_t, 3>;

struct ScenePoint {
  int track = 0;                                       ///< column in the window
  std::optional<int> plane = std::nullopt;             ///< number in the window; nullopt: on none
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< [unit of the export]
  Rgb color{128, 128, 128};  ///< from the reference image; gray without it
  /// In the window: in front of the camera, inlier of its plane or, on none, seen.
  std::vector<int> frames = {};
  double rms_px = 0;  ///< reprojection error over `frames`, undistorted
};

struct ScenePlane {
  int number = 0;     ///< in the window
  std::string title;  ///< "plane 2 (wall)"
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  /// Corners of a rectangle around most of its points, counterclockwise as the reference camera
  /// sees it; the first one is at the lower left if the camera is upright.
  std::array<Eigen::Vector3d, 4> corners = {};
  std::uint32_t rgb = 0;  ///< its tracks' color in the window
};

struct SceneCube {
  int plane = 0;                                       ///< number in the window
  std::array<Eigen::Vector3d, 8> corners{};            ///< see `cube_corners`
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< right-handed, columns
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double side = 0;
};

struct ExportScene {
  const Inspection& inspection;
  ExportWorld world;
  std::vector<Pose> cameras = {};       ///< one per frame of the window
  std::vector<ScenePoint> points = {};  ///< the leading plane's first
  std::vector<ScenePlane> planes = {};  ///< the leading one first
  std::vector<SceneCube> cubes = {};    ///< the leading plane's first
  ExportNotes left_out = {};
};

/// Outliers have this color, as in the window; inliers have that of their plane.
inline constexpr std::uint32_t kOutlierRgb = 0xF0503C;

/// Throws InputError if the initialization failed or a requested scale or world is unknown.
ExportScene export_scene(const Inspection& inspection, const ExportChoices& choices);

/// Returns whether the lens distorts: a radial-tangential one without coefficients does not.
bool has_distortion(const Camera& camera);

/// Returns the file name of a frame's image; for a video or a bag the one that `convert` writes.
std::string image_name(const Recording& recording, int frame);

/// Returns the image on a plane, rectified: BGRA, the last two corners above, transparent outside
/// of the reference image and, on further planes, where the nearest track is on another plane.
/// Empty without images.
cv::Mat rectified_image(const ExportScene& scene, const ScenePlane& plane);

/// Appends little-endian numbers.
void put_numbers(std::string& bytes, auto... numbers) {
  (bytes.append(reinterpret_cast<const char*>(&numbers), sizeof(numbers)), ...);
}

// The rows of the table.

void write_colmap(const ExportScene& scene, const fs::path& folder, ExportNotes& notes);
std::string gltf_bytes(const ExportScene& scene, ExportNotes& notes);
std::string ply_text(const ExportScene& scene, ExportNotes& notes);
void write_foxglove(const ExportScene& scene, const fs::path& file, ExportNotes& notes);

/// Returns the JSON schema of one of Foxglove's types with all its fields, as in
/// https://docs.foxglove.dev/docs/sdk/schemas.
nlohmann::ordered_json foxglove_schema(const std::string& type);

}  // namespace gpo
