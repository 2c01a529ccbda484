// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/exports/exports.h"
#include "engine/files/text_file.h"
#include "engine/inspection/inspector.h"
#include "engine/results/result_method.h"
#include "tests/engine/desk.h"
#include "tests/engine/exports/exported_room.h"
#include "tests/engine/test_folder.h"

#include <cstdlib>
#include <sstream>

#include <fmt/format.h>
#include <gmock/gmock.h>

namespace gpo::test {
namespace {

using testing::Contains, testing::HasSubstr, testing::StartsWith;

bool runs(const std::string& command) { return std::system(command.c_str()) == 0; }

bool has_colmap() { return runs("command -v colmap > /dev/null"); }

void run_colmap(const std::string& arguments, const fs::path& log) {
  const std::string command =
      fmt::format("QT_QPA_PLATFORM=offscreen colmap {} > '{}' 2>&1", arguments, log.string());
  ASSERT_TRUE(runs(command)) << command << "\n" << read_file(log);
}

/// Returns the mean of the points' errors in a COLMAP model in text form, and their number.
std::pair<double, int> mean_error(const fs::path& points) {
  std::istringstream lines(read_file(points));
  double sum = 0;
  int count = 0;
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() || line.front() == '#') continue;
    std::istringstream words(line);
    double value = 0;
    for (int k = 0; k < 8; ++k) words >> value;
    sum += value;
    ++count;
  }
  return {sum / count, count};
}

/// Lets COLMAP compute the errors of a model anew from its cameras, poses, points and pixels.
std::pair<double, int> recomputed(const fs::path& model, const fs::path& folder) {
  fs::create_directories(folder / "again");
  run_colmap(fmt::format("point_filtering --input_path '{}' --output_path '{}' --min_track_len 2 "
                         "--max_reproj_error 1000 --min_tri_angle 0",
                         model.string(),
                         (folder / "again").string()),
             folder / "filter.log");
  run_colmap(fmt::format("model_converter --input_path '{0}' --output_path '{0}' --output_type TXT",
                         (folder / "again").string()),
             folder / "convert.log");
  return mean_error(folder / "again/points3D.txt");
}

/// Returns the mean over the points of both planes of their mean reprojection errors, in the
/// recorded image.
double expected_error(const Inspection& room) {
  const Window& window = *room.window;
  double sum = 0;
  int points = 0;
  for (int k = 0; k < 2; ++k)
    for (const int j : window.planes[k].tracks) {
      const Eigen::Vector3d ray = window.K.inverse() * window.points_px[0].col(j).homogeneous();
      const Eigen::Vector3d point = on_room_plane(ray, k == 0 ? kRoomFloor : kRoomWall);
      double errors = 0;
      for (int i = 0; i < window.frame_count(); ++i) {
        const Eigen::Vector3d seen = to_camera(room.initialization->cameras[i], point);
        errors += (project(room.recording->camera, seen) - room.tracks->raw_px[i].col(j)).norm();
      }
      sum += errors / window.frame_count();
      ++points;
    }
  return sum / points;
}

const std::vector<Camera>& lenses() {
  static const std::vector<Camera> all{
      {640, 480, 500, 500, 319.5, 239.5, Distortion::none, {}},
      {640, 480, 500, 510, 325, 236, Distortion::none, {}},
      {640, 480, 500, 510, 325, 236, Distortion::radial_tangential, {-0.2, 0.05, 0.001, -0.002}},
      {640,
       480,
       500,
       510,
       325,
       236,
       Distortion::radial_tangential,
       {-0.2, 0.05, 0.001, -0.002, 0.01, 0.02, 0.01, 0.005}},
      {640, 480, 400, 410, 325, 236, Distortion::equidistant, {0.02, -0.01, 0.003, -0.001}},
      {640, 480, 400, 410, 325, 236, Distortion::field_of_view, {0.9}},
      {640,
       480,
       400,
       410,
       325,
       236,
       Distortion::thin_prism_fisheye,
       {0.02, -0.01, 0.001, -0.002, 0.003, -0.001, 0.002, -0.001}}};
  return all;
}

TEST(ColmapExport, ColmapComputesOurErrorsForEachLens) {
  if (!has_colmap()) GTEST_SKIP() << "COLMAP is not installed (package colmap)";
  const std::vector<std::string> models{"SIMPLE_PINHOLE",
                                        "PINHOLE",
                                        "OPENCV",
                                        "FULL_OPENCV",
                                        "OPENCV_FISHEYE",
                                        "FOV",
                                        "THIN_PRISM_FISHEYE"};
  const TestFolder folder;
  for (std::size_t i = 0; i < lenses().size(); ++i) {
    SCOPED_TRACE(models[i]);
    const Inspection room = exported_room(lenses()[i]);
    const fs::path model = folder.path() / models[i] / "model";
    fs::create_directories(model.parent_path());
    const ExportNotes notes = write_export(room, {}, {&export_format("colmap"), model});
    EXPECT_THAT(notes, Contains(HasSubstr("camera " + models[i] + ";")));
    const double expected_px = expected_error(room);
    const auto [written_px, points] = mean_error(model / "points3D.txt");
    EXPECT_NEAR(written_px, expected_px, 1e-6);
    const auto [colmap_px, colmap_points] = recomputed(model, model.parent_path());
    EXPECT_NEAR(colmap_px, expected_px, 1e-3);
    EXPECT_EQ(colmap_points, points);
  }
}

