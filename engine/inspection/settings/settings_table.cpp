// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inspection/settings/settings_table.h"

#include "engine/base/error.h"
#include "engine/methods/methods.h"
#include "engine/pipeline/method_defaults.h"

#include <algorithm>
#include <type_traits>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gpo {
namespace {

template <class T>
struct Plain {
  using Type = T;
  static constexpr bool kOptional = false;
};
template <class T>
struct Plain<std::optional<T>> {
  using Type = T;
  static constexpr bool kOptional = true;
};

template <class T>
constexpr bool kIsWhole = std::is_integral_v<T> && !std::is_same_v<T, bool>;

template <class T>
constexpr SettingKind kind_of() {
  if constexpr (Choice<T> || std::is_same_v<T, MethodChoice>) return SettingKind::choice;
  if constexpr (std::is_same_v<T, bool>) return SettingKind::on_off;
  if constexpr (std::is_same_v<T, double>) return SettingKind::number;
  if constexpr (std::is_same_v<T, std::vector<std::string>>) return SettingKind::keys;
  if constexpr (std::is_same_v<T, PointPair>) return SettingKind::point_pair;
  if constexpr (std::is_same_v<T, Masks>) return SettingKind::masks;
  return kIsWhole<T> ? SettingKind::whole : SettingKind::ids;
}

template <class T>
SettingValue value_of(const T& field) {
  if constexpr (Plain<T>::kOptional) {
    return field ? value_of(*field) : SettingValue();
  } else if constexpr (std::is_same_v<T, MethodChoice>) {
    return field.key();
  } else if constexpr (Choice<T>) {
    return std::string(to_string(field));
  } else if constexpr (kIsWhole<T>) {
    return static_cast<std::int64_t>(field);
  } else {
    return field;
  }
}

template <class T>
void set_field(T& field, const SettingValue& value) {
  if constexpr (Plain<T>::kOptional) {
    field.reset();
    if (!std::holds_alternative<std::monostate>(value)) set_field(field.emplace(), value);
  } else if constexpr (Choice<T>) {
    field = choice<T>(std::get<std::string>(value));
  } else if constexpr (std::is_same_v<T, MethodChoice>) {
    field = std::get<std::string>(value);
  } else if constexpr (kIsWhole<T>) {
    field = static_cast<T>(std::get<std::int64_t>(value));
  } else {
    field = std::get<T>(value);
  }
}

/// Completes a row from the field that `Field` returns: kind, optional or not, choices, access.
template <class Field>
Setting row(Field, Setting setting) {
  using Stored = std::decay_t<decltype(Field{}(std::declval<Settings&>()))>;
  using Value = typename Plain<Stored>::Type;
  setting.kind = kind_of<Value>();
  setting.optional = Plain<Stored>::kOptional;
  if constexpr (Choice<Value>) {
    for (const char* key : ChoiceKeys<Value>::keys) setting.choices.push_back({key, key});
  }
  setting.get = [](const Settings& s) { return value_of(Field{}(s)); };
  setting.set = [](Settings& s, const SettingValue& value) { set_field(Field{}(s), value); };
  return setting;
}

std::vector<SettingChoice> method_choices(const MethodTable& methods) {
  std::vector<SettingChoice> choices;
  for (const MethodChoice& method : methods.all())
    choices.push_back({method.key(), method.row().title, method.row().rgb});
  return choices;
}

std::vector<Setting> window_rows() {
  using enum SettingStage;
  std::vector<Setting> rows;
  rows.push_back(row([](auto& s) -> auto& { return s.start; },
                     {.key = "start",
                      .title = "Start",
                      .unit = "frame",
                      .help = "First frame of the window, its reference frame",
                      .most = 1e9,
                      .stage = tracks}));
  rows.push_back(row([](auto& s) -> auto& { return s.frames; },
                     {.key = "frames",
                      .title = "Frames",
                      .help = "Length of the window",
                      .least = 2,
                      .most = 1000,
                      .stage = tracks}));
  rows.push_back(row([](auto& s) -> auto& { return s.options.method; },
                     {.key = "method",
                      .title = "Method",
                      .help = "Initialization method",
                      .stage = initialization,
                      .choices = method_choices({})}));
  rows.push_back(row(
      [](auto& s) -> auto& { return s.options.rotations; },
      {.key = "rotations",
       .title = "Rotations",
       .help =
           "Source of the camera rotations: a gyroscope, decomposed homographies of one plane "
           "(averaging; -first and -second choose between two equally good orientations), or all "
           "tracks of a scene that is not one plane (five-point, direct)",
       .stage = rotations,
       .words = {{"automatic", "automatic", "with automatic rotations", 0x88CCEE},
                 {"raw", "raw", "with raw rotations", 0x7788AA},
                 {"gyro", "gyro", "with gyroscope", 0x117733},
                 {"gyro-calibrated", "gyro-calibrated", "with calibrated gyroscope", 0x3344AA},
                 {"averaging", "averaging", "with averaged rotations", 0xAA7711},
                 {"averaging-first", "averaging-first", "with the first orientation", 0xA5521F},
                 {"averaging-second", "averaging-second", "with the second orientation", 0x6A5ACD},
                 {"five-point", "five-point", "with five-point rotations", 0xCC6677},
                 {"direct", "direct", "with direct rotations", 0x3D8F5F},
                 {"truth", "truth", "with true rotations", 0x666666}},
       .why_not = [](const Recording& recording, const std::string& key) {
         return why_no_rotations(recording, choice<RotationSource>(key));
       }}));
  rows.push_back(
      row([](auto& s) -> auto& { return s.tracking; },
          {.key = "tracking",
           .title = "Tracking",
           .help = "How the built-in front end tracks corners",
           .reader = SettingReader::tracker,
           .stage = tracks,
           .words = {{"frame-to-frame", "frame-to-frame", "with frame-to-frame tracks", 0xDDCC77},
                     {"anchored", "anchored", "with anchored tracks", 0x44AA99}}}));
  return rows;
}

void add_inlier_rows(std::vector<Setting>& rows) {
  using enum SettingStage;
  rows.push_back(row([](auto& s) -> auto& { return s.options.ransac; },
                     {.key = "ransac",
                      .title = "RANSAC",
                      .help = "Reject tracks off the plane by a homography from the reference "
                              "frame; default: the method's choice",
                      .first_in_key = true,
                      .words = {{"ransac", "on", "with RANSAC", 0x882255},
                                {"no-ransac", "off", "without RANSAC", 0xBB3355}},
                      .used = [](const Settings& s) { return value_of(uses_ransac(s.options)); }}));
  rows.push_back(row([](auto& s) -> auto& { return s.options.ransac_threshold_px; },
                     {.key = "ransac_threshold_px",
                      .title = "Threshold",
                      .unit = "px",
                      .help = "Largest transfer error of an inlier; default: 2 px from 512x512 to "
                              "1280x960, more for larger images and noisy tracks",
                      .least = 0.1,
                      .most = 50,
                      .reader = SettingReader::inlier_test}));
  rows.push_back(
      row([](auto& s) -> auto& { return s.options.inliers; },
          {.key = "inliers",
           .title = "Inliers",
           .help = "Select tracks on the plane by frame, by consistency over the window, or by "
                   "the window's planes",
           .reader = SettingReader::inlier_test,
           .advanced = true,
           .words = {{"per-frame", "per-frame", "with per-frame inliers", 0x661100},
                     {"consistent", "consistent", "with consistent inliers", 0x999933},
                     {"planes", "planes", "with inliers by plane", 0x88AA55}},
           .used = [](const Settings& s) { return value_of(inliers_used(s.options)); }}));
  rows.push_back(row([](auto& s) -> auto& { return s.options.plane; },
                     {.key = "plane",
                      .title = "Plane",
                      .help = "Leading plane of the window: 1 has most tracks",
                      .least = 1,
                      .most = 9,
                      .reader = SettingReader::inlier_test}));
  rows.push_back(row([](auto& s) -> auto& { return s.options.seed; },
                     {.key = "seed",
                      .title = "Seed",
                      .help = "Seed of every random choice",
                      .most = 1e9,
                      .advanced = true}));
}

void add_exception_rows(std::vector<Setting>& rows) {
  rows.push_back(row([](auto& s) -> auto& { return s.intrinsics_scale; },
                     {.key = "intrinsics_scale",
                      .title = "Camera scale",
                      .help = "Factor for the calibration's focal lengths and principal point, if "
                              "the images were resized after it",
                      .least = 0.05,
                      .most = 20,
                      .stage = SettingStage::tracks,
                      .advanced = true,
                      .by_hand = true}));
  rows.push_back(row([](auto& s) -> auto& { return s.exclude; },
                     {.key = "exclude",
                      .title = "Excluded",
                      .help = "Ids of excluded tracks",
                      .advanced = true,
                      .by_hand = true}));
  rows.push_back(row([](auto& s) -> auto& { return s.mask; },
                     {.key = "mask",
                      .title = "Masks",
                      .help = "Areas of the reference frame in the recorded, distorted image [px]: "
                              "not:X1,Y1,X2,Y2 leaves out tracks in a rectangle, plane:X1,Y1,X2,"
                              "Y2,X3,Y3,... finds plane 1 in a polygon only; / between several",
                      .advanced = true,
                      .by_hand = true}));
  rows.push_back(row([](auto& s) -> auto& { return s.options.ignore_findings; },
                     {.key = "ignore_findings",
                      .title = "Ignored findings",
                      .help = "Keys of findings that do not lower the verdict, with commas; see "
                              "`gpo-inspector findings`",
                      .stage = SettingStage::initialization,
                      .advanced = true,
                      .by_hand = true}));
}

void add_world_rows(std::vector<Setting>& rows) {
  const auto add = [&](auto field, Setting setting) {
    setting.stage = SettingStage::initialization;
    setting.advanced = setting.by_hand = true;
    rows.push_back(row(field, std::move(setting)));
  };
  add([](auto& s) -> auto& { return s.scale_points; },
      {.key = "scale_points",
       .title = "Scale points",
       .help = "Two points on planes, scale_length apart, which determine the metric scale [px]"});
  add([](auto& s) -> auto& { return s.scale_length; },
      {.key = "scale_length",
       .title = "Scale length",
       .unit = "m",
       .help = "Distance of the scale points",
       .least = 1e-6,
       .most = 1e6});
  add([](auto& s) -> auto& { return s.scale_length_sigma; },
      {.key = "scale_length_sigma",
       .title = "Its uncertainty",
       .unit = "m",
       .help = "Standard deviation of the scale length",
       .most = 1e6});
  add([](auto& s) -> auto& { return s.world_points; },
      {.key = "world_points",
       .title = "World points",
       .help = "Origin of the exported world on a plane, and a point towards its x axis [px]"});
  add([](auto& s) -> auto& { return s.world_up; },
      {.key = "world_up",
       .title = "World z",
       .help = "z axis of the exported world: normal of the origin's plane, or against gravity"});
}

void add_option_rows(std::vector<Setting>& rows) {
  const auto add = [&](auto field, Setting setting) {
    setting.reader = SettingReader::method;
    setting.stage = SettingStage::initialization;
    setting.advanced = true;
    setting.help += fmt::format(" ({})", fmt::join(readers_of(setting.key), ", "));
    rows.push_back(row(field, std::move(setting)));
  };
  add([](auto& s) -> auto& { return s.options.method_options.solver; },
      {.key = "solver",
       .title = "Solver",
       .help = "Solver: our own Schur solver, or Ceres",
       .words = {{"schur", "schur", "by our own solver", 0x332288},
                 {"ceres", "ceres", "by Ceres", 0xAA4499}}});
  add([](auto& s) -> auto& { return s.options.method_options.error; },
      {.key = "error",
       .title = "Error",
       .help = "Transfer error, Sampson's, or latent positions in the reference frame; automatic: "
               "transfer for anchored tracks, else latent",
       .words = {{"automatic-error", "automatic", "with automatic error", 0x885522},
                 {"transfer", "transfer", "with transfer error", 0x6699CC},
                 {"sampson", "sampson", "with Sampson's error", 0x997700},
                 {"latent", "latent", "with latent reference positions", 0x0F4C5C}}});
  add([](auto& s) -> auto& { return s.options.method_options.loss; },
      {.key = "loss",
       .title = "Loss",
       .help = "Squared, or Huber's, linear for outliers",
       .words = {{"squared", "squared", "with squared loss", 0x004488},
                 {"huber", "huber", "with Huber's loss", 0xEE99AA}}});
  add([](auto& s) -> auto& { return s.options.method_options.shutter; },
      {.key = "shutter",
       .title = "Shutter",
       .help = "known: readout time of the camera file or log, estimated without one; estimated: "
               "always "
               "estimated; global: all rows are read at once",
       .words = {{"known-shutter", "known", "with known shutter", 0x4B6F2A},
                 {"estimated-shutter", "estimated", "with estimated shutter", 0x994455},
                 {"global-shutter", "global", "with global shutter", 0xEECC66}}});
  rows.back().stage = SettingStage::inliers;
  add([](auto& s) -> auto& { return s.options.method_options.planes; },
      {.key = "planes",
       .title = "Planes",
       .help = "All planes of the window at once, or the leading one alone",
       .words = {{"all-planes", "all", "with all planes", 0x557733},
                 {"one-plane", "one", "with one plane", 0xCC8899}}});
  add([](auto& s) -> auto& { return s.options.method_options.time_offset; },
      {.key = "time_offset",
       .title = "Time offset",
       .help = "Estimate the offset between the clocks of camera and gyroscope",
       .words = {{"time-offset", "on", "with time offset", 0x225555},
                 {"no-time-offset", "off", "without time offset", 0x77AADD}}});
}

}  // namespace

