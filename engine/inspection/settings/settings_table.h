// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/initialize.h"
#include "engine/recording/recording.h"
#include "engine/tracking/tracking.h"
#include "engine/window/tracks.h"

#include <span>
#include <string_view>
#include <variant>

namespace gpo {

/// Two points of an image, as X1, Y1, X2, Y2 in raw pixels and optionally the frame that shows
/// them, counted in the recording; default: the reference frame. Empty: none.
struct PointPair {
  std::vector<double> numbers = {};

  bool empty() const { return numbers.empty(); }
  Eigen::Vector2d point(int which) const { return {numbers[2 * which], numbers[2 * which + 1]}; }
  std::optional<int> frame() const {
    return numbers.size() == 5 ? std::optional(static_cast<int>(numbers[4])) : std::nullopt;
  }
  bool operator==(const PointPair&) const = default;
};

/// Direction of the z axis of a chosen world: the normal of the origin's plane, or against gravity.
enum class WorldUp { plane, gravity };

template <>
struct ChoiceKeys<WorldUp> : NamedKeys<"world up", "plane", "gravity"> {};

/// leave_out: tracks inside are left out. plane: the first plane of the window is found among the
/// tracks inside, all others among those outside.
enum class MaskKind { leave_out, plane };

template <>
struct ChoiceKeys<MaskKind> : NamedKeys<"mask", "not", "plane"> {};

/// Returns whether a polygon contains a point.
bool is_inside(std::span<const Eigen::Vector2d> polygon, const Eigen::Vector2d& point);

/// An area of the reference frame, in pixels of the recorded, distorted image. A track belongs to
/// it by its place in that frame.
struct Mask {
  MaskKind kind = MaskKind::leave_out;
  std::vector<Eigen::Vector2d> corners_raw_px = {};  ///< polygon; two: a rectangle

  /// Returns the corners in turn, at least three.
  std::vector<Eigen::Vector2d> outline() const;
  bool contains(const Eigen::Vector2d& raw_px) const;
  double area_px2() const;
  std::string text() const;  ///< "not:10,20,110,80"
  bool operator==(const Mask&) const = default;
};

/// Several masks, as not:X1,Y1,X2,Y2 (a rectangle) or plane:X1,Y1,X2,Y2,X3,Y3,... (a polygon) with
/// slashes in between. Empty: none.
struct Masks {
  std::vector<Mask> areas = {};

  bool contain(MaskKind kind, const Eigen::Vector2d& raw_px) const;
  bool has(MaskKind kind) const;
  bool operator==(const Masks&) const = default;
};

/// Returns the ids of the tracks in masks that leave them out.
std::vector<std::int64_t> left_out(const Tracks& tracks, const Masks& masks);
/// Returns `InlierOptions::on_first_plane`.
std::vector<bool> on_first_plane(const Tracks& tracks, const Masks& masks);

/// All inputs of a result other than the recording. Immutable in use. Each field has a row in
/// `settings_table`.
struct Settings {
  int start = 0;                            ///< reference frame, counts in the recording
  int frames = 30;                          ///< length of the window
  Tracking tracking = Tracking::anchored;   ///< by the built-in front end
  double intrinsics_scale = 1;              ///< for images resized after the calibration
  std::vector<std::int64_t> exclude = {};   ///< ids of excluded tracks, ascending
  Masks mask = {};                          ///< areas of the reference frame
  PointPair scale_points = {};              ///< `scale_length` apart, see `measure_scale`
  std::optional<double> scale_length = {};  ///< [m]
  double scale_length_sigma = 0;            ///< its standard deviation [m]
  PointPair world_points = {};              ///< origin, and a point towards x, see `choose_world`
  WorldUp world_up = WorldUp::plane;        ///< z of the chosen world
  InitializeOptions options = {};           ///< how the window's tracks are initialized

