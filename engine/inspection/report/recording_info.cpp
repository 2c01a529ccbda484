// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/error.h"
#include "engine/inspection/report/report.h"
#include "engine/recording/board/board.h"
#include "engine/recording/companions/companion_files.h"
#include "engine/recording/layouts/open_recording.h"
#include "engine/window/timestamps.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gpo {
namespace {

constexpr int kMostFramesExamined = 300;
constexpr int kSample = 60;
constexpr double kGap = 1.5;  // median periods
constexpr double kGyroGap = 5;
constexpr std::size_t kLongestFile = 300;

double in_seconds(std::int64_t ns) { return static_cast<double>(ns) * 1e-9; }

/// Returns 1 / the mean difference of successive time stamps without gaps [Hz]. The median would be
/// that of rounded time stamps.
double mean_rate_hz(std::span<const std::int64_t> times) {
  const double longest = kGap * static_cast<double>(median_period_ns(times));
  double sum_ns = 0, count = 0;
  for (std::size_t i = 1; i < times.size(); ++i) {
    const auto length = static_cast<double>(times[i] - times[i - 1]);
    if (length > longest) continue;
    sum_ns += length;
    ++count;
  }
  return sum_ns > 0 ? 1e9 * count / sum_ns : 0;
}

template <class Label>
std::vector<TimeGap> gaps(std::span<const std::int64_t> times,
                          double periods,
                          std::int64_t origin,
                          Label label) {
  const double longest = periods * static_cast<double>(median_period_ns(times));
  std::vector<TimeGap> found;
  for (std::size_t i = 1; i < times.size(); ++i) {
    const auto length = times[i] - times[i - 1];
    if (static_cast<double>(length) > longest)
      found.push_back({label(i - 1), in_seconds(times[i - 1] - origin), in_seconds(length)});
  }
  return found;
}

GyroscopeInfo describe_gyroscope(const Gyroscope& gyroscope, const Recording& recording) {
  const auto& times = gyroscope.timestamps_ns;
  const auto first = recording.timestamps_ns.front() + gyroscope.time_offset_ns;
  const auto last = recording.timestamps_ns.back() + gyroscope.time_offset_ns;
  return {mean_rate_hz(times),
          times.front() <= first && times.back() >= last,
          gaps(times, kGyroGap, first, [&](auto i) { return gyroscope.lines[i]; })};
}

int known_count(const GroundTruth& truth) {
  return static_cast<int>(
      std::ranges::count_if(truth.poses, [](const auto& pose) { return pose.has_value(); }));
}

TruthInfo examine_board(const Recording& recording) {
  const int frames = recording.frame_count();
  const int count = frames <= kMostFramesExamined ? frames : kSample;
  std::vector<int> sample;
  for (int i = 0; i < count; ++i)
    sample.push_back(static_cast<int>(std::int64_t{i} * (frames - 1) / std::max(1, count - 1)));
  const GroundTruth truth = board_truth(recording, sample);
  return {.source = truth.source + " (board.yaml)",
          .frames = known_count(truth),
          .examined = count,
          .uncertainty = median_uncertainty(truth.uncertainties)};
}

std::optional<TruthInfo> describe_truth(const Recording& recording) {
  if (const auto& truth = recording.truth)
    return TruthInfo{truth->source, known_count(*truth), static_cast<int>(truth->poses.size())};
  if (recording.board && recording.images) return examine_board(recording);
  return std::nullopt;
}

std::optional<TracksInfo> describe_tracks(const Recording& recording) {
  if (recording.tracks.empty()) return std::nullopt;
  std::map<std::int64_t, int> lengths;
  for (const auto& observation : recording.tracks) ++lengths[observation.track];
  TracksInfo info{static_cast<int>(lengths.size()), static_cast<int>(recording.tracks.size()), 0};
  for (const auto& [track, length] : lengths) info.longest = std::max(info.longest, length);
  return info;
}

nlohmann::json to_json(const std::vector<TimeGap>& gaps, const char* after) {
  auto list = nlohmann::json::array();
  for (const auto& gap : gaps)
    list.push_back({{after, gap.after}, {"at_s", gap.at_s}, {"length_s", gap.length_s}});
  return list;
}

nlohmann::json to_json(const Camera& camera) {
  return {{"model", "pinhole"},
          {"resolution", {camera.width, camera.height}},
          {"intrinsics", {camera.fx, camera.fy, camera.cx, camera.cy}},
          {"distortion_model", distortion_name(camera.distortion)},
          {"distortion_coefficients", camera.coefficients}};
}

nlohmann::json to_json(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

struct Table {
  std::string text;

  void row(const char* name, const std::string& value) {
    text += fmt::format("{:<14}{}\n", name, value);
  }
  template <class... Values>
  void row(const char* name, fmt::format_string<Values...> format, Values&&... values) {
    row(name, fmt::format(format, std::forward<Values>(values)...));
  }
  void gaps(const std::vector<TimeGap>& gaps, const char* after) {
    constexpr std::size_t kShown = 5;
    for (std::size_t i = 0; i < std::min(gaps.size(), kShown); ++i) {
      const auto& [index, at_s, length_s] = gaps[i];
      const char* name = i == 0 ? "  gaps" : "";
      row(name, "{:.3f} s after {} {} (at {:.3f} s)", length_s, after, index, at_s);
    }
    if (gaps.size() > kShown) row("", "and {} more", gaps.size() - kShown);
  }
};

void add_camera(Table& table, const Camera& camera, CameraSource source) {
  constexpr std::array kSources{"", "self-calibrated, ", "a guess: "};
  table.row("resolution", "{}x{} px", camera.width, camera.height);
  table.row("camera",
            "{}pinhole, fx {:.2f} fy {:.2f} cx {:.2f} cy {:.2f} px",
            kSources[static_cast<std::size_t>(source)],
            camera.fx,
            camera.fy,
            camera.cx,
            camera.cy);
  std::string distortion = distortion_name(camera.distortion);
  for (const double k : camera.coefficients) distortion += fmt::format(" {:g}", k);
  table.row("distortion", distortion);
}

double offset_ms(const Gyroscope& gyroscope) {
  return static_cast<double>(gyroscope.time_offset_ns) * 1e-6;
}

void add_gyroscope(Table& table, const RecordingInfo& info) {
  if (!info.gyroscope) return table.row("gyroscope", "none");
  const auto& [rate_hz, covers_frames, gaps] = *info.gyroscope;
  const Gyroscope& gyroscope = *info.recording->gyroscope;
  const std::string samples = counted(gyroscope.timestamps_ns.size(), "sample");
  const char* covers = covers_frames ? "" : ", does not cover all frames";
  table.row("gyroscope", "{:.1f} Hz, {}{}", rate_hz, samples, covers);
  table.row(
      "  bias", "{:g} rad/s ({})", fmt::join(gyroscope.bias_rad_s, ", "), gyroscope.bias_source);
  if (gyroscope.time_offset_ns != 0)
    table.row("  offset", "{:.3f} ms ahead of the camera", offset_ms(gyroscope));
  table.gaps(gaps, "line");
}

void add_truth(Table& table, const RecordingInfo& info) {
  if (!info.truth) return table.row("ground truth", "none");
  const auto& [source, frames, examined, uncertainty] = *info.truth;
  const char* sampled = examined < info.recording->frame_count() ? " examined" : "";
  table.row("ground truth", "{}, {} of {} frames{}", source, frames, examined, sampled);
  if (uncertainty) table.row("  uncertainty", uncertainty_text(*uncertainty));
}

std::string plane_text(const Plane& plane) {
  return fmt::format(
      "normal {:.6f}, distance {:.6f} m", fmt::join(plane.normal, ", "), plane.distance);
}

std::string board_text(const Board& board) {
  const double side_mm = board.square_m * 1e3;
  if (board.tags && board.tags->alone) {
    const int id = *board.tags->alone;
    const std::string number = id == BoardTags::kAnyTag ? "" : fmt::format(" {}", id);
    return fmt::format("AprilTag{} of {:g} mm", number, side_mm);
  }
  if (board.tags)
    return fmt::format("AprilGrid, {} x {} tags of {:g} mm, spacing {:g}",
                       board.columns / 2,
                       board.rows / 2,
                       side_mm,
                       board.tags->spacing);
  const std::string counts =
      fmt::format("{} x {} inner corners, squares of {:g} mm", board.columns, board.rows, side_mm);
  if (!board.markers) return fmt::format("chessboard, {}", counts);
  return fmt::format("ChArUco, {}, markers of {:g} mm from {}",
                     counts,
                     board.markers->side_m * 1e3,
                     board.markers->dictionary);
}

nlohmann::json to_json(const Board& board) {
  if (board.tags && board.tags->alone) {
    nlohmann::json json = {{"pattern", "apriltag"}, {"tag_m", board.square_m}};
    if (*board.tags->alone != BoardTags::kAnyTag) json["id"] = *board.tags->alone;
    return json;
  }
  if (board.tags)
    return {{"pattern", "aprilgrid"},
            {"tag_columns", board.columns / 2},
            {"tag_rows", board.rows / 2},
            {"tag_m", board.square_m},
            {"tag_spacing", board.tags->spacing}};
  nlohmann::json json = {{"pattern", board.markers ? "charuco" : "chessboard"},
                         {"columns", board.columns},
                         {"rows", board.rows},
                         {"square_m", board.square_m}};
  if (board.markers) {
    json["marker_m"] = board.markers->side_m;
    json["dictionary"] = board.markers->dictionary;
  }
  return json;
}

std::string readout_text(const Camera& camera) {
  if (!camera.readout) return "unknown";
  const Eigen::Vector2d along = camera.readout->seconds * readout_direction(camera);
  return fmt::format("{:.2f} ms, {} {} first",
                     1e3 * along.norm(),
                     along.sum() < 0 ? "last" : "first",
                     along.x() != 0 ? "column" : "row");
}

}  // namespace

RecordingInfo describe(const Recording& recording) {
  const auto& times = recording.timestamps_ns;
  RecordingInfo info;
  info.recording = &recording;
  info.duration_s = in_seconds(times.back() - times.front());
  info.rate_hz = mean_rate_hz(times);
  info.gaps = gaps(times, kGap, times.front(), [](auto i) { return static_cast<int>(i); });
  if (recording.gyroscope) info.gyroscope = describe_gyroscope(*recording.gyroscope, recording);
  info.truth = describe_truth(recording);
  info.tracks = describe_tracks(recording);
  info.notes = recording.notes;
  info.findings = findings_of(evidence_of(recording), {Of::recording});
  info.files = found_files(recording);
  return info;
}

nlohmann::json to_json(const RecordingInfo& info) {
  const Recording& recording = *info.recording;
  nlohmann::json json = {{"recording", recording.path.string()},
                         {"name", recording.name},
                         {"layout", recording.layout},
                         {"pictures", recording.images != nullptr},
                         {"frames", recording.frame_count()},
                         {"duration_s", info.duration_s},
                         {"rate_hz", info.rate_hz},
                         {"gaps", to_json(info.gaps, "after_frame")},
                         {"camera", to_json(recording.camera)},
                         {"notes", info.notes},
                         {"findings", to_json(info.findings)}};
  if (const auto& readout = recording.camera.readout) json["readout_ms"] = 1e3 * readout->seconds;
  json["camera"]["source"] = to_string(recording.camera_source);
  if (const auto& gyroscope = recording.gyroscope)
    json["gyroscope"] = {{"rate_hz", info.gyroscope->rate_hz},
                         {"samples", gyroscope->timestamps_ns.size()},
                         {"bias_rad_s", to_json(gyroscope->bias_rad_s)},
                         {"bias_source", gyroscope->bias_source},
                         {"time_offset_ms", offset_ms(*gyroscope)},
                         {"covers_frames", info.gyroscope->covers_frames},
                         {"gaps", to_json(info.gyroscope->gaps, "after_line")}};
  if (const auto& truth = info.truth) {
    json["ground_truth"] = {
        {"source", truth->source}, {"frames", truth->frames}, {"frames_examined", truth->examined}};
    if (truth->uncertainty) json["ground_truth"].update(pose_uncertainty_json(*truth->uncertainty));
  }
  if (const auto& plane = recording.plane)
    json["plane"] = {{"normal", to_json(plane->normal)}, {"distance", plane->distance}};
  if (recording.board) json["board"] = to_json(*recording.board);
  auto& files = json["files"] = nlohmann::json::array();
  for (const FoundFile& one : info.files)
    files.push_back({{"file", one.file.string()},
                     {"read", !one.use.empty()},
                     {"use", one.use},
                     {"reason", one.reason}});
  if (const auto& tracks = info.tracks)
    json["tracks"] = {{"count", tracks->tracks},
                      {"observations", tracks->observations},
                      {"longest", tracks->longest}};
  return json;
}

std::string to_text(const RecordingInfo& info) {
  const Recording& recording = *info.recording;
  Table table;
  table.row("recording", recording.path.string());
  table.row("layout", recording.layout + (recording.images ? "" : ", without images"));
  const int frames = recording.frame_count();
  table.row("frames", "{}, {:.2f} Hz, {:.2f} s", frames, info.rate_hz, info.duration_s);
  table.gaps(info.gaps, "frame");
  add_camera(table, recording.camera, recording.camera_source);
  table.row("readout", readout_text(recording.camera));
  add_gyroscope(table, info);
  add_truth(table, info);
  table.row("plane", recording.plane ? plane_text(*recording.plane) : "unknown");
  table.row("board", recording.board ? board_text(*recording.board) : "none");
  if (info.tracks)
    table.row("tracks",
              "{}, {}, the longest {}",
              info.tracks->tracks,
              counted(info.tracks->observations, "observation"),
              counted(info.tracks->longest, "frame"));
  for (std::size_t i = 0; i < info.files.size(); ++i)
    table.row(i == 0 ? "files" : "", legible(to_text(info.files[i]), kLongestFile));
  for (std::size_t i = 0; i < info.notes.size(); ++i)
    table.row(i == 0 ? "notes" : "", info.notes[i]);
  for (std::size_t i = 0; i < info.findings.size(); ++i)
    table.row(i == 0 ? "findings" : "",
              "{}: {} ({})",
              to_string(info.findings[i].level),
              text_of(info.findings[i]),
              info.findings[i].key);
  return table.text;
}

std::vector<TopicInfo> describe_topics(const fs::path& path, const TopicChoices& choices) {
  std::vector<TopicInfo> topics;
  try {
    if (!find_bag(path)) return {};
    const Bag bag = open_recorded_bag(find_bag_files(path));
    for (const BagTopic& topic : bag.topics) topics.push_back({topic, std::nullopt});
    const TopicRoles roles = topic_roles(bag, choices);
    for (int i = 0; i < kTopicRoles; ++i)
      if (const auto topic = roles.topics[i]) topics[*topic].role = static_cast<TopicRole>(i);
  } catch (const InputError&) {
    // Opening the recording reports the error.
  }
  return topics;
}

nlohmann::json to_json(const std::vector<TopicInfo>& topics) {
  auto list = nlohmann::json::array();
  for (const auto& [topic, role] : topics) {
    nlohmann::json one = {
        {"name", topic.name}, {"type", topic.shown_type()}, {"messages", topic.messages}};
    if (role) one["role"] = to_string(*role);
    list.push_back(one);
  }
  return list;
}

std::string to_text(const std::vector<TopicInfo>& topics) {
  constexpr std::size_t kLongestName = 200;
  std::string text;
  for (const auto& [topic, role] : topics)
    text += fmt::format("{:<14}{} ({}, {}){}\n",
                        text.empty() ? "topics" : "",
                        legible(topic.name, kLongestName),
                        legible(topic.shown_type(), kLongestName),
                        topic.messages,
                        role ? fmt::format(": {}", to_string(*role)) : "");
  return text;
}

}  // namespace gpo
