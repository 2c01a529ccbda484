// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/live/sources.h"

#include "engine/files/refuse.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>

namespace gpo {
namespace {

std::int64_t count_ns(auto duration) {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(duration).count();
}

void sleep_until(std::int64_t steady_ns, const std::stop_token& stop) {
  std::mutex mutex;
  std::condition_variable_any never;
  std::unique_lock lock(mutex);
  const std::chrono::steady_clock::time_point end{std::chrono::nanoseconds(steady_ns)};
  never.wait_until(lock, stop, end, [] { return false; });
}

}  // namespace

LiveClock real_clock() {
  // The steady clock, moved once, so that setting the system's clock does not shift times.
  const auto steady_now_ns = [] {
    return count_ns(std::chrono::steady_clock::now().time_since_epoch());
  };
  const std::int64_t since_1970_ns =
      count_ns(std::chrono::system_clock::now().time_since_epoch()) - steady_now_ns();
  return {[=] { return steady_now_ns() + since_1970_ns; },
          [=](std::int64_t time_ns, const std::stop_token& stop) {
            sleep_until(time_ns - since_1970_ns, stop);
          }};
}

const SourceRow& source_row(const std::string& address) {
  static constexpr auto kRows = std::to_array<SourceRow>(
      {{"camera:", true, open_camera},
       {"rtsp://", true, open_stream, "rtsp", "rtp,udp,tcp"},
       {"http://", true, open_stream, "mpegts,mpjpeg,mjpeg,jpeg_pipe,flv,matroska", "http,tcp"},
       {"udp://", true, open_stream, "mpegts", "udp"},
       {"", false, open_player}});
  return *std::ranges::find_if(
      kRows, [&](const SourceRow& row) { return address.starts_with(row.prefix); });
}

OpenSource open_player(const SourceAddress& address, const SourceContext& context) {
  const auto& recording = address.recording;
  if (!recording || !recording->images)
    refuse(address.text, "has no images; choose a video or a recording with images");
  const std::int64_t begin_ns = context.clock.now_ns();
  constexpr std::int64_t kLongest_ns = 366LL * 24 * 3600 * 1'000'000'000;  // broken times
  return {.device = "",
          .read = [=, next = std::make_shared<int>(0)]() -> std::optional<TimedImage> {
            if (*next >= recording->frame_count()) return std::nullopt;
            const std::int64_t time_ns = recording->timestamps_ns[*next];
            const std::int64_t elapsed_ns = time_ns - recording->timestamps_ns.front();
            const std::int64_t due_ns = begin_ns + std::min(elapsed_ns, kLongest_ns);
            const cv::Mat bgr = recording->images->bgr(*next);
            context.clock.wait_until(due_ns, context.stop);
            if (context.stop.stop_requested()) return std::nullopt;
            ++*next;
            return TimedImage{bgr, time_ns};
          }};
}

std::int64_t CaptureTimes::next(std::int64_t arrival_ns,
                                const std::optional<std::int64_t>& sender_ns) {
  std::int64_t time_ns = arrival_ns;
  if (last_ns_) time_ns = std::max(time_ns, *last_ns_ + 1);
  if (sender_ns) {
    const bool jumped = !last_sender_ns_ || *sender_ns < *last_sender_ns_ ||
                        std::abs(*sender_ns + offset_ns_ - arrival_ns) > kMostApart_ns;
    if (jumped) offset_ns_ = time_ns - *sender_ns;
    time_ns = *sender_ns + offset_ns_;
    last_sender_ns_ = sender_ns;
  }
  if (last_ns_) time_ns = std::max(time_ns, *last_ns_ + 1);
  last_ns_ = time_ns;
  return time_ns;
}

}  // namespace gpo
