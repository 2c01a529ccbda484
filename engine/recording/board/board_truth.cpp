// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/error.h"
#include "engine/base/stop.h"
#include "engine/files/byte_cursor.h"
#include "engine/files/output_file.h"
#include "engine/files/text_file.h"
#include "engine/geometry/statistics.h"
#include "engine/recording/board/board.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <system_error>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <opencv2/core/version.hpp>

namespace gpo {
namespace {

constexpr double kMostTimesMedian = 4;
constexpr double kAlwaysGood = 0.5;  ///< a blurred frame among very sharp ones [pixel_unit]
constexpr int kMedianFrames = 30;

BoardViews views_of(const Recording& recording,
                    const std::vector<int>& frames,
                    const std::stop_token& stop,
                    const BoardProgress& progress) {
  const auto cache = board_cache_file(recording);
  BoardViews views = cache ? load_board_views(*cache) : BoardViews{};
  std::vector<int> missing;
  std::ranges::copy_if(
      frames, std::back_inserter(missing), [&](int frame) { return !views.contains(frame); });
  if (missing.empty()) return views;
  const int of = static_cast<int>(frames.size());
  int done = of - static_cast<int>(missing.size());
  BoardViews found;
  std::mutex mutex;
  const auto process = [&](int frame, const cv::Mat& gray) {
    const Board& board = *recording.board;
    const auto pose = board_pose(find_board(gray, board), board, recording.camera);
    const std::scoped_lock lock(mutex);
    found[frame] = pose;
    if (progress) progress(++done, of);
  };
  const auto save = [&] {
    const StopScope to_the_end(nullptr);
    if (cache && !found.empty()) save_board_views(*cache, found);
  };
  try {
    for_each_image(*recording.images, missing, stop, process);
  } catch (...) {
    save();
    throw;
  }
  save();
  views.merge(found);
  return views;
}

/// Returns the RMS above which a fit is rejected as wrong [px].
double largest_rms_px(const BoardViews& views, std::span<const int> frames, const Camera& camera) {
  std::vector<double> rms_px;
  for (const int frame : frames) {
    const auto view = views.find(frame);
    if (view != views.end() && view->second) rms_px.push_back(view->second->uncertainty.rms_px);
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

GroundTruth in_one_frame(const BoardViews& views,
                         std::span<const int> frames,
                         const Board& board,
                         double most_rms_px) {
  GroundTruth truth;
  truth.source = board_title(board);
  truth.poses.resize(frames.size());
  truth.uncertainties.resize(frames.size());
  const auto symmetries = board_symmetries(board);
  std::optional<Pose> last;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const auto view = views.find(frames[i]);
    if (view == views.end() || !view->second) continue;
    const BoardPose& found = *view->second;
    if (found.uncertainty.rms_px > most_rms_px) continue;
    last = last ? nearest(found.pose, symmetries, *last) : found.pose;
    truth.poses[i] = last;
    truth.uncertainties[i] = found.uncertainty;
  }
  return truth;
}

/// Increase this whenever corners, poses or uncertainties in the same images change.
constexpr int kAlgorithm = 4;
constexpr std::string_view kMagic = "gpo board views\n";

/// Frame, whether the board was found, R_wc, p_wc, uncertainty.
using StoredView = std::array<double, 18>;

StoredView row_of(int frame, const std::optional<BoardPose>& view) {
  StoredView one{static_cast<double>(frame), view ? 1.0 : 0.0};
  if (!view) return one;
  Eigen::Map<Eigen::Matrix3d>(one.data() + 2) = view->pose.R_wc;
  Eigen::Map<Eigen::Vector3d>(one.data() + 11) = view->pose.p_wc;
  const auto& u = view->uncertainty;
  Eigen::Map<Eigen::Vector4d>(one.data() + 14) << u.rms_px, u.position_sigma_m,
      u.rotation_sigma_deg, u.normal_sigma_deg;
  return one;
}

std::optional<BoardPose> restored(const StoredView& one) {
  if (one[1] == 0) return std::nullopt;
  return BoardPose{
      {Eigen::Map<const Eigen::Matrix3d>(&one[2]), Eigen::Map<const Eigen::Vector3d>(&one[11])},
      {.rms_px = one[14],
       .position_sigma_m = one[15],
       .rotation_sigma_deg = one[16],
       .normal_sigma_deg = one[17]}};
}

/// Contains the file's name, so that a renamed file is not accepted.
std::string head_of(const fs::path& file) {
  return fmt::format("{}{}\n", kMagic, file.filename().string());
}

}  // namespace

GroundTruth board_truth(const Recording& recording,
                        const std::vector<int>& frames,
                        const std::stop_token& stop,
                        const BoardProgress& progress) {
  const BoardViews views = views_of(recording, frames, stop, progress);
  return in_one_frame(
      views, frames, *recording.board, largest_rms_px(views, frames, recording.camera));
}

GroundTruth board_truth(const Recording& recording,
                        int start,
                        int frames,
                        const std::stop_token& stop,
                        const BoardProgress& progress) {
  const int left = recording.frame_count() - start;
  std::vector<int> considered(std::max(frames, std::min(kMedianFrames, left)));
  std::iota(considered.begin(), considered.end(), start);
  const BoardViews views = views_of(recording, considered, stop, progress);
  const std::span<const int> all = considered;
  const double most_rms_px =
      largest_rms_px(views, all.first(std::min(kMedianFrames, left)), recording.camera);
  return in_one_frame(views, all.first(frames), *recording.board, most_rms_px);
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
  const Camera& camera = recording.camera;
  std::string key = fmt::format("{} {}\n{}x{} {} {} {} {} {} {}\n{}\n",
                                kAlgorithm,
                                CV_VERSION,
                                camera.width,
                                camera.height,
                                camera.fx,
                                camera.fy,
                                camera.cx,
                                camera.cy,
                                static_cast<int>(camera.distortion),
                                fmt::join(camera.coefficients, " "),
                                text_of(*recording.board));
  try {
    const RecordingContent content = content_of(recording);
    key += content.at("pictures") + content.at("time stamps");  // frames may be left out
  } catch (const InputError&) {
    return std::nullopt;
  }
  return recording.cache_folder / "boards" / fmt::format("{:016x}", fnv1a(key));
}

BoardViews load_board_views(const fs::path& file) {
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
  BoardViews views;
  ByteCursor cursor(body.substr(head.size()));
  for (auto one = cursor.number<StoredView>(); cursor.ok(); one = cursor.number<StoredView>())
    views[static_cast<int>(one[0])] = restored(one);
  return views;
}

void save_board_views(const fs::path& file, const BoardViews& views) {
  BoardViews all = load_board_views(file);
  all.insert(views.begin(), views.end());
  std::string bytes = head_of(file);
  for (const auto& [frame, view] : all) bytes += stored(row_of(frame, view));
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
