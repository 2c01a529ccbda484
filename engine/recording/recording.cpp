// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/recording.h"

#include "engine/base/stop.h"
#include "engine/files/libav_functions.h"
#include "engine/files/refuse.h"
#include "engine/files/text_file.h"

#include <algorithm>
#include <fstream>
#include <span>

#include <fmt/ranges.h>

namespace gpo {
namespace {

std::string sha256(const std::string& bytes) {
  const std::unique_ptr<AVSHA, void (*)(void*)> sum(libav::av_sha_alloc(),
                                                    [](void* sha) { libav::av_free(sha); });
  std::array<std::uint8_t, 32> digest{};
  libav::av_sha_init(sum.get(), 256);
  libav::av_sha_update(
      sum.get(), reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  libav::av_sha_final(sum.get(), digest.data());
  return fmt::format("{:02x}", fmt::join(digest, ""));
}

std::string text_of(const auto& matrix) {
  const std::span numbers(matrix.data(), static_cast<std::size_t>(matrix.size()));
  return fmt::format("{} ", fmt::join(numbers, " "));
}

std::string text_of(const Pose& pose) { return text_of(pose.R_wc) + text_of(pose.p_wc); }

std::string text_of(const Plane& plane) {
  return fmt::format("{}{}", text_of(plane.normal), plane.distance);
}

void add_camera(RecordingContent& content, const Camera& camera) {
  content["picture size"] = fmt::format("{}x{}", camera.width, camera.height);
  content["fx"] = fmt::format("{}", camera.fx);
  content["fy"] = fmt::format("{}", camera.fy);
  content["cx"] = fmt::format("{}", camera.cx);
  content["cy"] = fmt::format("{}", camera.cy);
  content["lens"] = fmt::format(
      "{} {}", static_cast<int>(camera.distortion), fmt::join(camera.coefficients, " "));
  if (!camera.sigmas.empty())
    content["lens uncertainty"] =
        fmt::format("{} {}", fmt::join(camera.sigmas, " "), fmt::join(camera.covariance, " "));
  if (camera.readout)
    content["readout"] =
        fmt::format("{} {} {}",
                    camera.readout->seconds,
                    camera.readout->sigma_s,
                    static_cast<int>(camera.readout_direction.value_or(ReadoutDirection::down)));
  else if (camera.readout_direction)
    content["readout"] = to_string(*camera.readout_direction);
}

std::string digest_of(const Gyroscope& gyroscope) {
  std::string text = fmt::format("{}{} {}{} {}\n{}",
                                 text_of(gyroscope.R_gyro_camera),
                                 gyroscope.time_offset_ns,
                                 text_of(gyroscope.bias_rad_s),
                                 gyroscope.bias_sigma_rad_s,
                                 gyroscope.noise_density,
                                 fmt::join(gyroscope.timestamps_ns, " "));
  for (const Eigen::Vector3d& rate : gyroscope.rates_rad_s) text += text_of(rate);
  for (const Eigen::Vector3d& one : gyroscope.accelerations_m_s2) text += text_of(one);
  return sha256(text);
}

std::string digest_of(const GroundTruth& truth) {
  std::string text = truth.upright ? "upright" : "";
  for (const auto& pose : truth.poses) text += pose ? text_of(*pose) : "-";
  return sha256(text);
}

std::string digest_of(const std::vector<TrackObservation>& tracks) {
  std::string text;
  for (const TrackObservation& one : tracks)
    text += fmt::format("{} {} {}", one.frame, one.track, text_of(one.raw_px)) +
            (one.sigma_px > 0 ? fmt::format(" {}", one.sigma_px) : "");
  return sha256(text);
}

std::string bytes_of(const fs::path& file, std::uint64_t begin, std::uint64_t count) {
  check_stop();
  std::ifstream stream(file, std::ios::binary);
  std::string bytes(count, '\0');
  stream.seekg(static_cast<std::streamoff>(begin));
  stream.read(bytes.data(), static_cast<std::streamsize>(count));
  if (!stream) refuse(file, "cannot be read");
  return bytes;
}

/// Returns the beginning, some blocks and the end of a file, and the time of its last change.
std::string sample_of(const fs::path& file, std::uint64_t size) {
  constexpr std::uint64_t kBlocks = 16, kBlockBytes = 4096;
  const auto time = fs::last_write_time(file).time_since_epoch().count();
  std::string sample = std::to_string(time);
  const std::uint64_t count = std::min(size, kBlockBytes);
  for (std::uint64_t i = 0; i < kBlocks; ++i)
    sample += bytes_of(file, (size - count) * i / (kBlocks - 1), count);
  return sample;
}

std::string digest_of(const std::vector<fs::path>& images) {
  constexpr std::uint64_t kMostReadWhole = std::uint64_t{64} << 20;  // a quarter of a second
  std::uint64_t total = 0;
  std::vector<std::uint64_t> sizes;
  for (const fs::path& file : images) {
    std::error_code error;
    sizes.push_back(fs::file_size(file, error));
    if (error) refuse(file, "cannot be read: {}", error.message());
    total += sizes.back();
  }
  std::string text;
  for (std::size_t i = 0; i < images.size(); ++i)
    text += fmt::format("{} {} {}\n",
                        images[i].filename().string(),
                        sizes[i],
                        sha256(total <= kMostReadWhole ? bytes_of(images[i], 0, sizes[i])
                                                       : sample_of(images[i], sizes[i])));
  return sha256(text);
}

using Ending = std::string_view;

constexpr std::array<Ending, 10> kImages = {
    "png", "jpg", "jpeg", "bmp", "pgm", "ppm", "tif", "tiff", "webp", "pnm"};
constexpr std::array<Ending, 7> kVideos = {"mp4", "mov", "m4v", "3gp", "mkv", "webm", "avi"};
/// Other programs use these endings for other files, so that only the content counts.
constexpr std::array<Ending, 3> kVideosByContent = {"ts", "m2ts", "mpg"};
constexpr std::array<Ending, 3> kBags = {"bag", "db3", "mcap"};

bool ends_in(const fs::path& file, std::span<const Ending> endings) {
  const std::string ending = lower_case(file.extension().string());
  return !ending.empty() && std::ranges::find(endings, Ending(ending).substr(1)) != endings.end();
}

}  // namespace

std::string text_of(const Board& board) {
  std::string kind = board.markers ? board.markers->dictionary : "";
  if (const auto& tags = board.tags)
    kind = fmt::format("tags {} {} {}", tags->spacing, tags->border, tags->alone.value_or(-1));
  const double side_m = board.markers ? board.markers->side_m : 0;
  return fmt::format("{}x{} {} {} {}", board.columns, board.rows, board.square_m, side_m, kind);
}

RecordingContent content_of(const Recording& recording) {
  RecordingContent content;
  add_camera(content, recording.camera);
  if (recording.camera_source != CameraSource::file)
    content["lens source"] = to_string(recording.camera_source);
  content["time stamps"] = sha256(fmt::format("{}", fmt::join(recording.timestamps_ns, " ")));
  if (recording.T_body_camera) content["camera in the body"] = text_of(*recording.T_body_camera);
  if (recording.images) content["pictures"] = digest_of(recording.image_files);
  if (recording.gyroscope) content["gyroscope"] = digest_of(*recording.gyroscope);
  if (recording.truth) content["truth"] = digest_of(*recording.truth);
  if (recording.plane) content["plane"] = text_of(*recording.plane);
  if (recording.board) content["board"] = text_of(*recording.board);
  if (!recording.tracks.empty()) content["tracks"] = digest_of(recording.tracks);
  if (is_recipe(recording.path)) content["recipe"] = sha256(read_file(recording.path));
  return content;
}

std::vector<std::string> differing_parts(const RecordingContent& a, const RecordingContent& b) {
  std::vector<std::pair<std::string, std::string>> parts;
  std::set_symmetric_difference(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(parts));
  std::vector<std::string> names;
  for (const auto& [name, part] : parts)
    if (names.empty() || names.back() != name) names.push_back(name);
  return names;
}

bool is_image_name(const fs::path& file) { return ends_in(file, kImages); }
bool is_video_name(const fs::path& file) { return ends_in(file, kVideos); }
bool is_bag_name(const fs::path& file) { return ends_in(file, kBags); }

std::string recording_endings() {
  return fmt::format("{}, {}, {}",
                     fmt::join(kVideos, ", "),
                     fmt::join(kVideosByContent, ", "),
                     fmt::join(kBags, ", "));
}

bool is_yaml_name(const fs::path& file) {
  constexpr std::array<Ending, 2> kYaml = {"yaml", "yml"};
  return ends_in(file, kYaml);
}

bool is_recipe(const fs::path& path) {
  return is_yaml_name(path) && path.filename() != "metadata.yaml" && is_file(path);
}

std::vector<fs::path> files_of_kind(const fs::path& folder,
                                    const std::function<bool(const fs::path& file)>& is_kind) {
  std::vector<fs::path> files = files_in(folder);
  std::erase_if(files, std::not_fn(is_kind));
  std::ranges::sort(files);
  return files;
}

std::optional<fs::path> only_file(const std::vector<fs::path>& files,
                                  const char* things,
                                  const fs::path& folder) {
  if (files.size() > 1)
    refuse(folder,
           "found {} {} ({}, {}{}), expected one; name the file to open",
           files.size(),
           things,
           files[0].filename().string(),
           files[1].filename().string(),
           files.size() > 2 ? ", ..." : "");
  return files.empty() ? std::nullopt : std::optional(files[0]);
}

}  // namespace gpo
