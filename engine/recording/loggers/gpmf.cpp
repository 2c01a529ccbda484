// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/error.h"
#include "engine/files/byte_cursor.h"
#include "engine/files/refuse.h"
#include "engine/recording/loggers/logs.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include <Eigen/LU>
#include <fmt/ranges.h>

namespace gpo {
namespace {

using Bytes = std::string_view;

std::string printable(Bytes key) {
  const bool plain = std::ranges::all_of(key, [](char c) { return c >= ' ' && c <= '~'; });
  return plain ? std::string(key) : fmt::format("bytes 0x{:08x}", big_endian(key, 0, 4));
}

[[noreturn]] void gpmf_fail(const GpmfItem& item,
                            const std::string& found,
                            const std::string& expected) {
  refuse(*item.source, "{}: found {}, expected {}", printable(item.key), found, expected);
}

int gpmf_size(char type) {
  if (type == 'b' || type == 'B') return 1;
  if (type == 's' || type == 'S') return 2;
  if (type == 'l' || type == 'L' || type == 'f') return 4;
  return type == 'd' || type == 'j' || type == 'J' ? 8 : 0;
}

struct Stream {
  std::map<Bytes, GpmfItem> items;

  const GpmfItem* find(Bytes key) const {
    const auto found = items.find(key);
    return found == items.end() ? nullptr : &found->second;
  }
};

Stream stream_of(const GpmfItem& nest) {
  Stream stream;
  GpmfItems items(nest.data, *nest.source);
  while (const auto item = items.next()) stream.items[item->key] = *item;
  return stream;
}

std::optional<double> number_of(const Stream& stream, Bytes key) {
  const GpmfItem* item = stream.find(key);
  if (item == nullptr) return std::nullopt;
  const auto numbers = gpmf_numbers(*item);
  return numbers.empty() ? std::nullopt : std::optional(numbers[0]);
}

/// `before` is the number of samples before if the camera stores no count.
GpmfStamp stamp_of(const Stream& stream, Bytes key, std::int64_t& before) {
  constexpr double kMostSamples = 1e12;
  constexpr double kMost_us = 1e15;
  GpmfStamp stamp{before, {}};
  const int count = stream.find(key)->count;
  if (const GpmfItem* total = stream.find("TSMP")) {
    const double number = number_of(stream, "TSMP").value_or(0);
    if (number < count || number > kMostSamples)
      gpmf_fail(*total, fmt::format("{:g}", number), "a count of all samples so far");
    stamp.first_sample = static_cast<std::int64_t>(number) - count;
  }
  before = stamp.first_sample + count;
  stamp.camera_us = number_of(stream, "STMP");
  if (!stamp.camera_us) {
    if (const auto tick = number_of(stream, "TICK")) stamp.camera_us = 1e3 * *tick;
  }
  if (stamp.camera_us && !(std::abs(*stamp.camera_us) < kMost_us)) stamp.camera_us.reset();
  return stamp;
}

std::string stored_axes(Bytes model) {
  if (model.starts_with("Hero6")) return "YxZ";
  if (model.starts_with("Hero7 Silver")) return "XZy";
  return model.starts_with("Fusion") ? "yXZ" : "ZXY";
}

Eigen::Matrix3d axes_of(const Stream& stream, Bytes model) {
  const GpmfItem* matrix = stream.find("MTRX");
  const GpmfItem* output = stream.find("ORIO");
  const GpmfItem* input = stream.find("ORIN");
  const auto named = [&](const GpmfItem& item) {
    const auto axes = signed_axes(gpmf_text(item));
    if (!axes) gpmf_fail(item, "no axes", "three right-handed axes such as ZXY");
    return *axes;
  };
  if (matrix != nullptr && output != nullptr) {
    const auto numbers = gpmf_numbers(*matrix);
    if (numbers.size() != 9) gpmf_fail(*matrix, "no 3 x 3 matrix", "nine numbers");
    const Eigen::Matrix3d M =
        Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(numbers.data());
    constexpr double kMostOff = 0.1;
    const bool rotates =
        (M * M.transpose() - Eigen::Matrix3d::Identity()).norm() < kMostOff && M.determinant() > 0;
    if (!rotates) gpmf_fail(*matrix, "a matrix that is not a rotation", "a rotation");
    return named(*output).transpose() * M;
  }
  if (input != nullptr) return named(*input).transpose();
  return signed_axes(stored_axes(model))->transpose();
}

Eigen::Vector3d scale_of(const Stream& stream) {
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();
  if (const GpmfItem* divisors = stream.find("SCAL")) {
    const auto numbers = gpmf_numbers(*divisors);
    if (numbers.size() != 1 && numbers.size() != 3)
      gpmf_fail(*divisors, counted(numbers.size(), "number"), "1 or 3");
    for (int i = 0; i < 3; ++i) {
      const double divisor = numbers[numbers.size() == 1 ? 0 : static_cast<std::size_t>(i)];
      if (divisor == 0) gpmf_fail(*divisors, "0", "a divisor");
      scale[i] = 1 / divisor;
    }
  }
  const GpmfItem* unit = stream.find("SIUN");
  if (unit == nullptr) unit = stream.find("UNIT");
  if (unit != nullptr && unit->data.find("deg") != Bytes::npos) scale *= std::numbers::pi / 180;
  return scale;
}

/// Reads GYRO or ACCL of a device; `before` counts the samples of previous payloads.
GpmfSamples samples_of(const Stream& stream, Bytes key, Bytes model, std::int64_t& before) {
  GpmfSamples result;
  const GpmfItem& samples = *stream.find(key);
  const int size = gpmf_size(samples.type);
  if (size == 0 || samples.size != 3 * size)
    gpmf_fail(samples, "samples that are not three numbers", "values of three axes");
  const auto numbers = gpmf_numbers(samples);
  const Eigen::Matrix3d axes = axes_of(stream, model);
  const Eigen::Vector3d scale = scale_of(stream);
  for (std::size_t i = 0; i + 2 < numbers.size(); i += 3) {
    const Eigen::Vector3d stored(numbers[i], numbers[i + 1], numbers[i + 2]);
    result.values.emplace_back(axes * scale.cwiseProduct(stored));
    if (!result.values.back().allFinite())
      gpmf_fail(samples, "a value that is not finite", "numbers");
  }
  result.first = stamp_of(stream, key, before);
  return result;
}

bool add_device(GpmfPayload& payload, const GpmfItem& device, GpmfCount& counted) {
  bool has_gyroscope = false;
  std::string model;
  GpmfItems items(device.data, *device.source);
  while (const auto item = items.next()) {
    if (item->key == "DVNM") model = gpmf_text(*item);
    if (item->key == "SROT" && item->type != 0) {
      const auto numbers = gpmf_numbers(*item);
      if (!numbers.empty()) payload.readout_s = 1e-3 * numbers[0];
    }
    if (item->key != "STRM" || item->type != 0) continue;
    const Stream stream = stream_of(*item);
    if (stream.find("GYRO") != nullptr && !has_gyroscope) {
      payload.rates_rad_s = samples_of(stream, "GYRO", model, counted.rates);
      has_gyroscope = true;
    }
    if (stream.find("ACCL") != nullptr && payload.accelerations_m_s2.values.empty())
      payload.accelerations_m_s2 = samples_of(stream, "ACCL", model, counted.accelerations);
    if (stream.find("SHUT") != nullptr)
      payload.exposures = stamp_of(stream, "SHUT", counted.exposures);
    if (const auto readout_ms = number_of(stream, "SROT")) payload.readout_s = 1e-3 * *readout_ms;
  }
  return has_gyroscope;
}

/// time = at_first + step * sample, by least squares.
struct Line {
  double at_first = 0, step = 0;
  double operator()(double sample) const { return at_first + step * sample; }
};

std::optional<Line> fitted(const std::vector<Eigen::Vector2d>& sample_and_time) {
  const auto n = static_cast<double>(sample_and_time.size());
  if (sample_and_time.size() < 2) return std::nullopt;
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const auto& one : sample_and_time) mean += one / n;
  double squares = 0, products = 0;
  for (const auto& one : sample_and_time) {
    squares += (one.x() - mean.x()) * (one.x() - mean.x());
    products += (one.x() - mean.x()) * (one.y() - mean.y());
  }
  if (!(squares > 0) || !(products > 0)) return std::nullopt;
  const double step = products / squares;
  return Line{mean.y() - step * mean.x(), step};
}

template <class StampOf>
std::optional<Line> camera_line(const std::vector<GpmfPayload>& payloads, const StampOf& stamp_of) {
  std::vector<Eigen::Vector2d> points;
  for (const GpmfPayload& payload : payloads) {
    const GpmfStamp* stamp = stamp_of(payload);
    if (stamp == nullptr || !stamp->camera_us) continue;
    points.emplace_back(static_cast<double>(stamp->first_sample), *stamp->camera_us);
  }
  return fitted(points);
}

std::optional<Line> sample_line(const std::vector<GpmfPayload>& payloads,
                                const std::vector<double>& payload_times_s,
                                GpmfSamples GpmfPayload::*sensor) {
  const auto with_samples = [&](const GpmfPayload& p) {
    return (p.*sensor).values.empty() ? nullptr : &(p.*sensor).first;
  };
  const auto exposures = [](const GpmfPayload& p) { return p.exposures ? &*p.exposures : nullptr; };
  const auto samples_us = camera_line(payloads, with_samples);
  const auto frames_us = camera_line(payloads, exposures);
  if (samples_us && frames_us)
    return Line{1e-6 * (samples_us->at_first - frames_us->at_first), 1e-6 * samples_us->step};
  std::vector<Eigen::Vector2d> points;
  for (std::size_t i = 0; i < payloads.size(); ++i) {
    const GpmfSamples& samples = payloads[i].*sensor;
    if (samples.values.empty()) continue;
    const auto first = static_cast<double>(samples.first.first_sample);
    points.emplace_back(first, payload_times_s[i]);
    if (payloads.size() > 1) continue;
    points.emplace_back(first + static_cast<double>(samples.values.size()), payload_times_s[i + 1]);
  }
  return fitted(points);
}

double number_at(const GpmfItem& item, std::size_t index) {
  const int size = gpmf_size(item.type);
  const std::uint64_t bits = big_endian(item.data, index * static_cast<std::size_t>(size), size);
  if (item.type == 'b') return static_cast<std::int8_t>(bits);
  if (item.type == 's') return static_cast<std::int16_t>(bits);
  if (item.type == 'l') return static_cast<std::int32_t>(bits);
  if (item.type == 'j') return static_cast<double>(static_cast<std::int64_t>(bits));
  if (item.type == 'f')
    return static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(bits)));
  if (item.type == 'd') return std::bit_cast<double>(bits);
  return static_cast<double>(bits);
}

}  // namespace

