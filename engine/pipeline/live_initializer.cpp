// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/error.h"
#include "engine/base/internal/background_job.h"
#include "engine/base/limits.h"
#include "engine/base/stop.h"
#include "engine/diagnosis/limits.h"
#include "engine/initialize.h"
#include "engine/live.h"
#include "engine/pipeline/live_progress.h"
#include "engine/pipeline/live_samples.h"
#include "engine/pipeline/method_defaults.h"
#include "engine/pipeline/pipeline.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <deque>
#include <exception>
#include <mutex>
#include <utility>

#include <fmt/format.h>

namespace gpo {
namespace {

/// No window is solved below this share of the translation that a ready window needs. One
/// homography gives the translation to a few percent.
constexpr double kTravelShare = 0.8;

void check(const LiveOptions& options) {
  check_options(std::to_array<Limit>(
      {{"most_frames", static_cast<double>(options.most_frames), {2, 1e9, "at least 2"}},
       {"least_tracks", static_cast<double>(options.least_tracks), {0, 1e9, "at least 0"}},
       {"least_share", options.least_share, {0, 1, "0 to 1"}}}));
}

/// Returns whether the translation by one homography bounds the verdict: for the plane with most
/// tracks.
bool is_bounded_by_travel(const InitializeOptions& options) {
  return options.plane == 1 && options.method.row().needs_plane;
}

}  // namespace

struct LiveInitializer::Impl {
  /// A frame of the window, and the window that ends with it.
  struct Entry {
    std::shared_ptr<const Frame> frame;
    std::optional<std::int64_t> samples_until_ns;  ///< nullopt: there are no samples
    bool may_be_ready = false;
    bool is_refused = false;  ///< solved and not ready
  };

  struct Task {
    int length;
    std::vector<std::shared_ptr<const Frame>> frames;
    std::optional<Gyroscope> gyroscope;
  };

  const Camera camera;
  const LiveOptions options;
  std::mutex adding;  ///< frames are added one after the other
  // Used with `adding`.
  std::optional<Travel> travel;
  double farthest = 0;  ///< largest translation from the reference frame [plane distance]
  // Used with the lock of the job that solves.
  LiveSamples samples;
  std::shared_ptr<const Frame> newest;               ///< null before the first frame
  int added = 0;                                     ///< frames, including those that wait
  std::deque<std::shared_ptr<const Frame>> waiting;  ///< for samples, or for the job to end
  std::vector<Entry> window;
  bool closed = false;   ///< the window does not grow any more
  int taken = 0;         ///< length of the longest window that is or was being solved
  bool skipped = false;  ///< windows that could be solved were not
  std::string why_anew;  ///< why the window started
  LiveProgress progress;
  BackgroundJob job{[this] { return next(); }};

  Impl(const Camera& of, const LiveOptions& how, const std::optional<Gyroscope>& gyroscope)
      : camera(of), options(how), samples(gyroscope) {
    check_camera(camera);
    check_options(options.initialize);
    check(options);
  }

  // With `adding`, without the lock.

  void add(const Frame& frame);
  /// Moves the first frame that waits into the window, or starts a new one with it. Returns false
  /// if it must wait, or if none does.
  bool admit(bool is_new);
  LiveOutcome solved(const Task& task, const std::stop_token& stop) const;
  void solve(const Task& task, const std::stop_token& stop);
  void solve_skipped();

  // With the lock.

  bool is_crowded() const { return std::ssize(waiting) > options.most_frames; }
  bool is_settled() const {
    return progress.status.ready && (closed || std::ssize(window) >= options.most_frames);
  }
  Coverage coverage_of_next(bool is_new) const;
  std::string why_restart(int seen) const;
  void restart(const std::string& why);
  void append(const Coverage& covered, const Travel::Step& step);
  bool is_candidate(int length, const LiveProgress& so_far) const;
  /// Returns the length to solve next, the longest one; 0: none.
  int longest_next() const;
  Task task_of(int length) const;
  BackgroundJob::Job next();