std::span<const Setting> settings_table() {
  static const std::vector<Setting> table = [] {
    std::vector<Setting> rows = window_rows();
    add_inlier_rows(rows);
    add_exception_rows(rows);
    add_option_rows(rows);
    rows.push_back(row([](auto& s) -> auto& { return s.options.lens; },
                       {.key = "lens",
                        .title = "Lens",
                        .help = "Judge windows by a typical calibration if the file states no "
                                "standard deviations, or by an exact lens",
                        .stage = SettingStage::initialization,
                        .advanced = true,
                        .words = {{"typical-lens", "typical", "with a typical lens", 0x8C6D31},
                                  {"exact-lens", "exact", "with an exact lens", 0x5254A3}}}));
    rows.push_back(row(
        [](auto& s) -> auto& { return s.options.gravity; },
        {.key = "gravity",
         .title = "Gravity",
         .help = "Estimate gravity and metric scale from the accelerometer: after the "
                 "initialization, from its poses; joint: together with the result of gpo_joint; "
                 "or off",
         .reader = SettingReader::gravity,
         .stage = SettingStage::initialization,
         .advanced = true,
         .words = {{"gravity-after", "after", "with gravity estimated afterwards", 0x5B8C9E},
                   {"joint-gravity", "joint", "with jointly estimated gravity", 0xB07AA1},
                   {"no-gravity", "off", "without gravity", 0x9C755F}}}));
    rows.push_back(row([](auto& s) -> auto& { return s.options.accelerometer_bias_sigma_m_s2; },
                       {.key = "accelerometer_bias_sigma",
                        .title = "Accelerometer bias",
                        .unit = "m/s^2",
                        .help = "Standard deviation of the accelerometer's bias, for gravity and "
                                "metric scale; a calibrated sensor has less",
                        .least = 0.001,
                        .most = 10,
                        .stage = SettingStage::initialization,
                        .advanced = true}));
    add_world_rows(rows);
    return rows;
  }();
  return table;
}

std::vector<std::string> setting_keys() {
  std::vector<std::string> keys;
  for (const Setting& setting : settings_table()) keys.push_back(setting.key);
  return keys;
}

std::vector<SettingChoice> choices_of(const Setting& setting, const MethodTable& methods) {
  return setting.key == "method" ? method_choices(methods) : setting.choices;
}

const Setting& find_setting(std::string_view key) {
  const auto found = std::ranges::find(settings_table(), key, &Setting::key);
  if (found != settings_table().end()) return *found;
  throw InputError(fmt::format(
      "unknown setting '{}', expected one of {}", key, fmt::join(setting_keys(), ", ")));
}

}  // namespace gpo
