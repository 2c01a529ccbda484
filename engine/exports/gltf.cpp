// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// The scene as glTF 2.0 (https://registry.khronos.org/glTF/specs/2.0/glTF-2.0.html). A root node
// turns and scales the world of the export to glTF's: y up, meters.
#include "engine/base/error.h"
#include "engine/exports/scene.h"
#include "engine/files/image_codec.h"
#include "engine/inspection/studies/studies.h"
#include "engine/recording/layouts/write_recording.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>
#include <fmt/format.h>

namespace gpo {
namespace {

using Eigen::Matrix3d, Eigen::Vector3d, Eigen::Vector4d;
using nlohmann::ordered_json;

enum Mode { points = 0, lines = 1, line_strip = 3, triangles = 4 };
enum Component { unsigned_byte = 5121, unsigned_short = 5123, floating = 5126 };

/// Chunks and buffer views begin at multiples of four bytes.
std::string aligned_to_four(std::string bytes, char filler) {
  bytes.resize((bytes.size() + 3) / 4 * 4, filler);
  return bytes;
}

/// A file in the making: JSON and one binary buffer. Indices are those of its lists.
class Glb {
 public:
  ordered_json json;

  /// Appends an element to a list of the file. Returns its index.
  int add(const char* list, ordered_json element) {
    json[list].push_back(std::move(element));
    return static_cast<int>(json[list].size()) - 1;
  }

  /// Appends vectors of one size. `bounds`: adds smallest and largest values, which positions and
  /// times need.
  template <int size>
  int add_vectors(const std::vector<Eigen::Vector<double, size>>& vectors, bool bounds) {
    std::vector<float> stored;
    for (const auto& vector : vectors) stored.insert(stored.end(), vector.begin(), vector.end());
    constexpr std::array kTypes{"SCALAR", "VEC2", "VEC3", "VEC4"};
    ordered_json accessor{{"componentType", Component::floating}, {"type", kTypes[size - 1]}};
    for (std::size_t k = 0; bounds && k < size; ++k) {
      float least = stored[k], most = stored[k];
      for (std::size_t i = k; i < stored.size(); i += size) {
        least = std::min(least, stored[i]);
        most = std::max(most, stored[i]);
      }
      accessor["min"].push_back(least);
      accessor["max"].push_back(most);
    }
    return add_values(stored, size, std::move(accessor));
  }
  int add_colors(const std::vector<std::uint8_t>& rgba) {  ///< four values per color
    return add_values(
        rgba,
        4,
        {{"componentType", Component::unsigned_byte}, {"type", "VEC4"}, {"normalized", true}});
  }
  int add_indices(const std::vector<std::uint16_t>& indices) {
    return add_values(
        indices, 1, {{"componentType", Component::unsigned_short}, {"type", "SCALAR"}});
  }
  int add_png(std::string_view png) {  ///< returns the index of a texture
    const int image = add("images", {{"bufferView", add_view(png)}, {"mimeType", "image/png"}});
    return add("textures", {{"source", image}});
  }

  std::string bytes() const {
    constexpr std::uint32_t kVersion = 2, kHeaderBytes = 12, kChunkHeadBytes = 8;
    const std::string binary = aligned_to_four(buffer_, '\0');
    ordered_json whole = json;
    whole["buffers"] = ordered_json::array({{{"byteLength", binary.size()}}});
    const std::string text = aligned_to_four(whole.dump(), ' ');
    const std::size_t length = kHeaderBytes + 2 * kChunkHeadBytes + text.size() + binary.size();
    std::string bytes = "glTF";
    put_numbers(bytes,
                kVersion,
                static_cast<std::uint32_t>(length),
                static_cast<std::uint32_t>(text.size()));
    bytes += "JSON" + text;
    put_numbers(bytes, static_cast<std::uint32_t>(binary.size()));
    return bytes + std::string("BIN\0", 4) + binary;
  }

 private:
  int add_view(std::string_view bytes) {
    buffer_ = aligned_to_four(std::move(buffer_), '\0');
    const std::size_t begin = buffer_.size();
    buffer_ += bytes;
    return add("bufferViews", {{"buffer", 0}, {"byteOffset", begin}, {"byteLength", bytes.size()}});
  }

