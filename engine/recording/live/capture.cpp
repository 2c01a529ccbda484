// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/live/capture.h"

#include "engine/base/error.h"
#include "engine/base/stop.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace gpo {
namespace {

constexpr std::int64_t kRetry_ns = 1'000'000'000;

}  // namespace

Capture::Capture(const SourceAddress& address,
                 const CaptureOptions& options,
                 std::function<void()> changed)
    : address_(address), options_(options), changed_(std::move(changed)) {
  status_.message = "connecting to " + address.text;
  thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

Capture::~Capture() = default;

double Capture::seconds_since(std::int64_t time_ns) const {
  return 1e-9 * static_cast<double>(options_.clock.now_ns() - time_ns);
}

bool Capture::gives_up() const { return seconds_since(last_image_ns_) > options_.give_up_s; }

bool Capture::is_overdue(const std::stop_token& stop) {
  const double seconds = seconds_since(std::max(last_image_ns_, connected_ns_));
  if (seconds > options_.stall_s && status().state == CaptureState::running)
    set_state(CaptureState::stalled,
              fmt::format("{}: no image for {:.0f} s", address_.text, options_.stall_s));
  return stop.stop_requested() || seconds > options_.reconnect_s || gives_up();
}

void Capture::set_state(CaptureState state, const std::string& message) {
  {
    const std::lock_guard lock(mutex_);
    if (status_.state == state && status_.message == message) return;
    status_.state = state;
    status_.message = message;
  }
  arrived_.notify_all();
  if (changed_) changed_();
}

void Capture::push(TimedImage image, int broken) {
  {
    const std::lock_guard lock(mutex_);
    if (status_.captured > 0 && image.bgr.size() != status_.size) ++segment_;
    status_.size = image.bgr.size();
    status_.state = CaptureState::running;
    status_.message.clear();
    // A stream that is joined begins with images that cannot be decoded.
    if (status_.captured > 0) status_.dropped += std::max(0, broken - status_.broken);
    status_.broken = broken;
    ++status_.captured;
    queue_.push_back({std::move(image.bgr), image.timestamp_ns, segment_, last_image_ns_});
    if (std::ssize(queue_) > options_.queue) {
      queue_.pop_front();
      ++status_.dropped;
    }
  }
  arrived_.notify_all();
}

std::string Capture::read(const OpenSource& source, const std::stop_token& stop) {
  {
    const std::lock_guard lock(mutex_);
    status_.device = source.device;
  }
  int read = 0;
  while (!stop.stop_requested()) {
    auto image = source.read();
    if (!image) break;
    last_image_ns_ = options_.clock.now_ns();
    push(std::move(*image), source.broken());
    ++read;
  }
  if (read == 0) return address_.text + ": found no images";
  return fmt::format("{}: ended after {}", address_.text, counted(read, "image"));
}

void Capture::run(const std::stop_token& stop) {
  const StopWatch watch{.stop = stop};
  const StopScope scope(&watch);
  const SourceRow& row = source_row(address_.text);
  last_image_ns_ = options_.clock.now_ns();
  const SourceContext context{options_.clock, stop, [this, &stop] { return is_overdue(stop); }};
  while (!stop.stop_requested()) {
    std::string reason;
    bool failed = false;
    connected_ns_ = options_.clock.now_ns();
    try {
      reason = read(row.open(address_, context), stop);
    } catch (const Stopped&) {
      return;
    } catch (const std::exception& error) {
      reason = message_of(error);
      failed = true;
    }
    if (stop.stop_requested()) return;
    const bool none = status().captured == 0;
    const bool waited = seconds_since(connected_ns_) > options_.reconnect_s;
    if (!row.reconnects() || gives_up() || (failed && none && !waited))
      return set_state(failed || none ? CaptureState::failed : CaptureState::ended, reason);
    set_state(CaptureState::connecting, reason + "; connecting again");
    options_.clock.wait_until(options_.clock.now_ns() + kRetry_ns, stop);
  }
}

std::optional<LiveImage> Capture::take(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  arrived_.wait(lock, stop, [this] { return !queue_.empty() || status_.is_over(); });
  if (queue_.empty() || stop.stop_requested()) return std::nullopt;
  LiveImage image = std::move(queue_.front());
  queue_.pop_front();
  return image;
}

CaptureStatus Capture::status() const {
  const std::lock_guard lock(mutex_);
  return status_;
}

}  // namespace gpo
