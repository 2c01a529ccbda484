// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/files/paths.h"
#include "engine/geometry/camera.h"
#include "engine/geometry/pose.h"

#include <cstdint>
#include <string>

namespace gpo {

/// amplitude * sin(2 pi frequency t + phase).
template <int N>
struct Harmonic {
  Eigen::Matrix<double, N, 1> amplitude;
  double frequency = 0;  ///< [Hz]
  double phase = 0;      ///< [rad]
};

/// A smooth path: start + velocity t + harmonics, for any time.
template <int N>
struct Path {
  using Vector = Eigen::Matrix<double, N, 1>;
  Vector start = Vector::Zero();
  Vector velocity = Vector::Zero();  ///< [1/s]
  std::vector<Harmonic<N>> harmonics;
};

/// Motion of the camera: its center, the point that it looks at, and its roll about that line.
struct Trajectory {
  Path<3> position;  ///< camera center [m]
  Path<3> look_at;   ///< [m]
  Path<1> roll;      ///< about the optical axis; positive turns the image counter-clockwise [rad]
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();  ///< up in an image without roll
};

/// Exact state of the camera; derivatives are analytic.
struct CameraMotion {
  Pose pose;                       ///< camera to world [m]
  Eigen::Vector3d velocity_w;      ///< camera center [m/s]
  Eigen::Vector3d acceleration_w;  ///< camera center [m/s^2]
  Eigen::Vector3d rate_c;          ///< angular rate in camera axes [rad/s]
};
CameraMotion camera_motion(const Trajectory& trajectory, double seconds);

/// State of the IMU, in body axes. Gravity is 9.81 m/s^2 against the world's z.
struct BodyMotion {
  Pose pose;                         ///< body to world [m]
  Eigen::Vector3d velocity_w;        ///< [m/s]
  Eigen::Vector3d rate_b;            ///< measurement of a perfect gyroscope [rad/s]
  Eigen::Vector3d specific_force_b;  ///< measurement of a perfect accelerometer [m/s^2]
};
BodyMotion body_motion(const Trajectory& trajectory, const Pose& T_body_camera, double seconds);

/// A printed sheet on a desk or a wall; later ones cover earlier ones.
struct PrintRecipe {
  std::string kind;                                  ///< one of print_kinds()
  Eigen::Vector2d center = Eigen::Vector2d::Zero();  ///< [m]
  Eigen::Vector2d size = Eigen::Vector2d::Zero();    ///< width, height [m]
  double angle = 0;  ///< counter-clockwise, seen from in front [rad]
};

/// A box on the desk (off-plane clutter).
struct BoxRecipe {
  std::string kind;                                  ///< one of box_kinds()
  Eigen::Vector2d center = Eigen::Vector2d::Zero();  ///< [m]
  Eigen::Vector3d size = Eigen::Vector3d::Zero();    ///< [m]
  double angle = 0;                                  ///< counter-clockwise from above [rad]
  double base = 0;                                   ///< height of its bottom over the desk [m]
};

/// A chessboard on white paper on the desk, above the prints.
struct BoardRecipe {
  int columns = 0;                                   ///< inner corners along a row
  int rows = 0;                                      ///< inner corners along a column
  double square = 0;                                 ///< [m]
  double margin = 0;                                 ///< white paper around the squares [m]
  Eigen::Vector2d center = Eigen::Vector2d::Zero();  ///< [m]
  double angle = 0;                                  ///< counter-clockwise from above [rad]
};

/// An upright wall, seen with `from` on the left.
struct WallRecipe {
  Eigen::Vector2d from = Eigen::Vector2d::Zero();  ///< on the floor [m]
  Eigen::Vector2d to = Eigen::Vector2d::Zero();    ///< on the floor [m]
  double height = 0;                               ///< [m]
  std::string surface = "plaster";                 ///< one of surface_kinds()
  std::uint64_t texture_seed = 1;
  std::vector<PrintRecipe> prints = {};  ///< centers: distance from `from`, height over the floor
};

/// The desk, or the floor of a room: the plane z = 0, centered at the origin, z up, y away from the
/// viewer.
struct DeskRecipe {
  Eigen::Vector2d size = Eigen::Vector2d::Zero();  ///< [m]; zero without a desk
  double scale = 1;              ///< size of all prints and texels, relative to those of a desk
  std::string surface = "wood";  ///< one of surface_kinds()
  std::uint64_t texture_seed = 1;
  std::optional<BoardRecipe> board;
  std::vector<PrintRecipe> prints;
  std::vector<BoxRecipe> boxes;
  std::vector<WallRecipe> walls;
};

/// A heap of rocks without large flat faces.
struct RubbleRecipe {
  int count = 0;
  Eigen::Vector2d size = Eigen::Vector2d::Zero();  ///< least and greatest diameter [m]
  Eigen::Vector3d low = Eigen::Vector3d::Zero();   ///< centers are between these corners [m]
  Eigen::Vector3d high = Eigen::Vector3d::Zero();
  std::uint64_t seed = 1;
};

struct ImageRecipe {
  std::string format = "jpg";  ///< jpg | png
  int quality = 90;            ///< for jpg, 1 .. 100
  int samples = 4;             ///< rays a pixel, along each axis
  double noise = 0;            ///< standard deviation, each channel [gray levels of 255]
  double blur = 0;             ///< standard deviation of the lens' point spread [px]
  double gain_variation = 0;   ///< amplitude of the exposure control relative to 1
  double exposure = 0;         ///< motion blur of each row [s]
  double rolling_shutter = 0;  ///< readout time from the first to the last row; 0: global [s]
};

struct GyroscopeRecipe {
  double rate = 0;                                 ///< [Hz]
  double noise_density = 0;                        ///< white noise [rad/s/sqrt(Hz)]
  Eigen::Vector3d bias = Eigen::Vector3d::Zero();  ///< true, constant [rad/s]
  std::optional<Eigen::Vector3d> calibrated_bias;  ///< wrong, from a calibration [rad/s]
};

/// All parameters of a synthesized recording; equal recipes make equal bytes.
struct Recipe {
  std::uint64_t seed = 1;  ///< for the noise of images and gyroscope
  Camera camera;
  Pose T_body_camera;  ///< camera in IMU axes, EuRoC's T_BS [m]
  int frame_count = 0;
  double frame_rate = 0;      ///< [Hz]
  std::int64_t start_ns = 0;  ///< time stamp of the first frame
  Trajectory trajectory;
  DeskRecipe desk;
  std::vector<RubbleRecipe> rubble;
  ImageRecipe image;
  GyroscopeRecipe gyroscope;
};

/// Without a desk there is no true plane.
bool has_desk(const Recipe& recipe);

Recipe read_recipe(const fs::path& file);

/// Time stamp of a frame [ns].
std::int64_t frame_timestamp_ns(const Recipe& recipe, int frame);

/// Time since the first frame, the time of the trajectory [s].
double trajectory_seconds(const Recipe& recipe, std::int64_t timestamp_ns);

/// Middle of the exposure of a row, or of a column if columns are read, in the time of the
/// trajectory [s]. The time stamp is that of the middle row; row r is read at
/// t + (r / (height - 1) - 0.5) * readout, or at t - ... if the direction is up or left.
double row_seconds(const Recipe& recipe, std::int64_t timestamp_ns, int row);

/// Rotation from the world into axes that are rotated counter-clockwise by an angle [rad].
Eigen::Matrix3d turn_into(double angle);

/// The board's inner corners in the world, row by row [m].
std::vector<Eigen::Vector3d> board_corners(const BoardRecipe& board);

}  // namespace gpo
