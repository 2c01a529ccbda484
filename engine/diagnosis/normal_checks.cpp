// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/diagnosis/checks.h"
#include "engine/diagnosis/limits.h"

#include <cmath>
#include <optional>

#include <fmt/format.h>

namespace gpo::check {
namespace {

constexpr double kUndetermined_deg = 90;  // beyond it a standard deviation means nothing
// Without parallax the best rotations leave 0.996 to 1.012 times the noise (simulated windows,
// tilts of 10 and 40 deg, 0.2 and 0.5 px), with a path of 4 % of the distance 1.6 to 14 times.
constexpr double kDegenerateRotationToNoise = 1.26;
constexpr double kDegenerateTranslation = 0.015;
constexpr double kMostBend_deg = 12;  // a surface whose normal varies more is no plane
constexpr double kMainShare = 0.7;    // about half of the variance

/// An unknown or infinite standard deviation is degenerate.
Level level_of(std::optional<double> sigma_deg) {
  if (!sigma_deg || !(*sigma_deg <= kDegenerateSigma_deg)) return Level::degenerate;
  return *sigma_deg > kWeakSigma_deg ? Level::weak : Level::note;
}

/// An uneven surface makes a window weak, not degenerate: a longer path would not help.
Level level_by_sigma(const Evidence& e) {
  const auto sigma_deg = e.numbers->normal_sigma_deg;
  const Level level = level_of(sigma_deg);
  const Uncertainty* u = e.uncertainty();
  if (level != Level::degenerate || u == nullptr || !u->bend_sigma_deg ||
      !(sigma_deg <= kMostBend_deg))
    return level;
  const double flat_deg2 = std::pow(*sigma_deg, 2) - std::pow(*u->bend_sigma_deg, 2);
  return level_of(std::sqrt(std::max(0.0, flat_deg2))) == Level::degenerate ? level : Level::weak;
}

bool is_main(const std::optional<double>& part_deg, const Evidence& e) {
  return part_deg && e.numbers->normal_sigma_deg &&
         *part_deg >= kMainShare * *e.numbers->normal_sigma_deg;
}

/// Returns the level of a main cause of a large standard deviation; note if it is none.
Level level_of_cause(const Evidence& e, const std::optional<double> Uncertainty::*part_deg) {
  if (e.numbers == nullptr || e.uncertainty() == nullptr) return Level::note;
  return is_main(e.uncertainty()->*part_deg, e) ? level_by_sigma(e) : Level::note;
}

Findings one(Level level, std::string sentence, std::string advice = "") {
  return {{.level = level, .sentence = std::move(sentence), .advice = std::move(advice)}};
}

}  // namespace

Findings rotation_only(const Evidence& e) {
  if (e.numbers == nullptr || !e.numbers->rotation_rms_px || !e.numbers->noise_px) return {};
  const double rotation_px = *e.numbers->rotation_rms_px, noise_px = *e.numbers->noise_px;
  if (!(rotation_px < kDegenerateRotationToNoise * noise_px)) return {};
  return one(Level::degenerate,
             fmt::format("rotations alone explain the window to {:.2f} px, the homographies to "
                         "{:.2f} px",
                         rotation_px,
                         noise_px));
}

Findings late_clock(const Evidence& e) {
  const Level level = level_of_cause(e, &Uncertainty::clock_sigma_deg);
  if (level == Level::note || !e.uncertainty()->late_s) return {};
  return one(level,
             fmt::format("the clock of the gyroscope is about {:+.0f} ms off",
                         1e3 * *e.uncertainty()->late_s),
             "use gpo_joint, or calibrate it");
}

Findings neglected_rolling_shutter(const Evidence& e) {
  const Level level = level_of_cause(e, &Uncertainty::shutter_sigma_deg);
  if (level == Level::note || !e.uncertainty()->neglected_row_delay_s) return {};
  return one(level,
             fmt::format("rolling shutter, {:.1f} us from row to row, which the method does not "
                         "know",
                         1e6 * *e.uncertainty()->neglected_row_delay_s),
             "use gpo_joint");
}

Findings little_parallax(const Evidence& e) {
  if (e.numbers == nullptr || !e.numbers->largest_translation) return {};
  const double travel = *e.numbers->largest_translation;
  if (travel < kDegenerateTranslation)
    return one(Level::degenerate,
               fmt::format("the camera moved by only {:.1f} % of its distance from the plane",
                           100 * travel));
  if (!(travel < kReadyTranslation)) return {};
  return one(Level::weak,
             fmt::format("little parallax: normal uncertainty {:.2f} deg (1 sigma), the camera "
                         "moved by {:.1f} % of its distance from the plane",
                         e.numbers->normal_sigma_deg.value_or(0),
                         100 * travel));
}

Findings uncertain_lens(const Evidence& e) {
  const Uncertainty* u = e.uncertainty();
  if (u == nullptr || e.numbers == nullptr || !e.numbers->normal_sigma_deg) return {};
  const double sigma_deg = *e.numbers->normal_sigma_deg;
  if (level_by_sigma(e) != Level::weak || !(u->normal_sigma_deg < kMainShare * sigma_deg) ||
      e.camera_is_guess)
    return {};
  return one(Level::weak,
             fmt::format("plane normal only known to {:.2f} deg with a typical calibration ({:.2f} "
                         "deg with an exact lens)",
                         sigma_deg,
                         u->normal_sigma_deg),
             "calibrate the camera");
}

Findings uneven_surface(const Evidence& e) {
  if (level_of_cause(e, &Uncertainty::bend_sigma_deg) != Level::weak) return {};
  return one(Level::weak,
             fmt::format("uneven surface or lens error: the normal varies by {:.2f} deg over the "
                         "plane",
                         *e.uncertainty()->bend_sigma_deg));
}

Findings regions_disagree(const Evidence& e) {
  if (level_of_cause(e, &Uncertainty::neighbors_sigma_deg) != Level::weak) return {};
  return one(Level::weak,
             fmt::format("image regions disagree by {:.2f} deg (lens, rolling shutter or uneven "
                         "surface)",
                         *e.uncertainty()->neighbors_sigma_deg));
}

Findings uncertain_normal(const Evidence& e) {
  if (e.numbers == nullptr || !e.numbers->largest_translation) return {};
  const auto sigma_deg = e.numbers->normal_sigma_deg;
  const Level level = level_by_sigma(e);
  if (level == Level::note) return {};
  if (!sigma_deg) return one(level, "the window does not determine the plane normal");
  const char* advice =
      e.camera_is_guess ? "the camera is a guess, calibrate it" : "use a longer camera path";
  if (!(*sigma_deg <= kUndetermined_deg))
    return one(level, "the plane normal is undetermined", advice);
  const int digits = *sigma_deg > kDegenerateSigma_deg ? 1 : 2;
  return one(
      level, fmt::format("plane normal only known to {:.{}f} deg", *sigma_deg, digits), advice);
}

}  // namespace gpo::check
