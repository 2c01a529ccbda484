// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "app/commands/commands.h"
#include "app/recordings/recordings.h"
#include "app/terminal/interrupt.h"
#include "app/terminal/output.h"
#include "app/terminal/progress_bar.h"
#include "engine/base/error.h"
#include "engine/calibration/calibration_report.h"
#include "engine/experiment/figure.h"
#include "engine/files/output_file.h"
#include "engine/inspection/studies/rotations_over_recording.h"
#include "engine/recording/layouts/open_recording.h"
#include "ui/views/figures/figure_view.h"

#include <array>

#include <fmt/format.h>

namespace gpo {
namespace {

void write_figure(const std::filesystem::path& file,
                  const std::vector<ImageRotations>& windows,
                  const Recording& recording,
                  const GyroscopeFit& fit) {
  const Figure figure{
      "gyroscope",
      fmt::format("{}: rotation rates in the camera's axes", recording.name),
      gyroscope_charts(windows, *recording.gyroscope, fit),
      fmt::format("clock {:+.2f} +- {:.2f} ms, rotation +- {:.2f} deg, residual {:.2f} deg",
                  1e3 * fit.time_offset_s,
                  1e3 * fit.time_offset_sigma_s,
                  fit.rotation_sigma_deg.maxCoeff(),
                  fit.rms_deg)};
  write_image(file, draw_figure(figure, default_figure_size(figure)));
}

}  // namespace

int calibrate_gyroscope_command(const CalibrateArguments& arguments) {
  std::vector<NamedFile> outputs{{"--output", arguments.output}};
  if (arguments.figure) outputs.push_back({"--figure", *arguments.figure});
  check_outputs(outputs, std::array{NamedFile{"recording", arguments.recording}});
  InspectArguments opened;
  opened.recording = resolve_recordings({arguments.recording}).front();
  const auto recording = open(opened);
  if (!recording->gyroscope) throw InputError(recording->name + " has no gyroscope");
  constexpr int kWindows = 80;
  const Interrupt interrupt;
  ProgressBar bar("rotations by pictures");
  const auto windows = rotations_over_recording(
      recording, kWindows, [&](int done, int of) { bar.show(done, of); }, interrupt.token());
  interrupt.check("nothing was written");
  const GyroscopeFit fit = fit_gyroscope(windows, *recording->gyroscope);
  if (fit.windows > 0) fmt::print("{}", to_text(fit, *recording->gyroscope));
  if (fit.windows > 0 && arguments.figure)
    write_figure(*arguments.figure, windows, *recording, fit);
  if (!fit.ok) {
    fmt::print("calibration failed: {}\n", fit.reason);
    return kFailed;
  }
  write_output(arguments.output, to_yaml(fit, recording->camera, recording->name));
  return kDone;
}

}  // namespace gpo
