// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/calibration/camera_parameters.h"
#include "engine/calibration/self_calibration.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gpo {
namespace {

/// "cx, cy: prior only", or nothing.
std::string known_by_prior(const PlaneLens& lens) {
  std::vector<const char*> names;
  for (int k = 0; k < kLensUnknowns; ++k)
    if (lens.prior_only[k]) names.push_back(kLensNames[k]);
  return names.empty() ? "" : fmt::format("{}: prior only", fmt::join(names, ", "));
}

std::string seen(const SelfCalibration& calibration) {
  const PlaneLens& lens = calibration.lens;
  return fmt::format(
      "{} points in {} pictures{}, normals up to {:.0f} deg apart, moved by {:.2f} distances",
      lens.points,
      lens.views,
      calibration.gyroscope ? " and the gyroscope" : "",
      lens.tilt_deg,
      lens.moved);
}

std::string readout(const PlaneLens& lens) {
  return fmt::format("{:10.3f} +- {:.3f} of the time from frame to frame, first row to last",
                     lens.lens[kReadout],
                     lens.sigma[kReadout]);
}

std::vector<std::string> warnings(const SelfCalibration& calibration) {
  const PlaneLens& lens = calibration.lens;
  std::vector<std::string> all = lens.warnings;
  if (const std::string prior = known_by_prior(lens); !prior.empty()) all.push_back(prior);
  if (!lens.left_out.empty())
    all.push_back(fmt::format("left out, as they disagree with the others: frames {}",
                              fmt::join(lens.left_out, ", ")));
  return all;
}

}  // namespace

std::string to_yaml(const SelfCalibration& calibration, const std::string& source) {
  std::string text = fmt::format("# calibrated from {} and a plane in view, RMS {:.2f} px\n# {}\n",
                                 source,
                                 calibration.lens.rms_px,
                                 seen(calibration));
  text += fmt::format("# {}: {}\n", kLensNames[kReadout], readout(calibration.lens));
  for (const std::string& warning : warnings(calibration))
    text += fmt::format("# warning: {}\n", warning);
  return text + camera_yaml(calibration.lens.camera, {.source = "source: self-calibrated\n"});
}

std::string to_text(const SelfCalibration& calibration) {
  const PlaneLens& lens = calibration.lens;
  const Camera& camera = lens.camera;
  std::string text =
      row("seen", seen(calibration)) + row("RMS", fmt::format("{:.3f} px", lens.rms_px));
  const std::array values{camera.fx, camera.fy, camera.cx, camera.cy};
  constexpr std::array kNames{"fx", "fy", "cx", "cy"};
  for (std::size_t k = 0; k < 4; ++k)
    text += row(kNames[k], fmt::format("{:10.2f} +- {:.2f} px", values[k], camera.sigmas[k]));
  for (std::size_t k = 0; k < camera.coefficients.size(); ++k)
    text += row(kLensNames[4 + k],
                fmt::format("{:10.5f} +- {:.5f}", camera.coefficients[k], camera.sigmas[4 + k]));
  text += row(kLensNames[kReadout], readout(lens));
  for (const std::string& warning : warnings(calibration)) text += row("warning", warning);
  return text;
}

}  // namespace gpo
