// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/calibration/calibrate.h"

#include "engine/calibration/calibration_report.h"
#include "engine/calibration/residual_structure.h"
#include "engine/recording/companions/companion_files.h"
#include "tests/engine/calibration/phone_and_board.h"
#include "tests/engine/recording/board/rendered_board.h"
#include "tests/engine/test_folder.h"
#include "tests/engine/tracking/texture.h"

#include <limits>
#include <memory>
#include <random>
#include <stdexcept>

#include <Eigen/Geometry>
#include <gmock/gmock.h>
#include <opencv2/core/eigen.hpp>
#include <opencv2/imgproc.hpp>

namespace gpo::test {
namespace {

using Eigen::Vector2d, Eigen::Vector3d, testing::HasSubstr;

Camera wide() {
  return {640, 480, 280, 281, 322, 236, Distortion::equidistant, {0.02, -0.01, 0.004, -0.001}};
}

/// A random camera that looks at the board, slanted by at most `slant_deg`.
Pose pose_from(std::mt19937& random, double distance, double slant_deg) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  const double slant = radians(slant_deg);
  const Eigen::Matrix3d R =
      so3_exp({slant * uniform(random), slant * uniform(random), 0.5 * uniform(random)});
  const Vector3d looked_at(0.1 + 0.12 * uniform(random), 0.06 + 0.1 * uniform(random), 0);
  return {R, looked_at - distance * (1 + 0.3 * uniform(random)) * R.col(2)};
}

struct SimulatedSearch {
  Camera camera = phone();
  int count = 30;  ///< number of views
  int seed = 1;
  double distance = 0.4;
  double slant_deg = 35;
  double rise_m = 0;  ///< height of the middle of the board above its ends
};

/// Views as a search finds them, with noise on the corners.
BoardSearch simulated(const SimulatedSearch& options) {
  const Camera& camera = options.camera;
  std::mt19937 random(options.seed);
  std::normal_distribution<double> noise(0, 0.15);
  BoardSearch search;
  search.size = {camera.width, camera.height};
  while (static_cast<int>(search.views.size()) < options.count) {
    CalibrationView view{search.examined++, {}, 1.5};
    const Pose pose = pose_from(random, options.distance, options.slant_deg);
    for (Vector3d corner : board_points(kBoard)) {
      const double along = 2 * corner.x() / ((kBoard.columns - 1) * kBoard.square_m) - 1;
      corner.z() = options.rise_m * (1 - along * along);
      view.corners.push_back(project(camera, to_camera(pose, corner)));
    }
    for (auto& corner : view.corners) corner += Vector2d(noise(random), noise(random));
    const Eigen::AlignedBox2d image(Vector2d(0, 0), Vector2d(camera.width - 1, camera.height - 1));
    if (std::ranges::all_of(view.corners, [&](const auto& px) { return image.contains(px); }))
      search.views.push_back(std::move(view));
  }
  return search;
}

/// Calibrates a camera; throws, and so fails the test, if that is impossible.
CameraCalibration calibrated(const BoardSearch& search,
                             const CalibrationOptions& options = {},
                             const Board& board = kBoard) {
  CameraCalibration found = calibrate_camera(search, board, options);
  if (!found.ok) throw std::runtime_error(found.reason);
  return found;
}

double largest_normalized_error(const CameraCalibration& found, const Camera& truth) {
  const auto values = parameters(found.camera);
  const auto expected = parameters(truth);
  double largest = 0;
  for (std::size_t k = 0; k < values.size(); ++k)
    largest = std::max(largest, std::abs(values[k] - expected[k]) / found.camera.sigmas[k]);
  return largest;
}

/// Error of fx - fy in standard deviations. The focal lengths are correlated, by a board strongly.
double normalized_aspect_error(const Camera& found, const Camera& truth, double most = 0.2) {
  const Eigen::MatrixXd covariance = from_upper_triangle(found.covariance);
  const double independent = covariance(0, 0) + covariance(1, 1);
  const double variance = independent - 2 * covariance(0, 1);
  EXPECT_LT(variance, most * independent);
  return (found.fx - found.fy - truth.fx + truth.fy) / std::sqrt(variance);
}

TEST(Calibrate, EstimatesTheCameraWithinThreeStandardDeviations) {
  for (const int seed : {1, 2, 3, 4}) {
    const auto found = calibrated(simulated({.count = 40, .seed = seed}));
    EXPECT_LT(largest_normalized_error(found, phone()), 3) << seed;
    EXPECT_LT(std::abs(normalized_aspect_error(found.camera, phone())), 3.5) << seed;
    EXPECT_LT(found.camera.sigmas[0], 6) << seed;
    EXPECT_NEAR(found.rms_px, 0.15 * std::sqrt(2.0), 0.02);
    EXPECT_EQ(found.found, 40);
    EXPECT_GT(found.coverage, 0.7);
    EXPECT_GT(found.slant_deg, 25);
    EXPECT_TRUE(found.warnings.empty()) << found.warnings.front();
    EXPECT_EQ(found.bend_m, 0) << "the board is flat";
  }
}

TEST(Calibrate, EstimatesTheShapeOfABentBoard) {
  const double rise_m = 0.0015;  // the rise of chessboard-floor
  for (const int seed : {1, 2, 3, 4}) {
    const auto found = calibrated(simulated({.count = 40, .seed = seed, .rise_m = rise_m}));
    EXPECT_LT(largest_normalized_error(found, phone()), 3) << seed;
    EXPECT_NEAR(found.camera.fx, phone().fx, 0.01 * phone().fx) << seed;
    EXPECT_NEAR(found.rms_px, 0.15 * std::sqrt(2.0), 0.02);
    // A parabola is up to two thirds of its rise above its plane.
    EXPECT_NEAR(found.bend_m, 2 * rise_m / 3, 0.2e-3) << seed;
    EXPECT_THAT(to_text(found), HasSubstr("not flat: corners are up to"));
  }
}

TEST(Calibrate, EstimatesAWideLens) {
  for (const int seed : {1, 2}) {
    const auto found =
        calibrated(simulated({.camera = wide(), .count = 40, .seed = seed, .distance = 0.2}),
                   {.distortion = Distortion::equidistant});
    EXPECT_EQ(found.camera.distortion, Distortion::equidistant);
    // Standard deviations by ten blocks are rough: one of eight parameters may be beyond 3.
    EXPECT_LT(largest_normalized_error(found, wide()), 4) << seed;
    EXPECT_LT(found.camera.sigmas[0], 3) << seed;
  }
}

TEST(Calibrate, EstimatesTheRequestedNumberOfCoefficients) {
  const BoardSearch search = simulated({.count = 20});
  for (const int count : {5, 8}) {
    const auto found = calibrate_camera(search, kBoard, {.coefficients = count});
    EXPECT_EQ(std::ssize(found.camera.coefficients), count);
    EXPECT_EQ(std::ssize(parameter_names(found.camera)), 4 + count);
  }
}

TEST(Calibrate, LeavesOutViewsThatFitFarWorse) {
  BoardSearch search = simulated({.seed = 5});
  for (std::size_t i = 0; i < search.views[7].corners.size(); i += 2)
    search.views[7].corners[i].x() += 4;
  const auto found = calibrated(search);
  EXPECT_THAT(found.frames, testing::Not(testing::Contains(search.views[7].frame)));
  EXPECT_LT(largest_normalized_error(found, phone()), 3);
}

TEST(Calibrate, AcceptsViewsWithHiddenCorners) {
  BoardSearch search = simulated({.seed = 6});
  for (auto& view : search.views)
    for (int i = 0; i < 20; ++i) view.corners[i].x() = std::nan("");
  const auto found = calibrated(search);
  EXPECT_LT(largest_normalized_error(found, phone()), 3);
}

TEST(Calibrate, FixesUndeterminedCoefficientsAtZero) {
  // No view of a narrow lens determines the ninth power of the angle.
  Camera narrow = phone();
  narrow.fx = narrow.fy = 1100;
  narrow.coefficients = {0, 0, 0, 0};
  const auto found = calibrated(simulated({.camera = narrow, .count = 40, .distance = 0.7}),
                                {.distortion = Distortion::equidistant});
  EXPECT_EQ(found.camera.coefficients[3], 0);
  EXPECT_EQ(found.camera.sigmas[7], 0);
  EXPECT_THAT(found.warnings, testing::Contains(HasSubstr("k4 is not determined by these views")));
  EXPECT_LT(std::abs(found.camera.fx - 1100), 3 * found.camera.sigmas[0]);
}

TEST(Calibrate, ExplainsFailures) {
  const auto few = calibrate_camera(simulated({.count = 5}), kBoard);
  EXPECT_THAT(few.reason, HasSubstr("found the board in 5 of "));
  EXPECT_FALSE(calibrate_camera({}, kBoard).ok);
  BoardSearch blurred = simulated({.count = 9});
  blurred.views[0].edge_px = blurred.views[1].edge_px = 9;
  EXPECT_THAT(calibrate_camera(blurred, kBoard).reason,
              HasSubstr(", but only 7 are sharp and show it from a usable side; at least 8"));
  // From straight above a longer lens at a larger distance sees the same.
  const auto frontal = calibrate_camera(simulated({.slant_deg = 1}), kBoard);
  EXPECT_TRUE(!frontal.ok && !frontal.reason.empty());
}

TEST(Calibrate, RefusesALensModelThatDoesNotDescribeTheLens) {
  const auto wrong = calibrate_camera(
      simulated({.camera = wide(), .count = 40, .distance = 0.2}), kBoard, {.coefficients = 4});
  EXPECT_FALSE(wrong.ok);
  EXPECT_THAT(wrong.reason,
              testing::AllOf(HasSubstr("depend on the place in the image"),
                             HasSubstr("try --model equidistant or --coefficients 8")));
}

TEST(Calibrate, RefusesALargeReprojectionError) {
  for (const double noise_px : {1.0, 2.0}) {
    BoardSearch search = simulated({.count = 40});
    std::mt19937 random(7);
    std::normal_distribution<double> noise(0, noise_px);
    for (auto& view : search.views)
      for (auto& corner : view.corners) corner += Vector2d(noise(random), noise(random));
    const auto found = calibrate_camera(search, kBoard);
    EXPECT_EQ(found.ok, noise_px == 1) << found.reason;
    if (!found.ok) EXPECT_THAT(found.reason, HasSubstr("the reprojection error is 2."));
  }
}

TEST(Calibrate, FindsLensesOfAllFieldsOfViewByTheEquidistantModel) {
  for (const double f : {200.0, 300.0, 500.0, 800.0}) {
    Camera camera = wide();
    camera.fx = camera.fy = f;
    const auto found = calibrated(simulated({.camera = camera, .count = 12, .distance = f / 1500}),
                                  {.distortion = Distortion::equidistant});
    EXPECT_LT(std::abs(found.camera.fx - f), 4 * found.camera.sigmas[0]) << f;
    EXPECT_NEAR(found.camera.fx, f, 0.03 * f);
    for (int k = 0; k < 4; ++k) EXPECT_GT(found.camera.sigmas[k], 0) << k;
  }
}

TEST(Calibrate, NumbersThatAreNotFiniteDoNotReachTheResult) {
  const auto expect_finite = [](const BoardSearch& search, const char* what) {
    const auto found = calibrate_camera(search, kBoard);
    if (!found.ok) return;
    EXPECT_LT(largest_normalized_error(found, phone()), 4) << what;
    EXPECT_TRUE(std::isfinite(found.rms_px)) << what;
    for (const double sigma : found.camera.sigmas)
      EXPECT_TRUE(std::isfinite(sigma) && sigma > 0) << what;
  };
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(),
                           std::numeric_limits<double>::infinity(),
                           -1e300}) {
    BoardSearch corner = simulated({.seed = 6});
    corner.views[3].corners[5].y() = bad;
    expect_finite(corner, "corner");
    BoardSearch view = simulated({.seed = 6});
    for (auto& px : view.views[3].corners) px.x() = bad;
    expect_finite(view, "view");
    BoardSearch edge = simulated({.seed = 6});
    edge.views[3].edge_px = bad;
    expect_finite(edge, "edge");
    BoardSearch velocities = simulated({.seed = 6});
    for (auto& one : velocities.views) one.velocities_px_s.assign(54, Vector2d(1, bad));
    expect_finite(velocities, "velocities");
  }
}

