// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/exports/foxglove_schemas.h"

#include <map>
#include <utility>

namespace gpo {
namespace {

using nlohmann::ordered_json;

const ordered_json kNumber{{"type", "number"}};
const ordered_json kInteger{{"type", "integer"}};
const ordered_json kString{{"type", "string"}};
const ordered_json kBoolean{{"type", "boolean"}};

ordered_json object_of(ordered_json properties) {
  return {{"type", "object"}, {"properties", std::move(properties)}};
}

ordered_json array_of(ordered_json items) {
  return {{"type", "array"}, {"items", std::move(items)}};
}

ordered_json numbers(int count) {
  return {{"type", "array"}, {"items", kNumber}, {"minItems", count}, {"maxItems", count}};
}

ordered_json numbers_named(const std::string& letters) {
  ordered_json properties;
  for (const char letter : letters) properties[std::string(1, letter)] = kNumber;
  return object_of(std::move(properties));
}

ordered_json time_schema(const char* title = "time") {
  ordered_json schema =
      object_of({{"sec", {{"type", "integer"}, {"minimum", 0}}},
                 {"nsec", {{"type", "integer"}, {"minimum", 0}, {"maximum", 999999999}}}});
  schema["title"] = title;
  return schema;
}

ordered_json pose_schema() {
  return object_of({{"position", numbers_named("xyz")}, {"orientation", numbers_named("xyzw")}});
}

ordered_json enumeration(int count) {
  ordered_json values = ordered_json::array();
  for (int value = 0; value < count; ++value) values.push_back({{"const", value}});
  return {{"oneOf", values}};
}

ordered_json compressed_image() {
  return object_of({{"timestamp", time_schema()},
                    {"frame_id", kString},
                    {"data", {{"type", "string"}, {"contentEncoding", "base64"}}},
                    {"format", kString}});
}

ordered_json camera_calibration() {
  return object_of({{"timestamp", time_schema()},
                    {"frame_id", kString},
                    {"width", kInteger},
                    {"height", kInteger},
                    {"distortion_model", kString},
                    {"D", array_of(kNumber)},
                    {"K", numbers(9)},
                    {"R", numbers(9)},
                    {"P", numbers(12)}});
}

ordered_json frame_transform() {
  return object_of({{"timestamp", time_schema()},
                    {"parent_frame_id", kString},
                    {"child_frame_id", kString},
                    {"translation", numbers_named("xyz")},
                    {"rotation", numbers_named("xyzw")}});
}

ordered_json poses_in_frame() {
  return object_of(
      {{"timestamp", time_schema()}, {"frame_id", kString}, {"poses", array_of(pose_schema())}});
}

ordered_json image_annotations() {
  const ordered_json color = numbers_named("rgba"), at = numbers_named("xy");
  const ordered_json circle = object_of({{"timestamp", time_schema()},
                                         {"position", at},
                                         {"diameter", kNumber},
                                         {"thickness", kNumber},
                                         {"fill_color", color},
                                         {"outline_color", color}});
  const ordered_json points = object_of({{"timestamp", time_schema()},
                                         {"type", enumeration(5)},
                                         {"points", array_of(at)},
                                         {"outline_color", color},
                                         {"outline_colors", array_of(color)},
                                         {"fill_color", color},
                                         {"thickness", kNumber}});
  const ordered_json text = object_of({{"timestamp", time_schema()},
                                       {"position", at},
                                       {"text", kString},
                                       {"font_size", kNumber},
                                       {"text_color", color},
                                       {"background_color", color}});
  return object_of(
      {{"circles", array_of(circle)}, {"points", array_of(points)}, {"texts", array_of(text)}});
}

/// The primitives of a scene entity.
ordered_json primitives() {
  const ordered_json pose = pose_schema(), point = numbers_named("xyz");
  const ordered_json color = numbers_named("rgba"), colors = array_of(color);
  const ordered_json points = array_of(point), indices = array_of(kInteger);
  const ordered_json solid = object_of({{"pose", pose}, {"size", point}, {"color", color}});
  ordered_json cylinder = solid;
  cylinder["properties"]["bottom_scale"] = kNumber;
  cylinder["properties"]["top_scale"] = kNumber;
  return {{"arrows",
           array_of(object_of({{"pose", pose},
                               {"shaft_length", kNumber},
                               {"shaft_diameter", kNumber},
                               {"head_length", kNumber},
                               {"head_diameter", kNumber},
                               {"color", color}}))},
          {"cubes", array_of(solid)},
          {"spheres", array_of(solid)},
          {"cylinders", array_of(cylinder)},
          {"lines",
           array_of(object_of({{"type", enumeration(3)},
                               {"pose", pose},
                               {"thickness", kNumber},
                               {"scale_invariant", kBoolean},
                               {"points", points},
                               {"color", color},
                               {"colors", colors},
                               {"indices", indices}}))},
          {"triangles",
           array_of(object_of({{"pose", pose},
                               {"points", points},
                               {"color", color},
                               {"colors", colors},
                               {"indices", indices}}))},
          {"texts",
           array_of(object_of({{"pose", pose},
                               {"billboard", kBoolean},
                               {"font_size", kNumber},
                               {"scale_invariant", kBoolean},
                               {"color", color},
                               {"text", kString}}))},
          {"models",
           array_of(object_of({{"pose", pose},
                               {"scale", point},
                               {"color", color},
                               {"override_color", kBoolean},
                               {"url", kString},
                               {"media_type", kString},
                               {"data", {{"type", "string"}, {"contentEncoding", "base64"}}}}))}};
}

ordered_json scene_update() {
  const ordered_json deletion =
      object_of({{"timestamp", time_schema()}, {"type", enumeration(2)}, {"id", kString}});
  ordered_json entity =
      object_of({{"timestamp", time_schema()},
                 {"frame_id", kString},
                 {"id", kString},
                 {"lifetime", time_schema("duration")},
                 {"frame_locked", kBoolean},
                 {"metadata", array_of(object_of({{"key", kString}, {"value", kString}}))}});
  entity["properties"].update(primitives());
  return object_of({{"deletions", array_of(deletion)}, {"entities", array_of(entity)}});
}

}  // namespace

ordered_json foxglove_schema(const std::string& type) {
  const std::map<std::string, ordered_json (*)()> kMakers{{"CompressedImage", compressed_image},
                                                          {"CameraCalibration", camera_calibration},
                                                          {"FrameTransform", frame_transform},
                                                          {"PosesInFrame", poses_in_frame},
                                                          {"ImageAnnotations", image_annotations},
                                                          {"SceneUpdate", scene_update}};
  ordered_json schema = kMakers.at(type)();
  schema["title"] = "foxglove." + type;
  return schema;
}

}  // namespace gpo
