// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/model/solid_model.h"

#include "engine/base/error.h"
#include "engine/files/output_file.h"
#include "tests/engine/test_folder.h"
#include "tests/ui/made_inspection.h"

#include <algorithm>
#include <cstring>

#include <Eigen/Geometry>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace gpo {
namespace {

using Eigen::Vector3d;
using testing::HasSubstr;

Eigen::AlignedBox3d box_of(const std::vector<Vector3d>& points) {
  Eigen::AlignedBox3d box;
  for (const Vector3d& point : points) box.extend(point);
  return box;
}

std::string error_of(const std::string& file) {
  return test::error_of([&] { read_solid_model(file); });
}

/// A wedge 4 wide (x), 2 deep and 3 high, with a low front at z = 2; y is up.
constexpr const char* kWedgeObj =
    "v 10 5 0\nv 14 5 0\nv 14 5 2\nv 10 5 2\nv 10 8 0\nv 14 8 0\n"
    "f 1 2 3 4\nf 1 5 6 2\nf 4 3 6 5\nf 1 4 5\nf 2 6 3\n";

TEST(SolidModel, StandsOnItsFootAndIsOneSideWide) {
  const test::TestFolder folder;
  write_file(folder.path() / "wedge.obj", kWedgeObj);
  const SolidModel model = read_solid_model(folder.path() / "wedge.obj");
  EXPECT_EQ(model.triangles.size(), 8U);
  const auto box = box_of(model.points);
  EXPECT_LT((box.min() - Vector3d(-0.5, -0.25, 0)).norm(), 1e-6);
  EXPECT_LT((box.max() - Vector3d(0.5, 0.25, 0.75)).norm(), 1e-6);
  EXPECT_NEAR(model.height_sides, 0.75, 1e-6);
  for (const Vector3d& point : model.points)
    EXPECT_TRUE(point.z() < 0.5 || point.y() > 0) << "the low front, z of the file, is at -y";
  EXPECT_EQ(lit_rgb(model, 0, 0xFFFFFF) >> 16, lit_rgb(model, 0, 0xFFFFFF) & 0xFF);
}

TEST(SolidModel, IsNotMirroredOnThePlane) {
  const Inspection inspection = made_inspection();
  const auto corners = cube_corners(*inspection.cube, 0.3);
  SolidModel model = read_solid_model("robot");
  const auto placed = placed_on(model, corners);
  const auto volume = [&](const std::vector<Vector3d>& points) {
    double sum = 0;
    for (const auto& [a, b, c] : model.triangles) sum += points[a].dot(points[b].cross(points[c]));
    return sum / 6;
  };
  EXPECT_GT(volume(model.points), 0) << "triangles are counterclockwise from outside";
  EXPECT_NEAR(volume(placed), 0.3 * 0.3 * 0.3 * volume(model.points), 1e-6);
  const Plane& plane = inspection.initialization->plane;
  double lowest = 1, highest = 0;
  for (const Vector3d& point : placed) {
    const double above = plane.normal.dot(point) + plane.distance;
    lowest = std::min(lowest, above);
    highest = std::max(highest, above);
  }
  EXPECT_NEAR(lowest, 0, 1e-9);
  EXPECT_NEAR(highest, 0.3 * model.height_sides, 1e-9);
}

TEST(SolidModel, ReadsColorsOfAPlyWithZUp) {
  const test::TestFolder folder;
  write_file(folder.path() / "one.ply",
             "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
             "property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
             "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
             "0 0 0 255 0 9\n2 0 0 255 0 9\n0 0 4 255 0 9\n3 0 1 2\n");
  const SolidModel model = read_solid_model(folder.path() / "one.ply");
  EXPECT_NEAR(model.height_sides, 2, 1e-6);
  ASSERT_EQ(model.rgb.size(), 1U);
  EXPECT_EQ(model.rgb[0], 0xFF0009U);
}

/// Returns a .glb (glTF 2.0) with a triangle that a node moves and scales.
std::string small_glb() {
  const std::array<float, 9> points = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  std::string json =
      R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],)"
      R"("nodes":[{"mesh":0,"translation":[0,7,0],"scale":[2,4,2]}],)"
      R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],)"
      R"("accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3",)"
      R"("min":[0,0,0],"max":[1,1,0]}],)"
      R"("bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36}]})";
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const auto word = [](std::size_t value) {
    const auto number = static_cast<std::uint32_t>(value);
    std::string bytes(4, '\0');
    std::memcpy(bytes.data(), &number, 4);
    return bytes;
  };
  std::string binary(36, '\0');
  std::memcpy(binary.data(), points.data(), 36);
  return "glTF" + word(2) + word(12 + 8 + json.size() + 8 + 36) + word(json.size()) + "JSON" +
         json + word(36) + std::string("BIN\0", 4) + binary;
}

TEST(SolidModel, AppliesTheNodesOfAGltf) {
  const test::TestFolder folder;
  write_file(folder.path() / "one.glb", small_glb());
  const SolidModel model = read_solid_model(folder.path() / "one.glb");
  EXPECT_EQ(model.triangles.size(), 1U);
  EXPECT_NEAR(model.height_sides, 2, 1e-6);
}

TEST(SolidModel, ReportsWhyAFileCannotBeRead) {
  const test::TestFolder folder;
  const auto in_folder = [&](const std::string& name, const std::string& text) {
    write_file(folder.path() / name, text);
    return (folder.path() / name).string();
  };
  EXPECT_THAT(error_of("statue.stl"), HasSubstr("statue.stl: expected .obj, .ply, .gltf or .glb"));
  EXPECT_THAT(error_of("nowhere.obj"), HasSubstr("nowhere.obj: no such file"));
  for (const char* name : {"empty.obj", "empty.ply", "empty.gltf", "empty.glb"})
    EXPECT_THAT(error_of(in_folder(name, "")), HasSubstr("no triangles found")) << name;
  for (const char* name : {"text.obj", "text.ply", "text.gltf", "text.glb"})
    EXPECT_THAT(error_of(in_folder(name, "what is this?\n")), HasSubstr("no triangles")) << name;
  EXPECT_THAT(error_of(in_folder("point.obj", "v 1 1 1\nf 1 1 1\n")), HasSubstr("point.obj: "));
  EXPECT_THAT(error_of(in_folder("hole.obj", "v 1 1 1\nf 1 2 99\n")),
              HasSubstr("hole.obj: a triangle refers to point 2 of 1"));
}

}  // namespace
}  // namespace gpo