TEST(ResidualStructure, SeparatesNoiseFromWhatViewsHaveInCommon) {
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0, 0.2);
  std::uniform_real_distribution<double> place(0, 1);
  const auto views = [&](double common_px) {
    std::vector<Eigen::Matrix4Xd> all(20, Eigen::Matrix4Xd(4, 54));
    for (auto& view : all)
      for (auto corner : view.colwise()) {
        const double x = 640 * place(random), y = 480 * place(random);
        corner << x, y, noise(random) + common_px * (x < 320 ? 1 : -1), noise(random);
      }
    return all;
  };
  const auto none = residual_structure(views(0), {640, 480});
  EXPECT_LT(std::abs(none.significance), 3);
  EXPECT_LT(none.share, 0.01);
  const auto common = residual_structure(views(0.1), {640, 480});
  EXPECT_NEAR(common.rms_px, 0.1, 0.02);
  EXPECT_NEAR(common.share, 0.01 / 0.09, 0.03);
  EXPECT_GT(common.significance, 6);
  // A single view has nothing in common with others.
  EXPECT_EQ(residual_structure({views(0.1).front()}, {640, 480}).rms_px, 0);
}

TEST(CalibrationReport, ComparesEachParameterWithTheRecordedOne) {
  Camera found = phone(), recorded = phone();
  found.sigmas = {3, 4, 0, 1, 0.01, 0.02, 0, 0.0004};
  recorded.sigmas = {4, 3, 0, 1, 0.01, 0.02, 0.0003, 0.0004};
  recorded.fx += 10;
  const std::string text = comparison_text(found, recorded);
  EXPECT_THAT(text,
              HasSubstr("fx              600.00, recorded 610.00 +- 4.00: -10.00 px (-2.0 sigma)"));
  EXPECT_THAT(text, HasSubstr("(no standard deviation)"));
  for (const std::string& name : parameter_names(found)) EXPECT_THAT(text, HasSubstr(name)) << name;
  recorded.distortion = Distortion::equidistant;
  EXPECT_THAT(comparison_text(found, recorded),
              testing::AllOf(HasSubstr("The lens models differ"), testing::Not(HasSubstr("k1 "))));
}

