// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// MCAP with Foxglove's messages in JSON (https://docs.foxglove.dev/docs/sdk/schemas).
#include "engine/base/error.h"
#include "engine/base/stop.h"
#include "engine/exports/scene.h"
#include "engine/files/image_codec.h"
#include "engine/files/text_file.h"
#include "engine/inspection/studies/studies.h"
#include "engine/recording/bags/messages.h"
#include "engine/recording/images/images.h"

#include <algorithm>

#include <Eigen/Geometry>
#include <fmt/format.h>

namespace gpo {
namespace {

using Eigen::Vector3d;
using nlohmann::ordered_json;

constexpr const char* kWorldFrame = "world";
constexpr const char* kCameraFrame = "camera";
constexpr int kJpegQuality = 92;

/// Topics in the order of their indices in the file.
enum FoxgloveTopic { image, calibration, transform, path, annotations, scene_entities };
struct FoxgloveRow {
  const char* topic;
  const char* type;
};
constexpr std::array<FoxgloveRow, 6> kFoxgloveTopics{{{"/camera/image", "CompressedImage"},
                                                      {"/camera/calibration", "CameraCalibration"},
                                                      {"/tf", "FrameTransform"},
                                                      {"/path", "PosesInFrame"},
                                                      {"/camera/tracks", "ImageAnnotations"},
                                                      {"/scene", "SceneUpdate"}}};

ordered_json time_json(std::int64_t ns) {
  constexpr std::int64_t kSecond_ns = 1'000'000'000;
  ns = std::max<std::int64_t>(ns, 0);  // the format begins in 1970
  return {{"sec", ns / kSecond_ns}, {"nsec", ns % kSecond_ns}};
}

ordered_json vector_json(const Vector3d& v) { return {{"x", v.x()}, {"y", v.y()}, {"z", v.z()}}; }

ordered_json rotation_json(const Eigen::Matrix3d& R) {
  const Eigen::Quaterniond q = Eigen::Quaterniond(R).normalized();
  return {{"x", q.x()}, {"y", q.y()}, {"z", q.z()}, {"w", q.w()}};
}

ordered_json pose_json(const Eigen::Matrix3d& R, const Vector3d& p) {
  return {{"position", vector_json(p)}, {"orientation", rotation_json(R)}};
}

ordered_json color_json(std::uint32_t rgb, double alpha) {
  const auto channel = [&](int shift) { return ((rgb >> shift) & 0xFF) / 255.0; };
  return {{"r", channel(16)}, {"g", channel(8)}, {"b", channel(0)}, {"a", alpha}};
}

/// The bytes of the recording's own image file, or a new JPEG.
struct EncodedImage {
  std::string bytes;
  const char* format;  ///< "jpeg" or "png"
};

EncodedImage encoded_image(const Recording& recording, int frame) {
  if (std::ssize(recording.image_files) == recording.frame_count() &&
      is_image_name(recording.image_files[frame])) {
    std::string bytes = read_file(recording.image_files[frame]);
    if (bytes.starts_with("\xFF\xD8")) return {std::move(bytes), "jpeg"};
    if (bytes.starts_with("\x89PNG")) return {std::move(bytes), "png"};
  }
  return {encode_jpeg(recording.images->bgr(frame), kJpegQuality), "jpeg"};
}

ordered_json calibration_json(const Recording& recording, std::int64_t time_ns) {
  const CameraInfoMessage info = camera_info_of(recording.camera);
  std::vector<double> P;
  for (int row = 0; row < 3; ++row) {
    P.insert(P.end(), info.K.begin() + 3 * row, info.K.begin() + 3 * row + 3);
    P.push_back(0);
  }
  return {{"timestamp", time_json(time_ns)},
          {"frame_id", kCameraFrame},
          {"width", info.width},
          {"height", info.height},
          {"distortion_model", info.distortion_model},
          {"D", info.D},
          {"K", info.K},
          {"R", {1, 0, 0, 0, 1, 0, 0, 0, 1}},
          {"P", P}};
}

/// Circles of the frame's tracks: inliers in the color of their plane, outliers in red.
ordered_json annotations_json(const Inspection& inspection, int frame) {
  const Tracks& tracks = *inspection.tracks;
  const double diameter = 6 * pixel_unit(inspection.recording->camera);
  ordered_json circles = ordered_json::array();
  for (int j = 0; j < tracks.track_count(); ++j) {
    if (!tracks.seen(frame, j) || is_excluded(inspection, j)) continue;
    const Eigen::Vector2d at = tracks.raw_px[frame].col(j);
    const auto plane = plane_of_track(*inspection.window, frame, j);
    circles.push_back(
        {{"timestamp", time_json(inspection.window->timestamps_ns[frame])},
         {"position", {{"x", at.x()}, {"y", at.y()}}},
         {"diameter", diameter},
         {"thickness", diameter / 4},
         {"fill_color", color_json(0, 0)},
         {"outline_color", color_json(plane ? plane_color(*plane) : kOutlierRgb, 1)}});
  }
  return {
      {"circles", circles}, {"points", ordered_json::array()}, {"texts", ordered_json::array()}};
}

ordered_json entity(const ExportScene& scene, const std::string& id) {
  ordered_json made{{"timestamp", time_json(scene.inspection.window->timestamps_ns.front())},
                    {"frame_id", kWorldFrame},
                    {"id", id},
                    {"lifetime", {{"sec", 0}, {"nsec", 0}}},
                    {"frame_locked", false},
                    {"metadata", ordered_json::array()}};
  made["metadata"].push_back({{"key", "world"}, {"value", scene.world.description()}});
  for (const char* list :
       {"arrows", "cubes", "spheres", "cylinders", "lines", "triangles", "texts", "models"})
    made[list] = ordered_json::array();
  return made;
}

ordered_json points_json(std::span<const Vector3d> points) {
  ordered_json list = ordered_json::array();
  for (const Vector3d& point : points) list.push_back(vector_json(point));
  return list;
}

ordered_json line_json(std::span<const Vector3d> points, int type, std::uint32_t rgb) {
  return {{"type", type},
          {"pose", pose_json(Eigen::Matrix3d::Identity(), Vector3d::Zero())},
          {"thickness", 2},
          {"scale_invariant", true},
          {"points", points_json(points)},
          {"color", color_json(rgb, 1)},
          {"colors", ordered_json::array()},
          {"indices", ordered_json::array()}};
}

/// A sphere or a cube.
ordered_json solid_json(const ordered_json& pose, double side, const ordered_json& color) {
  return {{"pose", pose}, {"size", vector_json(Vector3d::Constant(side))}, {"color", color}};
}

ordered_json plane_entity(const ExportScene& scene, const ScenePlane& plane) {
  constexpr int kLineLoop = 1;
  ordered_json made = entity(scene, plane.title);
  made["triangles"].push_back({{"pose", pose_json(Eigen::Matrix3d::Identity(), Vector3d::Zero())},
                               {"points", points_json(plane.corners)},
                               {"color", color_json(plane.rgb, 0.25)},
                               {"colors", ordered_json::array()},
                               {"indices", {0, 1, 2, 0, 2, 3}}});
  made["lines"].push_back(line_json(plane.corners, kLineLoop, plane.rgb));
  return made;
}

ordered_json scene_update(const ExportScene& scene) {
  constexpr int kLineStrip = 0;
  ordered_json entities = ordered_json::array();
  for (const ScenePlane& plane : scene.planes) entities.push_back(plane_entity(scene, plane));
  for (const SceneCube& cube : scene.cubes) {
    ordered_json made = entity(scene, fmt::format("cube on plane {}", cube.plane + 1));
    made["cubes"].push_back(solid_json(
        pose_json(cube.axes, cube.center), cube.side, color_json(plane_color(cube.plane), 0.5)));
    entities.push_back(std::move(made));
  }
  const double diameter =
      0.01 * scene.world.T_world_reference.scale * scene.inspection.initialization->plane.distance;
  ordered_json points = entity(scene, "tracks");
  for (const ScenePoint& point : scene.points)
    points["spheres"].push_back(
        solid_json(pose_json(Eigen::Matrix3d::Identity(), point.position),
                   diameter,
                   color_json(point.plane ? plane_color(*point.plane) : kOutlierRgb, 1)));
  entities.push_back(std::move(points));
  std::vector<Vector3d> centers;
  for (const Pose& camera : scene.cameras) centers.push_back(camera.p_wc);
  ordered_json path = entity(scene, "camera path");
  path["lines"].push_back(
      line_json(centers, kLineStrip, scene.inspection.settings.options.method.row().rgb));
  entities.push_back(std::move(path));
  return {{"deletions", ordered_json::array()}, {"entities", entities}};
}

/// Writes the messages of one frame.
void write_frame(const ExportScene& scene, const BagWriter& writer, int frame) {
  const Inspection& inspection = scene.inspection;
  const Recording& recording = *inspection.recording;
  const std::int64_t ns = inspection.window->timestamps_ns[frame];
  const auto write = [&](FoxgloveTopic topic, const ordered_json& message) {
    writer.write(topic, ns, message.dump());
  };
  const Pose& camera = scene.cameras[frame];
  write(transform,
        {{"timestamp", time_json(ns)},
         {"parent_frame_id", kWorldFrame},
         {"child_frame_id", kCameraFrame},
         {"translation", vector_json(camera.p_wc)},
         {"rotation", rotation_json(camera.R_wc)}});
  write(calibration, calibration_json(recording, ns));
  if (recording.images) {
    const EncodedImage encoded = encoded_image(recording, inspection.window->start + frame);
    write(image,
          {{"timestamp", time_json(ns)},
           {"frame_id", kCameraFrame},
           {"data", to_base64(encoded.bytes)},
           {"format", encoded.format}});
  }
  write(annotations, annotations_json(inspection, frame));
}

}  // namespace

void write_foxglove(const ExportScene& scene, const fs::path& file, ExportNotes& notes) {
  const Inspection& inspection = scene.inspection;
  std::vector<McapChannel> channels;
  for (const auto& [topic, type] : kFoxgloveTopics)
    channels.push_back({.topic = topic,
                        .schema = fmt::format("foxglove.{}", type),
                        .definition = foxglove_schema(type).dump()});
  const BagWriter writer = mcap_json_writer(file, channels);
  const std::int64_t first_ns = inspection.window->timestamps_ns.front();
  ordered_json poses = ordered_json::array();
  for (const Pose& camera : scene.cameras) poses.push_back(pose_json(camera.R_wc, camera.p_wc));
  const ordered_json path_message{
      {"timestamp", time_json(first_ns)}, {"frame_id", kWorldFrame}, {"poses", poses}};
  writer.write(path, first_ns, path_message.dump());
  writer.write(scene_entities, first_ns, scene_update(scene).dump());
  for (int i = 0; i < std::ssize(scene.cameras); ++i) {
    check_stop();
    write_frame(scene, writer, i);
  }
  writer.finish();
  notes.push_back(fmt::format("{}, {}, {}, {}; {}",
                              counted(scene.cameras.size(), "frame"),
                              counted(scene.planes.size(), "plane"),
                              counted(scene.points.size(), "point"),
                              counted(scene.cubes.size(), "cube"),
                              scene.world.description()));
  for (const std::string& left_out : scene.left_out) notes.push_back("left out: " + left_out);
  const Distortion distortion = inspection.recording->camera.distortion;
  if (distortion > Distortion::equidistant)
    notes.push_back(fmt::format(
        "Foxglove has no model of the lens {}: it cannot draw the scene over the images",
        lens_model(distortion).name));
}

}  // namespace gpo