TEST(ColmapExport, ColmapAnalyzesTheDesk) {
  if (!has_colmap()) GTEST_SKIP() << "COLMAP is not installed (package colmap)";
  const TestFolder folder;
  const auto result = Inspector(desk()).inspect({});
  const fs::path model = folder.path() / "model";
  const ExportNotes notes = write_export(*result, {}, {&export_format("colmap"), model});
  run_colmap(fmt::format("model_analyzer --path '{}'", model.string()), folder.path() / "log");
  const std::string log = folder.read("log");
  const auto [mean_px, points] = mean_error(model / "points3D.txt");
  EXPECT_THAT(log, HasSubstr("Registered images: 30"));
  EXPECT_THAT(log, HasSubstr(fmt::format("Points: {}", points)));
  const std::string label = "Mean reprojection error: ";
  ASSERT_THAT(log, HasSubstr(label));
  EXPECT_NEAR(std::stod(log.substr(log.find(label) + label.size())), mean_px, 1e-5);
  EXPECT_THAT(notes,
              Contains(HasSubstr(fmt::format("mean reprojection error {:.4f} px", mean_px))));
  EXPECT_NEAR(recomputed(model, folder.path()).first, mean_px, 1e-3);
}

TEST(ColmapExport, TextAndBinaryReadBackWithTheSameCameraCenters) {
  const TestFolder folder;
  Inspection room = exported_room(lenses()[2]);
  room.chosen_world = ChosenWorld{{so3_exp({0.3, -0.2, 0.5}), {1, 2, 3}}, ""};
  room.measured_scale = MeasuredScale{.meters_per_unit = 2.5};
  const fs::path model = folder.path() / "model";
  write_export(room, {}, {&export_format("colmap"), model});
  const CameraPath expected = estimated_path(room, export_world(room, false));
  for (const char* ending : {".txt", ".bin"}) {
    const ResultPoses back = read_result_poses(model / fmt::format("images{}", ending));
    ASSERT_EQ(back.poses.size(), expected.cameras.size());
    for (std::size_t i = 0; i < back.poses.size(); ++i) {
      EXPECT_LT((back.poses[i].p_wc - expected.cameras[i].p_wc).norm(), 1e-12);
      EXPECT_LT((back.poses[i].R_wc - expected.cameras[i].R_wc).norm(), 1e-12);
      EXPECT_EQ(back.names[i], fmt::format("{}.png", room.window->timestamps_ns[i]));
    }
    const auto points = read_result_points(model / fmt::format("points3D{}", ending));
    const auto& first = room.initialization->points.front();
    const Eigen::Vector3d at = export_world(room, false).T_world_reference * first.position;
    EXPECT_LT((points.col(0) - at).norm(), 1e-12);
  }
}

TEST(ColmapExport, UnknownLensIsUndistortedAndSaysSo) {
  const TestFolder folder;
  const Inspection room =
      exported_room({640, 480, 400, 410, 325, 236, Distortion::double_sphere, {-0.1, 0.5}});
  const fs::path model = folder.path() / "model";
  const ExportNotes notes = write_export(room, {}, {&export_format("colmap"), model});
  EXPECT_THAT(read_file(model / "cameras.txt"), HasSubstr("PINHOLE 640 480 400 410 325.5 236.5"));
  EXPECT_THAT(
      notes,
      Contains(StartsWith("COLMAP has no model of the lens double-sphere with 2 coefficients")));
  // Observations are those of the undistorted image, half a pixel further.
  std::istringstream lines(read_file(model / "images.txt"));
  std::string line;
  while (std::getline(lines, line) && line.starts_with('#')) {
  }
  std::getline(lines, line);
  double x = 0, y = 0;
  std::istringstream(line) >> x >> y;
  EXPECT_NEAR(x, room.window->points_px[0](0, 0) + 0.5, 1e-9);
  EXPECT_NEAR(y, room.window->points_px[0](1, 0) + 0.5, 1e-9);
}

TEST(ColmapExport, LeavesOutTracksWithoutAPoint) {
  const TestFolder folder;
  const Inspection room = exported_room(lenses()[0]);
  const ExportNotes notes =
      write_export(room, {}, {&export_format("colmap"), folder.path() / "model"});
  EXPECT_THAT(notes, Contains("left out: 1 track without a point"));
  EXPECT_THAT(folder.read("model/images.txt"), HasSubstr(" -1 ")) << "the outlier is observed";
}

}  // namespace
}  // namespace gpo::test
