// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/board/board_cache.h"

#include "engine/base/error.h"
#include "engine/files/output_file.h"
#include "engine/files/text_file.h"

#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <system_error>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <opencv2/core/version.hpp>

namespace gpo {

namespace {

namespace fs = std::filesystem;

/// To be raised whenever other corners, poses or uncertainties are found in the same pictures.
constexpr int kAlgorithm = 1;
constexpr std::string_view kMagic = "gpo board views\n";

/// As it lies in the file.
struct StoredView {
  std::int32_t frame = 0;
  std::int32_t found = 0;
  double R_wc[9] = {};
  double p_wc[3] = {};
  double rms_px = 0;
  double position_sigma_m = 0;
  double rotation_sigma_deg = 0;
  double normal_sigma_deg = 0;
};

/// FNV-1a.
std::uint64_t hash(std::string_view bytes) {
  std::uint64_t value = 14695981039346656037U;
  for (const char byte : bytes) value = (value ^ static_cast<unsigned char>(byte)) * 1099511628211U;
  return value;
}

std::string bytes_of(const auto& value) {
  std::string bytes(sizeof(value), '\0');
  std::memcpy(bytes.data(), &value, sizeof(value));
  return bytes;
}

StoredView stored(int frame, const std::optional<BoardPose>& view) {
  StoredView one;
  one.frame = frame;
  if (!view) return one;
  one.found = 1;
  Eigen::Map<Eigen::Matrix3d>(one.R_wc) = view->pose.R_wc;
  Eigen::Map<Eigen::Vector3d>(one.p_wc) = view->pose.p_wc;
  one.rms_px = view->uncertainty.rms_px;
  one.position_sigma_m = view->uncertainty.position_sigma_m;
  one.rotation_sigma_deg = view->uncertainty.rotation_sigma_deg;
  one.normal_sigma_deg = view->uncertainty.normal_sigma_deg;
  return one;
}

std::optional<BoardPose> restored(const StoredView& one) {
  if (one.found == 0) return std::nullopt;
  return BoardPose{
      {Eigen::Map<const Eigen::Matrix3d>(one.R_wc), Eigen::Map<const Eigen::Vector3d>(one.p_wc)},
      {one.rms_px, one.position_sigma_m, one.rotation_sigma_deg, one.normal_sigma_deg}};
}

/// The file's name is in its head, so that one that was renamed is told from ours.
std::string head_of(const fs::path& file) {
  return fmt::format("{}{}\n", kMagic, file.filename().string());
}

std::string key_of(const Camera& camera) {
  return fmt::format("{}x{} {} {} {} {} {} {}\n",
                     camera.width,
                     camera.height,
                     camera.fx,
                     camera.fy,
                     camera.cx,
                     camera.cy,
                     static_cast<int>(camera.distortion),
                     fmt::join(camera.coefficients, " "));
}

std::string tags_key(const Board& board) {
  if (!board.tags) return "";
  return fmt::format(
      "tags {} {} {}", board.tags->spacing, board.tags->border, board.tags->alone.value_or(-1));
}

std::string key_of(const Board& board) {
  return fmt::format("{}x{} {} {} {}\n",
                     board.columns,
                     board.rows,
                     board.square_m,
                     board.markers ? board.markers->side_m : 0,
                     board.markers ? board.markers->dictionary : tags_key(board));
}

}  // namespace

std::optional<fs::path> board_cache_file(const Recording& recording) {
  if (recording.cache_folder.empty() || recording.picture_files.empty() || !recording.board)
    return std::nullopt;
  std::string key = fmt::format("{} {}\n", kAlgorithm, CV_VERSION) + key_of(recording.camera) +
                    key_of(*recording.board);
  for (const fs::path& file : recording.picture_files) {
    std::error_code no_size;
    std::error_code no_time;
    const auto size = fs::file_size(file, no_size);
    const auto time = fs::last_write_time(file, no_time).time_since_epoch().count();
    if (no_size || no_time) return std::nullopt;
    key += fmt::format("{} {} {}\n", fs::absolute(file).string(), size, time);
  }
  return recording.cache_folder / "boards" / fmt::format("{:016x}", hash(key));
}

BoardViews load_board_views(const fs::path& file) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return {};
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
  if (bytes.substr(body.size()) != bytes_of(hash(body))) return {};
  BoardViews views;
  for (std::size_t i = head.size(); i + sizeof(StoredView) <= body.size();
       i += sizeof(StoredView)) {
    StoredView one;
    std::memcpy(&one, body.data() + i, sizeof(one));
    views[one.frame] = restored(one);
  }
  return views;
}

void save_board_views(const fs::path& file, const BoardViews& views) {
  BoardViews all = load_board_views(file);
  all.insert(views.begin(), views.end());
  std::string bytes = head_of(file);
  for (const auto& [frame, view] : all) bytes += bytes_of(stored(frame, view));
  bytes += bytes_of(hash(bytes));
  std::error_code error;
  fs::create_directories(file.parent_path(), error);
  try {
    write_file(file, bytes);
  } catch (const InputError&) {
    // Not worth a word: nobody asked for it.
  }
}

}  // namespace gpo
