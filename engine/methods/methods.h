// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/methods/common/initialization.h"
#include "engine/methods/common/method_options.h"
#include "engine/methods/common/window_checks.h"
#include "engine/window/window.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace gpo {

/// How a method combines frames (paper, "Multi-frame Initialization Baselines").
enum class MethodFamily { aggregation, optimization };

/// Properties of another program's result.
struct ImportedResult {
  /// Unit of an estimate; nullopt: its scale is arbitrary.
  std::optional<double> meters_per_unit = {};
  std::optional<double> time_offset_s = {};        ///< recording's time - result's time, estimated
  std::optional<double> time_offset_sigma_s = {};  ///< its standard deviation
  std::string clock = {};                          ///< source of the reference, for people
  double applied_time_offset_s = 0;                ///< added to the result's times
};

/// A row of the table of methods, which the command line, the window and the tests read.
struct Method {
  std::string key;         ///< on the command line, in files
  std::string title = {};  ///< for people
  std::uint32_t rgb = 0;   ///< 0xRRGGBB, Okabe-Ito
  MethodFamily family = MethodFamily::optimization;
  bool needs_plane = false;           ///< assumes that all given tracks are on the plane
  Inliers inliers = Inliers::planes;  ///< default, as in the method's paper
  /// Rotations that the method assumes, for its uncertainty: known or free; nullopt if the method
  /// computes its uncertainty itself.
  std::optional<RotationModel> rotations = {};
  /// Fields of `MethodOptions` that the method reads, by the keys of their settings.
  std::vector<std::string> reads = {};
  std::function<Initialization(
      const Window& window, const MethodOptions& options, const Watch& watch)>
      initialize = {};
  /// Description and assumptions, two sentences for people.
  std::string help = "Your own initializer, a separate process";
  /// True if `own_noise` runs it again without each region of the image.
  bool resampled = false;
  /// For these runs: starts from the result of all tracks; empty: they start as usual.
  std::function<Initialization(const Window& window,
                               const Initialization& start,
                               const MethodOptions& options,
                               const Watch& watch)>
      restart = {};
  // The other members belong to a user's own method; they are empty for ours.
  /// Initializes from all data of the recording.
  std::function<Initialization(const Window& window, const Sources& sources, const Watch& watch)>
      initialize_from = {};
  std::string identity = {};  ///< distinguishes its results from those of other programs
  std::string command = {};   ///< option and session value "NAME=COMMAND"
  std::string result = {};    ///< "NAME=FILE[,POINTS][,frame=camera|body]"
  int number = 0;             ///< index among the user's methods
};

/// Returns our methods in display order.
std::span<const Method> methods();

/// Returns our method named `key`. Throws SettingError with all known names.
const Method& find_method(std::string_view key);

/// Returns the keys of our methods that read an option, given by the key of its setting.
std::vector<std::string> readers_of(const std::string& option);

/// A chosen method: one of ours by its key, or a user's own.
class MethodChoice {
 public:
  MethodChoice(const char* key) : key_(key) {}
  MethodChoice(std::string key) : key_(std::move(key)) {}
  explicit MethodChoice(std::shared_ptr<const Method> own) : key_(own->key), own_(std::move(own)) {}

  const std::string& key() const { return key_; }
  operator const std::string&() const { return key_; }
  /// Throws SettingError for an unknown key.
  const Method& row() const { return own_ ? *own_ : find_method(key_); }
  const std::shared_ptr<const Method>& own() const { return own_; }  ///< null for our methods

  friend bool operator==(const MethodChoice&, const MethodChoice&) = default;

 private:
  std::string key_;
  std::shared_ptr<const Method> own_;
};

/// The available methods: ours, then the user's own. Copies share their rows.
class MethodTable {
 public:
  /// Adds a user's method. Throws InputError if the key exists.
  void add(Method own);
  /// Adds the row of a choice unless it is present or one of ours.
  void add(const MethodChoice& choice);

  const std::vector<std::shared_ptr<const Method>>& own() const { return own_; }
  std::vector<MethodChoice> all() const;
  bool contains(std::string_view key) const;
  /// Throws SettingError with all known names.
  MethodChoice find(std::string_view key) const;

 private:
  std::vector<std::shared_ptr<const Method>> own_;
};

/// Returns the covariances of a method's own estimates for `Initialization::own_noise`
/// (`spread_by_regions`); nullopt if the method is not resampled or the result does not allow it.
/// `initialize` runs the method from the start.
std::optional<NoiseSpread> own_noise(const Method& method,
                                     const Window& window,
                                     const Initialization& result,
                                     const std::function<Initialization(const Window&)>& initialize,
                                     const MethodOptions& options,
                                     const Watch& watch);

/// Adds the uncertainty and the errors of the fit to a method's result that is ok.
Initialization with_uncertainty(const Method& method, const Window& window, Initialization result);

}  // namespace gpo
