// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/exports/exports.h"

#include "engine/exports/scene.h"
#include "engine/files/image_codec.h"
#include "engine/files/text_file.h"
#include "engine/recording/bags/messages.h"
#include "engine/results/result_method.h"
#include "tests/engine/exports/exported_room.h"
#include "tests/engine/test_folder.h"

#include <set>

#include <fmt/format.h>
#include <gmock/gmock.h>

namespace gpo::test {
namespace {

using nlohmann::ordered_json;
using testing::Contains, testing::HasSubstr;

const Camera kRoomLens{
    640, 480, 500, 510, 325, 236, Distortion::radial_tangential, {-0.1, 0.02, 0.001, -0.002}};

TEST(Exports, UnknownFormatListsTheFormats) {
  EXPECT_EQ(error_of([] { export_format("obj"); }),
            "export format: found 'obj', expected one of colmap, gltf, ply, foxglove, tum, euroc, "
            "kitti");
  EXPECT_THAT(error_of([] { parse_export("colmap"); }),
              HasSubstr("--export: found 'colmap', expected FORMAT=PATH with a format of colmap,"));
  EXPECT_THAT(error_of([] { parse_export("ply=-"); }), HasSubstr("expected a file or a folder"));
  EXPECT_EQ(error_of([] { parse_export("colmap=model,gltf=a.glb"); }),
            "--export: found 'colmap=model,gltf=a.glb', expected one FORMAT=PATH; repeat --export "
            "for gltf");
  const ExportRequest request = parse_export("gltf=a=b.glb");
  EXPECT_STREQ(request.format->key, "gltf");
  EXPECT_EQ(request.path, "a=b.glb");
}

TEST(Exports, RefusesFullFoldersAndFailures) {
  const TestFolder folder;
  const fs::path kept = folder.write("full/kept.txt", "kept");
  const Inspection room = exported_room(kRoomLens);
  const ExportRequest request{&export_format("colmap"), kept.parent_path()};
  EXPECT_THAT(error_of([&] { check_export(request); }), HasSubstr("full"));
  EXPECT_THAT(error_of([&] { write_export(room, {}, request); }), HasSubstr("full"));
  EXPECT_EQ(read_file(kept), "kept");
  Inspection failure = room;
  failure.initialization = std::make_shared<const Initialization>(failed("no parallax"));
  for (const ExportFormat& format : export_formats()) {
    const fs::path path = folder.path() / format.key;
    EXPECT_EQ(error_of([&] {
                write_export(failure, {}, {&format, path});
              }),
              "room: the initialization failed (no parallax), so there is no result to export. "
              "Choose another window or method");
    EXPECT_FALSE(fs::exists(path));
  }
}

TEST(Exports, TrajectoriesAreThoseOfRun) {
  const TestFolder folder;
  const Inspection room = exported_room(kRoomLens);
  for (const TrajectoryFormat format :
       {TrajectoryFormat::tum, TrajectoryFormat::euroc, TrajectoryFormat::kitti}) {
    const fs::path file = folder.path() / to_string(format);
    write_export(room, {}, {&export_format(to_string(format)), file});
    EXPECT_EQ(read_file(file), to_text(estimated_path(room), format));
  }
}

TEST(PlyExport, HasAllPlanesWithTrackColorNormalAndResidual) {
  const TestFolder folder;
  const Inspection room = exported_room(kRoomLens);
  const fs::path file = folder.path() / "points.ply";
  write_export(room, {}, {&export_format("ply"), file});
  const Eigen::Matrix3Xd points = read_result_points(file);
  const auto& planes = room.window->planes;
  ASSERT_EQ(points.cols(), std::ssize(planes[0].tracks) + std::ssize(planes[1].tracks));
  EXPECT_LT((points.col(0) - room.initialization->points[0].position).norm(), 1e-8);
  std::istringstream text(read_file(file));
  std::string line;
  while (std::getline(text, line) && line != "end_header") {
  }
  std::array<int, 2> on_plane{};
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    double x = 0, y = 0, z = 0, nx = 0, ny = 0, nz = 0, residual = 0;
    int track = 0, red = 0, green = 0, blue = 0, plane = 0;
    text >> x >> y >> z >> track >> red >> green >> blue >> nx >> ny >> nz >> plane >> residual;
    ASSERT_TRUE(text.good() && (plane == 1 || plane == 2));
    ++on_plane[plane - 1];
    const Plane& expected = plane == 1 ? kRoomFloor : kRoomWall;
    EXPECT_NEAR(expected.normal.dot(Eigen::Vector3d(x, y, z)) + expected.distance, 0, 1e-6);
    EXPECT_NEAR(expected.normal.dot(Eigen::Vector3d(nx, ny, nz)), 1, 1e-6);
    EXPECT_THAT(planes[plane - 1].tracks, Contains(track - 100));
    EXPECT_TRUE(residual > 0 && residual < 1) << residual;
    const auto pixel = room.recording->images->bgr(0).at<cv::Vec3b>(
        static_cast<int>(std::lround(room.tracks->raw_px[0](1, track - 100))),
        static_cast<int>(std::lround(room.tracks->raw_px[0](0, track - 100))));
    EXPECT_EQ(cv::Vec3b(blue, green, red), pixel);
  }
  EXPECT_EQ(on_plane[1], std::ssize(planes[1].tracks));
  const std::string of_run = map_points_ply(room, {});
  EXPECT_THAT(of_run, HasSubstr(fmt::format("element vertex {}\n", planes[0].tracks.size())));
  EXPECT_THAT(of_run, HasSubstr("property double z\nproperty int track\nproperty uchar red\n"));
}

TEST(ExportScene, GivesEachTrackOfABundleAdjustmentOnePoint) {
  Inspection room = exported_room(kRoomLens);
  Initialization result = *room.initialization;
  for (const int j : room.window->planes[1].tracks) result.points.push_back({j, {0.5, 0, 2}});
  result.points.push_back({0, {0, 0, 1.5}});  // the outlier
  room.initialization = std::make_shared<const Initialization>(result);
  const ExportScene scene = export_scene(room, {});
  ASSERT_EQ(scene.points.size(), result.points.size());
  for (const ScenePoint& point : scene.points) {
    if (point.track == 0) {
      EXPECT_FALSE(point.plane);
      EXPECT_EQ(std::ssize(point.frames), room.window->frame_count());
      EXPECT_GT(point.rms_px, 1);
    } else if (point.plane == 1) {
      EXPECT_EQ(point.position, Eigen::Vector3d(0.5, 0, 2)) << "where the method has it";
    }
  }
  ExportNotes notes;
  EXPECT_THAT(ply_text(scene, notes), HasSubstr(" 0.000000000 0.000000000 0.000000000 0 "));
}

TEST(RectifiedImage, ShowsTheFloorAsItIs) {
  const Inspection room = exported_room(kRoomLens);
  const ExportScene scene = export_scene(room, {});
  ASSERT_EQ(scene.planes.size(), 2U);
  const ScenePlane& floor = scene.planes[0];
  const cv::Mat image = rectified_image(scene, floor);
  ASSERT_EQ(image.type(), CV_8UC4);
  int compared = 0, wrong = 0;
  for (int y = 0; y < image.rows; y += 3)
    for (int x = 0; x < image.cols; x += 3) {
      const auto texel = image.at<cv::Vec4b>(y, x);
      if (texel[3] < 255) continue;
      const double u = (x + 0.5) / image.cols, v = (y + 0.5) / image.rows;
      const Eigen::Vector3d point = floor.corners[3] + u * (floor.corners[2] - floor.corners[3]) +
                                    v * (floor.corners[0] - floor.corners[3]);
      ++compared;
      wrong += std::abs(texel[0] - floor_gray(point)) > 70 ? 1 : 0;
    }
  EXPECT_GT(compared, 1000);
  EXPECT_LT(wrong, compared / 50) << "only at the borders of squares";
  EXPECT_LT(cv::mean(image)[3], 255) << "a part is beyond the image and transparent";
}

TEST(RectifiedImage, HidesFurtherPlanesWhereTracksAreOnTheLeadingOne) {
  constexpr double kLeft = 420, kRight = 540;
  Inspection room = exported_room(kRoomLens);
  Window window = *room.window;
  for (int j = 0; j < window.track_count(); ++j) {
    const double x = room.tracks->raw_px[0](0, j);
    if (x < kLeft || x > kRight) continue;
    window.inlier[0][j] = true;
    window.planes[1].inlier[0][j] = false;
  }
  room.window = std::make_shared<const Window>(window);
  const ExportScene scene = export_scene(room, {});
  const ScenePlane& wall = scene.planes[1];
  const cv::Mat image = rectified_image(scene, wall);
  int shown = 0, shown_between = 0, between = 0;
  for (int y = 0; y < image.rows; y += 5)
    for (int x = 0; x < image.cols; x += 5) {
      const double u = (x + 0.5) / image.cols, v = (y + 0.5) / image.rows;
      const Eigen::Vector3d point = wall.corners[3] + u * (wall.corners[2] - wall.corners[3]) +
                                    v * (wall.corners[0] - wall.corners[3]);
      const bool opaque = image.at<cv::Vec4b>(y, x)[3] == 255;
      const double at = project(kRoomLens, point).x();
      shown += opaque ? 1 : 0;
      if (at < kLeft + 20 || at > kRight - 20) continue;
      ++between;
      shown_between += opaque ? 1 : 0;
    }
  EXPECT_GT(shown, 1000);
  EXPECT_GT(between, 500);
  EXPECT_EQ(shown_between, 0);
}

/// Returns why a value does not fit a JSON schema: a field that the schema lacks, one that is
/// missing, or a wrong type; empty if it fits.
std::string misfit(const ordered_json& value, const ordered_json& schema, const std::string& at) {
  if (schema.contains("oneOf")) {
    for (const auto& one : schema["oneOf"])
      if (one["const"] == value) return "";
    return at + " is none of its constants";
  }
  const std::string type = schema["type"];
  const bool right = type == "object"    ? value.is_object()
                     : type == "array"   ? value.is_array()
                     : type == "string"  ? value.is_string()
                     : type == "boolean" ? value.is_boolean()
                     : type == "integer" ? value.is_number_integer()
                                         : value.is_number();
  if (!right) return at + " is not of type " + type;
  if (type == "object") {
    for (const auto& [key, part] : value.items()) {
      if (!schema["properties"].contains(key)) return at + "." + key + " is not in the schema";
      const std::string reason = misfit(part, schema["properties"][key], at + "." + key);
      if (!reason.empty()) return reason;
    }
    for (const auto& [key, part] : schema["properties"].items())
      if (!value.contains(key)) return at + "." + key + " is missing";
  }
  if (type == "array") {
    if (schema.contains("minItems") && value.size() != schema["minItems"]) return at + " is short";
    for (const auto& part : value) {
      const std::string reason = misfit(part, schema["items"], at + "[]");
      if (!reason.empty()) return reason;
    }
  }
  return "";
}

struct FoxgloveFile : testing::Test {
  FoxgloveFile() {
    write_export(room, {}, {&export_format("foxglove"), file});
    bag = open_bag(file);
    for (const BagMessage& message : bag.messages)
      messages[bag.topics[message.topic].name].push_back(
          ordered_json::parse(bag.read(message, kWholeMessage)));
  }

