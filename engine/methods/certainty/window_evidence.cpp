// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/certainty/window_evidence.h"

#include "engine/methods/common/window_checks.h"
#include "engine/window/frame_errors.h"

#include <algorithm>

#include <fmt/format.h>

namespace gpo {
namespace {

// Simulated windows (0.5 px of noise): rotations only leave 1.9 to 12 deg, low parallax (4 % of d)
// 0.17 to 0.41, others less than 0.06; a room 0.1 to 0.4.
constexpr double kWeakSigma_deg = 0.5;
constexpr double kDegenerateSigma_deg = 10;
// The best rotations leave the noise where there is no parallax, twice to six times as much at low
// parallax.
constexpr double kDegenerateRotationToNoise = 1.3;
constexpr double kDegenerateTranslation = 0.015;

}  // namespace

void WindowEvidence::add(const FrameErrors& errors) {
  ++frames_;
  residuals_ += 2.0 * errors.inliers;
  homography_squares_ += errors.homography_squares;
  rotation_squares_ += errors.rotation_squares;
}

double WindowEvidence::noise_px() const {
  return gpo::noise_px(homography_squares_, residuals_, 8.0 * frames_);
}

double WindowEvidence::rotation_rms_px() const {
  return gpo::noise_px(rotation_squares_, residuals_, 3.0 * frames_);
}

WindowEvidence evidence_of(const Window& window) {
  WindowEvidence evidence;
  const std::vector<FrameErrors> errors = frame_errors(window);
  for (int i = 1; i < window.frame_count(); ++i) evidence.add(errors[i]);
  return evidence;
}

Verdict judged(const WindowEvidence& evidence,
               std::optional<double> normal_sigma_deg,
               double largest_translation) {
  const double noise_px = evidence.noise_px();
  const double rotation_px = evidence.rotation_rms_px();
  Verdict verdict{
      Readiness::degenerate, "", normal_sigma_deg, rotation_px, noise_px, largest_translation};
  if (rotation_px < kDegenerateRotationToNoise * noise_px) {
    verdict.reason = fmt::format(
        "rotations alone explain the window to {:.2f} px, where the homographies leave {:.2f} px",
        rotation_px,
        noise_px);
  } else if (!normal_sigma_deg) {
    verdict.reason = "the window does not determine the plane's normal";
  } else if (*normal_sigma_deg > kDegenerateSigma_deg) {
    verdict.reason = fmt::format(
        "the window tells the plane's normal to {:.1f} deg only; move the camera farther",
        *normal_sigma_deg);
  } else if (largest_translation < kDegenerateTranslation) {
    verdict.reason = fmt::format("the camera moved by only {:.1f} % of its distance from the plane",
                                 100 * largest_translation);
  } else if (largest_translation < kReadyTranslation) {
    verdict.readiness = Readiness::weak;
    verdict.reason = fmt::format(
        "little parallax: the window tells the normal to {:.2f} deg, the camera moved by {:.1f} % "
        "of its distance from the plane",
        *normal_sigma_deg,
        100 * largest_translation);
  } else if (*normal_sigma_deg > kWeakSigma_deg) {
    verdict.readiness = Readiness::weak;
    verdict.reason =
        fmt::format("the window tells the plane's normal to {:.2f} deg only", *normal_sigma_deg);
  } else {
    verdict.readiness = Readiness::ready;
    verdict.reason = fmt::format("the window tells the normal to {:.2f} deg", *normal_sigma_deg);
  }
  return verdict;
}

}  // namespace gpo
