// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/initializers/common/initialization.h"
#include "engine/initializers/common/initializer_options.h"
#include "engine/initializers/common/watch.h"
#include "engine/window/window.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace gpo {

/// How a method uses many frames (paper, "Multi-frame Initialization Baselines").
enum class MethodFamily { aggregation, optimization };

/// A method is one file and one row of this table: the command line's choices, the combo box, the
/// legends and the tests read it.
struct Method {
  std::string key;    ///< on the command line, in files
  std::string title;  ///< for people
  std::uint32_t rgb;  ///< 0xRRGGBB, Okabe-Ito
  MethodFamily family;
  bool needs_plane;  ///< takes every track that it is given to lie on the plane
  Inliers inliers;   ///< by default: as its authors do
  /// Whether it takes the rotations as given or moves them all (free), by which its uncertainty is
  /// computed; nothing: it says so itself.
  std::optional<RotationModel> rotations;
  /// The options that it heeds (fields of `InitializerOptions`), by the keys of their settings.
  std::vector<std::string> reads;
  Initialization (*initialize)(const Window& window,
                               const InitializerOptions& options,
                               const Watch& watch);
};

std::span<const Method> methods();

/// What a method made of the window, with its uncertainty and the verdict on the window. A
/// degenerate window's result becomes a failure.
Initialization assessed(const Method& method, const Window& window, Initialization result);

/// Keys of the methods that heed an option, by the key of its setting.
std::vector<std::string> readers_of(const std::string& option);

/// The row named `key`. Throws InputError that names the known ones.
const Method& find_method(std::string_view key);

}  // namespace gpo
