// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/results/result_method.h"

#include "engine/base/error.h"
#include "engine/external_methods/own_method.h"
#include "engine/files/refuse.h"
#include "engine/files/text_file.h"
#include "engine/results/result_cameras.h"
#include "engine/results/time_offset.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <tuple>

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

using Index = std::ptrdiff_t;

std::string offset_text(const TimeOffset& offset) {
  return fmt::format("{:+.2f} +- {:.2f} ms", 1e3 * offset.seconds, 1e3 * offset.sigma_s);
}

/// The files of a result for one recording.
class Reader {
 public:
  Reader(const ProgramResult& result, ResultLog log)
      : result_(result),
        log_(std::move(log)),
        poses_(read_result_poses(result.poses)),
        frame_(result.frame.value_or(poses_.frame)) {
    if (!result.points.empty())
      points_ = read_result_points(result.points);
    else if (is_folder(result.poses) && has_points(result.poses))
      points_ = read_result_points(result.poses);
    if (result.shift != TimeShift::none && poses_.by != FoundBy::time)
      refuse(result.poses, "--result {}: has no times, remove ,offset=", result.name);
  }

  Initialization initialize(const Window& window,
                            const Sources& sources,
                            const RecordingFacts& recording,
                            ImportedResult& imported) {
    try {
      add_time_offset(window, recording, imported);
      Initialization result = initialization(window, sources, imported);
      if (!result.ok) result.reason = fmt::format("{}: {}", result_.name, result.reason);
      return result;
    } catch (const std::exception& error) {
      return failed(fmt::format("{}: {}", result_.name, message_of(error)));
    }
  }

  std::optional<ImportedResult> describe(const RecordingFacts& recording) {
    if (poses_.by != FoundBy::time || !recording.clock || !camera_is_known(recording))
      return std::nullopt;
    const Pose T_posed_camera = pose_of_camera(frame_, recording.T_body_camera);
    ImportedResult imported;
    set_time_offset(
        cached_offset(T_posed_camera, *recording.clock), recording.clock->source, imported);
    return imported;
  }

 private:
  Initialization initialization(const Window& window,
                                const Sources& sources,
                                ImportedResult& imported) {
    const double offset_s = imported.applied_time_offset_s;
    const ResultCameras found = found_cameras(poses_, frame_, window, sources, offset_s);
    Answer answer;
    answer.cameras = found.cameras;
    propose_frame(answer.cameras, window, sources, offset_s);
    const ResultCoverage covered = coverage_of(answer.cameras);
    constexpr int kMinCovered = 3;
    const int least = std::min(kMinCovered, window.frame_count());
    if (covered.count < least || 2 * (covered.last - covered.first) < window.frame_count() - 1)
      return failed(
          fmt::format("has {} of the window's {} frames, expected at least {} over half of it{}",
                      covered.count,
                      window.frame_count(),
                      least,
                      span_text(poses_, window)));
    if (!answer.cameras.front())
      answer.cameras.front() = resected(window, triangulated(window, answer.cameras), 0);
    if (!answer.cameras.front())
      return failed("has no pose of the window's first frame and too few points to resect it");
    answer.plane = plane_in_view(points_, *answer.cameras.front(), window);
    report(found, window, answer.plane.has_value());
    Initialization result = initialization_of(window, answer);
    if (result.ok && result_.scale.value_or(default_scale()) == ResultScale::metric)
      imported.meters_per_unit = unit_of(found.cameras, result.cameras);
    return result;
  }

  /// Body poses come from programs that use an IMU, which measures meters.
  ResultScale default_scale() const {
    return frame_ == PosedFrame::body ? ResultScale::metric : ResultScale::free;
  }

  /// Returns the unit of the estimate in that of the result, from the largest distance of cameras.
  static std::optional<double> unit_of(const std::vector<std::optional<Pose>>& given,
                                       const std::vector<Pose>& estimated) {
    const auto first = std::ranges::find_if(given, [](const auto& one) { return one.has_value(); });
    const auto f = first - given.begin();
    double length = 0, own_length = 0;
    for (Index i = f + 1; i < std::ssize(given); ++i) {
      if (!given[i]) continue;
      const double apart = (given[i]->p_wc - (*first)->p_wc).norm();
      if (apart <= length) continue;
      length = apart;
      own_length = (estimated[i].p_wc - estimated[f].p_wc).norm();
    }
    return own_length > 0 ? std::optional(length / own_length) : std::nullopt;
  }

