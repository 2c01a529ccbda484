// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inspection/studies/studies.h"
#include "engine/methods/methods.h"
#include "ui/look/look.h"
#include "ui/views/overlay/overlay.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Core>
#include <gtest/gtest.h>

namespace gpo {
namespace {

using Eigen::Matrix3d, Eigen::Vector3d;

/// Returns linear RGB.
Vector3d linear(std::uint32_t rgb) {
  return Vector3d(red(rgb), green(rgb), blue(rgb)).unaryExpr([](double c) {
    return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
  });
}

/// Returns CIELAB of linear RGB, for a D65 white.
Vector3d lab(const Vector3d& rgb) {
  Matrix3d M;
  M << 0.4124564, 0.3575761, 0.1804375, 0.2126729, 0.7151522, 0.0721750, 0.0193339, 0.1191920,
      0.9503041;
  const Vector3d f = (M * rgb).cwiseQuotient(Vector3d(0.95047, 1, 1.08883)).unaryExpr([](double t) {
    return t > 0.008856 ? std::cbrt(t) : 7.787 * t + 16.0 / 116;
  });
  return {116 * f.y() - 16, 500 * (f.x() - f.y()), 200 * (f.y() - f.z())};
}

/// Normal vision, and complete protanopia, deuteranopia and tritanopia by Machado, Oliveira and
/// Fernandes, "A physiologically-based model for simulation of color vision deficiency" (2009).
std::vector<Matrix3d> visions() {
  std::vector<Matrix3d> all(4, Matrix3d::Identity());
  all[1] << 0.152286, 1.052583, -0.204868, 0.114503, 0.786281, 0.099216, -0.003882, -0.048116,
      1.051998;
  all[2] << 0.367322, 0.860646, -0.227968, 0.280085, 0.672501, 0.047413, -0.011820, 0.042940,
      0.968881;
  all[3] << 1.255528, -0.076749, -0.178779, -0.078411, 0.930809, 0.147602, 0.004733, 0.691367,
      0.303900;
  return all;
}

/// Returns the smallest distance in CIELAB for any vision; 2.3 is just noticeable side by side.
double distance(std::uint32_t a, std::uint32_t b) {
  double least = 1e9;
  for (const Matrix3d& vision : visions()) {
    const auto seen = [&](std::uint32_t rgb) {
      return lab((vision * linear(rgb)).cwiseMax(0).cwiseMin(1));
    };
    least = std::min(least, (seen(a) - seen(b)).norm());
  }
  return least;
}

TEST(ColorBlindness, SimulationConfusesRedAndGreenOfEqualLightness) {
  EXPECT_NEAR((lab(linear(0xFFFFFF)) - Vector3d(100, 0, 0)).norm(), 0, 0.1);
  EXPECT_LT(distance(0xC00000, 0x5A5A00), 15);  // for protanopia
  EXPECT_GT(distance(0x000000, 0xFFFFFF), 99);
}

TEST(ColorBlindness, EveryoneTellsTheMethodsApart) {
  for (const Method& one : methods())
    for (const Method& other : methods()) {
      if (one.key >= other.key) continue;
      const bool pba = std::string(one.key) == "pba" || std::string(other.key) == "pba";
      EXPECT_GT(distance(one.rgb, other.rgb), pba ? 24 : 8) << one.key << ", " << other.key;
    }
}

TEST(ColorBlindness, EveryoneTellsTheVerdictsApart) {
  for (const Theme theme : {Theme::dark, Theme::light}) {
    const auto rgb = [&](Role role) { return color_of(role, theme); };
    EXPECT_GT(distance(rgb(Role::good), rgb(Role::warning)), 20);
    EXPECT_GT(distance(rgb(Role::good), rgb(Role::bad)), 15);
    EXPECT_GT(distance(rgb(Role::warning), rgb(Role::bad)), 15);
  }
}

TEST(ColorBlindness, EveryoneTellsPlanesFromEachOtherAndFromVerdicts) {
  for (int plane = 0; plane < 5; ++plane) {
    for (int other = 0; other < plane; ++other)
      EXPECT_GT(distance(plane_color(plane), plane_color(other)), 13) << plane << other;
    for (const Role verdict : {Role::warning, Role::bad})
      EXPECT_GT(distance(plane_color(plane), color_of(verdict, Theme::dark)), 16) << plane;
  }
}

TEST(ColorBlindness, EveryoneTellsLostTracksFromInliersAndOutliers) {
  const std::uint32_t lost = color_of(Role::lost, Theme::dark);
  for (int plane = 0; plane < 5; ++plane)
    EXPECT_GT(distance(lost, plane_color(plane)), 20) << plane;
  EXPECT_GT(distance(lost, color_of(Role::outlier, Theme::dark)), 30);
  EXPECT_GT(distance(lost, color_of(Role::text_dim, Theme::dark)), 30) << "excluded";
}

TEST(ColorBlindness, EveryoneTellsPlaneNormalAndCamerasApart) {
  constexpr double kCameraTint = 0.35;  // share of the text's color in the scene
  for (const Theme theme : {Theme::dark, Theme::light}) {
    const std::uint32_t plane = color_of(Role::plane, theme),
                        normal = color_of(Role::normal, theme);
    EXPECT_GT(distance(plane, normal), 25);
    EXPECT_GT(distance(plane, color_of(Role::truth, theme)), 20);
    for (const Method& method : methods()) {
      const std::uint32_t camera = mixed_rgb(method.rgb, color_of(Role::text, theme), kCameraTint);
      EXPECT_GT(distance(plane, camera), 10) << method.key;
      EXPECT_GT(distance(normal, camera), 10) << method.key;
    }
  }
}

}  // namespace
}  // namespace gpo
