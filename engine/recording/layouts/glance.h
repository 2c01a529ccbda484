// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

namespace gpo {

/// What a folder or a file is, as far as its list of frames tells: no picture is decoded, no truth
/// computed.
struct Glance {
  std::string layout;  ///< "EuRoC"; empty: no recording
  int frames = 0;      ///< 0: cannot be told
  double seconds = 0;
};

/// Never throws: what cannot be read has no frames.
Glance glance(const std::filesystem::path& path);

}  // namespace gpo
