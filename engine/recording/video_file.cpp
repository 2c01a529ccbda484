// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/video_file.h"

#include "engine/error.h"
#include "engine/recording/picture_files.h"
#include "engine/recording/text_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <map>
#include <mutex>
#include <string>
#include <utility>

#include <opencv2/core/utils/logger.hpp>
#include <opencv2/videoio.hpp>

namespace gpo {

namespace {

/// FFmpeg and OpenCV write to stderr about broken files; what matters becomes our InputError.
void silence_libraries() {
  static std::once_flag once;
  std::call_once(once, [] {
    // OpenCV reads it when it first opens a video; there is no other way to reach av_log's level.
    ::setenv("OPENCV_FFMPEG_LOGLEVEL", "-8", 0);  // NOLINT(concurrency-mt-unsafe): once
    cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
  });
}

cv::VideoCapture open_capture(const std::filesystem::path& file) {
  silence_libraries();
  cv::VideoCapture capture(file.string(), cv::CAP_FFMPEG);
  if (!capture.isOpened()) {
    throw InputError(
        file.string() +
        ": found something that cannot be decoded (cut, or no video), expected a video");
  }
  return capture;
}

/// Times of all frames [ms], by decoding each. Where they do not ascend, the frame rate's instead.
std::vector<double> frame_times_ms(cv::VideoCapture& capture) {
  std::vector<double> times;
  std::size_t ascending = 0;
  while (capture.grab()) {
    times.push_back(capture.get(cv::CAP_PROP_POS_MSEC));
    const std::size_t n = times.size();
    if (ascending + 1 == n && (n == 1 || times[n - 1] > times[n - 2])) ascending = n;
  }
  // The last frames, which a decoder that reorders keeps back until the end, come without a time.
  const bool only_tail_lacks = std::all_of(times.begin() + static_cast<std::ptrdiff_t>(ascending),
                                           times.end(),
                                           [](double time) { return time == 0; });
  const std::size_t kept = only_tail_lacks ? ascending : 0;
  const double fps = capture.get(cv::CAP_PROP_FPS);
  const double period = fps > 0 ? 1e3 / fps : 1e3 / 30;
  for (std::size_t i = kept; i < times.size(); ++i) times[i] = i == 0 ? 0 : times[i - 1] + period;
  return times;
}

/// Whether the container promises clearly more than what could be decoded. With a variable frame
/// rate it may declare a count made up from the duration, so the time must be short as well.
bool is_cut(const std::vector<double>& times_ms, double declared, double fps) {
  const double missing = declared - static_cast<double>(times_ms.size());
  if (missing <= std::max(2.0, declared / 100)) return false;
  if (times_ms.empty() || fps <= 0) return true;
  const double frames_of_time = (times_ms.back() - times_ms.front()) * 1e-3 * fps + 1;
  return declared - frames_of_time > missing / 2;
}

/// Sequential access made random: forward from where it stands, from the beginning to go back
/// (seeking is not exact in every container). On the way back the frames before the one asked for
/// are kept as well, since stepping backward will ask for them next.
class SequentialDecoder {
 public:
  SequentialDecoder(std::filesystem::path file, Camera camera)
      : file_(std::move(file)), camera_(std::move(camera)) {}

  cv::Mat decode(int index) {
    if (const auto kept = before_.find(index); kept != before_.end()) return kept->second;
    int first_kept = index;
    if (!capture_.isOpened() || index < next_) {
      first_kept = next_ > 0 ? index - kKept : index;
      capture_ = open_capture(file_);
      next_ = 0;
      before_.clear();
    }
    cv::Mat picture;
    for (; next_ <= index; ++next_) {
      if (next_ < first_kept) {
        if (!capture_.grab()) fail();
        continue;
      }
      cv::Mat read;
      if (!capture_.read(read)) fail();
      picture = read.clone();
      if (next_ < index) before_[next_] = picture;
    }
    check_size(file_, picture, camera_);
    return picture;
  }

 private:
  static constexpr int kKept = 12;

  [[noreturn]] void fail() {
    capture_.release();
    throw InputError(file_.string() + ": frame " + std::to_string(next_) +
                     ": found nothing to decode, expected a picture");
  }

  std::filesystem::path file_;
  Camera camera_;
  cv::VideoCapture capture_;
  int next_ = 0;
  std::map<int, cv::Mat> before_;
};

}  // namespace

VideoFile open_video(const std::filesystem::path& file,
                     const Camera& camera,
                     std::size_t cache_bytes) {
  if (!std::filesystem::exists(file)) throw InputError(file.string() + ": no such file");
  cv::VideoCapture capture = open_capture(file);
  const double declared = capture.get(cv::CAP_PROP_FRAME_COUNT);
  const double fps = capture.get(cv::CAP_PROP_FPS);
  const auto times_ms = frame_times_ms(capture);
  if (times_ms.empty() || is_cut(times_ms, declared, fps)) {
    throw InputError(file.string() + ": found " + std::to_string(times_ms.size()) +
                     " frames that can be decoded (the file seems cut), expected " +
                     std::to_string(std::max(1L, std::lround(declared))));
  }
  const auto decoder = std::make_shared<SequentialDecoder>(file, camera);
  const auto decode = [decoder](int index) { return decoder->decode(index); };
  std::vector<std::int64_t> times_ns;
  times_ns.reserve(times_ms.size());
  for (const double ms : times_ms) times_ns.push_back(std::llround(ms * 1e6));
  return {
      std::move(times_ns),
      std::make_shared<const FrameCache>(static_cast<int>(times_ms.size()), decode, cache_bytes)};
}

bool is_video_name(const std::filesystem::path& file) {
  const std::string ending = lower_case(file.extension().string());
  constexpr std::array<const char*, 4> kEndings = {".mp4", ".avi", ".mov", ".mkv"};
  return std::find(kEndings.begin(), kEndings.end(), ending) != kEndings.end();
}

}  // namespace gpo
