// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/panels/facts/uncertainty_facts.h"

#include "ui/look/numbers.h"
#include "ui/views/overlay/plane_style.h"

#include <cmath>
#include <optional>

#include <fmt/format.h>

namespace gpo {
namespace {

/// Why there is no uncertainty of the result.
std::string why_not_certain(const Inspection& inspection) {
  if (!inspection.initialization->ok) return "Not known: the initialization failed";
  return "Not known: it could not be determined of this result";
}

const char* rotations_note(RotationModel model) {
  if (model == RotationModel::known) return "rotations held";
  if (model == RotationModel::bias) return "gyro bias unknown";
  return "rotations unknown";
}

ResultRow normal_row(const Uncertainty& uncertainty) {
  return {"Normal",
          "\u00b1" + angle_text(uncertainty.normal_sigma_deg),
          rotations_note(uncertainty.rotations),
          fmt::format("One standard deviation of the normal's angle, first order, from noise of {} "
                      "px on each coordinate; what is unknown of the rotations counts in",
                      number_text(uncertainty.sigma_px, 2))};
}

ResultRow distance_row(const Initialization& result) {
  const double ratio =
      plane_in_camera(result.plane, result.cameras.back()).distance / result.plane.distance;
  return {
      "Distance ratio",
      uncertain_text(ratio, result.uncertainty->distance_ratio_sigmas.back()),
      "last / first",
      "Distance of the window's last camera from the plane, in distances of the first one, with "
      "its standard deviation"};
}

ResultRow bias_row(const Initialization& result, int axis) {
  const double bias = (*result.bias_rad_s)[axis];
  std::string text = fmt::format("{:.4f}", bias);
  if (result.uncertainty && result.uncertainty->bias_covariance) {
    text = uncertain_text(bias, std::sqrt((*result.uncertainty->bias_covariance)(axis, axis)));
  }
  return {std::string("Bias ") + "xyz"[axis],
          text + " rad/s",
          "",
          "Constant error of the gyroscope's rate about its axis, as the method estimates it, with "
          "its standard deviation where that is known"};
}

ResultRow bound_row(std::string label,
                    const std::optional<double>& bound_deg,
                    const char* condition,
                    std::string why_not) {
  if (!bound_deg) return dash(std::move(label), std::move(why_not));
  return {std::move(label),
          angle_text(*bound_deg),
          "",
          std::string("Cram\u00e9r-Rao bound of the normal's angle in degrees: from these tracks "
                      "and this noise no unbiased method can do better on average, ") +
              condition};
}

}  // namespace

ResultGroup verdict_group(const Inspection& inspection) {
  const Verdict verdict = inspection.initialization->verdict.value_or(Verdict{});
  const std::string why = "Not known: it could not be computed of this window";
  ResultGroup group{kVerdictTitle, {dash("Rotation alone", why), dash("Moved", why)}};
  if (verdict.rotation_rms_px) {
    group.rows[0] = {
        "Rotation alone",
        number_text(*verdict.rotation_rms_px, 2) + " px",
        verdict.noise_px ? "noise " + number_text(*verdict.noise_px, 2) + " px" : "",
        "Root mean square error that the best rotations, without any motion, leave. Where that is "
        "no more than the noise of one coordinate there is no parallax"};
  }
  if (verdict.largest_translation) {
    group.rows[1] = {"Moved",
                     number_text(*verdict.largest_translation, 3) + " d",
                     "",
                     "Largest translation from the reference camera, in distances d of the plane"};
  }
  return group;
}

ResultGroup uncertainty_group(const Inspection& inspection) {
  const Initialization& result = *inspection.initialization;
  const std::string why = why_not_certain(inspection);
  const Uncertainty u = result.uncertainty.value_or(Uncertainty{});
  const bool distances = !u.distance_ratio_sigmas.empty() && !result.cameras.empty();
  ResultGroup group{"UNCERTAINTY",
                    {result.uncertainty ? normal_row(u) : dash("Normal", why),
                     distances ? distance_row(result) : dash("Distance ratio", why)}};
  for (int axis = 0; result.bias_rad_s && axis < 3; ++axis)
    group.rows.push_back(bias_row(result, axis));
  if (result.time_offset_s) {
    group.rows.push_back(
        {"Time offset",
         milliseconds_text(1e3 * *result.time_offset_s),
         "",
         "Gyroscope's clock = camera's clock + offset, as the method estimates it"});
  }
  group.rows.push_back(bound_row(
      "Bound, known rotations", u.bound_known_rotations_deg, "were the rotations exact", why));
  group.rows.push_back(
      bound_row("Bound, unknown bias",
                u.bound_unknown_bias_deg,
                "with a constant gyroscope bias that has to be estimated, too",
                result.uncertainty ? "Not known: it takes rotations from a gyroscope" : why));
  return group;
}

std::string bar_text(const Inspection& inspection, int frame) {
  const Window& window = *inspection.window;
  const int in_window = frame - window.start;
  std::string text = fmt::format("frame {}", frame);
  if (in_window < 0 || in_window >= window.frame_count()) return text;
  text += fmt::format(": {} inliers", window.inlier_count(in_window));
  if (in_window < static_cast<int>(inspection.motion.size())) {
    const FrameMotion& motion = inspection.motion[in_window];
    text += fmt::format("\nparallax {:.1f} px, turns at {:.0f}\u00b0/s",
                        motion.parallax_px,
                        motion.rotation_rate_deg_s);
  }
  if (in_window == 0) return text + ". The window starts here: its reference frame";
  const std::vector<Verdict> growth = shown_growth(inspection);
  if (in_window > static_cast<int>(growth.size())) return text;
  const Verdict& verdict = growth[in_window - 1];
  text += fmt::format("\nwindow of {} frames, {} to {}: {}\n{}",
                      in_window + 1,
                      window.start,
                      frame,
                      verdict_text(verdict),
                      verdict.reason);
  const bool whole = in_window + 1 == window.frame_count();
  if (!whole || !inspection.initialization || !inspection.initialization->verdict)
    text +=
        "\n(by GPO with the rotations as given; whether parts of the picture disagree is not "
        "asked)";
  return text;
}

}  // namespace gpo