  bool operator==(const Settings&) const = default;
};

/// Named sets of settings: the defaults, which are the most accurate; and those of the paper:
/// corners tracked from frame to frame, inliers by frame, an uncalibrated gyroscope, `gpo` by Ceres
/// starting without translation.
enum class Preset { best, paper };

template <>
struct ChoiceKeys<Preset> : NamedKeys<"preset", "best", "paper"> {};

/// Returns the settings with a preset applied. It does not change window, seed, excluded tracks,
/// leading plane, threshold and measured points.
Settings with_preset(Settings settings, Preset preset);
/// Shortens the default window to a recording of `frame_count` frames, unless its start or length
/// is among the keys `given`.
Settings with_window_within(Settings settings, std::span<const std::string> given, int frame_count);

/// Returns the preset that the settings match; nullopt if they are modified.
std::optional<Preset> preset_of(const Settings& settings);

/// A setting's value; monostate: left to the method, or a number to the window. A choice is its
/// key.
using SettingValue = std::variant<std::monostate,
                                  bool,
                                  std::int64_t,
                                  double,
                                  std::string,
                                  std::vector<std::int64_t>,
                                  std::vector<std::string>,
                                  PointPair,
                                  Masks>;

/// How a setting is typed, shown and stored.
enum class SettingKind { on_off, whole, number, choice, ids, keys, point_pair, masks };

/// Readers of a setting: all; the built-in front end; the test whether a track is an inlier; the
/// methods that list it among their options (`Method::reads`); the estimation of gravity
/// (`gravity_used`).
enum class SettingReader { all, tracker, inlier_test, method, gravity };

/// The stages of an inspection in their order. A setting affects its stage and all later ones.
enum class SettingStage { tracks, inliers, rotations, initialization };

struct SettingChoice {
  std::string key;
  std::string title;      ///< for people
  std::uint32_t rgb = 0;  ///< 0xRRGGBB, of a method
};

/// Name of a setting's value in a configuration (`gpo+no-ransac`).
struct SettingWord {
  const char* word;   ///< unique in the whole table
  const char* value;  ///< syntax of `setting_text`
  const char* title;  ///< after the method's: "without RANSAC"
  std::uint32_t rgb;  ///< 0xRRGGBB, none of the methods' own
};

/// One setting. Command line, JSON result, results.csv, sessions, scripts, settings panel,
/// comparisons and the Inspector's cache all read its row.
struct Setting {
  std::string key = {};    ///< in files and scripts; on the command line with dashes
  std::string title = {};  ///< in the window
  std::string unit = {};   ///< empty: none
  std::string help = {};   ///< one sentence
  double least = 0;        ///< range of a number
  double most = 0;
  SettingReader reader = SettingReader::all;
  SettingStage stage = SettingStage::inliers;
  bool advanced = false;                    ///< rarely changed
  bool by_hand = false;                     ///< set by hand only, never in experiments
  bool first_in_key = false;                ///< its word comes first in a key
  std::vector<SettingWord> words = {};      ///< empty: configurations do not name it
  std::vector<SettingChoice> choices = {};  ///< if it is a choice; for methods see `choices_of`
  SettingValue (*used)(const Settings&) = nullptr;  ///< returns the value that the method uses
  /// Returns why a recording does not allow a choice, one line; empty if it does. Null: all
  /// allowed.
  std::string (*why_not)(const Recording&, const std::string& choice) = nullptr;
  // From its field in `Settings`:
  SettingKind kind = SettingKind::whole;
  bool optional = false;  ///< may be left to the method or the window
  SettingValue (*get)(const Settings&) = nullptr;
  void (*set)(Settings&, const SettingValue&) = nullptr;  ///< unchecked
};

std::span<const Setting> settings_table();
std::vector<std::string> setting_keys();
/// Returns the choices of a setting; for the method those of the table.
std::vector<SettingChoice> choices_of(const Setting& setting, const MethodTable& methods);
/// Returns the setting. Throws InputError that lists the known ones.
const Setting& find_setting(std::string_view key);

/// Returns a value as scripts, sessions and the command line write it: a number, a choice's key,
/// on, off, ids or coordinates with commas, masks or none, or default if it is left to the method.
std::string value_text(const SettingValue& value);
/// Parses a value. Throws SettingError if it is invalid.
SettingValue value_from(const Setting& setting,
                        const std::string& text,
                        const MethodTable& methods = {});
/// Sets a value without checking it; looks up a method in `methods`.
void set_value(Settings& settings,
               const Setting& setting,
               const SettingValue& value,
               const MethodTable& methods = {});

std::string setting_text(const Settings& settings, const std::string& key);
/// Returns the settings with another value. Throws InputError for an unknown key, SettingError for
/// an invalid value.
Settings with_setting(Settings settings,
                      const std::string& key,
                      const std::string& text,
                      const MethodTable& methods = {});

/// Returns the settings with a switch on or off; left to the method if that is its default.
Settings switched(Settings settings, const std::string& key, bool on);

/// Returns the settings with this one at its default.
Settings with_default(Settings settings, const std::string& key);

/// Returns whether the method reads a setting; false only for an option that it does not list.
bool is_read(const Setting& setting, const MethodChoice& method);

/// Returns why a setting has no effect with the others or in this recording (null: in any), in one
/// line; empty if it may have one.
std::string why_idle(const Setting& setting, const Settings& settings, const Recording* recording);

/// Returns the settings in a normal form, equal for equal results: values left to the method are
/// replaced by those it uses, values that it does not read by their defaults. Throws InputError for
/// an unknown method.
Settings as_used(Settings settings);

/// Returns the settings on which the results of a stage depend, in normal form; those of later
/// stages, the method among them, are at their defaults.
Settings acting_until(SettingStage stage, const Settings& settings);

/// Returns what the recording lacks for a source of rotations, one line; empty if it has all.
std::string why_no_rotations(const Recording& recording, RotationSource source);

}  // namespace gpo
