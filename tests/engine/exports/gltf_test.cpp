// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/exports/exports.h"
#include "engine/files/byte_cursor.h"
#include "engine/files/image_codec.h"
#include "engine/files/text_file.h"
#include "tests/engine/exports/exported_room.h"
#include "tests/engine/test_folder.h"

#include <cstdlib>
#include <cstring>
#include <sstream>

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace gpo::test {
namespace {

using nlohmann::json;
using testing::AllOf, testing::Contains, testing::HasSubstr, testing::Not;

const Camera kGltfLens{640, 480, 500, 510, 325, 236, Distortion::none, {}};

/// A glTF file, read by the specification alone.
struct GltfFile {
  explicit GltfFile(const std::string& bytes) {
    ByteCursor cursor(bytes);
    EXPECT_EQ(cursor.take(4), "glTF");
    EXPECT_EQ(cursor.number<std::uint32_t>(), 2U);
    EXPECT_EQ(cursor.number<std::uint32_t>(), bytes.size());
    const auto length = cursor.number<std::uint32_t>();
    EXPECT_EQ(cursor.take(4), "JSON");
    EXPECT_EQ(length % 4, 0U);
    root = json::parse(cursor.take(length));
    const auto count = cursor.number<std::uint32_t>();
    EXPECT_EQ(cursor.take(4), std::string_view("BIN\0", 4));
    buffer = std::string(cursor.take(count));
    EXPECT_TRUE(cursor.ok() && !cursor.more());
    EXPECT_EQ(root["buffers"][0]["byteLength"], count);
  }
  std::string view(const json& index) const {
    const json& view = root["bufferViews"][index.get<std::size_t>()];
    return buffer.substr(view["byteOffset"], view["byteLength"]);
  }
  std::vector<float> floats(const json& index) const {
    const json& accessor = root["accessors"][index.get<std::size_t>()];
    EXPECT_EQ(accessor["componentType"], 5126);
    const std::string bytes = view(accessor["bufferView"]);
    std::vector<float> values(bytes.size() / sizeof(float));
    std::memcpy(values.data(), bytes.data(), values.size() * sizeof(float));
    return values;
  }
  json node(const std::string& name) const {
    for (const json& one : root["nodes"])
      if (one["name"] == name) return one;
    ADD_FAILURE() << "no node " << name;
    return {};
  }

  json root;
  std::string buffer;
};

Eigen::Vector3d vector_of(const json& list) {
  const auto values = list.get<std::array<double, 3>>();
  return Eigen::Vector3d(values.data());
}
Eigen::Quaterniond rotation_of(const json& xyzw) {
  const auto values = xyzw.get<std::array<double, 4>>();
  return Eigen::Quaterniond(Eigen::Vector4d(values.data()));
}

struct GltfExport : testing::Test {
  GltfFile exported(const Inspection& room, const ExportChoices& choices = {}) {
    notes = write_export(room, choices, {&export_format("gltf"), file});
    return GltfFile(read_file(file));
  }

  const TestFolder folder;
  const fs::path file = folder.path() / "room.glb";
  ExportNotes notes;
};

TEST_F(GltfExport, CamerasArePlacedAnimatedAndSeeWhatOursSee) {
  const Inspection room = exported_room(kGltfLens);
  const GltfFile gltf = exported(room);
  const auto& cameras = room.initialization->cameras;
  const json& animation = gltf.root["animations"][0];
  const auto times = gltf.floats(animation["samplers"][0]["input"]);
  const auto centers = gltf.floats(animation["samplers"][0]["output"]);
  const auto rotations = gltf.floats(animation["samplers"][1]["output"]);
  ASSERT_EQ(times.size(), cameras.size());
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    const json node = gltf.node(fmt::format("frame {}", i));
    EXPECT_LT((vector_of(node["translation"]) - cameras[i].p_wc).norm(), 1e-9);
    // glTF: x right, y up, looking along -z.
    const Eigen::Matrix3d R = rotation_of(node["rotation"]).matrix();
    EXPECT_LT((R.col(2) + cameras[i].R_wc.col(2)).norm(), 1e-9);
    EXPECT_LT((R.col(1) + cameras[i].R_wc.col(1)).norm(), 1e-9);
    EXPECT_NEAR(times[i], 0.033 * static_cast<double>(i), 1e-6);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(centers[3 * i + k], cameras[i].p_wc[k], 1e-6);
    const Eigen::Quaterniond moving(
        rotations[4 * i + 3], rotations[4 * i], rotations[4 * i + 1], rotations[4 * i + 2]);
    EXPECT_LT((moving.matrix() - R).norm(), 1e-5);
  }
  const json& lens = gltf.root["cameras"][0]["perspective"];
  EXPECT_NEAR(lens["yfov"], 2 * std::atan(240.0 / 510), 1e-9);
  EXPECT_NEAR(lens["aspectRatio"], 640 * 510 / (480.0 * 500), 1e-9);
}

TEST_F(GltfExport, PlanesAreTexturedQuadsWithThePointsOnThem) {
  const Inspection room = exported_room(kGltfLens);
  const GltfFile gltf = exported(room);
  for (const auto& [name, plane] : {std::pair("plane 1", kRoomFloor), {"plane 2", kRoomWall}}) {
    const json mesh = gltf.root["meshes"][gltf.node(name)["mesh"].get<std::size_t>()];
    const json& primitive = mesh["primitives"][0];
    const auto corners = gltf.floats(primitive["attributes"]["POSITION"]);
    ASSERT_EQ(corners.size(), 12U);
    for (int k = 0; k < 4; ++k)
      EXPECT_NEAR(
          plane.normal.dot(Eigen::Vector3f(&corners[3 * k]).cast<double>()) + plane.distance,
          0,
          1e-5);
    const json& material = gltf.root["materials"][primitive["material"].get<std::size_t>()];
    const json& texture =
        gltf.root["textures"]
                 [material["pbrMetallicRoughness"]["baseColorTexture"]["index"].get<std::size_t>()];
    const json& image = gltf.root["images"][texture["source"].get<std::size_t>()];
    EXPECT_FALSE(decode_png(gltf.view(image["bufferView"])).empty());
  }
  const json points = gltf.root["meshes"][gltf.node("points")["mesh"].get<std::size_t>()];
  const json& accessor =
      gltf.root["accessors"][points["primitives"][0]["attributes"]["POSITION"].get<std::size_t>()];
  EXPECT_EQ(accessor["count"], room.window->track_count() - 1);
  EXPECT_EQ(gltf.node("cube on plane 2")["name"], "cube on plane 2");
}

TEST_F(GltfExport, NamesWhatItsCamerasLack) {
  const auto distortion = HasSubstr("left out: lens distortion");
  const auto center = HasSubstr("left out: principal point");
  exported(exported_room({640, 480, 400, 410, 325, 236, Distortion::radial_tangential, {0.1, 0}}));
  EXPECT_THAT(notes, AllOf(Contains(distortion), Contains(center)));
  exported(
      exported_room({640, 480, 400, 410, 319.5, 239.5, Distortion::radial_tangential, {0, 0}}));
  EXPECT_THAT(notes, AllOf(Not(Contains(distortion)), Not(Contains(center))));
}

TEST_F(GltfExport, UpIsTheFloorsNormalTheWorldsOrGravitys) {
  Inspection room = exported_room(kGltfLens);
  const auto up_in_gltf = [&](const GltfFile& gltf, const Eigen::Vector3d& up) {
    return Eigen::Vector3d(rotation_of(gltf.node("world")["rotation"]) * up);
  };
  const Eigen::Vector3d y = Eigen::Vector3d::UnitY();
  GltfFile gltf = exported(room);
  EXPECT_LT((up_in_gltf(gltf, kRoomFloor.normal) - y).norm(), 1e-9);
  EXPECT_TRUE(gltf.root["asset"]["extras"]["meters_per_world_unit"].is_null());
  EXPECT_THAT(notes, Contains(HasSubstr("unit = distance of the plane; up = normal")));
  InertialAlignment inertial;
  inertial.ok = inertial.scale_known = true;
  inertial.scale = 0.8;
  inertial.gravity_m_s2 = Eigen::Vector3d(0.5, 9.7, 0.3);
  room.inertial = inertial;
  gltf = exported(room);
  EXPECT_LT((up_in_gltf(gltf, -inertial.gravity_m_s2.normalized()) - y).norm(), 1e-9);
  EXPECT_NEAR(gltf.node("world")["scale"][0], 0.8, 1e-12);
  EXPECT_EQ(gltf.root["asset"]["extras"]["unit"], "meter");
  gltf = exported(room, {.metric = true});
  EXPECT_NEAR(gltf.node("world")["scale"][0], 1, 1e-12) << "the world is in meters already";
  EXPECT_LT(
      (vector_of(gltf.node("frame 2")["translation"]) - 0.8 * room.initialization->cameras[2].p_wc)
          .norm(),
      1e-9);
  room.chosen_world = ChosenWorld{{so3_exp({0.3, -0.2, 0.5}), {1, 2, 3}}, ""};
  gltf = exported(room);
  EXPECT_LT((up_in_gltf(gltf, Eigen::Vector3d::UnitZ()) - y).norm(), 1e-9);
}

/// Returns the 16 numbers of a node's matrix in a dump of assimp.
Eigen::Matrix4d matrix_in_dump(const std::string& xml, const std::string& name) {
  const std::size_t at = xml.find("<Node name=\"" + name + "\"");
  EXPECT_NE(at, std::string::npos) << name;
  const std::size_t begin = xml.find("<Matrix4>", at) + 9;
  std::istringstream words(xml.substr(begin, xml.find("</Matrix4>", begin) - begin));
  Eigen::Matrix4d matrix;
  for (int k = 0; k < 16; ++k) words >> matrix(k / 4, k % 4);
  return matrix;
}

TEST_F(GltfExport, AssimpReadsTheSameCameras) {
  if (std::system("command -v assimp > /dev/null") != 0)
    GTEST_SKIP() << "assimp is not installed (package assimp-utils)";
  const Inspection room = exported_room(kGltfLens);
  exported(room);
  const fs::path dump = folder.path() / "dump.assxml";
  const std::string command = fmt::format(
      "assimp dump '{}' '{}' > '{}' 2>&1", file.string(), dump.string(), dump.string() + ".log");
  ASSERT_EQ(std::system(command.c_str()), 0) << read_file(dump.string() + ".log");
  const std::string xml = read_file(dump);
  const Eigen::Matrix4d world = matrix_in_dump(xml, "world");
  const Eigen::Vector3d row_of_y = world.block(1, 0, 1, 3).transpose();
  EXPECT_NEAR(row_of_y.dot(kRoomFloor.normal), 1, 1e-5) << "y is up";
  const auto& cameras = room.initialization->cameras;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    const Eigen::Matrix4d node = matrix_in_dump(xml, fmt::format("frame {}", i));
    EXPECT_LT((node.block<3, 1>(0, 3) - cameras[i].p_wc).norm(), 1e-5);
    EXPECT_LT((node.block<3, 1>(0, 2) + cameras[i].R_wc.col(2)).norm(), 1e-5);
  }
  EXPECT_THAT(xml, HasSubstr("<Animation name=\"camera\""));
}

