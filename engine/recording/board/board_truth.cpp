// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/error.h"
#include "engine/base/parallel.h"
#include "engine/base/stop.h"
#include "engine/files/byte_cursor.h"
#include "engine/files/output_file.h"
#include "engine/files/text_file.h"
#include "engine/geometry/statistics.h"
#include "engine/recording/board/board.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <set>
#include <system_error>

#include <fmt/format.h>
#include <opencv2/core/version.hpp>

namespace gpo {
namespace {

constexpr double kMostTimesMedian = 4;
constexpr double kAlwaysGood = 0.5;  ///< a blurred frame among very sharp ones [pixel_unit]
constexpr int kMedianFrames = 30;

/// Results by frame before a symmetric pose is chosen.
using BoardPoses = std::map<int, BoardPose>;

/// Adds the corners of frames that are missing.
void add_corners(const Recording& recording,
                 const std::vector<int>& frames,
                 BoardCorners& corners,
                 const std::stop_token& stop,
                 const BoardProgress& progress) {
  std::vector<int> missing;
  std::ranges::copy_if(
      frames, std::back_inserter(missing), [&](int frame) { return !corners.contains(frame); });
  if (missing.empty()) return;
  const int of = static_cast<int>(frames.size());
  int done = of - static_cast<int>(missing.size());
  BoardCorners found;
  std::mutex mutex;
  const auto process = [&](int frame, const cv::Mat& gray) {
    auto in_frame = find_board(gray, *recording.board);
    const std::scoped_lock lock(mutex);
    found[frame] = std::move(in_frame);
    if (progress) progress(++done, of);
  };
  const auto cache = board_cache_file(recording);
  const auto save = [&] {
    const StopScope to_the_end(nullptr);
    if (cache && !found.empty()) save_board_corners(*cache, found);
  };
  try {
    for_each_image(*recording.images, missing, stop, process);
  } catch (...) {
    save();
    throw;
  }
  save();
  corners.merge(found);
}

/// Adds the frames that determine the corners' velocities.
std::vector<int> with_neighbors(const Recording& recording, std::span<const int> frames) {
  constexpr int kReach = 2;
  std::set<int> all;
  for (const int frame : frames)
    for (int k = -kReach; k <= kReach; ++k)
      if (frame + k >= 0 && frame + k < recording.frame_count()) all.insert(frame + k);
  return {all.begin(), all.end()};
}

/// Returns the corners at the time stamp of the frame; empty if they or their velocities are
/// unknown.
std::vector<Eigen::Vector2d> corners_at(const Recording& recording,
                                        double readout_s,
                                        const BoardCorners& corners,
                                        int frame) {
  const std::vector<Eigen::Vector2d>& seen = corners.at(frame);
  if (seen.empty() || readout_s == 0) return seen;
  const auto velocities_px_s = corner_velocities(corners, frame, recording.timestamps_ns);
  if (velocities_px_s.empty()) return {};
  return at_time_stamp(seen, velocities_px_s, recording.camera, readout_s);
}

struct FoundPoses {
  BoardPoses poses;
  std::optional<Readout> estimated_readout;
};

/// Estimates an unknown readout time from the first `examined` of the frames.
FoundPoses poses_of(const Recording& recording,
                    const std::vector<int>& frames,
                    std::size_t examined,
                    const std::stop_token& stop,
                    const BoardProgress& progress) {
  const Camera& camera = recording.camera;
  const auto cache = board_cache_file(recording);
  BoardCorners corners = cache ? load_board_corners(*cache) : BoardCorners{};
  FoundPoses result;
  if (!camera.readout) {
    add_corners(recording, frames, corners, stop, progress);
    result.estimated_readout = readout_from_board(corners,
                                                  std::span(frames).first(examined),
                                                  recording.timestamps_ns,
                                                  *recording.board,
                                                  camera);
  }
  const double readout_s =
      camera.readout.value_or(result.estimated_readout.value_or(Readout{})).seconds;
  add_corners(recording,
              readout_s != 0 ? with_neighbors(recording, frames) : frames,
              corners,
              stop,
              progress);
  std::vector<int> found;
  std::ranges::copy_if(
      frames, std::back_inserter(found), [&](int frame) { return corners.contains(frame); });
  std::mutex mutex;
  in_parallel(static_cast<int>(found.size()),
              static_cast<int>(std::thread::hardware_concurrency()),
              [&](int k) {
                const auto seen = corners_at(recording, readout_s, corners, found[k]);
                const auto pose = board_pose(seen, *recording.board, camera);
                const std::scoped_lock lock(mutex);
                if (pose) result.poses.emplace(found[k], *pose);
              });
  return result;
}

/// Returns the RMS above which a fit is rejected as wrong [px].
double largest_rms_px(const BoardPoses& poses, std::span<const int> frames, const Camera& camera) {
  std::vector<double> rms_px;
  for (const int frame : frames) {
    const auto pose = poses.find(frame);
    if (pose != poses.end()) rms_px.push_back(pose->second.uncertainty.rms_px);
  }
  if (rms_px.empty()) return std::numeric_limits<double>::infinity();
  return std::max(kAlwaysGood * pixel_unit(camera), kMostTimesMedian * median(std::move(rms_px)));
}

Pose nearest(const Pose& pose, const std::vector<Pose>& symmetries, const Pose& last) {
  const auto turned = [&](const Pose& symmetry) {
    return so3_log(last.R_wc.transpose() * symmetry.R_wc * pose.R_wc).norm();
  };
  return *std::ranges::min_element(symmetries, {}, turned) * pose;
}

GroundTruth in_one_frame(const FoundPoses& of_frames,
                         std::span<const int> frames,
                         const Board& board,
                         double most_rms_px) {
  GroundTruth truth;
  truth.source = board_title(board);
  truth.estimated_readout = of_frames.estimated_readout;
  truth.poses.resize(frames.size());
  truth.uncertainties.resize(frames.size());
  const auto symmetries = board_symmetries(board);
  std::optional<Pose> last;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const auto pose = of_frames.poses.find(frames[i]);
    if (pose == of_frames.poses.end()) continue;
    const BoardPose& found = pose->second;
    if (found.uncertainty.rms_px > most_rms_px) continue;
    last = last ? nearest(found.pose, symmetries, *last) : found.pose;
    truth.poses[i] = last;
    truth.uncertainties[i] = found.uncertainty;
  }
  return truth;
}

/// Increase this whenever corners in the same images change.
constexpr int kAlgorithm = 5;
constexpr std::string_view kMagic = "gpo board corners\n";

/// Contains the file's name, so that a renamed file is not accepted.
std::string head_of(const fs::path& file) {
  return fmt::format("{}{}\n", kMagic, file.filename().string());
}

}  // namespace

