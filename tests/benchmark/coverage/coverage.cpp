// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause

// Coverage of the claimed covariances: initializes simulated windows with the default settings and
// compares errors with their covariances.
//   coverage [WINDOWS [automatic|transfer|sampson|latent [CASE]]]
#include "engine/geometry/pose.h"
#include "engine/geometry/statistics.h"
#include "engine/initialize.h"
#include "tests/engine/simulated_window.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <numbers>
#include <numeric>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <fmt/format.h>

namespace {

using namespace gpo;
using test::Motion;
using enum test::Motion;

enum class Given { rotations, gyroscope, nothing };

struct Case {
  const char* name;
  Given given = Given::rotations;
  double noise_px = 0.5;
  double reference_noise_px = 0.5;
  double row_delay_s = 0;
  Shutter shutter = Shutter::estimated;  ///< known: to 2 %
  double lens_px = 0;                    ///< smooth residual of the lens, at the corners
  double bend_px = 0;                    ///< quadratic distortion of the image
  double outliers = 0;                   ///< share of the tracks off the plane
  double late_s = 0;                     ///< gyroscope clock - camera clock, unknown
};

const std::vector<Case> kCases = {
    {.name = "exact reference", .reference_noise_px = 0},
    {.name = "noise 0.25 px", .noise_px = 0.25, .reference_noise_px = 0.25},
    {.name = "noise 0.5 px"},
    {.name = "noise 1 px", .noise_px = 1, .reference_noise_px = 1},
    {.name = "gyroscope", .given = Given::gyroscope},
    {.name = "gyroscope, exact reference", .given = Given::gyroscope, .reference_noise_px = 0},
    {.name = "gyroscope 10 ms late", .given = Given::gyroscope, .late_s = 0.01},
    {.name = "images only", .given = Given::nothing},
    {.name = "20 us", .row_delay_s = 2e-5},
    {.name = "20 us, known", .row_delay_s = 2e-5, .shutter = Shutter::known},
    {.name = "20 us, as global", .row_delay_s = 2e-5, .shutter = Shutter::global},
    {.name = "40 us", .row_delay_s = 4e-5},
    {.name = "40 us, known", .row_delay_s = 4e-5, .shutter = Shutter::known},
    {.name = "40 us, as global", .row_delay_s = 4e-5, .shutter = Shutter::global},
    {.name = "40 us, gyroscope", .given = Given::gyroscope, .row_delay_s = 4e-5},
    {.name = "40 us, gyroscope 10 ms late",
     .given = Given::gyroscope,
     .row_delay_s = 4e-5,
     .late_s = 0.01},
    {.name = "40 us, images only", .given = Given::nothing, .row_delay_s = 4e-5},
    {.name = "40 us, exact reference", .reference_noise_px = 0, .row_delay_s = 4e-5},
    {.name = "lens 0.3 px", .lens_px = 0.3},
    {.name = "lens 1 px", .lens_px = 1},
    {.name = "lens 0.3 px, images only", .given = Given::nothing, .lens_px = 0.3},
    {.name = "lens 1 px, images only", .given = Given::nothing, .lens_px = 1},
    {.name = "bend 0.3 px", .bend_px = 0.3},
    {.name = "bend 1 px", .bend_px = 1},
    {.name = "outliers 20 %", .outliers = 0.2},
};

constexpr Motion kUsed[] = {sideways, orbit, approach, up_down, wander, arc};

/// A smooth displacement of raw pixels that is the same in all frames: waves as long as the image
/// and a quadratic.
class LensResidual {
 public:
  LensResidual(const Case& with, std::uint64_t seed)
      : lens_px_(with.lens_px), bend_px_(with.bend_px) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> uniform(0, 2 * std::numbers::pi);
    for (double* phase : {&x_, &y_, &turn_}) *phase = uniform(random);
  }
  Eigen::Vector2d at(const Eigen::Vector2d& p) const {
    const Eigen::Vector2d q = (p - Eigen::Vector2d(319.5, 239.5)) / 400;
    const double r2 = q.squaredNorm();
    const Eigen::Vector2d waves(std::sin(2.5 * q.x() + 1.5 * q.y() + x_),
                                std::sin(1.5 * q.x() - 2.5 * q.y() + y_));
    const Eigen::Vector2d radial = q * r2;
    const Eigen::Vector2d quadratic(q.x() * q.x() - q.x() * q.y(), q.x() * q.y() + q.y() * q.y());
    return lens_px_ * (0.6 * radial + 0.4 * r2 * waves) +
           bend_px_ * (Eigen::Rotation2Dd(turn_) * quadratic);
  }

 private:
  double lens_px_, bend_px_, x_ = 0, y_ = 0, turn_ = 0;
};

std::vector<Frame> frames_of(const test::Simulation& simulation,
                             const Case& with,
                             std::uint64_t seed) {
  const LensResidual lens(with, seed);
  std::vector<Frame> frames;
  for (int i = 0; i < simulation.window.frame_count(); ++i) {
    Frame frame{.timestamp_ns = simulation.window.timestamps_ns[i]};
    frame.raw_px = simulation.window.points_px[i];
    for (int j = 0; j < simulation.window.track_count(); ++j) {
      frame.ids.push_back(j);
      frame.raw_px.col(j) += lens.at(frame.raw_px.col(j));
    }
    if (with.given == Given::rotations) frame.R_wc = simulation.cameras[i].R_wc;
    frames.push_back(std::move(frame));
  }
  return frames;
}

/// Squared errors normalized by their covariances; 1 - share of the limit is covered.
struct Normalized {
  double limit = 0;
  std::vector<double> values = {};

