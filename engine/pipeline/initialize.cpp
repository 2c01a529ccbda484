// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/initialize.h"

#include "engine/base/error.h"
#include "engine/base/limits.h"
#include "engine/map.h"
#include "engine/pipeline/method_defaults.h"
#include "engine/pipeline/pipeline.h"
#include "engine/window/tracks.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include <Eigen/LU>
#include <fmt/format.h>

namespace gpo {
namespace {

constexpr double kMostSkew = 1e-6;  // limit of each entry of R^T R - I
constexpr double kMostValue = 1e9;  // limit of pixels, rates and accelerations
/// Limit of times [ns], 126 years, so that their differences are representable.
constexpr std::int64_t kMostTime_ns = 4'000'000'000'000'000'000;
constexpr const char* kNoSamples =
    "the gyroscope has no samples in this window: the images determine the rotations";

bool is_usable(const Eigen::Ref<const Eigen::MatrixXd>& values) {
  return values.allFinite() && (values.size() == 0 || values.cwiseAbs().maxCoeff() <= kMostValue);
}

bool is_time(std::int64_t time_ns) { return time_ns >= -kMostTime_ns && time_ns <= kMostTime_ns; }

std::string out_of_range(std::int64_t time_ns) {
  return fmt::format("time stamp {}, expected -4e18 to 4e18 ns", time_ns);
}

std::string joined(const std::string& one, const std::string& other) {
  return one + (one.empty() || other.empty() ? "" : "; ") + other;
}

bool is_rotation(const Eigen::Matrix3d& R) {
  const Eigen::Matrix3d skewed = R.transpose() * R - Eigen::Matrix3d::Identity();
  return R.allFinite() && skewed.cwiseAbs().maxCoeff() < kMostSkew && R.determinant() > 0;
}

void check(const Camera& camera,
           std::span<const Frame> frames,
           const Gyroscope* gyroscope,
           const InitializeOptions& options) {
  check_camera(camera);
  check_options(options);
  if (frames.size() < 2)
    throw InputError("a window of " + counted(frames.size(), "frame") + ", expected at least 2");
  if (gyroscope != nullptr) check_gyroscope(*gyroscope);
  const std::int64_t offset_ns = gyroscope != nullptr ? gyroscope->time_offset_ns : 0;
  for (std::size_t i = 0; i < frames.size(); ++i)
    check_frame(frames[i], static_cast<int>(i), i > 0 ? &frames[i - 1] : nullptr, offset_ns);
}

std::vector<Eigen::Matrix3d> given_rotations(std::span<const Frame> frames) {
  std::vector<Eigen::Matrix3d> R_wc;
  for (const Frame& frame : frames)
    if (frame.R_wc) R_wc.emplace_back(frames[0].R_wc->transpose() * *frame.R_wc);
  return R_wc;
}

RotationSource requested_source(const InitializeOptions& options, bool given, bool has_gyroscope) {
  using enum RotationSource;
  if (given && (options.rotations == automatic || options.rotations == truth)) return truth;
  const char* lacks = options.rotations == truth                             ? "rotations"
                      : needs_gyroscope(options.rotations) && !has_gyroscope ? "gyroscope"
                                                                             : nullptr;
  if (lacks == nullptr) return options.rotations;
  throw SettingError("rotations",
                     fmt::format("{}: no {} given", to_string(options.rotations), lacks));
}

/// Completes names for messages; without a file, lines count samples.
Gyroscope with_names(Gyroscope gyroscope) {
  if (gyroscope.file.empty()) gyroscope.file = "gyroscope";
  if (gyroscope.lines.size() != gyroscope.timestamps_ns.size()) {
    gyroscope.lines.resize(gyroscope.timestamps_ns.size());
    std::iota(gyroscope.lines.begin(), gyroscope.lines.end(), 1);
  }
  return gyroscope;
}

std::optional<Pose> body_camera_of(const Gyroscope* gyroscope, const InitializeOptions& options) {
  if (gyroscope == nullptr || !options.p_gyro_camera_m) return std::nullopt;
  return Pose{gyroscope->R_gyro_camera, *options.p_gyro_camera_m};
}

}  // namespace

void check_options(const InitializeOptions& options) {
  const Method& method = options.method.row();
  if (!method.initialize && !method.initialize_from)
    throw SettingError("method", method.key + " has no function");
  check_ignored(options.ignore_findings);
  const Eigen::Vector3d lever_m = options.p_gyro_camera_m.value_or(Eigen::Vector3d::Zero());
  check_options(std::to_array<Limit>(
      {{"ransac_threshold_px", options.ransac_threshold_px.value_or(1), {1e-9, 1e9, "more than 0"}},
       {"plane", static_cast<double>(options.plane), {1, 1e9, "at least 1"}},
       {"accelerometer_bias_sigma_m_s2",
        options.accelerometer_bias_sigma_m_s2,
        {1e-9, 1e9, "more than 0"}},
       {"p_gyro_camera_m", lever_m.x(), kFinite},
       {"p_gyro_camera_m", lever_m.y(), kFinite},
       {"p_gyro_camera_m", lever_m.z(), kFinite}}));
}

std::vector<TrackObservation> observations_of(std::span<const Frame> frames) {
  std::vector<TrackObservation> observations;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    for (int k = 0; k < std::ssize(frames[i].ids); ++k)
      observations.push_back({.frame = static_cast<int>(i),
                              .track = frames[i].ids[k],
                              .raw_px = frames[i].raw_px.col(k),
                              .sigma_px = frames[i].sigma_px.size() ? frames[i].sigma_px[k] : 0});
  }
  return observations;
}