GroundTruth board_truth(const Recording& recording,
                        const std::vector<int>& frames,
                        const std::stop_token& stop,
                        const BoardProgress& progress) {
  const auto found = poses_of(recording, frames, frames.size(), stop, progress);
  return in_one_frame(
      found, frames, *recording.board, largest_rms_px(found.poses, frames, recording.camera));
}

GroundTruth board_truth(const Recording& recording,
                        int start,
                        int frames,
                        const std::stop_token& stop,
                        const BoardProgress& progress) {
  const int left = recording.frame_count() - start;
  std::vector<int> considered(std::max(frames, std::min(kMedianFrames, left)));
  std::iota(considered.begin(), considered.end(), start);
  const std::size_t examined = std::min(kMedianFrames, left);
  const auto found = poses_of(recording, considered, examined, stop, progress);
  const std::span<const int> all = considered;
  const double most_rms_px = largest_rms_px(found.poses, all.first(examined), recording.camera);
  return in_one_frame(found, all.first(frames), *recording.board, most_rms_px);
}

std::optional<PoseUncertainty> median_uncertainty(
    std::span<const std::optional<PoseUncertainty>> uncertainties) {
  const auto known = [](const auto& one) { return one.has_value(); };
  if (std::ranges::none_of(uncertainties, known)) return std::nullopt;
  const auto of = [&](double PoseUncertainty::*number) {
    std::vector<double> values;
    for (const auto& one : uncertainties)
      if (one) values.push_back((*one).*number);
    return median(std::move(values));
  };
  return PoseUncertainty{.rms_px = of(&PoseUncertainty::rms_px),
                         .position_sigma_m = of(&PoseUncertainty::position_sigma_m),
                         .rotation_sigma_deg = of(&PoseUncertainty::rotation_sigma_deg),
                         .normal_sigma_deg = of(&PoseUncertainty::normal_sigma_deg)};
}

std::string uncertainty_text(const PoseUncertainty& uncertainty) {
  return fmt::format("{:.2g} mm, {:.2g} deg, board normal {:.2g} deg (1 sigma; fit {:.2f} px RMS)",
                     1e3 * uncertainty.position_sigma_m,
                     uncertainty.rotation_sigma_deg,
                     uncertainty.normal_sigma_deg,
                     uncertainty.rms_px);
}

std::optional<fs::path> board_cache_file(const Recording& recording) {
  if (recording.cache_folder.empty() || recording.image_files.empty() || !recording.board)
    return std::nullopt;
  std::string key = fmt::format("{} {}\n{}\n", kAlgorithm, CV_VERSION, text_of(*recording.board));
  try {
    const RecordingContent content = content_of(recording);
    key += content.at("pictures") + content.at("time stamps");  // frames may be left out
  } catch (const InputError&) {
    return std::nullopt;
  }
  return recording.cache_folder / "boards" / fmt::format("{:016x}", fnv1a(key));
}

BoardCorners load_board_corners(const fs::path& file) {
  std::string bytes;
  try {
    bytes = read_file(file);
  } catch (const InputError&) {
    return {};
  }
  const std::string head = head_of(file);
  constexpr std::size_t kSum = sizeof(std::uint64_t);
  if (!bytes.starts_with(head) || bytes.size() < head.size() + kSum) return {};
  const std::string_view body = std::string_view(bytes).substr(0, bytes.size() - kSum);
  if (bytes.substr(body.size()) != stored(fnv1a(body))) return {};
  BoardCorners all;
  ByteCursor cursor(body.substr(head.size()));
  for (auto frame = cursor.number<std::int32_t>(); cursor.ok();
       frame = cursor.number<std::int32_t>()) {
    auto& corners = all[frame];
    const auto count = cursor.number<std::int32_t>();
    for (std::int32_t k = 0; k < count && cursor.ok(); ++k) {
      const auto x = cursor.number<double>();
      corners.emplace_back(x, cursor.number<double>());
    }
  }
  return all;
}

void save_board_corners(const fs::path& file, const BoardCorners& corners) {
  BoardCorners all = load_board_corners(file);
  all.insert(corners.begin(), corners.end());
  std::string bytes = head_of(file);
  for (const auto& [frame, in_frame] : all) {
    bytes += stored(std::int32_t{frame}) + stored(static_cast<std::int32_t>(in_frame.size()));
    for (const Eigen::Vector2d& corner : in_frame) bytes += stored(corner.x()) + stored(corner.y());
  }
  bytes += stored(fnv1a(bytes));
  std::error_code error;
  fs::create_directories(file.parent_path(), error);
  try {
    write_file(file, bytes);
  } catch (const InputError&) {
    // The cache is optional.
  }
}

}  // namespace gpo