TEST(Calibrate, WarnsIfTheBoardStaysInTheMiddle) {
  BoardSearch search = simulated({.count = 150, .seed = 2, .distance = 0.9});
  std::erase_if(search.views, [](const CalibrationView& view) {
    return std::ranges::any_of(view.corners, [](const Vector2d& corner) {
      return corner.x() < 140 || corner.x() > 500 || corner.y() < 100 || corner.y() > 380;
    });
  });
  const auto found = calibrated(search);
  ASSERT_FALSE(found.warnings.empty());
  EXPECT_THAT(found.warnings.front(), HasSubstr("% of the image, the lens is unknown"));
}

TEST(ChooseViews, ReturnsDifferentSharpViewsInOrderOfTime) {
  BoardSearch search = simulated({.count = 12, .seed = 3});
  // Twenty copies of the first, one of them sharper, and a blurred one that differs from all.
  for (int i = 0; i < 20; ++i) search.views.insert(search.views.begin(), search.views.front());
  for (int i = 0; i < 32; ++i) search.views[i].frame = i <= 20 ? 0 : i;
  search.views[4].edge_px = 1.4;
  search.views[4].frame = 1;
  search.views.back().edge_px = 5;
  std::vector<int> frames;
  for (const auto& view : choose_views(search, kBoard, 11)) frames.push_back(view.frame);
  EXPECT_THAT(frames, testing::ElementsAre(1, 21, 22, 23, 24, 25, 26, 27, 28, 29, 30));
}

