// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/results/result_method.h"

#include "engine/base/error.h"
#include "engine/external_methods/own_method.h"
#include "engine/files/text_file.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <mutex>

#include <Eigen/LU>
#include <fmt/format.h>

namespace gpo {
namespace {

constexpr std::string_view kRecording = "{recording}";

bool is_pattern(const ProgramResult& result) {
  return (result.poses.string() + result.points.string()).find(kRecording) != std::string::npos;
}

/// Returns a path with the name of a recording in place of each `{recording}`.
fs::path in_recording(const fs::path& pattern, const std::string& recording) {
  std::string path = pattern.string();
  for (std::size_t at = 0; (at = path.find(kRecording, at)) != std::string::npos;
       at += recording.size())
    path.replace(at, kRecording.size(), recording);
  return path;
}

ProgramResult in_recording(ProgramResult result, const std::string& recording) {
  result.poses = in_recording(result.poses, recording);
  result.points = in_recording(result.points, recording);
  return result;
}

std::string suffixes_of(const ProgramResult& result) {
  std::string text;
  if (result.frame) text += fmt::format(" {}", to_string(*result.frame));
  if (result.scale) text += fmt::format(" {}", to_string(*result.scale));
  if (result.shift == TimeShift::estimated) text += " offset=auto";
  if (result.shift == TimeShift::given) text += fmt::format(" offset={}", result.shift_s);
  return text;
}

std::string identity_of(const ProgramResult& result) {
  std::string identity = "result";
  for (const fs::path& path : {result.poses, result.points}) {
    if (path.empty()) continue;
    identity += fmt::format(" {}", path.filename().string());
    auto files = is_folder(path) ? files_in(path) : std::vector{path};
    std::ranges::sort(files);
    for (const fs::path& file : files) identity += fmt::format(" {}", checksum_of(file));
  }
  return identity + suffixes_of(result);
}

/// The files of a result, which are read at the first window of a recording if each has its own.
class Readers {
 public:
  /// Throws InputError.
  Readers(ProgramResult result, ResultLog log) : result_(std::move(result)), log_(std::move(log)) {
    if (!is_pattern(result_)) readers_[""] = read_result(result_, log_);
  }

  /// Throws InputError if the files are absent or cannot be read.
  ResultReader find(const std::string& recording) {
    const bool pattern = is_pattern(result_);
    if (pattern && recording.empty())
      throw InputError(fmt::format(
          "--result {}: {{recording}} stands for the name of a recording, but this one has none",
          result_.name));
    const std::lock_guard lock(mutex_);
    ResultReader& reader = readers_[pattern ? recording : ""];
    if (!reader.initialize) reader = read_result(in_recording(result_, recording), log_);
    return reader;
  }

  std::optional<std::string> identity_for(const std::string& recording) {
    const ProgramResult result = in_recording(result_, recording);
    std::error_code none;
    if (!fs::exists(result.poses, none)) return std::nullopt;
    find(recording);
    return identity_of(result);
  }

 private:
  const ProgramResult result_;
  const ResultLog log_;
  std::mutex mutex_;
  std::map<std::string, ResultReader> readers_;
};

/// Reads the value of `offset=`.
void read_shift(const std::string& value, ProgramResult& result) {
  constexpr double kMost_s = 1e6;
  const auto number = value == "auto" ? std::optional(0.0) : parse_number(value);
  if (!number || !(std::abs(*number) <= kMost_s))
    throw InputError(
        fmt::format("--result: 'offset={}', expected auto or seconds, e.g. offset=0.02", value));
  result.shift = value == "auto" ? TimeShift::estimated : TimeShift::given;
  result.shift_s = *number;
}

Eigen::Matrix3Xd inlier_rays(const Window& window) {
  const Eigen::Matrix3d K_inverse = window.K.inverse();
  const std::vector<int> tracks = window.inlier_tracks(0);
  Eigen::Matrix3Xd rays(3, std::ssize(tracks));
  for (Eigen::Index k = 0; k < rays.cols(); ++k)
    rays.col(k) = (K_inverse * window.points_px[0].col(tracks[k]).homogeneous()).normalized();
  return rays;
}

}  // namespace

ProgramResult parse_program_result(const std::string& text) {
  constexpr const char* kExpected =
      "NAME=FILE[,POINTS][,frame=camera|body][,scale=metric|free][,offset=auto|SECONDS]";
  const auto [name, files] = parse_named(text, "--result", kExpected);
  ProgramResult result{name, {}, {}};
  for (const std::string& part : split(files, ',')) {
    const std::string value = part.substr(part.find('=') + 1);
    if (part.starts_with("frame=")) {
      result.frame = choice<PosedFrame>(value);
    } else if (part.starts_with("scale=")) {
      result.scale = choice<ResultScale>(value);
    } else if (part.starts_with("offset=")) {
      read_shift(value, result);
    } else if (result.poses.empty()) {
      result.poses = part;
    } else if (result.points.empty()) {
      result.points = part;
    } else {
      throw InputError(fmt::format("--result: '{}', expected {}", text, kExpected));
    }
  }
  if (result.poses.empty())
    throw InputError(fmt::format("--result: '{}' names no file, expected {}", text, kExpected));
  return result;
}

Method result_method(const ProgramResult& result, const ResultLog& log, int number) {
  const auto readers = std::make_shared<Readers>(result, log);
  RecordingMethod method;
  method.bind = [readers](const RecordingFacts& recording) -> BoundMethod {
    return [reader = readers->find(recording.name), recording](
               const Window& window, const Sources& sources, ImportedResult& imported) {
      return reader.initialize(window, sources, recording, imported);
    };
  };
  method.describe = [readers](const RecordingFacts& recording) {
    return readers->find(recording.name).describe(recording);
  };
  const bool pattern = is_pattern(result);
  if (pattern)
    method.identity_for = [readers](const std::string& recording) {
      return readers->identity_for(recording);
    };
  return own_method(
      result.name,
      number,
      std::move(method),
      pattern ? "result of each recording" + suffixes_of(result) : identity_of(result));
}

std::optional<Plane> plane_in_view(const Eigen::Matrix3Xd& points,
                                   const Pose& reference,
                                   const Window& window) {
  constexpr double kNear_deg = 2;
  constexpr int kMinPoints = 10;
  const Eigen::Matrix3Xd rays = inlier_rays(window);
  if (rays.cols() == 0) return std::nullopt;
  const double near = std::cos(radians(kNear_deg));
  const Eigen::Vector3d middle = rays.rowwise().sum().normalized();
  const double widest = std::acos(std::min(1.0, (middle.transpose() * rays).minCoeff()));
  const double in_cone = std::cos(std::min(widest + radians(kNear_deg), M_PI));
  Eigen::Matrix3Xd seen(3, points.cols());
  int count = 0;
  for (const auto& point : points.colwise()) {
    const Eigen::Vector3d P = to_camera(reference, point);
    const double distance = P.norm();
    if (!(P.z() > 0) || middle.dot(P) < in_cone * distance) continue;
    if ((P.transpose() * rays).maxCoeff() >= near * distance) seen.col(count++) = P;
  }
  if (count < kMinPoints) return std::nullopt;
  const auto plane = fit_plane(seen.leftCols(count));
  if (!plane) return std::nullopt;
  return plane_in_camera(*plane, inverse(reference));
}

}  // namespace gpo
