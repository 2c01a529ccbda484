// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/error.h"
#include "engine/initialize.h"
#include "tests/engine/pipeline/simulated_frames.h"

#include <cmath>

#include <gmock/gmock.h>

namespace gpo::test {
namespace {

constexpr int kParameters = 8;
using Covariance = Eigen::Matrix<double, kParameters, kParameters>;

/// f, c and distortion with strong correlations: fx with fy, k1 with k2, c with p.
Covariance correlated() {
  Eigen::Matrix<double, kParameters, 1> sigmas;
  sigmas << 1.5, 1.5, 0.8, 0.8, 0.004, 0.01, 3e-4, 3e-4;
  Covariance correlations = Covariance::Identity();
  const auto correlate = [&](int a, int b, double by) {
    correlations(a, b) = correlations(b, a) = by;
  };
  correlate(0, 1, 0.98);
  correlate(4, 5, -0.95);
  correlate(2, 7, 0.9);
  correlate(3, 6, 0.9);
  return sigmas.asDiagonal() * correlations * sigmas.asDiagonal();
}

struct Views {
  Camera camera;
  std::vector<Frame> frames;
};

Views views_of(const SimulationOptions& options) {
  const Simulation truth = simulate(options);
  Views views{camera_of(truth.window), frames_of(truth.window)};
  views.camera.sigmas.clear();
  views.camera.distortion = Distortion::radial_tangential;
  views.camera.coefficients.assign(kParameters - 4, 0.0);
  for (std::size_t i = 0; i < views.frames.size(); ++i) views.frames[i].R_wc = truth.window.R_wc[i];
  return views;
}

Initialization solved(const Views& views, const Camera& camera, Lens lens = Lens::typical) {
  InitializeOptions options{.lens = lens};
  options.method_options = {.loss = Loss::squared, .shutter = Shutter::global};
  return initialize(camera, views.frames, nullptr, options).initialization;
}

Camera with_covariance(Camera camera, const Covariance& covariance) {
  set_lens_covariance(camera, covariance);
  return camera;
}

/// Returns d normal / d parameters by central differences of the whole pipeline.
Eigen::Matrix<double, 3, kParameters> derivatives_of_normal(const Views& views) {
  Eigen::Matrix<double, 3, kParameters> G;
  for (int k = 0; k < kParameters; ++k) {
    const double step = k < 4 ? 1e-2 : 1e-5;
    const auto normal = [&](double sign) {
      Camera off = views.camera;
      double* const pinhole[] = {&off.fx, &off.fy, &off.cx, &off.cy};
      (k < 4 ? *pinhole[k] : off.coefficients[k - 4]) += sign * step;
      return solved(views, off).plane.normal;
    };
    G.col(k) = (normal(1) - normal(-1)) / (2 * step);
  }
  return G;
}

TEST(LensCovariance, ContributesAsDerivativesOfTheWholePipelineSay) {
  for (const Motion motion : {Motion::wander, Motion::orbit, Motion::arc}) {
    const Views views = views_of({.motion = motion, .noise_px = 0.2});
    const auto G = derivatives_of_normal(views);
    const auto expect_contribution = [&](const Camera& camera, const Covariance& covariance) {
      const auto result = solved(views, camera);
      ASSERT_TRUE(result.uncertainty && result.uncertainty->lens_sigma_deg);
      const double expected_deg = degrees(std::sqrt((G * covariance * G.transpose()).trace()));
      EXPECT_NEAR(*result.uncertainty->lens_sigma_deg / expected_deg, 1, 0.05);
      EXPECT_FALSE(result.uncertainty->typical_lens_sigma_deg);
    };
    const Covariance all = correlated();
    const Covariance diagonal = all.diagonal().asDiagonal();
    expect_contribution(with_covariance(views.camera, all), all);
    expect_contribution(with_covariance(views.camera, diagonal), diagonal);
    Camera by_sigmas = views.camera;
    for (int k = 0; k < kParameters; ++k) by_sigmas.sigmas.push_back(std::sqrt(all(k, k)));
    expect_contribution(by_sigmas, diagonal);
    const double ratio = (G * all * G.transpose()).trace() / (G * diagonal * G.transpose()).trace();
    EXPECT_GT(std::abs(ratio - 1), 0.05);
  }
}

TEST(LensVerdict, DependsOnATypicalCalibrationUnlessTheLensIsExact) {
  constexpr double kWeakSigma_deg = 0.5;
  int weak = 0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const Views views = views_of({.noise_px = 0.2, .travel = 0.07, .seed = seed});
    const Initialization typical = solved(views, views.camera);
    const Initialization exact = solved(views, views.camera, Lens::exact);
    ASSERT_TRUE(typical.verdict && typical.uncertainty && exact.verdict);
    const Uncertainty& u = *typical.uncertainty;
    ASSERT_TRUE(u.typical_lens_sigma_deg);
    EXPECT_GT(*u.typical_lens_sigma_deg, u.normal_sigma_deg);
    EXPECT_EQ(*typical.verdict->normal_sigma_deg, *u.typical_lens_sigma_deg);
    EXPECT_EQ(*exact.verdict->normal_sigma_deg, u.normal_sigma_deg);
    EXPECT_EQ(typical.plane.normal, exact.plane.normal);
    EXPECT_EQ(exact.verdict->readiness, Readiness::ready) << exact.verdict->reason;
    const bool is_weak = *u.typical_lens_sigma_deg > kWeakSigma_deg;
    EXPECT_EQ(typical.verdict->readiness, is_weak ? Readiness::weak : Readiness::ready);
    EXPECT_THAT(
        typical.verdict->reason,
        testing::HasSubstr(is_weak ? "with a typical calibration" : "if the lens is exact"));
    weak += is_weak ? 1 : 0;
  }
  EXPECT_GT(weak, 0);
}

TEST(LensVerdict, AGuessIsFarWorseThanATypicalCalibration) {
  Window window = simulate({.frames = 2}).window;
  const auto typical = typical_lens_moves_px(window);
  window.camera_is_guess = true;
  const auto guess = typical_lens_moves_px(window);
  ASSERT_EQ(guess.size(), typical.size());
  for (std::size_t k = 0; k < guess.size(); ++k)
    EXPECT_GT(guess[k][1].norm(), 6 * typical[k][1].norm()) << k;
  EXPECT_NEAR(guess[0][1].norm() / typical[0][1].norm(), 0.2 / 0.003, 1e-6) << "focal length";
}

TEST(LensVerdict, TakesALensAsExactIfItsFileSaysSo) {
  const Views views = views_of({.travel = 0.1});
  const Initialization unknown = solved(views, views.camera);
  const Initialization stated = solved(views, with_covariance(views.camera, Covariance::Zero()));
  ASSERT_TRUE(unknown.uncertainty && stated.uncertainty && stated.verdict);
  EXPECT_EQ(stated.uncertainty->lens_sigma_deg, 0);
  EXPECT_FALSE(stated.uncertainty->typical_lens_sigma_deg);
  EXPECT_NEAR(stated.uncertainty->normal_sigma_deg, unknown.uncertainty->normal_sigma_deg, 1e-6);
  EXPECT_EQ(stated.verdict->normal_sigma_deg, stated.uncertainty->normal_sigma_deg);
}

TEST(LensCovariance, IsRefusedForOtherParameters) {
  const Views views = views_of({});
  Camera camera = views.camera;
  camera.sigmas = {1, 1, 1};
  EXPECT_THROW(solved(views, camera), InputError);
  camera.sigmas = {1, 1, 1, -1};
  EXPECT_THROW(solved(views, camera), InputError);
  Covariance indefinite = correlated();
  indefinite(0, 2) = indefinite(2, 0) = 2 * std::sqrt(indefinite(0, 0) * indefinite(2, 2));
  EXPECT_THROW(solved(views, with_covariance(views.camera, indefinite)), InputError);
  camera = with_covariance(views.camera, correlated());
  camera.covariance.pop_back();
  EXPECT_THROW(solved(views, camera), InputError);
}

}  // namespace
}  // namespace gpo::test