TEST(CalibrationViews, MeasureTheWidthOfEdgesAndRefuseDifferentSizes) {
  const Camera camera{320, 240, 300, 300, 160, 120, phone().distortion, phone().coefficients};
  const cv::Mat sharp = render_board(kBoard, camera, looking_at(kBoard, 0.35, 10, 5));
  const FrameCache images(3, [&](int index) {
    cv::Mat image;
    const std::vector<cv::Size> blur = {{1, 1}, {7, 1}, {1, 9}};
    cv::blur(sharp, image, blur[index]);
    cv::cvtColor(image, image, cv::COLOR_GRAY2BGR);
    return image;
  });
  std::vector<int> progress;
  const BoardSearch search =
      find_calibration_views(images, kBoard, 10, [&](int done, int) { progress.push_back(done); });
  EXPECT_THAT(progress, testing::ElementsAre(1, 2, 3));
  EXPECT_EQ(search.size, sharp.size());
  ASSERT_EQ(search.views.size(), 3U);
  EXPECT_LT(search.views[0].edge_px, 2);
  for (const int blurred : {1, 2}) EXPECT_GT(search.views[blurred].edge_px, 3);
  const FrameCache unlike(
      2, [](int index) { return cv::Mat(48, 64 + index, CV_8UC3, cv::Scalar::all(9)); });
  EXPECT_EQ(error_of([&] { find_calibration_views(unlike, kBoard, 10); }),
            "image 1: found 65x48 pixels, expected 64x48 as in the first");
}