  LiveStatus latest() const;
};

void LiveInitializer::Impl::add(const Frame& frame) {
  {
    const auto lock = job.lock();
    check_frame(frame, added, newest.get(), samples.time_offset_ns());
    if (options.initialize.rotations == RotationSource::truth && !frame.R_wc)
      throw SettingError("rotations", "truth: no rotations given");
    waiting.push_back(std::make_shared<const Frame>(frame));
    newest = waiting.back();
    ++added;
    progress.status.started_anew = false;
  }
  while (admit(true)) {
  }
}

Coverage LiveInitializer::Impl::coverage_of_next(bool is_new) const {
  if (window.empty()) return {};
  constexpr std::int64_t kLongAfter_ns = 1'000'000'000;
  const std::int64_t last_ns = waiting.front()->timestamp_ns;
  return samples.coverage(window.front().frame->timestamp_ns,
                          last_ns,
                          is_crowded() ? last_ns + kLongAfter_ns : newest->timestamp_ns,
                          is_new && waiting.size() == 1);
}

std::string LiveInitializer::Impl::why_restart(int seen) const {
  if (window.empty() || progress.status.ready) return "";
  const auto of = static_cast<double>(window.front().frame->ids.size());
  if (std::ssize(window) >= options.most_frames)
    return fmt::format("not ready after {} frames: {}", window.size(), progress.status.reason);
  if (seen == 0 || seen < options.least_tracks || seen < options.least_share * of)
    return fmt::format("{} of the first frame's {} tracks are left", seen, of);
  return "";
}

void LiveInitializer::Impl::restart(const std::string& why) {
  job.cancel();
  window.clear();
  taken = 0;
  skipped = false;
  why_anew = why;
  progress = {{.reference = added - static_cast<int>(waiting.size()), .started_anew = true}};
  travel.reset();
  farthest = 0;
}

bool LiveInitializer::Impl::admit(bool is_new) {
  auto lock = job.lock();
  if (waiting.empty()) return false;
  if (is_settled()) {
    samples.close();
    waiting.pop_front();
    return true;
  }
  const std::shared_ptr<const Frame> frame = waiting.front();
  const Coverage covered = coverage_of_next(is_new);
  if (covered.kind == Coverage::Kind::waiting) return false;
  Travel::Step step;
  if (travel && !progress.status.ready) {
    lock.unlock();
    step = travel->to(*frame);
    lock.lock();
  }
  if (progress.status.ready) {
    closed = !covered.reason.empty();
    if (closed) progress.status.reason = "the window ended, its answer is final: " + covered.reason;
  } else if (const std::string why =
                 covered.reason.empty() ? why_restart(step.seen) : covered.reason;
             !why.empty()) {
    // The window that is being solved may be ready.
    if (job.busy() && !is_crowded()) return false;
    restart(why);
  }
  if (!closed) append(covered, step);
  waiting.pop_front();
  const int length = options.background ? 0 : longest_next();
  if (length == 0) return true;
  taken = length;
  const Task task = task_of(length);
  lock.unlock();
  solve(task, {});
  return true;
}

void LiveInitializer::Impl::append(const Coverage& covered, const Travel::Step& step) {
  const Frame& frame = *waiting.front();
  if (!travel) {
    travel.emplace(camera, ransac_options(options.initialize), frame);
    samples.drop_before(frame.timestamp_ns);
  }
  LiveStatus& status = progress.status;
  farthest = std::max(farthest, step.tau.value_or(0));
  const bool moved = farthest >= kTravelShare * kReadyTranslation;
  const bool bounded = is_bounded_by_travel(options.initialize) && step.tau;
  window.push_back({waiting.front(), std::nullopt, !window.empty() && (moved || !bounded)});
  if (covered.kind == Coverage::Kind::complete)
    window.back().samples_until_ns = samples.newest_ns();
  status.frames = static_cast<int>(window.size());
  if (status.frames > 1 && !window.back().may_be_ready && !status.ready)
    status.reason = fmt::format(
        "the camera moved by about {:.1f} % of its distance from the plane, {:.0f} % are needed",
        100 * farthest,
        100 * kReadyTranslation);
  if (options.background && longest_next() > 0) job.wake();
}

bool LiveInitializer::Impl::is_candidate(int length, const LiveProgress& so_far) const {
  return (window[length - 1].may_be_ready || so_far.status.ready) && so_far.worth_solving(length);
}

int LiveInitializer::Impl::longest_next() const {
  for (int length = static_cast<int>(window.size()); length > taken; --length)
    if (is_candidate(length, progress)) return length;
  return 0;
}

LiveInitializer::Impl::Task LiveInitializer::Impl::task_of(int length) const {
  const Entry& last = window[length - 1];
  Task task{
      length,
      {},
      samples.of_window(
          window.front().frame->timestamp_ns, last.frame->timestamp_ns, last.samples_until_ns)};
  for (int i = 0; i < length; ++i) task.frames.push_back(window[i].frame);
  return task;
}

BackgroundJob::Job LiveInitializer::Impl::next() {
  const int length = longest_next();
  if (length == 0) return nullptr;
  for (int shorter = taken + 1; shorter < length; ++shorter)
    skipped |= is_candidate(shorter, progress);
  taken = length;
  return [this, task = task_of(length)](const std::stop_token& stop) { solve(task, stop); };
}

LiveOutcome LiveInitializer::Impl::solved(const Task& task, const std::stop_token& stop) const {
  try {
    std::vector<Frame> frames;
    for (const auto& frame : task.frames) frames.push_back(*frame);
    const Gyroscope* gyroscope = task.gyroscope ? &*task.gyroscope : nullptr;
    return {std::make_shared<const WindowResult>(
        gpo::initialize(camera, frames, gyroscope, options.initialize, stop))};
  } catch (const std::exception& error) {
    return {nullptr, message_of(error)};
  } catch (const Stopped&) {
    throw;  // by the caller's own thread, or by the background job, which expects it
  } catch (...) {
    return {nullptr, "the method failed with an unknown error"};
  }
}

void LiveInitializer::Impl::solve(const Task& task, const std::stop_token& stop) {
  LiveOutcome outcome = solved(task, stop);
  job.publish(stop, [&] {
    window[task.length - 1].is_refused = !outcome.is_ready();
    progress.take(task.length, std::move(outcome));
  });
}

/// Solves the skipped windows, so that the answer is that of all windows in their order.
void LiveInitializer::Impl::solve_skipped() {
  auto lock = job.lock();
  if (!skipped) return;
  LiveProgress all{progress.status};
  all.status.ready = all.status.metric = false;
  all.status.ready_frames = all.status.solved_frames = 0;
  all.status.answer = nullptr;
  for (int length = 2; length <= std::ssize(window); ++length) {
    if (!is_candidate(length, all)) continue;
    if (!all.status.ready && window[length - 1].is_refused) {
      all.status.solved_frames = length;
      continue;
    }
    LiveOutcome outcome{progress.first};
    if (length != progress.status.ready_frames) {
      const Task task = task_of(length);
      lock.unlock();
      outcome = solved(task, {});
      lock.lock();
    }
    window[length - 1].is_refused = !outcome.is_ready();
    all.take(length, std::move(outcome));
  }
  progress = std::move(all);
  skipped = false;
}

LiveStatus LiveInitializer::Impl::latest() const {
  const auto lock = job.lock();
  LiveStatus now = progress.status;
  if (now.started_anew && !now.ready) now.reason = why_anew;
  now.pending = (job.running() ? 1 : 0) + (longest_next() > 0 ? 1 : 0);
  now.waiting = static_cast<int>(waiting.size());
  return now;
}

LiveInitializer::LiveInitializer(const Camera& camera,
                                 const LiveOptions& options,
                                 const std::optional<Gyroscope>& gyroscope)
    : impl_(std::make_unique<Impl>(camera, options, gyroscope)) {}

LiveInitializer::~LiveInitializer() = default;
LiveInitializer::LiveInitializer(LiveInitializer&&) noexcept = default;
LiveInitializer& LiveInitializer::operator=(LiveInitializer&&) noexcept = default;

void LiveInitializer::add_gyroscope(std::int64_t timestamp_ns, const Eigen::Vector3d& rate_rad_s) {
  const auto lock = impl_->job.lock();
  impl_->samples.add(timestamp_ns, rate_rad_s, nullptr);
}

void LiveInitializer::add_imu(std::int64_t timestamp_ns,
                              const Eigen::Vector3d& rate_rad_s,
                              const Eigen::Vector3d& acceleration_m_s2) {
  const auto lock = impl_->job.lock();
  impl_->samples.add(timestamp_ns, rate_rad_s, &acceleration_m_s2);
}

LiveStatus LiveInitializer::add_frame(const Frame& frame) {
  const std::lock_guard alone(impl_->adding);
  impl_->add(frame);
  return impl_->latest();
}

LiveStatus LiveInitializer::status() const { return impl_->latest(); }

LiveStatus LiveInitializer::wait() {
  const std::lock_guard alone(impl_->adding);
  do {
    {
      auto lock = impl_->job.lock();
      impl_->job.wait_until_idle(lock);
    }
    impl_->solve_skipped();
  } while (impl_->admit(false));
  return impl_->latest();
}

}  // namespace gpo
