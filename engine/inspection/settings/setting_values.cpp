// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/error.h"
#include "engine/diagnosis/diagnosis.h"
#include "engine/files/text_file.h"
#include "engine/inspection/settings/settings_table.h"
#include "engine/methods/methods.h"
#include "engine/pipeline/method_defaults.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gpo {
namespace {

constexpr const char* kDefault = "default";
constexpr const char* kNone = "none";
constexpr double kLargestId = 9e15;
constexpr double kMostPixel = 1e6;

[[noreturn]] void refuse(const Setting& setting,
                         const std::string& text,
                         const std::string& expected) {
  throw SettingError(setting.key, fmt::format("'{}', expected {}", text, expected));
}

template <class Number>
SettingValue in_range(const Setting& setting,
                      const std::string& text,
                      const std::optional<Number>& number,
                      double least,
                      double most) {
  const double value = number ? static_cast<double>(*number) : least - 1;
  const char* kind = std::is_integral_v<Number> ? "a whole number" : "a number";
  if (!(value >= least && value <= most))
    refuse(setting, text, fmt::format("{} from {:g} to {:g}", kind, least, most));
  return *number;
}

SettingValue ids_from(const Setting& setting, const std::string& text) {
  std::set<std::int64_t> ids;
  if (text == kNone) return std::vector<std::int64_t>();
  for (const std::string& one : split(text + ",", ','))
    ids.insert(std::get<std::int64_t>(in_range(setting, one, parse_integer(one), 0, kLargestId)));
  return std::vector(ids.begin(), ids.end());
}

SettingValue keys_from(const std::string& text) {
  if (text == kNone) return std::vector<std::string>();
  const std::vector<std::string> given = split(text, ',');
  const std::set<std::string> keys(given.begin(), given.end());
  const std::vector<std::string> sorted(keys.begin(), keys.end());
  check_ignored(sorted);
  return sorted;
}

SettingValue point_pair_from(const Setting& setting, const std::string& text) {
  PointPair pair;
  if (text == kNone) return pair;
  for (const std::string& one : split(text + ",", ',')) {
    const double most = pair.numbers.size() < 4 ? kMostPixel : kLargestId;
    pair.numbers.push_back(
        std::get<double>(in_range(setting, one, parse_number(one), -kMostPixel, most)));
  }
  const auto count = pair.numbers.size();
  const bool whole =
      count < 5 || pair.numbers[4] == std::clamp(std::round(pair.numbers[4]), 0., 1e9);
  if (count < 4 || count > 5 || !whole)
    refuse(setting, text, "X1,Y1,X2,Y2 or X1,Y1,X2,Y2,FRAME or none");
  if (pair.point(0) == pair.point(1)) refuse(setting, text, "two different points");
  return pair;
}

Mask mask_from(const Setting& setting, const std::string& text) {
  const std::size_t colon = text.find(':');
  Mask mask;
  mask.kind = choice<MaskKind>(text.substr(0, colon));
  std::vector<double> numbers;
  if (colon != std::string::npos)
    for (const std::string& one : split(text.substr(colon + 1) + ",", ','))
      numbers.push_back(
          std::get<double>(in_range(setting, one, parse_number(one), -kMostPixel, kMostPixel)));
  for (std::size_t k = 0; k + 1 < numbers.size(); k += 2)
    mask.corners_raw_px.emplace_back(numbers[k], numbers[k + 1]);
  if (numbers.size() < 4 || numbers.size() % 2 != 0)
    refuse(
        setting, text, "KIND:X1,Y1,X2,Y2 (a rectangle) or KIND:X1,Y1,X2,Y2,X3,Y3,... (a polygon)");
  if (mask.area_px2() < 1) refuse(setting, text, "an area of at least one pixel");
  return mask;
}

SettingValue masks_from(const Setting& setting, const std::string& text) {
  Masks masks;
  if (text == kNone) return masks;
  for (const std::string& one : split(text + "/", '/'))
    masks.areas.push_back(mask_from(setting, one));
  return masks;
}

SettingValue choice_from(const Setting& setting,
                         const std::string& text,
                         const MethodTable& methods) {
  const std::vector<SettingChoice> choices = choices_of(setting, methods);
  std::vector<const char*> known;
  for (const SettingChoice& one : choices) {
    if (one.key == text) return text;
    known.push_back(one.key.c_str());
  }
  refuse_choice(setting.key.c_str(), text, known);
}

Settings paper() {
  Settings settings;
  settings.options.method = "gpo";
  settings.options.rotations = RotationSource::raw;
  settings.tracking = Tracking::frame_to_frame;
  settings.options.inliers = Inliers::per_frame;
  settings.options.method_options = {.solver = Solver::ceres,
                                     .loss = Loss::squared,
                                     .shutter = Shutter::global,
                                     .planes = Planes::one};
  return settings;
}

/// Returns why another value than the default has no effect with the other settings or in this
/// recording; empty if it may have one.
std::string why_change_is_idle(const std::string& key,
                               const Settings& settings,
                               const Recording* recording) {
  const InitializeOptions& options = settings.options;
  const RotationSource rotations = options.rotations;
  const bool no_gyroscope = recording != nullptr && !recording->gyroscope;
  if (key == "ransac" && !options.method.row().result.empty())
    return "The result of another program uses all tracks";
  if (key == "time_offset" &&
      (no_gyroscope || (rotations != RotationSource::automatic && !needs_gyroscope(rotations))))
    return "The rotations are not from a gyroscope";
  // Standard deviations of 0 state the exact lens that the change requests.
  if (key == "lens" && recording != nullptr && !lens_root(recording->camera).isZero(0))
    return "The calibration states its standard deviations";
  if (key == "accelerometer_bias_sigma" && options.gravity == Gravity::off)
    return "Gravity is not estimated";
  if ((key == "scale_length" || key == "scale_length_sigma") && settings.scale_points.empty())
    return "There are no scale points";
  if (key == "world_up" && settings.world_points.empty()) return "There are no world points";
  return "";
}

}  // namespace

