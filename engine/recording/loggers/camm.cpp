// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/loggers/camm.h"

#include "engine/base/error.h"

#include <bit>
#include <cstdint>

#include <fmt/format.h>

namespace gpo {
namespace {

constexpr std::size_t kHead = 4;  // two bytes that are reserved, two that tell the kind
constexpr std::uint64_t kExposure = 1;
constexpr std::uint64_t kGyroscope = 2;

std::uint64_t little_endian(std::string_view bytes, std::size_t at, std::size_t size) {
  std::uint64_t value = 0;
  for (std::size_t k = size; k-- > 0;)
    value = value << 8 | static_cast<unsigned char>(bytes[at + k]);
  return value;
}

}  // namespace

CammSample parse_camm(std::string_view bytes, const std::string& source) {
  const auto need = [&](std::size_t length) {
    if (bytes.size() >= length) return;
    throw InputError(fmt::format(
        "{}: found a sample of {} bytes (cut), expected {}", source, bytes.size(), length));
  };
  need(kHead);
  CammSample sample;
  const std::uint64_t kind = little_endian(bytes, 2, 2);
  if (kind == kExposure) {
    need(kHead + 8);
    const auto skew_ns = static_cast<std::int32_t>(little_endian(bytes, kHead + 4, 4));
    sample.readout_s = 1e-9 * skew_ns;
  }
  if (kind == kGyroscope) {
    need(kHead + 12);
    Eigen::Vector3d rates;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto bits = static_cast<std::uint32_t>(little_endian(bytes, kHead + 4 * k, 4));
      rates[static_cast<int>(k)] = static_cast<double>(std::bit_cast<float>(bits));
    }
    if (!rates.allFinite()) {
      throw InputError(
          fmt::format("{}: found a rate that is not finite, expected three numbers", source));
    }
    sample.rates_rad_s = rates;
  }
  return sample;
}

}  // namespace gpo