  const TestFolder folder;
  const Inspection room = exported_room(kRoomLens);
  const fs::path file = folder.path() / "room.mcap";
  Bag bag;
  std::map<std::string, std::vector<ordered_json>> messages;
};

TEST_F(FoxgloveFile, MessagesFitTheirSchemasFieldByField) {
  ASSERT_EQ(bag.topics.size(), 6U);
  for (const BagTopic& topic : bag.topics) {
    ASSERT_EQ(topic.encoding, MessageEncoding::json);
    ASSERT_TRUE(topic.type.starts_with("foxglove.")) << topic.type;
    const ordered_json schema = foxglove_schema(topic.type.substr(9));
    ASSERT_FALSE(messages[topic.name].empty()) << topic.name;
    for (const ordered_json& message : messages[topic.name])
      EXPECT_EQ(misfit(message, schema, topic.type), "");
  }
  EXPECT_NE(misfit({{"frame_id", 1}}, foxglove_schema("PosesInFrame"), "x"), "");
}

TEST_F(FoxgloveFile, OurReaderFindsImagesAndCalibration) {
  const Bag read = open_recorded_bag({{file}, {}});
  const TopicRoles roles = topic_roles(read, {});
  ASSERT_TRUE(roles.of(TopicRole::image) && roles.of(TopicRole::camera_info));
  EXPECT_FALSE(roles.of(TopicRole::truth)) << "an estimate is no ground truth";
  const BagContents contents = read_contents(read, roles);
  EXPECT_EQ(contents.image_times_ns, room.window->timestamps_ns);
  Camera camera = camera_of(*contents.camera_info, "camera");
  camera.coefficients.resize(kRoomLens.coefficients.size());
  EXPECT_EQ(camera, kRoomLens);
  const BagMessage& first = contents.images.front();
  const cv::Mat image =
      bag_image(read.read(first, kWholeMessage), read.topics[first.topic], "image");
  EXPECT_LT(cv::norm(image, room.recording->images->bgr(0), cv::NORM_L1) / (3.0 * image.total()), 4)
      << "a JPEG of the image";
}

TEST_F(FoxgloveFile, TransformsAndSceneAreTheResult) {
  const auto vector = [](const ordered_json& json) {
    return Eigen::Vector3d(json["x"], json["y"], json["z"]);
  };
  const auto& cameras = room.initialization->cameras;
  ASSERT_EQ(messages["/tf"].size(), cameras.size());
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    const ordered_json& transform = messages["/tf"][i];
    EXPECT_LT((vector(transform["translation"]) - cameras[i].p_wc).norm(), 1e-12);
    const auto& q = transform["rotation"];
    const Eigen::Matrix3d R = Eigen::Quaterniond(q["w"], q["x"], q["y"], q["z"]).matrix();
    EXPECT_LT((R - cameras[i].R_wc).norm(), 1e-12);
    EXPECT_LT((vector(messages["/path"][0]["poses"][i]["position"]) - cameras[i].p_wc).norm(),
              1e-12);
  }
  std::map<std::string, ordered_json> entities;
  for (const ordered_json& one : messages["/scene"][0]["entities"]) entities[one["id"]] = one;
  ASSERT_TRUE(entities.contains("plane 1") && entities.contains("plane 2"));
  for (const ordered_json& corner : entities["plane 2"]["triangles"][0]["points"])
    EXPECT_NEAR(kRoomWall.normal.dot(vector(corner)) + kRoomWall.distance, 0, 1e-9);
  const ordered_json cube = entities["cube on plane 1"]["cubes"][0];
  const double side = default_cube_side(*room.cube);
  EXPECT_NEAR(cube["size"]["x"], side, 1e-12);
  EXPECT_LT((vector(cube["pose"]["position"]) - room.cube->origin - 0.5 * side * kRoomFloor.normal)
                .norm(),
            1e-9);
  EXPECT_EQ(entities["tracks"]["spheres"].size(), room.window->track_count() - 1);
  const auto& circles = messages["/camera/tracks"][1]["circles"];
  ASSERT_EQ(circles.size(), room.window->track_count());
  EXPECT_NEAR(circles[0]["outline_color"]["r"], 0xF0 / 255.0, 1e-12) << "the outlier is red";
  EXPECT_NEAR(circles[0]["position"]["x"], room.tracks->raw_px[1](0, 0), 1e-12);
}

}  // namespace
}  // namespace gpo::test
