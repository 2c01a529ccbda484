// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/results/result_method.h"

#include "engine/base/error.h"
#include "engine/commands/answered.h"
#include "engine/commands/completion.h"
#include "engine/commands/own_method.h"
#include "engine/files/folder.h"
#include "engine/geometry/plane_fit.h"
#include "engine/results/found_frames.h"
#include "engine/results/plane_in_view.h"

#include <algorithm>
#include <memory>
#include <mutex>
#include <set>
#include <sstream>
#include <utility>

#include <fmt/format.h>

namespace gpo {
namespace {

namespace fs = std::filesystem;

/// Fewer cameras, or all within less than half of the window, say nothing of it.
constexpr int kLeastCovered = 3;

struct Coverage {
  int count = 0;
  int first = 0;  ///< frames of the window
  int last = 0;
};

Coverage coverage_of(const std::vector<std::optional<Pose>>& cameras) {
  Coverage coverage;
  for (int i = 0; i < std::ssize(cameras); ++i) {
    if (!cameras[i]) continue;
    if (coverage.count++ == 0) coverage.first = i;
    coverage.last = i;
  }
  return coverage;
}

std::string span_text(const ResultPoses& poses, const Window& window) {
  constexpr double kSecond = 1e9;
  if (poses.by == FoundBy::number) return fmt::format("; it has {} lines", poses.poses.size());
  if (poses.by == FoundBy::name)
    return fmt::format("; it has {} pictures, the first is {}",
                       poses.names.size(),
                       legible(poses.names.front(), 60));
  return fmt::format("; it is from {:.3f} to {:.3f} s, the window from {:.3f} to {:.3f} s",
                     static_cast<double>(poses.timestamps_ns.front()) / kSecond,
                     static_cast<double>(poses.timestamps_ns.back()) / kSecond,
                     static_cast<double>(window.timestamps_ns.front()) / kSecond,
                     static_cast<double>(window.timestamps_ns.back()) / kSecond);
}

/// A result's files, read, and what it makes of windows. Used by several threads at once.
class Reader {
 public:
  Reader(const ProgramResult& result, ResultTeller told)
      : name_(result.name),
        told_(std::move(told)),
        poses_(read_result_poses(result.poses)),
        frame_(result.frame.value_or(poses_.frame)) {
    if (!result.points.empty())
      points_ = read_result_points(result.points);
    else if (is_folder(result.poses) && has_points(result.poses))
      points_ = read_result_points(result.poses);
  }

  Initialization initialize(const Window& window, const Sources& sources) {
    try {
      Initialization result = initialization(window, sources);
      if (!result.ok) result.reason = fmt::format("{}: {}", name_, result.reason);
      return result;
    } catch (const std::exception& error) {
      return failed(fmt::format("{}: {}", name_, message_of(error)));
    }
  }

 private:
  Initialization initialization(const Window& window, const Sources& sources) {
    Answer answer;
    answer.cameras = found_cameras(poses_, frame_, window, sources);
    const Coverage covered = coverage_of(answer.cameras);
    const int least = std::min(kLeastCovered, window.frame_count());
    if (covered.count < least || 2 * (covered.last - covered.first) < window.frame_count() - 1) {
      return failed(
          fmt::format("has {} of the window's {} frames, expected {} or more over half of it{}",
                      covered.count,
                      window.frame_count(),
                      least,
                      span_text(poses_, window)));
    }
    if (!answer.cameras.front())
      answer.cameras.front() = resected(window, triangulated(window, answer.cameras), 0);
    if (!answer.cameras.front())
      return failed("has no pose of the window's first frame, and too few points to find it from");
    answer.plane = plane_in_view(points_, *answer.cameras.front(), window);
    tell(covered, window, answer.plane.has_value());
    return initialization_of(window, answer);
  }

  /// Each sentence once.
  void tell(const Coverage& covered, const Window& window, bool plane_of_points) {
    if (!told_) return;
    constexpr std::size_t kMostSentences = 20;
    const std::string sentence =
        fmt::format("{}, the {}'s poses{}; {} of the window's {} frames{}; plane through {}",
                    poses_.layout,
                    to_string(frame_),
                    frame_ == PosedFrame::body ? ", with T_BS" : "",
                    covered.count,
                    window.frame_count(),
                    covered.count < window.frame_count() ? ", the others resected" : "",
                    plane_of_points ? "its points" : "what its cameras triangulate");
    const std::lock_guard lock(mutex_);
    if (sentences_.size() < kMostSentences && sentences_.insert(sentence).second)
      told_(name_, sentence);
  }

  const std::string name_;
  const ResultTeller told_;
  const ResultPoses poses_;
  const PosedFrame frame_;
  Eigen::Matrix3Xd points_;
  std::mutex mutex_;
  std::set<std::string> sentences_;
};

/// What is compared is what the files have, wherever they lie.
std::string identity_of(const ProgramResult& result) {
  std::string identity = "result";
  for (const fs::path& path : {result.poses, result.points}) {
    if (path.empty()) continue;
    identity += fmt::format(" {}", path.filename().string());
    auto files = is_folder(path) ? files_in(path) : std::vector{path};
    std::ranges::sort(files);
    for (const fs::path& file : files) identity += fmt::format(" {}", checksum_of(file));
  }
  return identity + (result.frame ? fmt::format(" {}", to_string(*result.frame)) : "");
}

}  // namespace

ProgramResult parse_program_result(const std::string& text) {
  constexpr const char* kExpected = "NAME=FILE[,POINTS][,frame=camera|body]";
  const auto [name, files] = parse_named(text, "--result", kExpected);
  ProgramResult result{name, {}, {}};
  std::istringstream parts(files);
  for (std::string part; std::getline(parts, part, ',');) {
    if (part.starts_with("frame=")) {
      result.frame = choice<PosedFrame>(part.substr(part.find('=') + 1));
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

Method result_method(const ProgramResult& result, const ResultTeller& told, int number) {
  const auto reader = std::make_shared<Reader>(result, told);
  return own_method(
      result.name,
      number,
      [reader](const Window& window, const Sources& sources, const Watch& /*watch*/) {
        return reader->initialize(window, sources);
      },
      identity_of(result));
}

}  // namespace gpo