TEST_F(GltfExport, BlenderReadsTheSameCamerasAndTheirAnimation) {
  if (std::system("command -v blender > /dev/null") != 0)
    GTEST_SKIP() << "blender is not installed (package blender)";
  const Inspection room = exported_room(kGltfLens);
  const GltfFile gltf = exported(room);
  const fs::path log = folder.path() / "blender.log";
  const std::string command =
      fmt::format("blender --background --python-exit-code 1 --python '{}' -- '{}' > '{}' 2>&1",
                  GPO_SOURCE_DIR "/tests/engine/exports/blender_cameras.py",
                  file.string(),
                  log.string());
  ASSERT_EQ(std::system(command.c_str()), 0) << read_file(log);
  const std::string printed = read_file(log);
  const std::size_t begin = printed.find("CAMERAS ") + 8;
  const json found = json::parse(printed.substr(begin, printed.find('\n', begin) - begin));
  const Eigen::Matrix3d R_gltf_world = rotation_of(gltf.node("world")["rotation"]).matrix();
  const auto& cameras = room.initialization->cameras;
  ASSERT_EQ(found["path"].size(), cameras.size());
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    const std::string name = fmt::format("frame {}", i);
    const Eigen::Vector3d center = R_gltf_world * cameras[i].p_wc;
    EXPECT_LT((vector_of(found["centers"][name]) - center).norm(), 1e-5);
    EXPECT_LT((vector_of(found["path"][i]) - center).norm(), 1e-4);
    EXPECT_LT((vector_of(found["directions"][name]) - R_gltf_world * cameras[i].R_wc.col(2)).norm(),
              1e-5);
  }
  EXPECT_NEAR(found["yfov_rad"], 2 * std::atan(240.0 / 510), 1e-5);
  EXPECT_EQ(found["images"], 2) << "both planes have a texture";
}

}  // namespace
}  // namespace gpo::test