  void add_time_offset(const Window& window,
                       const RecordingFacts& recording,
                       ImportedResult& imported) {
    if (poses_.by != FoundBy::time || !camera_is_known(recording)) return;
    const bool whole = recording.clock != nullptr;
    const ClockReference of_window{"the window's rotations", window.timestamps_ns, window.R_wc};
    const ClockReference& reference = whole ? *recording.clock : of_window;
    const Pose T_posed_camera = pose_of_camera(frame_, recording.T_body_camera);
    const auto offset = whole ? cached_offset(T_posed_camera, reference)
                              : estimate_time_offset(poses_, T_posed_camera, reference);
    set_time_offset(offset, reference.source, imported);
    report_time_offset(offset, reference.source);
  }

  void set_time_offset(const std::optional<TimeOffset>& offset,
                       const std::string& source,
                       ImportedResult& imported) const {
    imported.clock = source;
    if (result_.shift == TimeShift::given) imported.applied_time_offset_s = result_.shift_s;
    if (!offset) return;
    imported.time_offset_s = offset->seconds;
    imported.time_offset_sigma_s = offset->sigma_s;
    if (result_.shift == TimeShift::estimated) imported.applied_time_offset_s = offset->seconds;
  }

  bool camera_is_known(const RecordingFacts& recording) const {
    return frame_ == PosedFrame::camera || recording.T_body_camera;
  }

  /// The estimate depends on the recording only, so all windows have the same.
  std::optional<TimeOffset> cached_offset(const Pose& T_posed_camera,
                                          const ClockReference& reference) {
    const std::lock_guard lock(mutex_);
    const auto& times = reference.timestamps_ns;
    OffsetKey key{reference.source, times.size(), times.front(), times.back()};
    if (!offset_ || offset_->first != key)
      offset_.emplace(std::move(key), estimate_time_offset(poses_, T_posed_camera, reference));
    return offset_->second;
  }

  void report_time_offset(const std::optional<TimeOffset>& offset, const std::string& source) {
    constexpr double kSignificant = 3, kLeast_s = 1e-3;
    const bool requested = result_.shift != TimeShift::none;
    if (!offset) {
      if (result_.shift == TimeShift::estimated)
        report(
            fmt::format("time offset: undetermined by {}, none is applied; state it with "
                        ",offset=SECONDS",
                        source));
      return;
    }
    const double left_s =
        std::abs(offset->seconds - (result_.shift == TimeShift::given ? result_.shift_s : 0));
    const bool significant = left_s > std::max(kLeast_s, kSignificant * offset->sigma_s);
    if (!requested && !significant) return;
    const std::string advice = result_.shift == TimeShift::estimated ? "; it is applied"
                               : requested
                                   ? fmt::format("; {:+.1f} ms are applied", 1e3 * result_.shift_s)
                               : significant ? "; it is not applied, add ,offset=auto to apply it"
                                             : "";
    report(fmt::format(
        "time offset {}, recording minus result, by {}{}", offset_text(*offset), source, advice));
  }

  /// Reports that the poses fit the window's rotations far better in the other frame, unless the
  /// user chose it.
  void propose_frame(const std::vector<std::optional<Pose>>& cameras,
                     const Window& window,
                     const Sources& sources,
                     double offset_s) {
    constexpr double kFarBetter = 1.0 / 3, kLeast_deg = 0.5;
    if (result_.frame || !sources.T_body_camera) return;
    const PosedFrame other = frame_ == PosedFrame::body ? PosedFrame::camera : PosedFrame::body;
    const double now_deg = rotation_misfit_deg(cameras, window);
    const double other_deg = rotation_misfit_deg(
        found_cameras(poses_, other, window, sources, offset_s).cameras, window);
    if (now_deg > kLeast_deg && other_deg < kFarBetter * now_deg)
      report(
          fmt::format("add ,frame={}: as {} poses its rotations are {:.2f} deg from the "
                      "window's, as {} poses {:.2f} deg",
                      to_string(other),
                      to_string(other),
                      other_deg,
                      to_string(frame_),
                      now_deg));
  }

  void report(const std::string& message) {
    if (!log_) return;
    constexpr std::size_t kMaxMessages = 20;
    const std::lock_guard lock(mutex_);
    if (messages_.size() < kMaxMessages && messages_.insert(message).second)
      log_(result_.name, message);
  }