/// Image of an AprilGrid by warping a large print, without lens distortion.
cv::Mat grid_image(const cv::Mat& print, double texels, const Camera& camera, const Pose& pose) {
  constexpr int kFine = 3;
  const Eigen::Matrix3d R = pose.R_wc.transpose();
  Eigen::Matrix3d plane;  // board [m] -> camera
  plane << R.col(0), R.col(1), -R * pose.p_wc;
  Eigen::Matrix3d to_board, to_fine;
  const double margin = 0.5 * print.cols / texels - 0.1225;  // board and print have one center
  const double above = 0.5 * print.rows / texels - 0.09;
  to_board << 1 / texels, 0, 0.5 / texels - margin, 0, 1 / texels, 0.5 / texels - above, 0, 0, 1;
  to_fine << kFine, 0, 1, 0, kFine, 1, 0, 0, 1;
  const Eigen::Matrix3d H = to_fine * intrinsic_matrix(camera) * plane * to_board;
  cv::Mat warp;
  cv::eigen2cv(H, warp);
  cv::Mat fine, image;
  cv::warpPerspective(print,
                      fine,
                      warp,
                      {kFine * camera.width, kFine * camera.height},
                      cv::INTER_AREA,
                      cv::BORDER_CONSTANT,
                      cv::Scalar(110));
  cv::resize(fine, image, {camera.width, camera.height}, 0, 0, cv::INTER_AREA);
  cv::cvtColor(image, image, cv::COLOR_GRAY2BGR);
  return image;
}