  void add(double value) { values.push_back(value); }
  double count() const { return static_cast<double>(std::max<std::size_t>(1, values.size())); }
  double mean() const { return std::reduce(values.begin(), values.end()) / count(); }
  double beyond_percent() const {
    const auto beyond = std::ranges::count_if(values, [&](double value) { return value > limit; });
    return 100.0 * static_cast<double>(beyond) / count();
  }
};

double median_of(const std::vector<double>& values) {
  return values.empty() ? std::nan("") : median(values);
}

struct Totals {
  std::map<std::string, int> reasons;
  int windows = 0, solved = 0, ready = 0, found_shutter = 0;
  std::vector<double> errors_deg, bounds_deg, sigmas_deg, row_delay_errors;
  Normalized normal{5.991}, center{7.815}, ratio{3.841};
};

double nees(const Eigen::Vector3d& error, const Eigen::Matrix3d& covariance, double rank) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(covariance);
  double sum = 0;
  for (int k = 3 - static_cast<int>(rank); k < 3; ++k)
    sum += std::pow(eigen.eigenvectors().col(k).dot(error), 2) / eigen.eigenvalues()(k);
  return sum;
}

void add(const test::Simulation& simulation,
         const WindowResult& result,
         double row_delay_s,
         Totals& totals) {
  ++totals.windows;
  const Initialization& found = result.initialization;
  if (!found.ok || !found.uncertainty) {
    ++totals.reasons[found.reason];
    return;
  }
  ++totals.solved;
  totals.ready += result.is_ready() ? 1 : 0;
  const Uncertainty& u = *found.uncertainty;
  const Eigen::Vector3d& n = simulation.plane.normal;
  totals.errors_deg.push_back(angle_deg(found.plane.normal, n));
  totals.sigmas_deg.push_back(u.normal_sigma_deg);
  if (u.bound_known_rotations_deg) totals.bounds_deg.push_back(*u.bound_known_rotations_deg);
  totals.normal.add(nees(found.plane.normal - n, u.normal_covariance, 2));
  for (std::size_t i = 1; i < found.cameras.size(); ++i) {
    const Eigen::Vector3d error = found.cameras[i].p_wc - simulation.cameras[i].p_wc;
    totals.center.add(nees(error, u.center_covariances[i], 3));
    const double ratio =
        found.plane.normal.dot(found.cameras[i].p_wc) - n.dot(simulation.cameras[i].p_wc);
    totals.ratio.add(std::pow(ratio / u.distance_ratio_sigmas[i], 2));
  }
  totals.found_shutter += found.row_delay_s ? 1 : 0;
  totals.row_delay_errors.push_back((found.row_delay_s.value_or(0) - row_delay_s) * 1e6);
}

test::Simulation simulated(const Case& one, int number) {
  test::SimulationOptions options;
  options.motion = kUsed[number % std::size(kUsed)];
  options.noise_px = one.noise_px;
  options.reference_noise_px = one.reference_noise_px;
  options.row_delay_s = one.row_delay_s;
  options.off_plane = one.outliers;
  options.seed = 1000 + number;
  return test::simulate(options);
}

void measure(const Case& one, ErrorModel error, int windows) {
  Totals totals;
  for (int number = 0; number < windows; ++number) {
    const test::Simulation simulation = simulated(one, number);
    std::optional<Gyroscope> gyroscope;
    if (one.given == Given::gyroscope) {
      test::SimulationOptions options;
      options.motion = kUsed[number % std::size(kUsed)];
      options.seed = 1000 + number;
      options.gyro_bias_rad_s = 0.02;
      options.gyro_noise_rad_s = 0.002;
      options.gyro_offset_s = one.late_s;
      gyroscope = test::simulated_gyroscope(options);
    }
    InitializeOptions options;
    options.lens = Lens::exact;
    options.method_options.error = error;
    options.method_options.shutter = one.shutter;
    Camera camera{640, 480, 500, 500, 319.5, 239.5};
    if (one.shutter == Shutter::known) camera.readout = readout_of(479 * one.row_delay_s);
    add(simulation,
        initialize(
            camera, frames_of(simulation, one, number), gyroscope ? &*gyroscope : nullptr, options),
        one.row_delay_s,
        totals);
  }
  fmt::print(
      "| {:24} | {:3.0f} % | {:3.0f} % | {:6.3f} | {:6.3f} | {:6.3f} | {:5.2f}, {:3.0f} % | "
      "{:5.2f}, {:3.0f} % | {:5.2f}, {:3.0f} % | {:3.0f} % | {:6.2f} |\n",
      one.name,
      100.0 * totals.solved / totals.windows,
      100.0 * totals.ready / totals.windows,
      median_of(totals.errors_deg),
      median_of(totals.sigmas_deg),
      median_of(totals.bounds_deg),
      totals.normal.mean(),
      totals.normal.beyond_percent(),
      totals.center.mean(),
      totals.center.beyond_percent(),
      totals.ratio.mean(),
      totals.ratio.beyond_percent(),
      100.0 * totals.found_shutter / std::max(1, totals.solved),
      median_of(totals.row_delay_errors));
  for (const auto& [reason, count] : totals.reasons) fmt::print("  {} x {}\n", count, reason);
  std::fflush(stdout);
}

}  // namespace

int main(int count, char** arguments) {
  const int windows = count > 1 ? std::atoi(arguments[1]) : 200;
  const auto error = choice<ErrorModel>(count > 2 ? arguments[2] : "automatic");
  fmt::print(
      "| case | solved | ready | error [deg] | sigma [deg] | bound [deg] | normal (2), beyond | "
      "center (3), beyond | ratio (1), beyond | shutter found | row delay error [us] |\n"
      "| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n");
  for (const Case& one : kCases)
    if (count < 4 || std::string_view(one.name).find(arguments[3]) != std::string_view::npos)
      measure(one, error, windows);
}
