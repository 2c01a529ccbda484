// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/snapshot.h"

#include "engine/recording/images/images.h"
#include "tests/ui/gl_test.h"
#include "tests/ui/made_inspection.h"
#include "ui/context/gui.h"
#include "ui/views/compare/compare_view.h"

#include <set>
#include <utility>

#include <Eigen/LU>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

namespace gpo {
namespace {

class Snapshot : public DrawingTest {};

TEST_F(Snapshot, HasTheSameBytesAgain) {
  const Inspection inspection = made_inspection();
  const Inspection tilted = made_inspection({.estimate_error = 2});
  const cv::Mat image = snapshot_image(inspection, 34), scene = snapshot_scene(tilted, 24);
  keep("image", image);
  keep("scene", scene);
  EXPECT_EQ(image.size(), cv::Size(640, 480)) << "the recording's";
  EXPECT_EQ(scene.size(), cv::Size(960, 720));
  if (!on_llvmpipe()) GTEST_SKIP() << "bytes are reproducible only with llvmpipe";
  EXPECT_TRUE(same_bytes(image, snapshot_image(inspection, 34)));
  EXPECT_TRUE(same_bytes(scene, snapshot_scene(tilted, 24)));
}

TEST_F(Snapshot, AnotherProcessGivesTheSameBytes) {
  if (!on_llvmpipe()) GTEST_SKIP() << "bytes are reproducible only with llvmpipe";
  const auto folder = std::filesystem::path(GPO_TEST_OUTPUT_DIR) / "another-process";
  std::filesystem::remove_all(folder);
  const std::string self = std::filesystem::read_symlink("/proc/self/exe").string();
  const std::string command = "GPO_TEST_KEEP='" + folder.string() + "' '" + self +
                              "' --gtest_filter=Snapshot.HasTheSameBytesAgain >/dev/null";
  ASSERT_EQ(std::system(command.c_str()), 0);
  const cv::Mat image = read_image(folder / "image.png");
  const cv::Mat scene = read_image(folder / "scene.png");
  EXPECT_TRUE(same_bytes(snapshot_image(made_inspection(), 34), image));
  EXPECT_TRUE(same_bytes(snapshot_scene(made_inspection({.estimate_error = 2}), 24), scene));
}

TEST_F(Snapshot, UndistortsAsOpenCvDoes) {
  const Inspection inspection = made_inspection({.distorted = true});
  const Camera& camera = inspection.recording->camera;
  ViewToggles only_image{.undistorted = true, .legend = false};
  only_image.tracks = only_image.cube = only_image.truth = only_image.gravity = false;
  const cv::Mat drawn = snapshot_image(inspection, 20, {}, {.show = only_image});
  keep("image_undistorted", drawn);
  cv::Mat expected;
  const cv::Mat K =
      (cv::Mat_<double>(3, 3) << camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1);
  cv::undistort(inspection.recording->images->bgr(20), expected, K, camera.coefficients);
  cv::Mat difference;
  cv::absdiff(drawn, expected, difference);
  EXPECT_LT(cv::mean(difference.reshape(1))[0], 1.5) << "of 255";
}

/// Returns the smallest rectangle around the pixels that differ.
cv::Rect differing_part(const cv::Mat& a, const cv::Mat& b) {
  cv::Mat difference, largest;
  cv::absdiff(a, b, difference);
  cv::reduce(
      difference.reshape(1, static_cast<int>(difference.total())), largest, 1, cv::REDUCE_MAX);
  return cv::boundingRect(largest.reshape(1, a.rows));
}

TEST_F(Snapshot, LegendIsInACornerWithoutACube) {
  for (const Vector2d& at : {Vector2d(0, 0), Vector2d(640, 0)}) {
    Inspection inspection = made_inspection();
    const Window& window = *inspection.window;
    const auto from_corner = [&](int j) { return (window.points_px[0].col(j) - at).norm(); };
    int nearest = 0;
    for (int j = 0; j < window.track_count(); ++j)
      if (from_corner(j) < from_corner(nearest)) nearest = j;
    move_cubes(inspection, window.K.inverse() * window.points_px[0].col(nearest).homogeneous());
    ViewOptions all{.cube_side = 0.5}, no_legend{.show = {.legend = false}, .cube_side = 0.5};
    ViewOptions no_cube = no_legend;
    no_cube.show.cube = false;
    const auto drawn = [&](int frame, const ViewOptions& options) {
      return snapshot_image(inspection, frame, {}, options);
    };
    const int frame = window.start + 10;
    const cv::Mat without = drawn(frame, no_legend);
    const cv::Rect legend = differing_part(drawn(frame, all), without);
    const cv::Rect cube = differing_part(drawn(frame, no_cube), without);
    const cv::Rect on_its_side({at.x() > 0 ? 630 - legend.width : 10, 10}, legend.size());
    EXPECT_GT((on_its_side & cube).area(), 0) << "the cube is where a legend could be";
    EXPECT_EQ((legend & cube).area(), 0) << legend << " covers " << cube;
    EXPECT_EQ(differing_part(drawn(frame + 5, all), drawn(frame + 5, no_legend)).tl(), legend.tl())
        << "it stays there in all frames";
  }
}

TEST_F(Snapshot, SaysWhyAFrameAfterTheWindowHasNoCamera) {
  const auto inspection = std::make_shared<const Inspection>(made_inspection());
  Extrapolation ended{inspection};
  ended.end = "frame 36: 5 points of the planes seen, at least 8 are needed";
  const ViewOptions options{.after = std::make_shared<const Extrapolation>(ended)};
  const auto differs = [&](int frame) {
    return !same_bytes(snapshot_image(*inspection, frame),
                       snapshot_image(*inspection, frame, {}, options));
  };
  EXPECT_TRUE(differs(38));
  EXPECT_FALSE(differs(2)) << "before the window";
}

TEST_F(Snapshot, DrawsEveryKindOfInspectionWithoutMessages) {
  const Inspection plain = made_inspection(), failed = made_inspection({.ok = false});
  const Inspection tilted = made_inspection({.estimate_error = 3});
  const Inspection blind = made_inspection({.images = false, .truth = false});
  keep("image_error", snapshot_image(tilted, 30, {}, {.show = {.residuals = true}}));
  keep("image_large", snapshot_image(plain, 20, cv::Size(1280, 720)));
  keep("image_reference", snapshot_image(plain, 5));
  keep("image_outside", snapshot_image(plain, 38));
  keep("image_failed", snapshot_image(failed, 20));
  keep("image_tracks_only", snapshot_image(blind, 20));
  const Inspection uncertain = made_inspection({.estimate_error = 0.5, .normal_sigma_deg = 0.3});
  for (const int times : {0, 1, 10, 100})
    keep("scene_uncertain_" + std::to_string(times),
         snapshot_scene(uncertain, 30, {}, {.show = {.uncertainty = times}}));
  keep("scene_no_truth", snapshot_scene(made_inspection({.truth = false}), 5));
  keep("scene_failed", snapshot_scene(failed, 20));
  keep("scene_refused", snapshot_scene(made_inspection({.refused = true}), 20));
  keep("scene_failed_blind", snapshot_scene(made_inspection({.ok = false, .truth = false}), 20));
  keep("scene_outside", snapshot_scene(plain, 2, cv::Size(600, 900)));
}

const cv::Mat& drawn() {
  static const cv::Mat image = snapshot_image(made_inspection(), 20);
  return image;
}

TEST(ImageCompare, AcceptsTheSameImageAndTwoLevelsOfRoundingEverywhere) {
  const ImageComparison same = compare_images(drawn(), drawn());
  EXPECT_TRUE(same.equal && same.reason.empty() && same.unequal == 0);
  cv::Mat noise(drawn().size(), CV_8SC3), noisy;
  cv::RNG(3).fill(noise, cv::RNG::UNIFORM, -2, 3);
  cv::add(drawn(), noise, noisy, cv::noArray(), CV_8U);
  const ImageComparison result = compare_images(noisy, drawn());
  EXPECT_TRUE(result.equal) << result.reason;
  EXPECT_GT(result.beyond[0], 0);
  EXPECT_EQ(result.beyond[1], 0);
}

TEST(ImageCompare, RejectsACubeMovedByTwoPixels) {
  Inspection moved = made_inspection();
  const double depth = to_camera(moved.initialization->cameras[15], moved.cube->origin).z();
  const double two_px = 2 * depth / moved.recording->camera.fx;
  moved.cube->origin += two_px * moved.cube->axes.col(0);
  const ImageComparison result = compare_images(snapshot_image(moved, 20), drawn());
  EXPECT_FALSE(result.equal);
  EXPECT_NE(result.reason.find("16x16"), std::string::npos) << result.reason;
  EXPECT_EQ(result.difference.size(), drawn().size());
}

TEST(ImageCompare, RejectsSwappedColorsAndAShiftByOnePixel) {
  cv::Mat swapped, shifted = drawn().clone(), green = drawn().clone(), red = drawn().clone();
  cv::cvtColor(drawn(), swapped, cv::COLOR_BGR2RGB);
  drawn().colRange(0, drawn().cols - 1).copyTo(shifted.colRange(1, drawn().cols));
  for (const cv::Mat& other : {swapped, shifted})
    EXPECT_FALSE(compare_images(other, drawn()).equal);
  const cv::Rect mark(320, 300, 12, 12);
  green(mark) = cv::Scalar(10, 200, 30);
  red(mark) = cv::Scalar(10, 30, 200);
  EXPECT_FALSE(compare_images(red, green).equal);
}

TEST(ImageCompare, RejectsAnotherSizeAndNamesBoth) {
  const ImageComparison result = compare_images(drawn().colRange(0, 100), drawn());
  EXPECT_FALSE(result.equal);
  EXPECT_EQ(result.reason, "size 100x480, expected 640x480");
}

TEST(ImageCompare, ToleranceIsTheLargestDifferenceThatCountsAsEqual) {
  const cv::Mat lighter = drawn() + cv::Scalar::all(10);
  EXPECT_FALSE(compare_images(lighter, drawn(), 9).equal);
  EXPECT_TRUE(compare_images(lighter, drawn(), 10).equal);
}

class CompareView : public DrawingTest {};

constexpr int kFrame = 24;
using Inspections = std::vector<std::shared_ptr<const Inspection>>;

std::shared_ptr<const Inspection> made(const MadeOptions& options,
                                       const InitializeOptions& other = {}) {
  auto inspection = std::make_shared<Inspection>(made_inspection(options));
  inspection->settings.options.ransac = other.ransac;
  inspection->settings.options.rotations = other.rotations;
  if (auto& evaluation = inspection->evaluation) {
    evaluation->pne_deg = options.estimate_error;
    evaluation->ate_m = 0.0042;
    evaluation->pde_m = 0.0021;
    evaluation->pne_bound_deg = 0.021;
  }
  return inspection;
}

/// Returns a true estimate, one wrong by 3 degrees, and a failed one.
Inspections three() {
  return {made({}),
          made({.estimate_error = 3}, {.ransac = false}),
          made({.ok = false}, {.rotations = RotationSource::averaging})};
}

cv::Size default_size(const Inspections& inspections) {
  return default_compare_size(static_cast<int>(inspections.size()),
                              *inspections.front()->recording);
}

/// Returns the part of an image of `three()` with one of them.
cv::Mat column(const cv::Mat& image, int index) {
  return image.colRange(index * (image.cols / 3), (index + 1) * (image.cols / 3));
}

std::pair<int, int> grid_of(const Eigen::Vector2d& size, int count, double aspect) {
  std::set<double> xs, ys;
  for (const ColumnPlace& place : compare_places({{0, 0}, size}, count, aspect, true)) {
    xs.insert(place.image.min.x());
    ys.insert(place.image.min.y());
  }
  return {static_cast<int>(xs.size()), static_cast<int>(ys.size())};
}

TEST_F(CompareView, ArrangesColumnsForTheLargestImages) {
  const OffscreenContext context(64, 64);
  Gui gui;  // its font determines sizes
  gui.begin_frame(64, 64);
  EXPECT_EQ(grid_of({1600, 1000}, 4, 16.0 / 9), std::pair(2, 2));
  EXPECT_EQ(grid_of({1900, 450}, 4, 16.0 / 9), std::pair(4, 1));
  EXPECT_EQ(grid_of({500, 1000}, 2, 4.0 / 3), std::pair(1, 2));
  EXPECT_EQ(grid_of({1600, 1000}, 1, 4.0 / 3), std::pair(1, 1));
  EXPECT_EQ(grid_of({1600, 1000}, 5, 4.0 / 3), std::pair(3, 2));
  ImGui::EndFrame();
}

TEST_F(CompareView, ColumnsHaveTheirColorAndTheirCubeOrReason) {
  const Inspections inspections = three();
  const cv::Mat image = snapshot_compare(inspections, kFrame);
  keep("compare", image);
  ASSERT_EQ(image.size(), default_size(inspections));
  for (int i = 0; i < 3; ++i) {
    const Configuration configuration = configuration_of(inspections[i]->settings);
    const cv::Mat heading = column(image, i).rowRange(38, 92);
    EXPECT_GT(count_pixels(heading, color_of(configuration)), 150) << "column " << i;
    const bool ok = inspections[i]->initialization->ok;
    const cv::Mat shown = column(image, i).rowRange(92, image.rows - 58);
    EXPECT_EQ(count_pixels(shown, color_of(Role::cube_base)) > 200, ok) << "column " << i;
    EXPECT_EQ(count_pixels(shown, color_of(Role::warning)) > 50, !ok) << "column " << i;
  }
  // All columns show the same part of the image: here a part of the floor without a cube.
  const cv::Rect corner(20, 100, 60, 60);
  for (int i = 1; i < 3; ++i)
    EXPECT_TRUE(same_bytes(image(corner), image(corner + cv::Point(i * 492, 0)))) << i;
}

TEST_F(CompareView, AMovedCubeChangesOnlyItsColumn) {
  Inspections inspections = three();
  const cv::Mat before = snapshot_compare(inspections, kFrame);
  auto moved = std::make_shared<Inspection>(*inspections[0]);
  // Within the true cube, so that all columns still show the same part of the image.
  moved->cube->axes *= 0.8;
  moved->cube->origin += 0.01 * moved->cube->axes.col(0);
  inspections[0] = moved;
  const cv::Mat after = snapshot_compare(inspections, kFrame);
  for (int i = 0; i < 3; ++i)
    EXPECT_EQ(same_bytes(column(before, i), column(after, i)), i != 0) << "column " << i;
}

TEST_F(CompareView, WrapsMoreThanFourColumnsIntoRows) {
  Inspections seven;
  for (int i = 0; i < 7; ++i) seven.push_back(made({.estimate_error = 0.4 * i}));
  const cv::Size size = default_size(seven);
  EXPECT_EQ(size.width, 4 * 492 + 12);
  EXPECT_EQ(size.height, default_compare_size(4, *seven[0]->recording).height * 2 - 38);
  const cv::Mat image = snapshot_compare(seven, kFrame);
  keep("compare_seven", image);
  // The eighth place is empty.
  EXPECT_EQ(count_pixels(image(cv::Rect(3 * 492 + 12, size.height / 2 + 20, 490, 400)),
                         color_of(Role::panel)),
            490 * 400);
}

TEST_F(CompareView, ArrangesNineColumnsInThreeRows) {
  Inspections nine;
  for (int i = 0; i < 9; ++i)
    nine.push_back(made({.ok = i != 8, .estimate_error = 0.4 * i, .normal_sigma_deg = 0.3}));
  EXPECT_EQ(default_size(nine).width, 3 * 492 + 12);
  const cv::Mat image = snapshot_compare(nine, kFrame);
  keep("compare_nine", image);
  const cv::Mat first = image(cv::Rect(12, 38, 480, 54));
  const cv::Mat last = image(cv::Rect(12 + 2 * 492, 38 + 2 * (image.rows - 38) / 3, 480, 54));
  EXPECT_GT(count_pixels(first, color_of(Role::good)), 30);  // ready
  EXPECT_GT(count_pixels(last, color_of(Role::bad)), 8);     // degenerate
}

TEST_F(CompareView, DrawsIncompleteResultsWithoutMessages) {
  const Inspections blind{made({.images = false, .truth = false})};
  const Inspections failed{made({.ok = false, .truth = false})};
  keep("compare_blind", snapshot_compare(blind, kFrame));
  keep("compare_outside", snapshot_compare(three(), 38));
  keep("compare_failed", snapshot_compare(failed, kFrame));
  keep("compare_small", snapshot_compare(three(), kFrame, cv::Size(900, 330)));
}

}  // namespace
}  // namespace gpo