TEST(Calibrate, AcceptsImagesOfAnAprilGrid) {
  const Board grid{8, 6, 0.05, {}, BoardTags{0.3, 2, {}}};
  constexpr double kTexels = 2400;  // per meter
  cv::Mat print(static_cast<int>(0.24 * kTexels), static_cast<int>(0.31 * kTexels), CV_8U);
  const Vector3d last = board_points(grid).back();
  ASSERT_NEAR(last.x() / 2, 0.1225, 1e-12);
  ASSERT_NEAR(last.y() / 2, 0.09, 1e-12);
  for (int v = 0; v < print.rows; ++v)
    for (int u = 0; u < print.cols; ++u)
      print.at<std::uint8_t>(v, u) = static_cast<std::uint8_t>(
          tag_gray(grid,
                   (u + 0.5) / kTexels - 0.5 * print.cols / kTexels + last.x() / 2,
                   (v + 0.5) / kTexels - 0.5 * print.rows / kTexels + last.y() / 2));
  const Camera camera{640, 480, 600, 604, 317, 243, Distortion::none, {}};
  std::mt19937 random(5);
  std::vector<cv::Mat> images;
  for (int i = 0; i < 30; ++i)
    images.push_back(grid_image(print, kTexels, camera, pose_from(random, 0.45, 35)));
  const FrameCache frames(
      30, [&](int frame) { return images[frame]; }, FrameCache::kDefaultByteLimit);
  const auto found = calibrated(find_calibration_views(frames, grid, 30), {}, grid);
  EXPECT_GE(found.found, 28);
  EXPECT_LT(found.rms_px, 0.15);
  for (int k = 0; k < 4; ++k) EXPECT_NEAR(parameters(found.camera)[k], parameters(camera)[k], 2);
}

TEST(CalibrationReport, CanBeReadAsACalibration) {
  CameraCalibration calibration;
  calibration.ok = true;
  calibration.camera = phone();
  calibration.camera.readout = Readout{0.0213, 4e-4};
  calibration.camera.readout_direction = ReadoutDirection::left;
  const Eigen::VectorXd sigmas{{1.5, 1.6, 0.7, 0.8, 0.01, 0.02, 0.0003, 0.0004}};
  set_lens_covariance(
      calibration.camera,
      0.5 * sigmas * sigmas.transpose() + 0.5 * Eigen::MatrixXd(sigmas.cwiseAbs2().asDiagonal()));
  calibration.frames = {1, 2, 3};
  calibration.warnings = {"a warning: with a colon"};
  const TestFolder folder;
  const auto file = folder.write("camera.yaml", to_yaml(calibration, "a video.mp4"));
  const Camera read = read_calibration(file).camera;
  EXPECT_EQ(parameters(read), parameters(phone()));
  EXPECT_EQ(read.readout, calibration.camera.readout);
  EXPECT_EQ(read.readout_direction, calibration.camera.readout_direction);
  for (std::size_t k = 0; k < calibration.camera.covariance.size(); ++k)
    EXPECT_NEAR(read.covariance[k], calibration.camera.covariance[k], 1e-8 * read.covariance[k]);
  EXPECT_THAT(folder.read("camera.yaml"), HasSubstr("intrinsics_sigma: [1.5, 1.6, 0.7"));
  EXPECT_THAT(to_text(calibration), HasSubstr("fx              600.00 +- 1.50 px\n"));
  EXPECT_THAT(to_text(calibration), HasSubstr("warning     a warning: with a colon\n"));
}

const Camera kFilmingCamera{
    320, 240, 290, 291, 164, 117, Distortion::radial_tangential, {0.05, -0.1, 0, 0}};

/// A hand-held camera about 1 m above z = 0 that leans by up to `lean_deg` in all directions.
Pose pose_at(double t, double lean_deg) {
  const double lean = radians(lean_deg);
  const Eigen::Matrix3d R = so3_exp(
      Vector3d(lean * std::sin(5 * t), lean * std::sin(3.7 * t + 1), 0.15 * std::sin(4 * t)));
  const Vector3d looked_at(0.25 * std::sin(3 * t), 0.2 * std::sin(2 * t + 2), 0);
  return {R, looked_at - (1 + 0.1 * std::sin(2.5 * t)) * R.col(2)};
}

