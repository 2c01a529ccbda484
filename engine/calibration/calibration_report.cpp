// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/calibration/calibration_report.h"

#include "engine/calibration/camera_parameters.h"

#include <fmt/format.h>

namespace gpo {

namespace {

std::string seen(const CameraCalibration& calibration) {
  return fmt::format("corners in {:.0f} % of the picture, board slanted by up to {:.0f} deg",
                     100 * calibration.coverage,
                     calibration.slant_deg);
}

std::string board(const CameraCalibration& calibration) {
  return fmt::format("not flat: corners are up to {:.2g} mm off a plane, which is allowed for",
                     1000 * calibration.bend_m);
}

}  // namespace

std::string to_yaml(const CameraCalibration& calibration, const std::string& source) {
  std::string text = fmt::format("# calibrated from {}: {} views of a board, RMS {:.2f} px\n# {}\n",
                                 source,
                                 calibration.frames.size(),
                                 calibration.rms_px,
                                 seen(calibration));
  if (calibration.bend_m > 0) text += fmt::format("# board {}\n", board(calibration));
  for (const std::string& warning : calibration.warnings) {
    text += fmt::format("# warning: {}\n", warning);
  }
  Camera with_sigmas = calibration.camera;
  with_sigmas.sigmas = calibration.sigmas;
  return text +
         camera_yaml(with_sigmas,
                     {.sigmas_remark = "# standard deviations, from leaving out blocks of time\n"});
}

std::string to_text(const CameraCalibration& calibration) {
  const auto names = parameter_names(calibration.camera);
  const auto values = parameters(calibration.camera);
  std::string text = row("views",
                         fmt::format("{} used; the board was found in {} of {} pictures",
                                     calibration.frames.size(),
                                     calibration.found,
                                     calibration.examined)) +
                     row("RMS", fmt::format("{:.3f} px", calibration.rms_px));
  for (std::size_t i = 0; i < names.size(); ++i) {
    const double sigma = calibration.sigmas[i];
    text += row(names[i],
                i < 4 ? fmt::format("{:10.2f} +- {:.2f} px", values[i], sigma)
                      : fmt::format("{:10.5f} +- {:.5f}", values[i], sigma));
  }
  text += row("seen", seen(calibration));
  if (calibration.bend_m > 0) text += row("board", board(calibration));
  for (const std::string& warning : calibration.warnings) text += row("warning", warning);
  return text;
}

}  // namespace gpo
