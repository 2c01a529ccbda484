// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/exports/exports.h"

#include "engine/base/error.h"
#include "engine/files/output_file.h"
#include "engine/files/refuse.h"

#include <array>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gpo {
namespace {

template <TrajectoryFormat format>
std::string trajectory_text(const ExportScene& scene, ExportNotes& notes) {
  const CameraPath path = estimated_path(scene.inspection, scene.world);
  notes.push_back(fmt::format("{} camera poses; {}", path.cameras.size(), path.world));
  return to_text(path, format);
}

constexpr std::array<ExportFormat, 7> kExportFormats{
    {{.key = "colmap",
      .title = "COLMAP model",
      .ending = "",
      .help = "Folder with a COLMAP model, text and binary: camera, images, tracks, points",
      .content = nullptr,
      .write = write_colmap},
     {.key = "gltf",
      .title = "glTF scene",
      .ending = ".glb",
      .help = "glTF 2.0 scene: cameras, animated camera, textured planes, points, cubes",
      .content = gltf_bytes},
     {.key = "ply",
      .title = "Points of all planes (PLY)",
      .ending = ".ply",
      .help = "Points of all planes as PLY: track, color, normal, plane, residual",
      .content = ply_text},
     {.key = "foxglove",
      .title = "MCAP for Foxglove",
      .ending = ".mcap",
      .help = "MCAP with Foxglove's schemas: images, tracks, camera, planes, points, cubes",
      .content = nullptr,
      .write = write_foxglove},
     {.key = "tum",
      .title = "Trajectory (TUM)",
      .ending = ".txt",
      .help = "Camera poses as TUM: seconds, p, q_xyzw",
      .content = trajectory_text<TrajectoryFormat::tum>},
     {.key = "euroc",
      .title = "Trajectory (EuRoC)",
      .ending = ".csv",
      .help = "Camera poses as EuRoC: nanoseconds, p, q_wxyz",
      .content = trajectory_text<TrajectoryFormat::euroc>},
     {.key = "kitti",
      .title = "Trajectory (KITTI)",
      .ending = ".txt",
      .help = "Camera poses as KITTI: (R | p), row by row, without times",
      .content = trajectory_text<TrajectoryFormat::kitti>}}};

std::string keys_of_formats() {
  std::vector<std::string> keys;
  for (const ExportFormat& format : kExportFormats) keys.emplace_back(format.key);
  return fmt::format("{}", fmt::join(keys, ", "));
}

}  // namespace

std::span<const ExportFormat> export_formats() { return kExportFormats; }

const ExportFormat& export_format(const std::string& key) {
  for (const ExportFormat& format : kExportFormats)
    if (key == format.key) return format;
  refuse("export format", "found '{}', expected one of {}", key, keys_of_formats());
}

ExportRequest parse_export(const std::string& text) {
  const std::size_t equal = text.find('=');
  if (equal == std::string::npos || equal + 1 == text.size())
    refuse("--export",
           "found '{}', expected FORMAT=PATH with a format of {}",
           text,
           keys_of_formats());
  const fs::path path = text.substr(equal + 1);
  if (path == "-") refuse("--export", "found '{}', expected a file or a folder instead of -", text);
  for (const ExportFormat& format : export_formats())
    if (text.find(fmt::format(",{}=", format.key)) != std::string::npos)
      refuse("--export",
             "found '{}', expected one FORMAT=PATH; repeat --export for {}",
             text,
             format.key);
  return {&export_format(text.substr(0, equal)), path};
}

void check_export(const ExportRequest& request) {
  if (request.format->is_folder())
    check_output_folder(request.path);
  else
    check_writable(request.path);
}

ExportNotes write_export(const Inspection& inspection,
                         const ExportChoices& choices,
                         const ExportRequest& request) {
  const auto& [format, path] = request;
  const ExportScene scene = export_scene(inspection, choices);
  ExportNotes notes;
  if (format->content != nullptr) {
    const std::string content = format->content(scene, notes);
    write_file(path, content);
  } else if (format->is_folder()) {
    AtomicFolder folder(path);
    format->write(scene, folder.path(), notes);
    folder.finish();
  } else {
    AtomicFile file(path);
    format->write(scene, file.path(), notes);
    file.finish();
  }
  return notes;
}

std::string map_points_ply(const Inspection& inspection, const ExportWorld& world) {
  ExportScene scene = export_scene(inspection, {.metric = world.meters});
  std::set<int> tracks;
  for (const MapPoint& point : inspection.initialization->points) tracks.insert(point.track);
  std::erase_if(scene.points,
                [&](const ScenePoint& point) { return !tracks.contains(point.track); });
  ExportNotes notes;
  return ply_text(scene, notes);
}

}  // namespace gpo