/// Images of a texture on z = 0, in closed form.
FrameCache images_of(int count, double lean_deg) {
  const auto rays = std::make_shared<std::vector<Vector3d>>();
  for (int v = 0; v < kFilmingCamera.height; ++v)
    for (int u = 0; u < kFilmingCamera.width; ++u)
      rays->push_back(intrinsic_matrix(kFilmingCamera).inverse() *
                      undistort(kFilmingCamera, Vector2d(u, v)).homogeneous());
  return {
      count, [=](int i) {
        const Pose pose = pose_at(i / 30.0, lean_deg);
        const auto place = [&](const Vector2d& px) -> Vector2d {
          const Vector3d ray =
              pose.R_wc *
              (*rays)[static_cast<int>(px.y()) * kFilmingCamera.width + static_cast<int>(px.x())];
          // A texel is a pixel if the camera looks straight at the plane. Bent, so that it does not
          // repeat.
          const Vector2d texel = 290 * (pose.p_wc - ray * pose.p_wc.z() / ray.z()).head<2>();
          return texel + 12 * Vector2d(std::sin(texel.y() / 31), std::sin(texel.x() / 27));
        };
        const cv::Mat exact = image_of({kFilmingCamera.width, kFilmingCamera.height}, place);
        cv::Mat noise(exact.size(), CV_16S), gray, bgr;
        cv::RNG(i + 1).fill(noise, cv::RNG::NORMAL, 0, 3);  // gray levels
        cv::add(exact, noise, gray, cv::noArray(), CV_8U);
        cv::cvtColor(gray, bgr, cv::COLOR_GRAY2BGR);
        return bgr;
      }};
}

TEST(SelfCalibration, EstimatesTheCameraFromImagesOfAPlane) {
  const FrameCache images = images_of(60, 25);
  std::vector<std::int64_t> times_ns;
  for (int i = 0; i < 60; ++i) times_ns.push_back(i * 33'333'333LL);
  std::vector<std::string> steps;
  const auto found =
      calibrate_from_plane(images,
                           camera_of_view(kFilmingCamera.width, kFilmingCamera.height),
                           times_ns,
                           nullptr,
                           [&](const char* what, int, int) {
                             if (steps.empty() || steps.back() != what) steps.emplace_back(what);
                           });
  ASSERT_TRUE(found.ok) << found.reason;
  EXPECT_NEAR(found.camera.fx, kFilmingCamera.fx, 0.01 * kFilmingCamera.fx) << to_text(found);
  EXPECT_LT(std::abs(found.camera.fx - kFilmingCamera.fx), 3 * found.camera.sigmas[0])
      << to_text(found);
  EXPECT_THAT(
      steps,
      testing::ElementsAre(
          "following a plane", "finding its points in other images", "estimating the lens"));
  const TestFolder folder;
  const Calibration read = read_calibration(folder.write("camera.yaml", to_yaml(found, "test")));
  EXPECT_EQ(read.source, CameraSource::self_calibrated);
  EXPECT_NEAR(read.camera.fx, found.camera.fx, 1e-4);
  ASSERT_EQ(read.camera.sigmas.size(), 8);
  EXPECT_NEAR(read.camera.sigmas[0], found.camera.sigmas[0], 0.01 * read.camera.sigmas[0]);
  EXPECT_LT(std::abs(normalized_aspect_error(read.camera, kFilmingCamera, 0.6)), 3.5);
  ASSERT_TRUE(read.camera.readout);
  EXPECT_LT(std::abs(read.camera.readout->seconds), 4 * read.camera.readout->sigma_s);
}

TEST(SelfCalibration, RefusesACameraThatKeepsItsTilt) {
  const FrameCache images = images_of(40, 0.5);
  const auto found =
      calibrate_from_plane(images, camera_of_view(kFilmingCamera.width, kFilmingCamera.height));
  EXPECT_FALSE(found.ok) << to_text(found);
  EXPECT_THAT(found.reason, HasSubstr("keeps its tilt to the plane"));
}

}  // namespace
}  // namespace gpo::test