void check_frame(const Frame& frame, int number, const Frame* before, std::int64_t time_offset_ns) {
  const auto refuse = [&](const std::string& what) {
    throw InputError(fmt::format("frame {}: {}", number, what));
  };
  for (const std::int64_t offset_ns : {std::int64_t{0}, time_offset_ns})
    if (!is_time(frame.timestamp_ns) || !is_time(frame.timestamp_ns + offset_ns))
      refuse(out_of_range(frame.timestamp_ns + offset_ns));
  if (before != nullptr && frame.timestamp_ns <= before->timestamp_ns) {
    refuse(fmt::format(
        "time stamp {} does not come after {}", frame.timestamp_ns, before->timestamp_ns));
  }
  if (static_cast<Eigen::Index>(frame.ids.size()) != frame.raw_px.cols()) {
    refuse(fmt::format(
        "{} ids and {} pixels, expected equal counts", frame.ids.size(), frame.raw_px.cols()));
  }
  if (!frame.raw_px.allFinite()) refuse("a pixel is not finite");
  if (!is_usable(frame.raw_px)) refuse("a pixel is beyond 1e9");
  const Eigen::VectorXd& sigma_px = frame.sigma_px;
  if (sigma_px.size() > 0 && sigma_px.size() != frame.raw_px.cols())
    refuse(fmt::format("{} sigma_px and {} ids, expected equal counts or none",
                       sigma_px.size(),
                       frame.ids.size()));
  if (!sigma_px.allFinite() || (sigma_px.array() <= 0).any())
    refuse("a sigma_px is not a finite number above 0");
  std::vector<std::int64_t> ids = frame.ids;
  std::ranges::sort(ids);
  if (const auto twice = std::ranges::adjacent_find(ids); twice != ids.end())
    refuse(fmt::format("track {} is seen twice", *twice));
  if (before != nullptr && before->R_wc.has_value() != frame.R_wc.has_value())
    refuse("expected rotations of all frames or of none");
  const auto has_sigma = [](const Frame& f) { return f.sigma_px.size() > 0; };
  if (before != nullptr && !before->ids.empty() && !frame.ids.empty() &&
      has_sigma(*before) != has_sigma(frame))
    refuse("expected sigma_px of all frames or of none");
  if (frame.R_wc && !is_rotation(*frame.R_wc)) refuse("R_wc is not a rotation");
}

void check_sample(std::int64_t timestamp_ns,
                  const Eigen::Vector3d& rate_rad_s,
                  const Eigen::Vector3d* acceleration_m_s2) {
  if (!is_time(timestamp_ns)) throw InputError("gyroscope: " + out_of_range(timestamp_ns));
  if (!rate_rad_s.allFinite()) throw InputError("gyroscope: a rate is not finite");
  if (!is_usable(rate_rad_s)) throw InputError("gyroscope: a rate is beyond 1e9 rad/s");
  if (acceleration_m_s2 == nullptr) return;
  if (!acceleration_m_s2->allFinite())
    throw InputError("accelerometer: an acceleration is not finite");
  if (!is_usable(*acceleration_m_s2))
    throw InputError("accelerometer: an acceleration is beyond 1e9 m/s^2");
}

void check_gyroscope(const Gyroscope& gyroscope) {
  const auto& t = gyroscope.timestamps_ns;
  if (t.size() != gyroscope.rates_rad_s.size()) {
    throw InputError(fmt::format("gyroscope: {} time stamps and {} rates, expected equal counts",
                                 t.size(),
                                 gyroscope.rates_rad_s.size()));
  }
  if (const auto back = std::ranges::adjacent_find(t, std::ranges::greater_equal());
      back != t.end())
    throw InputError(
        fmt::format("gyroscope: time stamp {} does not come after {}", *(back + 1), *back));
  const auto& accelerations = gyroscope.accelerations_m_s2;
  if (!accelerations.empty() && accelerations.size() != t.size())
    throw InputError(fmt::format(
        "accelerometer: {} time stamps and {} accelerations, expected equal counts or none",
        t.size(),
        accelerations.size()));
  for (std::size_t k = 0; k < t.size(); ++k)
    check_sample(
        t[k], gyroscope.rates_rad_s[k], accelerations.empty() ? nullptr : &accelerations[k]);
  if (!is_time(gyroscope.time_offset_ns))
    throw InputError("gyroscope: time_offset_ns: " + out_of_range(gyroscope.time_offset_ns));
  check_limits("gyroscope",
               std::to_array<Limit>({{"bias_rad_s", gyroscope.bias_rad_s.x(), kFinite},
                                     {"bias_rad_s", gyroscope.bias_rad_s.y(), kFinite},
                                     {"bias_rad_s", gyroscope.bias_rad_s.z(), kFinite},
                                     {"bias_sigma_rad_s", gyroscope.bias_sigma_rad_s, kAboveZero},
                                     {"noise_density", gyroscope.noise_density, kFromZero}}));
  if (!is_rotation(gyroscope.R_gyro_camera))
    throw InputError("gyroscope: R_gyro_camera is not a rotation");
}