  template <class Value>
  int add_values(const std::vector<Value>& values, std::size_t size, ordered_json accessor) {
    accessor["bufferView"] =
        add_view({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Value)});
    accessor["count"] = values.size() / size;
    return add("accessors", std::move(accessor));
  }

  std::string buffer_;
};

struct UpAxis {
  Vector3d direction = Vector3d::UnitZ();  ///< in the world of the export
  const char* source = "";
};

UpAxis up_axis(const ExportScene& scene) {
  const Inspection& inspection = scene.inspection;
  const Matrix3d& R = scene.world.T_world_reference.R_ab;
  if (inspection.chosen_world) return {Vector3d::UnitZ(), "z axis of the chosen world"};
  if (inspection.inertial && inspection.inertial->ok)
    return {R * -inspection.inertial->gravity_m_s2.normalized(), "gravity"};
  return {R * inspection.initialization->plane.normal, "normal of the leading plane"};
}

/// Returns the rotation to axes with y up and x as near as possible to the export's.
Matrix3d rotation_to_y_up(const Vector3d& up) {
  Vector3d x = Vector3d::UnitX() - up.x() * up;
  if (x.norm() < 0.1) x = up.unitOrthogonal();
  x.normalize();
  Matrix3d R;
  R << x.transpose(), up.transpose(), x.cross(up).transpose();
  return R;
}

Vector4d xyzw(const Matrix3d& R) { return Eigen::Quaterniond(R).normalized().coeffs(); }

ordered_json list_of(const auto& vector) {
  return std::vector<double>(vector.begin(), vector.end());
}

/// glTF's cameras look along -z, with y up.
Matrix3d gltf_camera_rotation(const Pose& camera) {
  return camera.R_wc * Vector3d(1, -1, -1).asDiagonal();
}

std::vector<double> linear_rgba(std::uint32_t rgb, double alpha) {
  std::vector<double> rgba;
  for (const int shift : {16, 8, 0}) {
    const double s = ((rgb >> shift) & 0xFF) / 255.0;  // sRGB, while glTF's factors are linear
    rgba.push_back(s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4));
  }
  rgba.push_back(alpha);
  return rgba;
}

class SceneFile {
 public:
  explicit SceneFile(const ExportScene& scene) : scene_(scene) {}

  std::string bytes() {
    const auto scale = known_scale(scene_.inspection);
    const UpAxis up = up_axis(scene_);
    const double meters =  // per unit of the export
        scene_.world.meters ? 1 : scale.value_or(1);
    file_.json = {
        {"asset",
         {{"version", "2.0"},
          {"generator", "gpo-inspector"},
          {"extras",
           {{"recording", scene_.inspection.recording->name},
            {"world", scene_.world.description()},
            {"unit", is_metric() ? "meter" : "distance of the leading plane"},
            {"meters_per_world_unit", is_metric() ? ordered_json(meters) : ordered_json()},
            {"up", up.source}}}}},
        {"scene", 0},
        {"extensionsUsed", ordered_json::array({"KHR_materials_unlit"})}};
    add_planes();
    add_points();
    add_cubes();
    add_cameras();
    add_path();
    const int root = file_.add("nodes",
                               {{"name", "world"},
                                {"rotation", list_of(xyzw(rotation_to_y_up(up.direction)))},
                                {"scale", {meters, meters, meters}},
                                {"children", children_}});
    file_.add(
        "scenes",
        {{"name", scene_.inspection.recording->name}, {"nodes", ordered_json::array({root})}});
    return file_.bytes();
  }
  bool is_metric() const { return scene_.world.meters || known_scale(scene_.inspection); }
  std::string up_source() const { return up_axis(scene_).source; }

