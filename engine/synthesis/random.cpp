// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/synthesis/random.h"

#include <cmath>
#include <numbers>

namespace gpo {
namespace {

std::uint64_t mix(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}

double lattice(std::int64_t x, std::int64_t y, std::uint64_t seed) {
  const std::uint64_t key = static_cast<std::uint64_t>(x) * 0x9e3779b97f4a7c15ULL ^
                            static_cast<std::uint64_t>(y) * 0xc2b2ae3d27d4eb4fULL ^ seed;
  return static_cast<double>(mix(key) >> 11) * 0x1.0p-53;
}

double blend(double a, double b, double t) { return a + (b - a) * t; }

double ease(double t) { return t * t * t * (t * (6 * t - 15) + 10); }

std::int64_t round_down(double x) {
  const auto truncated = static_cast<std::int64_t>(x);
  return truncated - (x < static_cast<double>(truncated) ? 1 : 0);
}

double value_noise(double x, double y, std::uint64_t seed) {
  const std::int64_t ix = round_down(x);
  const std::int64_t iy = round_down(y);
  const double a = ease(x - static_cast<double>(ix));
  const double b = ease(y - static_cast<double>(iy));
  const double top = blend(lattice(ix, iy, seed), lattice(ix + 1, iy, seed), a);
  const double bottom = blend(lattice(ix, iy + 1, seed), lattice(ix + 1, iy + 1, seed), a);
  return blend(top, bottom, b);
}

double value_noise(const Eigen::Vector3d& p, std::uint64_t seed) {
  const std::int64_t layer = round_down(p.z());
  const auto below = static_cast<std::uint64_t>(layer);
  return blend(value_noise(p.x(), p.y(), mix(seed + below)),
               value_noise(p.x(), p.y(), mix(seed + below + 1)),
               ease(p.z() - static_cast<double>(layer)));
}

template <typename Noise>
double mean_of_octaves(int octaves, std::uint64_t seed, const Noise& noise) {
  double sum = 0, weight = 0, size = 1;
  for (int octave = 0; octave < octaves; ++octave, size /= 2) {
    sum += size * noise(size, mix(seed + static_cast<std::uint64_t>(octave)));
    weight += size;
  }
  return sum / weight;
}

}  // namespace

Random::Random(std::uint64_t seed, std::uint64_t stream)
    : state_(mix(seed + 0x9e3779b97f4a7c15ULL) ^ mix(stream ^ 0xd1b54a32d192ed03ULL)) {}

std::uint64_t Random::bits() { return mix(state_ += 0x9e3779b97f4a7c15ULL); }

double Random::uniform(double low, double high) {
  return low + (high - low) * static_cast<double>(bits() >> 11) * 0x1.0p-53;
}

int Random::below(int n) { return static_cast<int>(uniform(0, n)); }

double Random::normal() {
  // Box-Muller; 1 - u is never zero.
  const double radius = std::sqrt(-2 * std::log(1 - uniform()));
  return radius * std::cos(2 * std::numbers::pi * uniform());
}

double fractal_noise(double x, double y, int octaves, std::uint64_t seed) {
  return mean_of_octaves(octaves, seed, [&](double size, std::uint64_t octave_seed) {
    return value_noise(x / size, y / size, octave_seed);
  });
}

double fractal_noise(const Eigen::Vector3d& place, int octaves, std::uint64_t seed) {
  return mean_of_octaves(octaves, seed, [&](double size, std::uint64_t octave_seed) {
    return value_noise(place / size, octave_seed);
  });
}

}  // namespace gpo
