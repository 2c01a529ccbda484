// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/initializers/common/initialization.h"
#include "engine/initializers/common/initializer_options.h"
#include "engine/initializers/common/sources.h"
#include "engine/initializers/common/watch.h"
#include "engine/window/window.h"

#include <cstdint>
#include <functional>
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
  std::function<Initialization(
      const Window& window, const InitializerOptions& options, const Watch& watch)>
      initialize;
  /// What it does and what it assumes, two sentences for people.
  std::string help = "Your own initializer, a process beside this one";
  /// Of a user's own: the same for those who have more than the window; empty of ours.
  std::function<Initialization(const Window& window, const Sources& sources, const Watch& watch)>
      initialize_from = {};
  /// Of a user's own: what it is, by which results of another are told from its own; empty of ours.
  std::string identity = {};
};

/// Ours, and then the user's own.
std::span<const Method> methods();

/// The user's own, in their order: to be called once at most, before anything asks for `methods()`
/// (main does, before it reads its other arguments), so that the table never changes under those
/// who read it, on whatever thread. Throws std::logic_error where it is too late; InputError for a
/// key that is taken.
void add_methods(std::vector<Method> own);

/// What a method made of the window, with its uncertainty and the verdict on the window. A
/// degenerate window's result becomes a failure.
Initialization assessed(const Method& method, const Window& window, Initialization result);

/// Keys of the methods that heed an option, by the key of its setting.
std::vector<std::string> readers_of(const std::string& option);

/// The row named `key`. Throws InputError that names the known ones.
const Method& find_method(std::string_view key);

}  // namespace gpo