 private:
  int material(const char* name, const std::vector<double>& rgba, std::optional<int> texture = {}) {
    ordered_json made{{"name", name},
                      {"pbrMetallicRoughness",
                       {{"baseColorFactor", rgba}, {"metallicFactor", 0}, {"roughnessFactor", 1}}},
                      {"doubleSided", true},
                      {"extensions", {{"KHR_materials_unlit", ordered_json::object()}}}};
    if (texture) made["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", *texture}};
    if (texture || rgba[3] < 1) made["alphaMode"] = "BLEND";
    return file_.add("materials", std::move(made));
  }

  void add_mesh(const std::string& name, ordered_json primitives) {
    const int mesh = file_.add("meshes", {{"name", name}, {"primitives", std::move(primitives)}});
    children_.push_back(file_.add("nodes", {{"name", name}, {"mesh", mesh}}));
  }

  void add_planes() {
    for (const ScenePlane& plane : scene_.planes) {
      const cv::Mat image = rectified_image(scene_, plane);
      std::optional<int> texture;
      if (!image.empty()) texture = file_.add_png(encode_png(image));
      const std::vector<double> color =
          texture ? std::vector<double>{1, 1, 1, 1} : linear_rgba(plane.rgb, 0.4);
      const std::vector<Vector3d> corners(plane.corners.begin(), plane.corners.end());
      const std::vector<Eigen::Vector2d> coordinates{{0, 1}, {1, 1}, {1, 0}, {0, 0}};
      ordered_json primitive{
          {"attributes",
           {{"POSITION", file_.add_vectors(corners, true)},
            {"NORMAL", file_.add_vectors(std::vector<Vector3d>(4, plane.normal), false)},
            {"TEXCOORD_0", file_.add_vectors(coordinates, false)}}},
          {"indices", file_.add_indices({0, 1, 2, 0, 2, 3})},
          {"mode", Mode::triangles},
          {"material", material(plane.title.c_str(), color, texture)}};
      add_mesh(plane.title, ordered_json::array({std::move(primitive)}));
    }
  }

  void add_points() {
    if (scene_.points.empty()) return;
    std::vector<Vector3d> positions;
    std::vector<std::uint8_t> colors;
    for (const ScenePoint& point : scene_.points) {
      positions.push_back(point.position);
      colors.insert(colors.end(), point.color.begin(), point.color.end());
      colors.push_back(255);
    }
    ordered_json primitive{
        {"attributes",
         {{"POSITION", file_.add_vectors(positions, true)}, {"COLOR_0", file_.add_colors(colors)}}},
        {"mode", Mode::points},
        {"material", material("points", {1, 1, 1, 1})}};
    add_mesh("points", ordered_json::array({std::move(primitive)}));
  }

  void add_cubes() {
    for (const SceneCube& cube : scene_.cubes) {
      const std::vector<Vector3d> corners(cube.corners.begin(), cube.corners.end());
      const int positions = file_.add_vectors(corners, true);
      const std::vector<std::uint16_t> faces{0, 1, 3, 0, 3, 2, 4, 6, 7, 4, 7, 5, 0, 4, 5, 0, 5, 1,
                                             2, 3, 7, 2, 7, 6, 0, 2, 6, 0, 6, 4, 1, 5, 7, 1, 7, 3};
      const std::vector<std::uint16_t> edges{0, 1, 2, 3, 4, 5, 6, 7, 0, 2, 1, 3,
                                             4, 6, 5, 7, 0, 4, 1, 5, 2, 6, 3, 7};
      const std::uint32_t rgb = plane_color(cube.plane);
      const ordered_json attributes{{"POSITION", positions}};
      const std::string name = fmt::format("cube on plane {}", cube.plane + 1);
      ordered_json solid{{"attributes", attributes},
                         {"indices", file_.add_indices(faces)},
                         {"mode", Mode::triangles},
                         {"material", material("cube", linear_rgba(rgb, 0.3))}};
      ordered_json wire{{"attributes", attributes},
                        {"indices", file_.add_indices(edges)},
                        {"mode", Mode::lines},
                        {"material", material("cube edges", linear_rgba(rgb, 1))}};
      add_mesh(name, ordered_json::array({std::move(solid), std::move(wire)}));
    }
  }

  /// One node per frame, and one that moves along them. The principal point is not in glTF.
  void add_cameras() {
    const Inspection& inspection = scene_.inspection;
    const Camera& lens = inspection.recording->camera;
    const double height = lens.height > 0 ? lens.height : 2 * lens.cy + 1;
    const double width = lens.width > 0 ? lens.width : 2 * lens.cx + 1;
    const int camera =
        file_.add("cameras",
                  {{"type", "perspective"},
                   {"perspective",
                    {{"yfov", 2 * std::atan(height / (2 * lens.fy))},
                     {"aspectRatio", width * lens.fy / (height * lens.fx)},
                     {"znear", 0.01},
                     {"zfar", 1000}}},
                   {"extras", {{"cx_px", lens.cx}, {"cy_px", lens.cy}, {"width_px", width}}}});
    std::vector<Vector3d> centers;
    std::vector<Vector4d> rotations;
    std::vector<Eigen::Vector<double, 1>> seconds;
    SteadyQuaternions steady;
    const auto& times = inspection.window->timestamps_ns;
    for (std::size_t i = 0; i < scene_.cameras.size(); ++i) {
      centers.push_back(scene_.cameras[i].p_wc);
      rotations.emplace_back(steady(gltf_camera_rotation(scene_.cameras[i])).coeffs());
      seconds.emplace_back(1e-9 * static_cast<double>(times[i] - times.front()));
      children_.push_back(file_.add(
          "nodes",
          {{"name", fmt::format("frame {}", inspection.window->start + static_cast<int>(i))},
           {"camera", camera},
           {"translation", list_of(centers.back())},
           {"rotation", list_of(rotations.back())}}));
    }
    const int moving = file_.add("nodes",
                                 {{"name", "moving camera"},
                                  {"camera", camera},
                                  {"translation", list_of(centers.front())},
                                  {"rotation", list_of(rotations.front())}});
    children_.push_back(moving);
    const int input = file_.add_vectors(seconds, true);
    const auto sampler = [&](int output) {
      return ordered_json{{"input", input}, {"output", output}, {"interpolation", "LINEAR"}};
    };
    const auto channel = [&](int index, const char* path) {
      return ordered_json{{"sampler", index}, {"target", {{"node", moving}, {"path", path}}}};
    };
    file_.add(
        "animations",
        {{"name", "camera"},
         {"samplers",
          ordered_json::array({sampler(file_.add_vectors(centers, false)),
                               sampler(file_.add_vectors(rotations, false))})},
         {"channels", ordered_json::array({channel(0, "translation"), channel(1, "rotation")})}});
  }

  void add_path() {
    std::vector<Vector3d> centers;
    for (const Pose& camera : scene_.cameras) centers.push_back(camera.p_wc);
    if (centers.size() < 2) return;
    const std::uint32_t rgb = scene_.inspection.settings.options.method.row().rgb;
    ordered_json primitive{{"attributes", {{"POSITION", file_.add_vectors(centers, true)}}},
                           {"mode", Mode::line_strip},
                           {"material", material("camera path", linear_rgba(rgb, 1))}};
    add_mesh("camera path", ordered_json::array({std::move(primitive)}));
  }

  const ExportScene& scene_;
  Glb file_;
  std::vector<int> children_;
};

}  // namespace

std::string gltf_bytes(const ExportScene& scene, ExportNotes& notes) {
  SceneFile file(scene);
  std::string bytes = file.bytes();
  notes.push_back(fmt::format("{}, {}, {}, {}; unit = {}; up = {}",
                              counted(scene.cameras.size(), "camera"),
                              counted(scene.planes.size(), "plane"),
                              counted(scene.points.size(), "point"),
                              counted(scene.cubes.size(), "cube"),
                              file.is_metric() ? "meter" : "distance of the plane",
                              file.up_source()));
  for (const std::string& left_out : scene.left_out) notes.push_back("left out: " + left_out);
  const Camera& camera = scene.inspection.recording->camera;
  if (has_distortion(camera))
    notes.emplace_back("left out: lens distortion of the cameras, which glTF lacks");
  if (camera.cx != (camera.width - 1) / 2. || camera.cy != (camera.height - 1) / 2.)
    notes.emplace_back("left out: principal point, which glTF has in the middle of the image");
  return bytes;
}

}  // namespace gpo