std::optional<Eigen::Matrix3d> signed_axes(Bytes text) {
  if (text.size() != 3) return std::nullopt;
  Eigen::Matrix3d rows = Eigen::Matrix3d::Zero();
  for (int i = 0; i < 3; ++i) {
    const std::size_t axis = Bytes("XYZxyz").find(text[i]);
    if (axis == Bytes::npos) return std::nullopt;
    rows(i, static_cast<int>(axis % 3)) = axis < 3 ? 1 : -1;
  }
  return rows.determinant() > 0.5 ? std::optional(rows) : std::nullopt;
}
GpmfPayload parse_gpmf(Bytes bytes, const std::string& source, GpmfCount& counted) {
  GpmfPayload payload;
  GpmfItems devices(bytes, source);
  while (const auto device = devices.next()) {
    if (device->key != "DEVC" || device->type != 0) continue;
    if (add_device(payload, *device, counted)) break;
  }
  return payload;
}

std::vector<std::int64_t> gpmf_times_ns(const std::vector<GpmfPayload>& payloads,
                                        const std::vector<double>& payload_times_s,
                                        GpmfSamples GpmfPayload::*sensor) {
  constexpr double kMost_s = 4e9;
  const auto line = sample_line(payloads, payload_times_s, sensor);
  std::vector<std::int64_t> times;
  if (!line) return times;
  for (const GpmfPayload& payload : payloads) {
    const auto& [values, first] = payload.*sensor;
    for (std::size_t k = 0; k < values.size(); ++k) {
      const double time_s =
          (*line)(static_cast<double>(first.first_sample) + static_cast<double>(k));
      if (!(std::abs(time_s) < kMost_s)) return {};
      times.push_back(std::llround(1e9 * time_s));
    }
  }
  return times;
}

