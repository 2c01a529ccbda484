// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/initialize.h"

#include "engine/geometry/pose.h"
#include "engine/inspection/inspector.h"
#include "engine/live.h"
#include "tests/engine/desk.h"
#include "tests/engine/pipeline/simulated_frames.h"
#include "tests/engine/test_folder.h"

#include <functional>
#include <limits>
#include <optional>
#include <random>

#include <Eigen/Cholesky>
#include <gmock/gmock.h>

namespace gpo::test {
namespace {

using testing::HasSubstr, testing::StartsWith;

TEST(Initialize, GivesTheSameBitsAsAnInspection) {
  const auto recording = desk();
  Inspector inspector(recording);
  using enum RotationSource;
  using Options = InitializeOptions;
  for (Options options : {Options{.method = "gpo_joint"},
                          Options{.method = "gpo_joint", .rotations = averaging},
                          Options{.method = "gpo_joint", .plane = 2},
                          Options{.method = "gpo", .rotations = raw},
                          Options{.method = "gpo", .rotations = five_point},  // rejected
                          Options{.method = "gpo", .rotations = truth},
                          Options{.method = "closed_form", .rotations = gyro, .ransac = false},
                          Options{.method = "pba"},
                          Options{.method = "ba"}}) {
    SCOPED_TRACE(options.method.key() + " " + to_string(options.rotations));
    options.method_options.error = ErrorModel::transfer;  // the tracks are anchored
    const auto inspection = inspector.inspect({.frames = 12, .options = options});
    std::vector<Frame> frames = frames_of(*inspection);
    if (options.rotations == truth)
      for (std::size_t i = 0; i < frames.size(); ++i)
        frames[i].R_wc = inspection->truth->cameras[i]->R_wc;
    const WindowResult result =
        initialize(recording->camera, frames, &*recording->gyroscope, options);
    expect_same(*inspection->initialization, result.initialization);
    EXPECT_EQ(inspection->rotations_used, result.rotations);
    EXPECT_EQ(inspection->rotations_note, result.rotations_note);
    EXPECT_EQ(inspection->tracks->ids, result.ids);
  }
}

TEST(Initialize, UsesAGyroscopeThatDoesNotFitTheImagesAsAnInspectionDoes) {
  const auto with = [](const std::function<void(Gyroscope&)>& change) {
    auto recording = std::make_shared<Recording>(*desk());
    change(*recording->gyroscope);
    const InitializeOptions options{.method_options = {.error = ErrorModel::transfer}};
    const auto inspection = Inspector(recording).inspect({.options = options});
    const WindowResult result =
        initialize(recording->camera, frames_of(*inspection), &*recording->gyroscope, options);
    expect_same(*inspection->initialization, result.initialization);
    EXPECT_EQ(inspection->inertial.has_value(), result.inertial.has_value());
    const Finding* misfit = find_finding(inspection->findings, "gyroscope-misfit");
    EXPECT_THAT(result.rotations_note, StartsWith(misfit == nullptr ? "" : misfit->sentence));
    return result.rotations_note;
  };
  EXPECT_THAT(with([](Gyroscope& late) { late.time_offset_ns -= 50'000'000; }),
              HasSubstr("its clock is about +50 ms off, corrected in this window"));
  EXPECT_THAT(with([](Gyroscope& swapped) {
                swapped.R_gyro_camera = swapped.R_gyro_camera * so3_exp({0, 0, M_PI / 2});
              }),
              HasSubstr("the gyroscope is not used, it does not fit the images"));
  EXPECT_THAT(with([](Gyroscope& ending) {
                const auto count =
                    std::ranges::upper_bound(ending.timestamps_ns, desk()->timestamps_ns[15]) -
                    ending.timestamps_ns.begin();
                ending.timestamps_ns.resize(count);
                ending.rates_rad_s.resize(count);
                ending.lines.resize(count);
                if (!ending.accelerations_m_s2.empty()) ending.accelerations_m_s2.resize(count);
              }),
              HasSubstr("the gyroscope ends at"));
}

WindowResult initialized(const Simulation& simulation, const InitializeOptions& options = {}) {
  return initialize(camera_of(simulation.window), frames_of(simulation.window), nullptr, options);
}

TEST(Initialize, FindsASimulatedPlaneFromTracksAloneOrWithRotationsOfTheFrames) {
  const auto simulation = simulate({.motion = Motion::orbit, .frames = 15, .seed = 3});
  const WindowResult result = initialized(simulation);
  ASSERT_TRUE(result.is_ready()) << result.initialization.reason;
  EXPECT_EQ(result.rotations, RotationSource::averaging);
  EXPECT_THAT(result.rotations_note, HasSubstr("one plane"));
  EXPECT_LT(angle_deg(result.initialization.plane.normal, simulation.plane.normal), 0.5);
  const auto rotated = simulate({.motion = Motion::arc, .frames = 10});
  std::vector<Frame> frames = frames_of(rotated.window);
  const Eigen::Matrix3d R_other_world = so3_exp({0.3, -0.4, 1.1});
  for (std::size_t i = 0; i < frames.size(); ++i)
    frames[i].R_wc = R_other_world * rotated.window.R_wc[i];
  const WindowResult given =
      initialize(camera_of(rotated.window), frames, nullptr, {.method = "gpo"});
  EXPECT_EQ(given.rotations, RotationSource::truth);
  EXPECT_LT(angle_deg(given.initialization.plane.normal, rotated.plane.normal), 0.2);
}

TEST(Initialize, RunsAUsersMethod) {
  const auto simulation = simulate({.frames = 15});
  auto own = std::make_shared<Method>(find_method("pnp"));
  own->key = "mine";
  const WindowResult mine = initialized(simulation, {.method = MethodChoice(own)});
  ASSERT_TRUE(mine.initialization.ok) << mine.initialization.reason;
  EXPECT_EQ(mine.initialization.plane.normal,
            initialized(simulation, {.method = "pnp"}).initialization.plane.normal);
  EXPECT_THROW(initialized(simulation, {.method = "mine"}), SettingError);
}

TEST(Initialize, IsAtMostWeakWithAGuessedCameraAndReportsWhyAWindowFails) {
  const WindowResult result = initialized(simulate({.frames = 15}), {.camera_is_guess = true});
  EXPECT_TRUE(result.initialization.ok);
  EXPECT_FALSE(result.is_ready());
  EXPECT_EQ(result.why_not_ready(), "the camera is a guess: calibrate it");
  const WindowResult refused =
      initialized(simulate({.motion = Motion::rotation_only, .frames = 10}));
  EXPECT_FALSE(refused.initialization.ok);
  EXPECT_THAT(refused.why_not_ready(), HasSubstr("no parallax"));
  EXPECT_EQ(initialized(simulate({.frames = 15})).why_not_ready(), "");
  EXPECT_EQ(WindowResult().why_not_ready(), "there is no verdict on the window");
  EXPECT_EQ(refused.initialization.cameras.size(), 0U);
}

// The verdict judges the window, so it may stand beside a method that failed.
TEST(Initialize, SaysThatTheMethodFailedInTheVerdictOnItsWindow) {
  const auto own = std::make_shared<Method>(find_method("pnp"));
  own->key = "lost";
  own->initialize = [](const Window&, const MethodOptions&, const Watch&) {
    return failed("lost");
  };
  for (const double travel : {0.3, 0.05}) {
    const InitializeOptions options{.method = MethodChoice(own)};
    const WindowResult result = initialized(simulate({.frames = 15, .travel = travel}), options);
    EXPECT_EQ(result.initialization.reason, "lost");
    const Verdict verdict = result.initialization.verdict.value_or(Verdict{});
    EXPECT_EQ(verdict.readiness, Readiness::weak);
    EXPECT_EQ(verdict.reason, "the method failed: lost");
    EXPECT_EQ(find_finding(result.findings, "little-parallax") != nullptr, travel < 0.1);
  }
}

TEST(Initialize, TakesTheRowDelayFromTheReadoutTimeOfTheCamera) {
  const auto simulation = simulate({.frames = 12, .reference_noise_px = 0.5});
  Camera camera = camera_of(simulation.window);
  camera.readout = Readout{0.0479, 0.000479};
  const WindowResult result = initialize(camera, frames_of(simulation.window));
  ASSERT_TRUE(result.window.row_delay);
  EXPECT_NEAR(result.window.row_delay->mean_s, 1e-4, 1e-12);
  EXPECT_NEAR(result.window.row_delay->sigma_s, 1e-6, 1e-12);
  camera.readout_direction = ReadoutDirection::left;
  const Window by_columns = initialize(camera, frames_of(simulation.window)).window;
  EXPECT_NEAR(by_columns.row_delay->mean_s, 0.0479 / 639, 1e-12);
  EXPECT_EQ(by_columns.readout_direction, -Eigen::Vector2d::UnitX());
}

/// Rows of the undistorted image are farther apart, up to 1.3 times at its edge.
TEST(Initialize, CountsRowsInTheRecordedImage) {
  constexpr double kRowDelay_s = 4e-5;
  double sum_us = 0;
  for (int k = 0; k < 6; ++k) {
    SimulationOptions options = noisy(kMotions[k], 40 + k, 0.1);
    options.row_delay_s = kRowDelay_s;
    Camera camera = camera_of(simulate({.frames = 1}).window);
    camera.distortion = Distortion::radial_tangential;
    camera.coefficients = {-0.28, 0.07, 0, 0};
    camera.sigmas.assign(8, 0);
    options.lens = camera;
    std::vector<Frame> frames = frames_of(simulate(options).window);
    for (Frame& frame : frames)
      for (auto p : frame.raw_px.colwise()) p = distort(camera, p);
    const Initialization result = initialize(camera, frames).initialization;
    ASSERT_TRUE(result.ok && result.row_delay_s) << k << result.reason;
    sum_us += 1e6 * (*result.row_delay_s - kRowDelay_s);
  }
  EXPECT_NEAR(sum_us / 6, 0, 0.8);  // -4 if rows were those of the undistorted image
}

TEST(Initialize, MeasuresThePlanesShareOfTheRecordedImage) {
  const Window seen = simulate({.frames = 12}).window;
  Camera camera = camera_of(seen);
  camera.distortion = Distortion::radial_tangential;
  camera.coefficients = {-0.28, 0.07, 0, 0};
  camera.sigmas.assign(8, 0);
  std::vector<Frame> frames = frames_of(seen);
  for (Frame& frame : frames)
    for (auto p : frame.raw_px.colwise()) p = distort(camera, p);
  const Window window = initialize(camera, frames).window;
  ASSERT_EQ(window.planes.size(), 1U);
  Eigen::Vector2d least = frames[0].raw_px.rowwise().minCoeff();
  Eigen::Vector2d most = frames[0].raw_px.rowwise().maxCoeff();
  // The hull of 150 points lacks the corners of their bounding box.
  const double box = (most - least).prod() / (640 * 480);
  EXPECT_LT(window.planes[0].image_share, box);
  EXPECT_GT(window.planes[0].image_share, 0.8 * box);
}

/// Mean squared errors of the last camera's center and distance, divided by their covariances.
struct LensErrorRatios {
  double center = 0;
  double ratio = 0;
};

/// Initializes with errors of the lens of the size that `typical_lens_moves_px` assumes.
LensErrorRatios errors_with_wrong_lens(Lens lens) {
  constexpr int kWindows = 40;
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  LensErrorRatios mean;
  for (int k = 0; k < kWindows; ++k) {
    const Simulation simulation = simulate(noisy(kMotions[k % 8], 200 + k, 0.2));
    Camera camera = camera_of(simulation.window);
    camera.sigmas.clear();
    const double focal = 1 + 0.003 * normal(random);
    camera.fx *= focal;
    camera.fy *= focal;
    camera.cx += 0.003 * camera.width * normal(random);
    camera.cy += 0.003 * camera.width * normal(random);
    std::vector<Frame> frames = frames_of(simulation.window);
    for (std::size_t i = 0; i < frames.size(); ++i) frames[i].R_wc = simulation.cameras[i].R_wc;
    const Initialization result =
        initialize(camera, frames, nullptr, {.lens = lens}).initialization;
    EXPECT_TRUE(result.uncertainty) << k << result.reason;
    if (!result.uncertainty) continue;
    const Eigen::Vector3d& p = simulation.cameras.back().p_wc;
    const Eigen::Vector3d e = result.cameras.back().p_wc - p;
    mean.center += e.dot(result.uncertainty->center_covariances.back().ldlt().solve(e)) / 3;
    const double ratio =
        result.plane.normal.dot(result.cameras.back().p_wc) - simulation.plane.normal.dot(p);
    mean.ratio += std::pow(ratio / result.uncertainty->distance_ratio_sigmas.back(), 2);
  }
  return {mean.center / kWindows, mean.ratio / kWindows};
}

TEST(Initialize, CoversTypicalErrorsOfALensWithoutStandardDeviations) {
  const LensErrorRatios typical = errors_with_wrong_lens(Lens::typical);
  EXPECT_NEAR(typical.center, 1, 0.5);
  EXPECT_NEAR(typical.ratio, 1, 0.7);
  const LensErrorRatios exact = errors_with_wrong_lens(Lens::exact);
  EXPECT_GT(exact.center, 4);
}

/// Input of `initialize`: four frames of a simulated camera.
struct FourFrames {
  Simulation simulation = simulate({.frames = 4});
  Camera camera = camera_of(simulation.window);
  std::vector<Frame> frames = frames_of(simulation.window);
  std::optional<Gyroscope> gyroscope = std::nullopt;
  InitializeOptions options = {};