  void report(const ResultCameras& found, const Window& window, bool plane_of_points) {
    const ResultCoverage covered = coverage_of(found.cameras);
    report(fmt::format(
        "{}, {} poses{}{}{}; {} of the window's {} frames{}{}{}; plane through {}",
        poses_.layout,
        to_string(frame_),
        frame_ == PosedFrame::body ? ", with T_BS" : "",
        poses_.repeats > 0 ? fmt::format(", {} left out", counted(poses_.repeats, "repeated row"))
                           : "",
        poses_.unmeasured > 0
            ? fmt::format(", {} without a pose left out", counted(poses_.unmeasured, "row"))
            : "",
        covered.count,
        window.frame_count(),
        found.interpolated > 0 ? fmt::format(" ({} interpolated)", found.interpolated) : "",
        found.in_gaps > 0 ? fmt::format(" ({} in gaps of up to {:.3g} s between poses)",
                                        found.in_gaps,
                                        found.longest_gap_s)
                          : "",
        covered.count < window.frame_count() ? ", the others resected" : "",
        plane_of_points ? "its points" : "points triangulated from its cameras"));
  }

  using OffsetKey = std::tuple<std::string, std::size_t, std::int64_t, std::int64_t>;
  const ProgramResult result_;
  const ResultLog log_;
  const ResultPoses poses_;
  const PosedFrame frame_;
  Eigen::Matrix3Xd points_;
  std::mutex mutex_;
  std::set<std::string> messages_;
  std::optional<std::pair<OffsetKey, std::optional<TimeOffset>>>
      offset_;  ///< for the last recording
};

/// The files of a result, which are read at the first window of a recording if each has its own.
class Readers {
 public:
  /// Throws InputError.
  Readers(ProgramResult result, ResultLog log) : result_(std::move(result)), log_(std::move(log)) {
    if (!is_pattern(result_)) readers_[""] = std::make_shared<Reader>(result_, log_);
  }

  /// Throws InputError if the files are absent or cannot be read.
  std::shared_ptr<Reader> find(const std::string& recording) {
    const bool pattern = is_pattern(result_);
    if (pattern && recording.empty())
      refuse("--result " + result_.name,
             "{{recording}} stands for the name of a recording, but this one has none");
    const std::lock_guard lock(mutex_);
    std::shared_ptr<Reader>& reader = readers_[pattern ? recording : ""];
    if (!reader) reader = std::make_shared<Reader>(in_recording(result_, recording), log_);
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
  std::map<std::string, std::shared_ptr<Reader>> readers_;
};

/// Reads the value of `offset=`.
void read_shift(const std::string& value, ProgramResult& result) {
  constexpr double kMost_s = 1e6;
  const auto number = value == "auto" ? std::optional(0.0) : parse_number(value);
  if (!number || !(std::abs(*number) <= kMost_s))
    refuse("--result", "'offset={}', expected auto or seconds of at most {:g}", value, kMost_s);
  result.shift = value == "auto" ? TimeShift::estimated : TimeShift::given;
  result.shift_s = *number;
}

/// Returns `choice`, whose errors then name the option.
template <class E>
E choice_in_result(const std::string& value) try {
  return choice<E>(value);
} catch (const SettingError& error) {
  refuse("--result", "{}", error.what());
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
      result.frame = choice_in_result<PosedFrame>(value);
    } else if (part.starts_with("scale=")) {
      result.scale = choice_in_result<ResultScale>(value);
    } else if (part.starts_with("offset=")) {
      read_shift(value, result);
    } else if (result.poses.empty()) {
      result.poses = part;
    } else if (result.points.empty()) {
      result.points = part;
    } else {
      refuse("--result", "'{}', expected {}", text, kExpected);
    }
  }
  if (result.poses.empty()) refuse("--result", "'{}' names no file, expected {}", text, kExpected);
  return result;
}

Method result_method(const ProgramResult& result, const ResultLog& log, int number) {
  const auto readers = std::make_shared<Readers>(result, log);
  RecordingMethod method;
  method.bind = [readers](const RecordingFacts& recording) -> BoundMethod {
    return [reader = readers->find(recording.name), recording](
               const Window& window, const Sources& sources, ImportedResult& imported) {
      return reader->initialize(window, sources, recording, imported);
    };
  };
  method.describe = [readers](const RecordingFacts& recording) {
    return readers->find(recording.name)->describe(recording);
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

}  // namespace gpo