std::optional<GpmfItem> GpmfItems::next() {
  constexpr std::size_t kHead = 8;
  if (rest_.size() < kHead || rest_.starts_with(Bytes("\0\0\0\0", 4))) return std::nullopt;
  GpmfItem item{.key = rest_.substr(0, 4),
                .type = rest_[4],
                .size = static_cast<int>(big_endian(rest_, 5, 1)),
                .count = static_cast<int>(big_endian(rest_, 6, 2)),
                .source = &source_};
  const std::size_t length = static_cast<std::size_t>(item.size) * item.count;
  const std::size_t left = rest_.size() - kHead;
  if (length > left)
    gpmf_fail(item, fmt::format("{} bytes (truncated)", left), std::to_string(length));
  item.data = rest_.substr(kHead, length);
  rest_.remove_prefix(std::min(rest_.size(), kHead + (length + 3) / 4 * 4));
  return item;
}

std::vector<double> gpmf_numbers(const GpmfItem& item) {
  const int size = gpmf_size(item.type);
  if (size == 0 || item.size % size != 0) gpmf_fail(item, "a type without numbers", "numbers");
  std::vector<double> numbers(item.data.size() / static_cast<std::size_t>(size));
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    numbers[i] = number_at(item, i);
    if (!std::isfinite(numbers[i])) gpmf_fail(item, "a number that is not finite", "numbers");
  }
  return numbers;
}

std::string stabilization_of_gpmf(Bytes settings) {
  const std::string source = "settings";
  std::vector<std::string> flags;
  try {
    GpmfItems devices(settings, source);
    while (const auto device = devices.next()) {
      if (device->key != "DEVC" || device->type != 0) continue;
      GpmfItems items(device->data, source);
      while (const auto item = items.next()) {
        if (item->key != "EISE" && item->key != "EISA") continue;
        const std::string value = gpmf_text(*item);
        const bool is_off = value.empty() || value == "N" || value == "N/A" || value == "OFF";
        if (!is_off) flags.push_back(std::string(item->key) + " " + value);
      }
    }
  } catch (const InputError&) {
    // Truncated settings are unusable.
  }
  return fmt::format("{}", fmt::join(flags, ", "));
}

std::string gpmf_text(const GpmfItem& item) {
  return std::string(item.data.substr(0, item.data.find('\0')));
}

}  // namespace gpo