  std::string error() const {
    const Gyroscope* given = gyroscope ? &*gyroscope : nullptr;
    return error_of([&] { initialize(camera, frames, given, options); });
  }
};

using Change = std::function<void(FourFrames&)>;

std::string error_after(const Change& change) {
  FourFrames input;
  change(input);
  return input.error();
}

Gyroscope two_samples(std::int64_t first_ns, std::int64_t second_ns) {
  Gyroscope gyroscope;
  gyroscope.timestamps_ns = {first_ns, second_ns};
  gyroscope.rates_rad_s.assign(2, Eigen::Vector3d::Zero());
  return gyroscope;
}

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(Initialize, RejectsBadInputByName) {
  EXPECT_EQ(error_after([](auto& i) { i.camera.readout = readout_of(2); }),
            "camera: readout seconds 2, expected less than a second");
  EXPECT_EQ(error_after([](auto& i) { i.camera.fx = 0; }),
            "camera: fx 0, fy 500, cx 319.5, cy 239.5, expected focal lengths above 0");
  EXPECT_EQ(error_after([](auto& i) { i.frames.resize(1); }),
            "a window of 1 frame, expected at least 2");
  EXPECT_THAT(error_after([](auto& i) { i.frames[2].timestamp_ns = i.frames[1].timestamp_ns; }),
              HasSubstr("frame 2: time stamp"));
  EXPECT_EQ(error_after([](auto& i) { i.frames[1].ids.pop_back(); }),
            "frame 1: 149 ids and 150 pixels, expected equal counts");
  EXPECT_EQ(error_after([](auto& i) { i.frames[1].ids[4] = 7; }), "frame 1: track 7 is seen twice");
  EXPECT_EQ(error_after([](auto& i) { i.frames[3].raw_px(0, 0) = kNotANumber; }),
            "frame 3: a pixel is not finite");
  EXPECT_EQ(error_after([](auto& i) { i.frames[3].raw_px(1, 0) = 1e10; }),
            "frame 3: a pixel is beyond 1e9");
  EXPECT_EQ(error_after([](auto& i) {
              i.frames[3].timestamp_ns = std::numeric_limits<std::int64_t>::max();
            }),
            "frame 3: time stamp 9223372036854775807, expected -4e18 to 4e18 ns");
  EXPECT_EQ(error_after([](auto& i) { i.frames[0].R_wc = Eigen::Matrix3d::Identity(); }),
            "frame 1: expected rotations of all frames or of none");
  EXPECT_EQ(error_after([](auto& i) { i.frames[0].R_wc = Eigen::Matrix3d::Zero(); }),
            "frame 0: R_wc is not a rotation");
  EXPECT_THAT(error_after([](auto& i) { i.options.method = "magic"; }),
              HasSubstr("method: unknown method"));
  EXPECT_EQ(error_after([](auto& i) { i.options.plane = 0; }), "plane: 0, expected at least 1");
  EXPECT_EQ(error_after([](auto& i) { i.options.rotations = RotationSource::gyro; }),
            "rotations: gyro: no gyroscope given");
  EXPECT_EQ(error_after([](auto& i) { i.options.rotations = RotationSource::truth; }),
            "rotations: truth: no rotations given");
  EXPECT_EQ(error_after([](auto& i) { i.gyroscope = two_samples(5, 5); }),
            "gyroscope: time stamp 5 does not come after 5");
  EXPECT_THAT(error_after([](auto& i) {
                i.gyroscope = two_samples(-9'000'000'000, -8'990'000'000);
                i.options.rotations = RotationSource::gyro;
              }),
              HasSubstr("gyroscope:2: the gyroscope ends at"));
}

TEST(Initialize, RejectsNumbersThatAreNotFiniteNegativeOrPriorsOfZero) {
  const auto expect = [](const Change& change, const std::string& expected) {
    FourFrames input;
    input.gyroscope.emplace();
    change(input);
    EXPECT_EQ(input.error(), expected);
    const LiveOptions live{.initialize = input.options};
    EXPECT_EQ(error_of([&] { LiveInitializer(input.camera, live, input.gyroscope); }), expected);
  };
  expect([](auto& i) { i.camera.coefficients.assign(2, kNotANumber); },
         "camera: distortion coefficient nan, expected at most 1e6");
  expect([](auto& i) { i.camera.sigmas.assign(4, -1); },
         "camera: standard deviation -1, expected 0 to 1e6");
  expect([](auto& i) { i.camera.coefficients.resize(15); },
         "camera: 15 distortion coefficients, expected at most 14");
  expect([](auto& i) { i.camera.sigmas.resize(2); },
         "camera: 2 standard deviations, expected none, 4 or 4");
  expect([](auto& i) { i.camera.readout.emplace().seconds = 0.02; },
         "camera: readout sigma_s 0, expected a finite number above 0");
  expect([](auto& i) { i.gyroscope->bias_rad_s.z() = kInfinity; },
         "gyroscope: bias_rad_s inf, expected a finite number");
  expect([](auto& i) { i.gyroscope->bias_sigma_rad_s = 0; },
         "gyroscope: bias_sigma_rad_s 0, expected a finite number above 0");
  expect([](auto& i) { i.gyroscope->noise_density = -1; },
         "gyroscope: noise_density -1, expected a finite number from 0 on");
  expect([](auto& i) { i.gyroscope->time_offset_ns = std::numeric_limits<std::int64_t>::min(); },
         "gyroscope: time_offset_ns: time stamp -9223372036854775808, expected -4e18 to 4e18 ns");
  expect([](auto& i) { i.camera.width = -1; }, "camera: width -1, expected 0 to 1e6");
  expect([](auto& i) { i.options.ransac_threshold_px = kInfinity; },
         "ransac_threshold_px: inf, expected more than 0");
  expect([](auto& i) { i.options.p_gyro_camera_m = Eigen::Vector3d(0, kNotANumber, 0); },
         "p_gyro_camera_m: nan, expected a finite number");
}

TEST(Initialize, FailsIfTheRequestedPlaneDoesNotExist) {
  const auto simulation = simulate({});
  const WindowResult result =
      initialize(camera_of(simulation.window), frames_of(simulation.window), nullptr, {.plane = 5});
  EXPECT_FALSE(result.initialization.ok);
  EXPECT_EQ(result.initialization.reason, "plane 5 does not exist: the window has 1 plane");
}

}  // namespace
}  // namespace gpo::test
