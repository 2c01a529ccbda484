// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/synthesis/rubble.h"

#include "engine/base/parallel.h"
#include "engine/synthesis/random.h"

#include <algorithm>
#include <array>

#include <Eigen/Geometry>

namespace gpo {
namespace {

constexpr int kStone = 144;  ///< texels along an edge of the block of stone
constexpr int kCuts = 9;

Eigen::Vector3d pick_direction(Random& random) {
  Eigen::Vector3d v;
  for (double& coordinate : v) coordinate = random.normal();
  return v.normalized();
}

Eigen::Matrix3d pick_turn(Random& random) {
  Eigen::Vector4d q;
  for (double& coordinate : q) coordinate = random.normal();
  return Eigen::Quaterniond(q.normalized()).toRotationMatrix();
}

cv::Vec3f pick_tint(Random& random) {
  static const std::array<cv::Vec3f, 4> kStones = {
      {{0.80F, 0.92F, 1.0F}, {0.97F, 0.98F, 1.0F}, {0.66F, 0.80F, 1.0F}, {0.98F, 1.0F, 0.94F}}};
  const cv::Vec3f& stone = kStones[static_cast<std::size_t>(random.below(kStones.size()))];
  return stone * static_cast<float>(random.uniform(0.7, 1.15));
}

SceneRock make_rock(const RubbleRecipe& heap, Random random) {
  SceneRock rock;
  for (int k = 0; k < 3; ++k) rock.center[k] = random.uniform(heap.low[k], heap.high[k]);
  // Small ones are more frequent.
  const double pick = random.uniform();
  rock.reach = (heap.size[0] + (heap.size[1] - heap.size[0]) * pick * pick) / 2;
  Eigen::Vector3d axes;
  for (double& axis : axes) axis = rock.reach * random.uniform(0.6, 1);
  rock.R_unit_world = axes.cwiseInverse().asDiagonal() * pick_turn(random);
  for (int i = 0; i < kCuts; ++i) {
    const Eigen::Vector3d normal = pick_direction(random);
    rock.cuts.push_back({normal, random.uniform(0.62, 0.96)});
  }
  rock.tint = pick_tint(random);
  rock.grain = random.uniform(0.6, 1);
  return rock;
}

/// Layers, grains of two minerals and dark cracks.
double brightness(const Eigen::Vector3d& p) {
  const double tone = fractal_noise(3 * p, 4, 1);
  const double grain = fractal_noise(13 * p, 2, 2);
  const double crack = std::abs(fractal_noise(4 * p, 3, 3) - 0.5);
  const double speck = std::clamp((fractal_noise(19 * p, 1, 4) - 0.68) * 9, 0.0, 1.0);
  const double base = 0.5 + 1.1 * (tone - 0.5) + 0.75 * (grain - 0.5);
  return (base + 0.35 * speck) * (1 - 0.6 * std::exp(-crack * crack / (2 * 0.012 * 0.012)));
}

}  // namespace

cv::Mat make_stone(int threads) {
  const std::array<int, 3> sizes = {kStone, kStone, kStone};
  cv::Mat stone(3, sizes.data(), CV_8UC1);
  in_parallel(kStone, threads, [&](int i) {
    for (int j = 0; j < kStone; ++j) {
      for (int k = 0; k < kStone; ++k) {
        const Eigen::Vector3d place = Eigen::Vector3d(i, j, k) * (2.0 / (kStone - 1));
        stone.at<uchar>(i, j, k) = cv::saturate_cast<uchar>(255 * brightness(place));
      }
    }
  });
  return stone;
}

void pile_rocks(std::vector<SceneRock>& rocks, const RubbleRecipe& heap) {
  for (int i = 0; i < heap.count; ++i) {
    rocks.push_back(make_rock(heap, Random(heap.seed, static_cast<std::uint64_t>(i))));
  }
}

float sample_stone(const cv::Mat& stone, const Eigen::Vector3d& place) {
  std::array<int, 3> at{};
  std::array<float, 3> part{};
  for (int k = 0; k < 3; ++k) {
    const double x = std::clamp((place[k] + 1) / 2 * (kStone - 1), 0.0, kStone - 1.001);
    at[static_cast<std::size_t>(k)] = static_cast<int>(x);
    part[static_cast<std::size_t>(k)] = static_cast<float>(x - static_cast<int>(x));
  }
  const auto along = [&](int i, int j) {
    const uchar* p = stone.ptr<uchar>(at[0] + i, at[1] + j) + at[2];
    return static_cast<float>(p[0]) * (1 - part[2]) + static_cast<float>(p[1]) * part[2];
  };
  const float near = along(0, 0) * (1 - part[1]) + along(0, 1) * part[1];
  const float far = along(1, 0) * (1 - part[1]) + along(1, 1) * part[1];
  return near * (1 - part[0]) + far * part[0];
}

}  // namespace gpo