std::vector<Eigen::Vector2d> Mask::outline() const {
  if (corners_raw_px.size() != 2) return corners_raw_px;
  const Eigen::Vector2d &a = corners_raw_px[0], &b = corners_raw_px[1];
  return {a, {b.x(), a.y()}, b, {a.x(), b.y()}};
}

bool is_inside(std::span<const Eigen::Vector2d> polygon, const Eigen::Vector2d& point) {
  bool inside = false;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Eigen::Vector2d &a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
    if ((a.y() > point.y()) == (b.y() > point.y())) continue;
    const double x = a.x() + (point.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
    if (point.x() < x) inside = !inside;
  }
  return inside;
}

bool Mask::contains(const Eigen::Vector2d& raw_px) const { return is_inside(outline(), raw_px); }

double Mask::area_px2() const {
  const std::vector<Eigen::Vector2d> corners = outline();
  double twice = 0;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Eigen::Vector2d &a = corners[k], &b = corners[(k + 1) % corners.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return std::abs(twice) / 2;
}

std::string Mask::text() const {
  std::vector<double> numbers;
  for (const Eigen::Vector2d& corner : corners_raw_px)
    numbers.insert(numbers.end(), {corner.x(), corner.y()});
  return fmt::format("{}:{}", to_string(kind), fmt::join(numbers, ","));
}

bool Masks::contain(MaskKind kind, const Eigen::Vector2d& raw_px) const {
  return std::ranges::any_of(
      areas, [&](const Mask& mask) { return mask.kind == kind && mask.contains(raw_px); });
}

bool Masks::has(MaskKind kind) const {
  return std::ranges::find(areas, kind, &Mask::kind) != areas.end();
}

std::vector<std::int64_t> left_out(const Tracks& tracks, const Masks& masks) {
  std::vector<std::int64_t> ids;
  if (!masks.has(MaskKind::leave_out)) return ids;
  for (int j = 0; j < tracks.track_count(); ++j)
    if (masks.contain(MaskKind::leave_out, tracks.raw_px[0].col(j))) ids.push_back(tracks.ids[j]);
  return ids;
}

std::vector<bool> on_first_plane(const Tracks& tracks, const Masks& masks) {
  std::vector<bool> on_plane;
  if (!masks.has(MaskKind::plane)) return on_plane;
  for (int j = 0; j < tracks.track_count(); ++j)
    on_plane.push_back(masks.contain(MaskKind::plane, tracks.raw_px[0].col(j)));
  return on_plane;
}

std::string value_text(const SettingValue& value) {
  struct Text {
    std::string operator()(std::monostate) const { return kDefault; }
    std::string operator()(bool on) const { return on ? "on" : "off"; }
    std::string operator()(std::int64_t number) const { return fmt::format("{}", number); }
    std::string operator()(double number) const { return fmt::format("{}", number); }
    std::string operator()(const std::string& key) const { return key; }
    std::string operator()(const std::vector<std::int64_t>& ids) const {
      return ids.empty() ? kNone : fmt::format("{}", fmt::join(ids, ","));
    }
    std::string operator()(const std::vector<std::string>& keys) const {
      return keys.empty() ? kNone : fmt::format("{}", fmt::join(keys, ","));
    }
    std::string operator()(const Masks& masks) const {
      std::vector<std::string> areas;
      for (const Mask& mask : masks.areas) areas.push_back(mask.text());
      return areas.empty() ? kNone : fmt::format("{}", fmt::join(areas, "/"));
    }
    std::string operator()(const PointPair& pair) const {
      return pair.empty() ? kNone : fmt::format("{}", fmt::join(pair.numbers, ","));
    }
  };
  return std::visit(Text{}, value);
}

SettingValue value_from(const Setting& setting,
                        const std::string& text,
                        const MethodTable& methods) {
  using enum SettingKind;
  if (setting.optional && text == kDefault) return {};
  switch (setting.kind) {
    case on_off:
      if (text != "on" && text != "off") refuse(setting, text, "on or off");
      return text == "on";
    case whole:
      return in_range(setting, text, parse_integer(text), setting.least, setting.most);
    case number:
      return in_range(setting, text, parse_number(text), setting.least, setting.most);
    case choice:
      return choice_from(setting, text, methods);
    case ids:
      return ids_from(setting, text);
    case keys:
      return keys_from(text);
    case point_pair:
      return point_pair_from(setting, text);
    case masks:
      return masks_from(setting, text);
  }
  return {};
}

std::string setting_text(const Settings& settings, const std::string& key) {
  return value_text(find_setting(key).get(settings));
}

void set_value(Settings& settings,
               const Setting& setting,
               const SettingValue& value,
               const MethodTable& methods) {
  setting.set(settings, value);
  if (setting.key == "method")
    settings.options.method = methods.find(settings.options.method.key());
}

Settings with_setting(Settings settings,
                      const std::string& key,
                      const std::string& text,
                      const MethodTable& methods) {
  const Setting& setting = find_setting(key);
  set_value(settings, setting, value_from(setting, text, methods), methods);
  return settings;
}

Settings switched(Settings settings, const std::string& key, bool on) {
  const Setting& setting = find_setting(key);
  if (setting.optional && setting.used != nullptr) {
    setting.set(settings, SettingValue());
    if (setting.used(settings) == SettingValue(on)) return settings;
  }
  setting.set(settings, on);
  return settings;
}

Settings with_default(Settings settings, const std::string& key) {
  const Setting& setting = find_setting(key);
  setting.set(settings, setting.get(Settings{}));
  return settings;
}

bool is_read(const Setting& setting, const MethodChoice& method) {
  const auto& options = method.row().reads;
  return setting.reader != SettingReader::method ||
         std::ranges::find(options, setting.key) != options.end();
}

std::string why_idle(const Setting& setting, const Settings& settings, const Recording* recording) {
  switch (setting.reader) {
    case SettingReader::all:
      break;
    case SettingReader::tracker:
      return recording != nullptr && !recording->tracks.empty() ? "The recording has its own tracks"
                                                                : "";
    case SettingReader::inlier_test:
      return !uses_ransac(settings.options) && settings.options.method.row().needs_plane
                 ? "Without RANSAC every track counts as an inlier"
                 : "";
    case SettingReader::method:
      if (is_read(setting, settings.options.method)) break;
      return fmt::format("Applies only to {}", fmt::join(readers_of(setting.key), " and "));
    case SettingReader::gravity:
      return gravity_used(settings.options) != settings.options.gravity
                 ? "Only gpo_joint estimates gravity jointly; other methods find it afterwards"
                 : "";
  }
  const bool changed = setting.get(settings) != setting.get(Settings{});
  return changed ? why_change_is_idle(setting.key, settings, recording) : "";
}

Settings as_used(Settings settings) {
  const Settings given = settings;
  for (const Setting& setting : settings_table()) {
    if (setting.used != nullptr) setting.set(settings, setting.used(given));
    if (!is_read(setting, given.options.method)) setting.set(settings, setting.get(Settings{}));
  }
  settings.options.gravity = gravity_used(settings.options);
  return settings;
}

Settings acting_until(SettingStage stage, const Settings& settings) {
  Settings acting = as_used(settings);
  for (const Setting& setting : settings_table())
    if (setting.stage > stage) setting.set(acting, setting.get(Settings{}));
  return acting;
}

Settings with_preset(Settings settings, Preset preset) {
  Settings chosen = preset == Preset::best ? Settings{} : paper();
  chosen.start = settings.start;
  chosen.frames = settings.frames;
  chosen.options.ransac_threshold_px = settings.options.ransac_threshold_px;
  chosen.options.plane = settings.options.plane;
  chosen.options.seed = settings.options.seed;
  for (const Setting& setting : settings_table())
    if (setting.by_hand) setting.set(chosen, setting.get(settings));
  return chosen;
}

Settings with_window_within(Settings settings,
                            std::span<const std::string> given,
                            int frame_count) {
  const bool chosen = std::ranges::any_of(
      given, [](const std::string& key) { return key == "start" || key == "frames"; });
  if (!chosen && frame_count >= 2) settings.frames = std::min(settings.frames, frame_count);
  return settings;
}

std::optional<Preset> preset_of(const Settings& settings) {
  for (const Preset preset : {Preset::best, Preset::paper})
    if (settings == with_preset(settings, preset)) return preset;
  return std::nullopt;
}

std::string why_no_rotations(const Recording& recording, RotationSource source) {
  if (needs_gyroscope(source) && !recording.gyroscope) return recording.name + " has no gyroscope";
  const bool truth = recording.truth || (recording.board && recording.images);
  if (source == RotationSource::truth && !truth)
    return recording.name + " has no ground truth, and no images of a board to compute it from";
  return "";
}

}  // namespace gpo
