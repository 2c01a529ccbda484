// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/exports/scene.h"
#include "engine/files/text_file.h"

#include <map>

namespace gpo {
namespace {

using nlohmann::ordered_json;

/// The fields of Foxglove's types as NAME:TYPE. TYPE[] is a list, TYPE[9] a list of nine, and enum3
/// one of the numbers 0, 1 and 2.
const std::map<std::string, std::string> kFoxgloveTypes{
    {"Point2", "x:number y:number"},
    {"Vector3", "x:number y:number z:number"},
    {"Quaternion", "x:number y:number z:number w:number"},
    {"Color", "r:number g:number b:number a:number"},
    {"Pose", "position:Vector3 orientation:Quaternion"},
    {"KeyValuePair", "key:string value:string"},
    {"CompressedImage", "timestamp:time frame_id:string data:base64 format:string"},
    {"CameraCalibration",
     "timestamp:time frame_id:string width:integer height:integer distortion_model:string "
     "D:number[] K:number[9] R:number[9] P:number[12]"},
    {"FrameTransform",
     "timestamp:time parent_frame_id:string child_frame_id:string translation:Vector3 "
     "rotation:Quaternion"},
    {"PosesInFrame", "timestamp:time frame_id:string poses:Pose[]"},
    {"ImageAnnotations",
     "circles:CircleAnnotation[] points:PointsAnnotation[] texts:TextAnnotation[]"},
    {"CircleAnnotation",
     "timestamp:time position:Point2 diameter:number thickness:number fill_color:Color "
     "outline_color:Color"},
    {"PointsAnnotation",
     "timestamp:time type:enum5 points:Point2[] outline_color:Color outline_colors:Color[] "
     "fill_color:Color thickness:number"},
    {"TextAnnotation",
     "timestamp:time position:Point2 text:string font_size:number text_color:Color "
     "background_color:Color"},
    {"SceneUpdate", "deletions:SceneEntityDeletion[] entities:SceneEntity[]"},
    {"SceneEntityDeletion", "timestamp:time type:enum2 id:string"},
    {"SceneEntity",
     "timestamp:time frame_id:string id:string lifetime:duration frame_locked:boolean "
     "metadata:KeyValuePair[] arrows:ArrowPrimitive[] cubes:CubePrimitive[] "
     "spheres:SpherePrimitive[] cylinders:CylinderPrimitive[] lines:LinePrimitive[] "
     "triangles:TriangleListPrimitive[] texts:TextPrimitive[] models:ModelPrimitive[]"},
    {"ArrowPrimitive",
     "pose:Pose shaft_length:number shaft_diameter:number head_length:number head_diameter:number "
     "color:Color"},
    {"CubePrimitive", "pose:Pose size:Vector3 color:Color"},
    {"SpherePrimitive", "pose:Pose size:Vector3 color:Color"},
    {"CylinderPrimitive",
     "pose:Pose size:Vector3 color:Color bottom_scale:number top_scale:number"},
    {"LinePrimitive",
     "type:enum3 pose:Pose thickness:number scale_invariant:boolean points:Vector3[] color:Color "
     "colors:Color[] indices:integer[]"},
    {"TriangleListPrimitive",
     "pose:Pose points:Vector3[] color:Color colors:Color[] indices:integer[]"},
    {"TextPrimitive",
     "pose:Pose billboard:boolean font_size:number scale_invariant:boolean color:Color "
     "text:string"},
    {"ModelPrimitive",
     "pose:Pose scale:Vector3 color:Color override_color:boolean url:string media_type:string "
     "data:base64"}};

ordered_json schema_of(const std::string& type) {
  if (type == "base64") return {{"type", "string"}, {"contentEncoding", "base64"}};
  if (type == "time" || type == "duration")
    return {{"type", "object"},
            {"properties",
             {{"sec", {{"type", "integer"}, {"minimum", 0}}},
              {"nsec", {{"type", "integer"}, {"minimum", 0}, {"maximum", 999999999}}}}},
            {"title", type}};
  ordered_json schema;
  if (type.starts_with("enum")) {
    for (int value = 0; value < type.back() - '0'; ++value)
      schema["oneOf"].push_back({{"const", value}});
  } else if (const std::size_t bracket = type.find('['); bracket != std::string::npos) {
    schema = {{"type", "array"}, {"items", schema_of(type.substr(0, bracket))}};
    const auto count = parse_integer(type.substr(bracket + 1, type.size() - bracket - 2));
    if (count) schema.update({{"minItems", *count}, {"maxItems", *count}});
  } else if (const auto fields = kFoxgloveTypes.find(type); fields != kFoxgloveTypes.end()) {
    schema["type"] = "object";
    for (const std::string& field : split(fields->second, ' ')) {
      const std::size_t colon = field.find(':');
      schema["properties"][field.substr(0, colon)] = schema_of(field.substr(colon + 1));
    }
  } else {
    schema["type"] = type;
  }
  return schema;
}

}  // namespace

ordered_json foxglove_schema(const std::string& type) {
  ordered_json schema = schema_of(type);
  schema["title"] = "foxglove." + type;
  return schema;
}

}  // namespace gpo
