// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include <Eigen/Core>

namespace gpo {

/// What a sample of a Camera Motion Metadata (CAMM) track says; most say one thing.
struct CammSample {
  std::optional<Eigen::Vector3d> rates_rad_s;  ///< the gyroscope's axes
  std::optional<double> readout_s;             ///< from the first row to the last
};

/// Kinds of samples that are not known are passed over. Throws InputError, which names `source`:
/// one that is cut, or rates that are no numbers.
CammSample parse_camm(std::string_view bytes, const std::string& source);

}  // namespace gpo