bool WindowResult::is_metric() const { return inertial && inertial->ok && inertial->scale_known; }

bool WindowResult::is_ready() const {
  return initialization.ok && initialization.verdict &&
         initialization.verdict->readiness == Readiness::ready;
}

std::string WindowResult::why_not_ready() const {
  if (is_ready()) return "";
  if (!initialization.ok && !initialization.reason.empty()) return initialization.reason;
  const auto& verdict = initialization.verdict;
  if (verdict && verdict->readiness != Readiness::ready && !verdict->reason.empty())
    return verdict->reason;
  return "there is no verdict on the window";
}

std::map<std::int64_t, Eigen::Vector3d> points_by_id(const WindowResult& result) {
  std::map<std::int64_t, Eigen::Vector3d> points;
  for (const auto& [track, position] : result.initialization.points)
    points.emplace(result.ids[track], position);
  return points;
}

std::vector<std::int64_t> inlier_ids(const WindowResult& result, int frame) {
  std::vector<std::int64_t> ids;
  for (const int track : result.window.inlier_tracks(frame)) ids.push_back(result.ids[track]);
  return ids;
}

std::optional<PosePrior> pose_prior(const WindowResult& result) {
  const Initialization& found = result.initialization;
  if (!found.ok || !found.uncertainty || found.uncertainty->pose_covariance.size() == 0)
    return std::nullopt;
  PosePrior prior{found.cameras, found.uncertainty->pose_covariance, {}};
  for (std::size_t i = 1; i < prior.cameras.size(); ++i)
    for (const char* part : {"rotation", "center"})
      for (const char axis : {'x', 'y', 'z'})
        prior.rows.push_back(fmt::format("camera {} {} {}", i, part, axis));
  return prior;
}

WindowResult initialize(const Camera& camera,
                        std::span<const Frame> frames,
                        const Gyroscope* gyroscope,
                        const InitializeOptions& options,
                        const std::stop_token& stop) {
  check(camera, frames, gyroscope, options);
  const auto R_wc = given_rotations(frames);
  std::optional<Gyroscope> named;
  if (gyroscope != nullptr && !gyroscope->timestamps_ns.empty()) named = with_names(*gyroscope);
  const Gyroscope* gyro = named ? &*named : nullptr;
  const RotationSource requested = requested_source(options, !R_wc.empty(), gyro != nullptr);

  std::vector<std::int64_t> timestamps_ns;
  for (const Frame& frame : frames) timestamps_ns.push_back(frame.timestamp_ns);
  Tracks tracks = select_tracks(observations_of(frames), 0, static_cast<int>(frames.size()));
  Window window = window_of(tracks, camera, timestamps_ns, options);
  const WindowRotations rotations =
      window_rotations(window, {gyro, R_wc, options.seed}, requested, stop);
  const ChosenRotations& chosen = rotations.chosen;

  WindowResult result;
  result.rotations = chosen.source;
  const bool lacks_samples = gyroscope != nullptr && gyro == nullptr && R_wc.empty();
  result.rotations_note =
      joined(lacks_samples ? kNoSamples : joined(rotations.note, rotations.advice), chosen.note);
  window = with_rotations(std::move(window), chosen.rotations, options);
  gyro = rotations.usable(gyro);
  const Sources sources{&camera, gyro, body_camera_of(gyro, options)};
  const std::string missing = missing_plane(window, options);
  MethodRun of_method =
      missing.empty() ? run_method(std::move(window), chosen.rotations, sources, options, stop)
                      : MethodRun{std::move(window), failed(missing)};
  result.window = std::move(of_method.window);
  Initialization found = std::move(of_method.result);
  add_own_noise(result.window, sources, options, stop, found);
  std::vector<Verdict> growth;
  const bool needs_growth = missing.empty() && !found.ok && !chosen.rotations.R_wc.empty();
  if (needs_growth) growth = growing_numbers(result.window, options.lens, stop);
  const Evidence known{.camera = &camera, .gyroscope = gyro, .tracks = &tracks, .ids = tracks.ids};
  Finished end = finished(result.window, sources, options, known, growth, std::move(found));
  result.initialization = std::move(end.initialization);
  result.inertial = std::move(end.inertial);
  result.findings = std::move(end.findings);
  result.ids = std::move(tracks.ids);
  return result;
}

}  // namespace gpo
