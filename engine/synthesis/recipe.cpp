// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/synthesis/recipe.h"

#include "engine/files/budget.h"
#include "engine/files/yaml_entry.h"
#include "engine/synthesis/drawing.h"

#include <cmath>
#include <numbers>
#include <tuple>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <fmt/format.h>

namespace gpo {
namespace {

template <int N>
std::array<Eigen::Matrix<double, N, 1>, 3> derivatives(const Path<N>& path, double seconds) {
  std::array<Eigen::Matrix<double, N, 1>, 3> d = {
      path.start + path.velocity * seconds, path.velocity, Eigen::Matrix<double, N, 1>::Zero()};
  for (const auto& harmonic : path.harmonics) {
    const double w = 2 * std::numbers::pi * harmonic.frequency;
    const double angle = w * seconds + harmonic.phase;
    d[0] += harmonic.amplitude * std::sin(angle);
    d[1] += harmonic.amplitude * (w * std::cos(angle));
    d[2] -= harmonic.amplitude * (w * w * std::sin(angle));
  }
  return d;
}

struct Direction {
  Eigen::Vector3d value;
  Eigen::Vector3d rate;
};
Direction normalized(const Eigen::Vector3d& v, const Eigen::Vector3d& v_rate) {
  const double length = v.norm();
  const Eigen::Vector3d unit = v / length;
  return {unit, (v_rate - unit * unit.dot(v_rate)) / length};
}

const Bounds kMeters{-100, 100, "m"};
const Bounds kLength{0.001, 20, "m"};
const Bounds kDegrees{-3600, 3600, "deg"};
const Bounds kSeed{0, 9e15};

std::uint64_t read_seed(StrictMap& map, const std::string& key) {
  return map.integer<std::uint64_t>(key, kSeed, 1);
}

double read_angle(StrictMap& map, const std::string& key) {
  return radians(map.number(key, kDegrees, 0));
}

Camera read_camera(StrictMap& map) {
  Camera camera;
  const auto resolution = map.vector<2>("resolution", {16, 8192, "px"});
  camera.width = static_cast<int>(resolution.x());
  camera.height = static_cast<int>(resolution.y());
  const auto k = map.vector<4>("intrinsics", {0, 1e5, "px"});
  camera.fx = k[0];
  camera.fy = k[1];
  camera.cx = k[2];
  camera.cy = k[3];
  if (camera.fx < 1 || camera.fy < 1)
    map.fail("intrinsics", "a focal length below 1", "[fx, fy, cx, cy] in pixels");
  const std::string model =
      map.choice("distortion_model", {"none", "radial-tangential", "equidistant"});
  if (model != "none") {
    const bool equidistant = model == "equidistant";
    camera.distortion = equidistant ? Distortion::equidistant : Distortion::radial_tangential;
    camera.coefficients = map.numbers("distortion_coefficients", {-10, 10}, 4, equidistant ? 4 : 8);
  }
  camera.sigmas.assign(4 + camera.coefficients.size(), 0.0);  // images are rendered by exactly it
  return camera;
}

Pose read_pose(StrictMap& map, const std::string& key) {
  const auto values = map.numbers(key, kMeters, 16, 16);
  const Eigen::Matrix4d T =
      Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(values.data());
  const Eigen::Matrix3d R = T.topLeftCorner<3, 3>();
  const bool rigid = (R * R.transpose() - Eigen::Matrix3d::Identity()).norm() < 1e-6 &&
                     R.determinant() > 0 && T.row(3) == Eigen::RowVector4d(0, 0, 0, 1);
  if (!rigid) map.fail(key, "no rotation in it", "a rigid 4x4 transformation, row by row");
  return {R, T.topRightCorner<3, 1>()};
}

/// `scale` converts the file's unit; `duration` is the time from start to end [s].
template <int N>
Path<N> read_path(StrictMap& map, const Bounds& range, double scale, double duration) {
  Path<N> path;
  path.start = scale * map.vector<N>("start", range);
  if (map.has("end")) {
    const typename Path<N>::Vector end = scale * map.vector<N>("end", range);
    if (duration > 0) path.velocity = (end - path.start) / duration;
  }
  path.harmonics = map.list("harmonics", [&](StrictMap& entry) {
    return Harmonic<N>{.amplitude = scale * entry.vector<N>("amplitude", range),
                       .frequency = entry.number("frequency", {0, 20, "Hz"}),
                       .phase = read_angle(entry, "phase")};
  });
  return path;
}

Trajectory read_trajectory(StrictMap& map, double duration) {
  const auto read_point = [&](StrictMap& path) { return read_path<3>(path, kMeters, 1, duration); };
  const auto read_roll = [&](StrictMap& path) {
    return read_path<1>(path, kDegrees, radians(1), duration);
  };
  Trajectory trajectory;
  trajectory.position = map.map("position", read_point);
  trajectory.look_at = map.map("look_at", read_point);
  if (map.has("roll")) trajectory.roll = map.map("roll", read_roll);
  if (map.has("up")) trajectory.up = map.vector<3>("up", {-INFINITY, INFINITY});
  return trajectory;
}

BoardRecipe read_board(StrictMap& map) {
  return {.columns = map.integer("columns", {2, 50}),
          .rows = map.integer("rows", {2, 50}),
          .square = map.number("square", kLength),
          .margin = map.number("margin", {0, 1, "m"}, 0.015),
          .center = map.vector<2>("center", kMeters),
          .angle = read_angle(map, "angle")};
}

constexpr double kLargestFace = 5;  // width or height of a desk at scale 1 [m]

std::vector<PrintRecipe> read_prints(StrictMap& map, double scale) {
  return map.list("prints", [&](StrictMap& entry) {
    return PrintRecipe{.kind = entry.choice("kind", print_kinds()),
                       .center = entry.vector<2>("center", kMeters),
                       .size = entry.vector<2>("size", {0.01 * scale, 3 * scale, "m"}),
                       .angle = read_angle(entry, "angle")};
  });
}

BoxRecipe read_box(StrictMap& map, double scale) {
  return {.kind = map.choice("kind", box_kinds()),
          .center = map.vector<2>("center", kMeters),
          .size = map.vector<3>("size", {0.005 * scale, 3 * scale, "m"}),
          .angle = read_angle(map, "angle"),
          .base = map.number("base", {0, 3 * scale, "m"}, 0)};
}

WallRecipe read_wall(StrictMap& map, double scale) {
  const Bounds side{0.05, kLargestFace * scale, "m"};
  WallRecipe wall;
  wall.from = map.vector<2>("from", kMeters);
  wall.to = map.vector<2>("to", kMeters);
  const double length = (wall.to - wall.from).norm();
  if (length < side.low || length > side.high)
    map.fail("to",
             fmt::format("a wall {:.4g} m long", length),
             fmt::format("from {} to {} m", side.low, side.high));
  wall.height = map.number("height", side);
  wall.surface = map.choice("surface", surface_kinds(), wall.surface);
  wall.texture_seed = read_seed(map, "texture_seed");
  wall.prints = read_prints(map, scale);
  return wall;
}

double area_of(const BoxRecipe& box) {
  return 2 * (box.size.x() + box.size.y()) * box.size.z() + box.size.head<2>().prod();
}

double area_of(const std::vector<PrintRecipe>& prints) {
  double area = 0;
  for (const PrintRecipe& print : prints) area += print.size.prod();
  return area;
}

void check_texels(StrictMap& map, const DeskRecipe& desk) {
  double faces = desk.size.prod(), sheets = area_of(desk.prints);  // [m^2]
  for (const WallRecipe& wall : desk.walls) {
    faces += (wall.to - wall.from).norm() * wall.height;
    sheets += area_of(wall.prints);
  }
  for (const BoxRecipe& box : desk.boxes) sheets += area_of(box);
  const auto most = static_cast<double>(limits().texels);
  const double texels = (faces * kFaceTexelsPerMeter * kFaceTexelsPerMeter +
                         sheets * kSheetTexelsPerMeter * kSheetTexelsPerMeter) /
                        (desk.scale * desk.scale);
  if (texels <= most) return;
  map.fail("size",
           fmt::format("surfaces, boxes and prints of {:.0f} million texels", texels * 1e-6),
           fmt::format("at most {:.0f} million; increase `scale` or make them smaller; --limits "
                       "allows more",
                       most * 1e-6));
}

DeskRecipe read_desk(StrictMap& map) {
  DeskRecipe desk;
  desk.scale = map.number("scale", {1, 10}, 1);
  desk.size = map.vector<2>("size", {0.05, kLargestFace * desk.scale, "m"});
  desk.surface = map.choice("surface", surface_kinds(), desk.surface);
  desk.texture_seed = read_seed(map, "texture_seed");
  if (map.has("board")) desk.board = map.map("board", read_board);
  desk.prints = read_prints(map, desk.scale);
  desk.boxes = map.list("boxes", [&](StrictMap& box) { return read_box(box, desk.scale); });
  desk.walls = map.list("walls", [&](StrictMap& wall) { return read_wall(wall, desk.scale); });
  check_texels(map, desk);
  return desk;
}

RubbleRecipe read_heap(StrictMap& map) {
  RubbleRecipe heap;
  heap.count = map.integer("count", {1, 1000});
  heap.size = map.vector<2>("size", {0.01, 20, "m"});
  if (heap.size[0] > heap.size[1])
    map.fail("size", "the maximum first", "[minimum, maximum] in meters");
  heap.low = map.vector<3>("low", kMeters);
  heap.high = map.vector<3>("high", kMeters);
  if ((heap.low.array() > heap.high.array()).any())
    map.fail("high", "a corner below `low`", "x, y and z of at least those of `low`");
  heap.seed = read_seed(map, "seed");
  return heap;
}

std::optional<ReadoutDirection> read_direction(StrictMap& map) {
  constexpr const char* kKey = "readout_direction";
  if (!map.has(kKey)) return std::nullopt;
  const auto& keys = ChoiceKeys<ReadoutDirection>::keys;
  return choice<ReadoutDirection>(map.choice(kKey, {keys.begin(), keys.end()}));
}

ImageRecipe read_image(StrictMap& map, double period) {
  return {.format = map.choice("format", {"jpg", "png"}),
          .quality = map.integer("quality", {1, 100}, ImageRecipe{}.quality),
          .samples = map.integer("samples", {1, 16}, ImageRecipe{}.samples),
          .noise = map.number("noise", {0, 100, "gray levels"}, 0),
          .blur = map.number("blur", {0, 20, "px"}, 0),
          .gain_variation = map.number("gain_variation", {0, 0.5}, 0),
          .exposure = map.number("exposure", {0, 1, "s"}, 0),
          .rolling_shutter = map.number("rolling_shutter", {0, period, "s"}, 0)};
}

GyroscopeRecipe read_gyroscope(StrictMap& map) {
  GyroscopeRecipe gyroscope;
  gyroscope.rate = map.number("rate", {1, 10000, "Hz"});
  gyroscope.noise_density = map.number("noise_density", {0, 1, "rad/s/sqrt(Hz)"}, 0);
  gyroscope.bias = map.vector<3>("bias", {-1, 1, "rad/s"});
  if (map.has("calibrated_bias"))
    gyroscope.calibrated_bias = map.vector<3>("calibrated_bias", {-1, 1, "rad/s"});
  return gyroscope;
}

void check_extent(StrictMap& top, const Recipe& recipe) {
  constexpr double kMostRays = 1e8;
  constexpr double kMostSamples = 1e6;
  const int rays_per_pixel = recipe.image.samples * recipe.image.samples;
  const double rays = double(recipe.camera.width) * recipe.camera.height * rays_per_pixel;
  if (rays > kMostRays)
    top.fail("picture",
             fmt::format("{:.0f} rays (width x height x samples^2)", rays),
             fmt::format("at most {:.0f}", kMostRays));
  const double samples = recipe.frame_count / recipe.frame_rate * recipe.gyroscope.rate;
  if (samples > kMostSamples)
    top.fail("gyroscope",
             fmt::format("{:.0f} samples (rate x time)", samples),
             fmt::format("at most {:.0f}", kMostSamples));
}

void check_trajectory(StrictMap& top, const Recipe& recipe) {
  for (int frame = 0; frame < recipe.frame_count; ++frame) {
    const double t = trajectory_seconds(recipe, frame_timestamp_ns(recipe, frame));
    const CameraMotion motion = camera_motion(recipe.trajectory, t);
    if (!motion.pose.R_wc.allFinite() || !motion.rate_c.allFinite() || motion.rate_c.norm() > 100)
      top.fail("trajectory",
               "no direction of view in frame " + std::to_string(frame),
               "look_at away from position, and not along up");
    if (has_desk(recipe) && motion.pose.p_wc.z() <= 0)
      top.fail("trajectory",
               "a camera below the desk in frame " + std::to_string(frame),
               "position above z = 0");
  }
}

}  // namespace

CameraMotion camera_motion(const Trajectory& trajectory, double seconds) {
  const auto position = derivatives(trajectory.position, seconds);
  const auto look_at = derivatives(trajectory.look_at, seconds);
  const auto roll = derivatives(trajectory.roll, seconds);

  // Axes of a camera without roll: z forward, x = z x up, y = z x x.
  const Direction z = normalized(look_at[0] - position[0], look_at[1] - position[1]);
  const Direction x = normalized(z.value.cross(trajectory.up), z.rate.cross(trajectory.up));
  Eigen::Matrix3d R;
  R << x.value, z.value.cross(x.value), z.value;
  const Eigen::Vector3d y_rate = z.rate.cross(x.value) + z.value.cross(x.rate);

  // dR/dt = R [w]x: the rates are the products of axes and derivatives of axes.
  const Eigen::Vector3d rate(R.col(2).dot(y_rate), R.col(0).dot(z.rate), R.col(1).dot(x.rate));
  const Eigen::Matrix3d R_roll =
      Eigen::AngleAxisd(roll[0](0), Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return {.pose = {R * R_roll, position[0]},
          .velocity_w = position[1],
          .acceleration_w = position[2],
          .rate_c = R_roll.transpose() * rate + Eigen::Vector3d(0, 0, roll[1](0))};
}

BodyMotion body_motion(const Trajectory& trajectory, const Pose& T_body_camera, double seconds) {
  const CameraMotion camera = camera_motion(trajectory, seconds);
  // The angular acceleration, for the accelerometer only, is by differences.
  const double step = 1e-4;
  const Eigen::Vector3d rate_change_c = (camera_motion(trajectory, seconds + step).rate_c -
                                         camera_motion(trajectory, seconds - step).rate_c) /
                                        (2 * step);
  const Pose T_camera_body = inverse(T_body_camera);
  const Eigen::Vector3d& lever_c = T_camera_body.p_wc;
  const Eigen::Vector3d spin_c = camera.rate_c.cross(lever_c);
  const Eigen::Vector3d acceleration_w =
      camera.acceleration_w +
      camera.pose.R_wc * (rate_change_c.cross(lever_c) + camera.rate_c.cross(spin_c));
  const Pose pose = camera.pose * T_camera_body;
  return {
      .pose = pose,
      .velocity_w = camera.velocity_w + camera.pose.R_wc * spin_c,
      .rate_b = T_body_camera.R_wc * camera.rate_c,
      .specific_force_b = pose.R_wc.transpose() * (acceleration_w + Eigen::Vector3d(0, 0, 9.81))};
}

bool has_desk(const Recipe& recipe) { return recipe.desk.size.x() > 0; }

Recipe read_recipe(const fs::path& file) {
  StrictMap top(load_yaml(file));
  Recipe recipe;
  recipe.seed = read_seed(top, "seed");

  std::tie(recipe.camera, recipe.T_body_camera) = top.map("camera", [](StrictMap& map) {
    return std::pair{read_camera(map), read_pose(map, "T_BS")};
  });
  std::tie(recipe.frame_count, recipe.frame_rate, recipe.start_ns) =
      top.map("frames", [](StrictMap& map) {
        return std::tuple{map.integer("count", {1, 100000}),
                          map.number("rate", {0.1, 1000, "Hz"}),
                          map.integer<std::int64_t>("start_ns", {1e9, 9e18, "ns"})};
      });
  recipe.trajectory = top.map("trajectory", [&](StrictMap& map) {
    return read_trajectory(map, (recipe.frame_count - 1) / recipe.frame_rate);
  });
  recipe.rubble = top.list("rubble", read_heap);
  // `floor` is the desk of a room; rubble needs neither.
  if (top.has("floor"))
    recipe.desk = top.map("floor", read_desk);
  else if (recipe.rubble.empty() || top.has("desk"))
    recipe.desk = top.map("desk", read_desk);
  recipe.image = top.map("picture", [&](StrictMap& map) {
    recipe.camera.readout_direction = read_direction(map);
    return read_image(map, 1 / recipe.frame_rate);
  });
  recipe.gyroscope = top.map("gyroscope", read_gyroscope);
  top.finish();
  check_extent(top, recipe);
  check_trajectory(top, recipe);
  return recipe;
}

std::int64_t frame_timestamp_ns(const Recipe& recipe, int frame) {
  return recipe.start_ns + std::llround(frame * 1e9 / recipe.frame_rate);
}

double trajectory_seconds(const Recipe& recipe, std::int64_t timestamp_ns) {
  return static_cast<double>(timestamp_ns - recipe.start_ns) * 1e-9;
}

double row_seconds(const Recipe& recipe, std::int64_t timestamp_ns, int row) {
  const double sign = readout_direction(recipe.camera).sum();
  const double place = sign * (static_cast<double>(row) / (readout_lines(recipe.camera) - 1) - 0.5);
  return trajectory_seconds(recipe, timestamp_ns) + place * recipe.image.rolling_shutter;
}

Eigen::Matrix3d turn_into(double angle) {
  return Eigen::AngleAxisd(-angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
}

std::vector<Eigen::Vector3d> board_corners(const BoardRecipe& board) {
  std::vector<Eigen::Vector3d> corners;
  const Eigen::Vector3d center(board.center.x(), board.center.y(), 0);
  for (int row = 0; row < board.rows; ++row) {
    for (int column = 0; column < board.columns; ++column) {
      const Eigen::Vector3d in_board((column - (board.columns - 1) / 2.0) * board.square,
                                     (row - (board.rows - 1) / 2.0) * board.square,
                                     0);
      corners.emplace_back(center + turn_into(-board.angle) * in_board);
    }
  }
  return corners;
}

}  // namespace gpo
