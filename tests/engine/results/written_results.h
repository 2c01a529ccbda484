// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/pose.h"

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <fmt/ranges.h>

// Results in the formats of other programs. Poses: world from camera or body.
namespace gpo::test {

template <class T>
std::string bytes_of(T value) {
  return {reinterpret_cast<const char*>(&value), sizeof(T)};
}

/// Returns "seconds p q_xyzw" or, with `ns`, ORB-SLAM3's "1520530308199447552.000000 ..." for
/// EuRoC.
inline std::string tum_text(const std::vector<std::int64_t>& times_ns,
                            const std::vector<Pose>& poses,
                            bool ns = false) {
  constexpr std::int64_t kSecond = 1'000'000'000;
  std::string text;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const std::int64_t time = times_ns[i];
    text += ns ? fmt::format("{:.6f}", static_cast<double>(time))
               : fmt::format("{}.{:09d}", time / kSecond, time % kSecond);
    const Eigen::Quaterniond q(poses[i].R_wc);
    text += fmt::format(
        " {:.12f} {:.12f}\n", fmt::join(poses[i].p_wc, " "), fmt::join(q.coeffs(), " "));
  }
  return text;
}

/// Returns VINS-Mono's "ns,p,q_wxyz,v," without a header.
inline std::string vins_text(const std::vector<std::int64_t>& times_ns,
                             const std::vector<Pose>& poses) {
  std::string text;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Eigen::Quaterniond q(poses[i].R_wc);
    text += fmt::format("{},{:.12f},{:.12f},{:.12f},0.1,0.2,0.3,\n",
                        times_ns[i],
                        fmt::join(poses[i].p_wc, ","),
                        q.w(),
                        fmt::join(q.vec(), ","));
  }
  return text;
}

inline std::string kitti_text(const std::vector<Pose>& poses) {
  std::string text;
  for (const Pose& pose : poses) {
    Eigen::Matrix<double, 3, 4, Eigen::RowMajor> T;
    T << pose.R_wc, pose.p_wc;
    text += fmt::format("{:.12e}\n", fmt::join(T.data(), T.data() + T.size(), " "));
  }
  return text;
}

inline std::string colmap_images_text(const std::vector<std::string>& names,
                                      const std::vector<Pose>& cameras) {
  std::string text =
      "# Image list with two lines of data per image:\n"
      "#   IMAGE_ID, QW, QX, QY, QZ, TX, TY, TZ, CAMERA_ID, NAME\n"
      "#   POINTS2D[] as (X, Y, POINT3D_ID)\n";
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    const Pose from_world = inverse(cameras[i]);
    const Eigen::Quaterniond q(from_world.R_wc);
    text += fmt::format("{} {:.12f} {:.12f} {:.12f} 1 {}\n{}\n",
                        i + 1,
                        q.w(),
                        fmt::join(q.vec(), " "),
                        fmt::join(from_world.p_wc, " "),
                        names[i],
                        i % 2 == 0 ? "" : "12.5 13.5 -1");
  }
  return text;
}

inline std::string colmap_images_binary(const std::vector<std::string>& names,
                                        const std::vector<Pose>& cameras) {
  std::string bytes = bytes_of(std::uint64_t{cameras.size()});
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    const Pose from_world = inverse(cameras[i]);
    const Eigen::Quaterniond q(from_world.R_wc);
    bytes += bytes_of(static_cast<std::uint32_t>(i + 1));
    for (const double number : {q.w(), q.x(), q.y(), q.z()}) bytes += bytes_of(number);
    for (const double number : from_world.p_wc) bytes += bytes_of(number);
    bytes += bytes_of(std::uint32_t{1}) + names[i] + '\0' + bytes_of(std::uint64_t{1}) +
             bytes_of(12.5) + bytes_of(13.5) + bytes_of(std::int64_t{-1});
  }
  return bytes;
}

inline std::string colmap_points_text(const Eigen::Matrix3Xd& points) {
  std::string text = "# 3D point list with one line of data per point:\n";
  for (int j = 0; j < points.cols(); ++j)
    text += fmt::format("{} {:.12f} 10 20 30 0.5 1 7 2 8\n", j + 1, fmt::join(points.col(j), " "));
  return text;
}

inline std::string colmap_points_binary(const Eigen::Matrix3Xd& points) {
  std::string bytes = bytes_of(static_cast<std::uint64_t>(points.cols()));
  for (int j = 0; j < points.cols(); ++j) {
    bytes += bytes_of(static_cast<std::uint64_t>(j + 1));
    for (const double number : points.col(j)) bytes += bytes_of(number);
    bytes += std::string("\x0a\x14\x1e", 3) + bytes_of(0.5) + bytes_of(std::uint64_t{1}) +
             bytes_of(std::uint32_t{1}) + bytes_of(std::uint32_t{7});
  }
  return bytes;
}

inline std::string ply_header(const char* format, const char* kind, Eigen::Index count) {
  return fmt::format(
      "ply\nformat {0} 1.0\ncomment made\nelement vertex {1}\nproperty uchar red\nproperty {2} x\n"
      "property {2} y\nproperty {2} z\nelement face 1\nproperty list uchar int vertex_indices\n"
      "end_header\n",
      format,
      count,
      kind);
}

/// Returns vertices with colors, and a face at the end.
inline std::string ply_text(const Eigen::Matrix3Xd& points) {
  std::string text = ply_header("ascii", "float", points.cols());
  for (int j = 0; j < points.cols(); ++j)
    text += fmt::format("200 {:.12g}\n", fmt::join(points.col(j), " "));
  return text + "3 0 1 2\n";
}

inline std::string ply_binary(const Eigen::Matrix3Xd& points) {
  std::string bytes = ply_header("binary_little_endian", "double", points.cols());
  for (int j = 0; j < points.cols(); ++j) {
    bytes += "\xc8";
    for (const double number : points.col(j)) bytes += bytes_of(number);
  }
  return bytes + "\x03" + bytes_of(0) + bytes_of(1) + bytes_of(2);
}

}  // namespace gpo::test
