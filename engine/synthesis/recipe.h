// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/camera.h"
#include "engine/geometry/pose.h"
#include "engine/synthesis/trajectory.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// A printed sheet that lies on the desk or hangs on a wall; later ones lie over earlier ones.
struct PrintRecipe {
  std::string kind;                                  ///< one of print_kinds()
  Eigen::Vector2d center = Eigen::Vector2d::Zero();  ///< [m]
  Eigen::Vector2d size = Eigen::Vector2d::Zero();    ///< width, height [m]
  double angle = 0;                                  ///< counter-clockwise as one looks at it [rad]
};

/// A box that stands on the desk (off-plane clutter).
struct BoxRecipe {
  std::string kind;                                  ///< one of box_kinds()
  Eigen::Vector2d center = Eigen::Vector2d::Zero();  ///< [m]
  Eigen::Vector3d size = Eigen::Vector3d::Zero();    ///< [m]
  double angle = 0;                                  ///< counter-clockwise from above [rad]
  double base = 0;                                   ///< height of its bottom over the desk [m]
};

/// A chessboard printed on white paper that lies on the desk, over the prints.
struct BoardRecipe {
  int columns = 0;                                   ///< inner corners along a row
  int rows = 0;                                      ///< inner corners along a column
  double square = 0;                                 ///< [m]
  double margin = 0;                                 ///< white paper around the squares [m]
  Eigen::Vector2d center = Eigen::Vector2d::Zero();  ///< [m]
  double angle = 0;                                  ///< counter-clockwise from above [rad]
};

/// A wall that stands upright on the floor. It is drawn for who sees `from` on the left.
struct WallRecipe {
  Eigen::Vector2d from = Eigen::Vector2d::Zero();  ///< on the floor [m]
  Eigen::Vector2d to = Eigen::Vector2d::Zero();    ///< on the floor [m]
  double height = 0;                               ///< [m]
  std::string surface = "plaster";                 ///< one of surface_kinds()
  std::uint64_t texture_seed = 1;
  std::vector<PrintRecipe> prints;  ///< centers: how far from `from`, how high over the floor
};

/// The desk, or the floor of a room: the plane z = 0, centered at the origin, z up, y away from who
/// sits at it.
struct DeskRecipe {
  Eigen::Vector2d size = Eigen::Vector2d::Zero();  ///< [m]; zero: there is none
  double scale = 1;  ///< all that is drawn, and how finely, is so many times as large as on a desk
  std::string surface = "wood";  ///< one of surface_kinds()
  std::uint64_t texture_seed = 1;
  std::optional<BoardRecipe> board;
  std::vector<PrintRecipe> prints;
  std::vector<BoxRecipe> boxes;
  std::vector<WallRecipe> walls;
};

/// A heap of rocks, none of which is flat over much of a picture.
struct RubbleRecipe {
  int count = 0;
  Eigen::Vector2d size = Eigen::Vector2d::Zero();  ///< least and greatest diameter [m]
  Eigen::Vector3d low = Eigen::Vector3d::Zero();   ///< centers are between these corners [m]
  Eigen::Vector3d high = Eigen::Vector3d::Zero();
  std::uint64_t seed = 1;
};

struct ImageRecipe {
  std::string format = "jpg";  ///< jpg | png
  int quality = 90;            ///< of jpg, 1 .. 100
  int samples = 4;             ///< rays a pixel, along each axis
  double noise = 0;            ///< standard deviation, each channel [gray levels of 255]
  double blur = 0;             ///< standard deviation of the lens' point spread [px]
  double gain_variation = 0;   ///< of the exposure control, amplitude relative to 1
  double exposure = 0;         ///< of each row: motion blur [s]
  double rolling_shutter = 0;  ///< readout time from the first to the last row; 0: global [s]
};

struct GyroscopeRecipe {
  double rate = 0;                                 ///< [Hz]
  double noise_density = 0;                        ///< white noise [rad/s/sqrt(Hz)]
  Eigen::Vector3d bias = Eigen::Vector3d::Zero();  ///< true, constant [rad/s]
  std::optional<Eigen::Vector3d> calibrated_bias;  ///< what a calibration believes [rad/s]
};

/// All that a synthesized recording is made of; two equal recipes make equal bytes.
struct Recipe {
  std::uint64_t seed = 1;  ///< of the picture's and the gyroscope's noise
  Camera camera;
  Pose T_body_camera;  ///< camera in the axes of the IMU, EuRoC's T_BS [m]
  int frame_count = 0;
  double frame_rate = 0;      ///< [Hz]
  std::int64_t start_ns = 0;  ///< time stamp of the first frame
  Trajectory trajectory;
  DeskRecipe desk;
  std::vector<RubbleRecipe> rubble;
  ImageRecipe image;
  GyroscopeRecipe gyroscope;
};

/// What lies on no desk has no true plane.
bool has_desk(const Recipe& recipe);

/// Reads a recipe strictly. Throws InputError that names file, line, key, what was found and what
/// was expected, for unknown and missing keys, wrong types and values out of range.
Recipe read_recipe(const std::filesystem::path& file);

/// Time stamp of a frame [ns].
std::int64_t frame_timestamp_ns(const Recipe& recipe, int frame);

/// Seconds since the first frame, the trajectory's time.
double trajectory_seconds(const Recipe& recipe, std::int64_t timestamp_ns);

/// Time of the middle of a row's exposure. The time stamp belongs to the middle row: row r is
/// read at t + (r / (height - 1) - 0.5) * readout, in the trajectory's time [s].
double row_seconds(const Recipe& recipe, std::int64_t timestamp_ns, int row);

/// Rotation from the world into axes that are turned counter-clockwise by an angle [rad].
Eigen::Matrix3d turn_into(double angle);

/// The board's inner corners in the world, row by row [m].
std::vector<Eigen::Vector3d> board_corners(const BoardRecipe& board);

}  // namespace gpo
