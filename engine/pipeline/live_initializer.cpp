// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/error.h"
#include "engine/base/internal/background_job.h"
#include "engine/base/limits.h"
#include "engine/frontend/inliers.h"
#include "engine/geometry/pose.h"
#include "engine/initialize.h"
#include "engine/live.h"
#include "engine/methods/certainty/window_evidence.h"
#include "engine/pipeline/method_defaults.h"
#include "engine/pipeline/pipeline.h"

#include <algorithm>
#include <array>
#include <deque>
#include <exception>
#include <unordered_map>
#include <utility>

#include <Eigen/LU>
#include <Eigen/SVD>
#include <fmt/format.h>

namespace gpo {
namespace {

/// No window is solved below this share of the translation that a ready window needs. One
/// homography gives the translation to a few percent.
constexpr double kTravelShare = 0.8;
constexpr double kMostTurnSigmas = 4;  // rotation of the normal that a later answer may cause
constexpr double kLonger = 1.5;  // length of a window that may improve an answer, to the last one
constexpr std::int64_t kSamplesBefore_ns = 1'000'000'000;  // gyroscope samples before the window
constexpr int kMostIterations = 600;  // enough for a plane with a third of the tracks

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

std::string why_not_ready(const WindowResult& result) {
  const Initialization& initialization = result.initialization;
  return initialization.verdict ? initialization.verdict->reason : initialization.reason;
}

}  // namespace

/// Estimates the camera's translation from its reference frame by one homography, in a fraction of
/// a millisecond: without rotations, a normal or other frames.
class Travel {
 public:
  Travel(const Camera& camera, const RansacOptions& ransac, const Frame& reference)
      : camera_(camera), ransac_(ransac), K_(intrinsic_matrix(camera)) {
    ransac_.most_iterations = kMostIterations;
    if (!ransac_.threshold_px) ransac_.threshold_px = usual_threshold_px(camera, {});
    for (std::size_t k = 0; k < reference.ids.size(); ++k)
      reference_px_[reference.ids[k]] =
          undistort(camera, reference.raw_px.col(static_cast<Eigen::Index>(k)));
  }

  struct Step {
    int seen = 0;  ///< tracks of the reference frame that are seen
    /// |tau| [distance of the plane with most tracks]; nullopt if they have no homography.
    std::optional<double> tau;
  };

  // K^-1 H K ~ R^T (I - tau n^T): its largest and smallest singular values differ by |tau| if the
  // middle one is scaled to 1 (Zhang and Hanson 1996).
  Step to(const Frame& frame) const {
    Eigen::Matrix2Xd from(2, frame.raw_px.cols());
    Eigen::Matrix2Xd at(2, frame.raw_px.cols());
    Step step;
    for (std::size_t k = 0; k < frame.ids.size(); ++k) {
      const auto first = reference_px_.find(frame.ids[k]);
      if (first == reference_px_.end() || !first->second.allFinite()) continue;
      const Eigen::Vector2d now =
          undistort(camera_, frame.raw_px.col(static_cast<Eigen::Index>(k)));
      if (!now.allFinite()) continue;
      from.col(step.seen) = first->second;
      at.col(step.seen) = now;
      ++step.seen;
    }
    const auto robust =
        homography_ransac(from.leftCols(step.seen), at.leftCols(step.seen), ransac_);
    if (!robust) return step;
    const Eigen::Vector3d s =
        Eigen::JacobiSVD<Eigen::Matrix3d>(K_.inverse() * robust->H * K_).singularValues();
    step.tau = (s[0] - s[2]) / s[1];
    return step;
  }

 private:
  Camera camera_;
  RansacOptions ransac_;
  Eigen::Matrix3d K_;
  std::unordered_map<std::int64_t, Eigen::Vector2d> reference_px_;  ///< undistorted, by track
};

struct LiveInitializer::Impl {
  Camera camera;
  LiveOptions options;
  // Used by the thread that adds frames.
  std::optional<Gyroscope> gyroscope;
  std::optional<Travel> travel;
  double farthest = 0;  ///< largest translation from the reference frame [plane distance]
  int added = 0;
  // Shared with the job that solves, guarded by its lock.
  std::vector<std::shared_ptr<const Frame>> frames;
  struct Task {
    int frames;
    std::shared_ptr<const Gyroscope> samples;
  };
  std::deque<Task> tasks;
  std::exception_ptr thrown;
  LiveStatus status;
  std::shared_ptr<const WindowResult> first;  ///< the answer that was ready first
  BackgroundJob job{[this] { return next(); }};

  Impl(const Camera& of, const LiveOptions& how, std::optional<Gyroscope> gyro)
      : camera(of), options(how), gyroscope(std::move(gyro)) {
    check_camera(camera);
    check_options(options.initialize);
    check(options);
    if (gyroscope) check_gyroscope(*gyroscope);
  }

  void restart(const std::string& why) {
    const auto lock = job.lock();
    frames.clear();
    tasks.clear();
    first.reset();
    status = {.reference = added, .started_anew = true, .reason = why};
    travel.reset();
    farthest = 0;
  }

  /// Returns why the frame starts a new window; empty if it does not.
  std::string why_restart(int seen) {
    const auto lock = job.lock();
    if (status.ready || frames.empty() || job.busy()) return "";
    const auto of = static_cast<double>(frames.front()->ids.size());
    if (status.frames >= options.most_frames)
      return fmt::format("not ready after {} frames: {}", status.frames, status.reason);
    if (seen < options.least_tracks || seen < options.least_share * of)
      return fmt::format("{} of the first frame's {} tracks are left", seen, of);
    return "";
  }

  /// Adds the frame to the window and returns whether the window may be ready now.
  bool append(const Frame& frame) {
    std::string anew;
    Travel::Step step;
    if (travel && !is_ready()) {
      step = travel->to(frame);
      anew = why_restart(step.seen);
    }
    if (!anew.empty()) restart(anew);
    const bool is_first = !travel || !anew.empty();
    if (is_first) {
      travel.emplace(camera, ransac_options(options.initialize), frame);
      drop_samples_before(frame.timestamp_ns);
    }
    farthest = is_first ? 0 : std::max(farthest, step.tau.value_or(0));
    const bool far = farthest >= kTravelShare * kReadyTranslation;
    const auto lock = job.lock();
    ++added;
    if (frames.size() < static_cast<std::size_t>(options.most_frames))
      frames.push_back(std::make_shared<const Frame>(frame));
    const bool grown = static_cast<int>(frames.size()) > status.frames;
    status.frames = static_cast<int>(frames.size());
    status.started_anew = !anew.empty();
    if (is_first || !grown) return false;
    if (far || status.ready || !is_bounded_by_travel(options.initialize) || !step.tau) return true;
    status.reason = fmt::format(
        "the camera moved by about {:.1f} % of its distance from the plane, {:.0f} % are needed",
        100 * farthest,
        100 * kReadyTranslation);
    return false;
  }

  void drop_samples_before(std::int64_t frame_ns) {
    if (!gyroscope) return;
    auto& t = gyroscope->timestamps_ns;
    const std::int64_t first_ns = frame_ns + gyroscope->time_offset_ns - kSamplesBefore_ns;
    const auto old = std::ranges::lower_bound(t, first_ns) - t.begin();
    t.erase(t.begin(), t.begin() + old);
    auto& rates = gyroscope->rates_rad_s;
    rates.erase(rates.begin(), rates.begin() + old);
    auto& accelerations = gyroscope->accelerations_m_s2;
    if (!accelerations.empty())
      accelerations.erase(accelerations.begin(), accelerations.begin() + old);
    gyroscope->lines.clear();
  }

  void add_sample(std::int64_t timestamp_ns,
                  const Eigen::Vector3d& rate_rad_s,
                  const std::optional<Eigen::Vector3d>& acceleration_m_s2) {
    if (!gyroscope) gyroscope.emplace();
    auto& t = gyroscope->timestamps_ns;
    auto& accelerations = gyroscope->accelerations_m_s2;
    if (!t.empty() && timestamp_ns <= t.back()) {
      throw InputError(
          fmt::format("gyroscope: time stamp {} does not come after {}", timestamp_ns, t.back()));
    }
    if (!rate_rad_s.allFinite()) throw InputError("gyroscope: a rate is not finite");
    if (acceleration_m_s2 && !acceleration_m_s2->allFinite())
      throw InputError("accelerometer: an acceleration is not finite");
    if (accelerations.size() != (acceleration_m_s2 ? t.size() : 0))
      throw InputError("accelerometer: expected an acceleration with each sample, or with none");
    t.push_back(timestamp_ns);
    gyroscope->rates_rad_s.push_back(rate_rad_s);
    if (acceleration_m_s2) accelerations.push_back(*acceleration_m_s2);
  }

  std::shared_ptr<const Gyroscope> samples_now() const {
    return gyroscope ? std::make_shared<const Gyroscope>(*gyroscope) : nullptr;
  }

  bool is_ready() {
    const auto lock = job.lock();
    return status.ready;
  }

  bool worth_solving(int length) const {
    return !status.ready || length >= kLonger * status.solved_frames;
  }

  void solve(const Task& task, const std::stop_token& stop) {
    std::vector<Frame> window;
    {
      const auto lock = job.lock();
      if (!worth_solving(task.frames)) return;
      for (int i = 0; i < task.frames; ++i) window.push_back(*frames[i]);
    }
    auto result = std::make_shared<const WindowResult>(
        initialize(camera, window, task.samples.get(), options.initialize, stop));
    if (result->initialization.stopped) return;
    const auto lock = job.lock();
    status.solved_frames = task.frames;
    take(task.frames, std::move(result));
  }

  void take(int length, std::shared_ptr<const WindowResult> result) {
    if (!status.ready) {
      status.reason = why_not_ready(*result);
      if (!result->is_ready()) return;
      status.ready = true;
      status.ready_frames = length;
      status.metric = result->is_metric();
      first = status.answer = std::move(result);
      return;
    }
    status.reason = why_not_better(length, *result);
    if (!status.reason.empty()) return;
    status.metric = result->is_metric();
    status.answer = std::move(result);
  }

  /// Returns why a result does not replace the answer; empty if it does.
  std::string why_not_better(int length, const WindowResult& result) const {
    if (!result.is_ready())
      return fmt::format("the window of {} frames is not ready: {}", length, why_not_ready(result));
    const double sigma_deg = first->initialization.verdict->normal_sigma_deg.value_or(0);
    const double apart_deg =
        angle_deg(first->initialization.plane.normal, result.initialization.plane.normal);
    if (apart_deg <= kMostTurnSigmas * sigma_deg) return "";
    return fmt::format(
        "the normals of {} and {} frames differ by {:.2f} deg, {:.1f} standard deviations",
        status.ready_frames,
        length,
        apart_deg,
        apart_deg / sigma_deg);
  }

  BackgroundJob::Job next() {
    if (tasks.empty()) return nullptr;
    Task task = std::move(tasks.front());
    tasks.pop_front();
    return [this, task = std::move(task)](const std::stop_token& stop) {
      try {
        solve(task, stop);
      } catch (...) {
        job.publish(stop, [&] { thrown = std::current_exception(); });
      }
    };
  }

  void solve_in_background(Task task) {
    const auto lock = job.lock();
    tasks.push_back(std::move(task));
    job.wake();
  }

  LiveStatus latest() {
    const auto lock = job.lock();
    if (thrown) std::rethrow_exception(std::exchange(thrown, nullptr));
    LiveStatus now = status;
    now.pending = static_cast<int>(tasks.size()) + (job.running() ? 1 : 0);
    return now;
  }
};

LiveInitializer::LiveInitializer(const Camera& camera,
                                 const LiveOptions& options,
                                 std::optional<Gyroscope> gyroscope)
    : impl_(std::make_unique<Impl>(camera, options, std::move(gyroscope))) {}

LiveInitializer::~LiveInitializer() = default;
LiveInitializer::LiveInitializer(LiveInitializer&&) noexcept = default;
LiveInitializer& LiveInitializer::operator=(LiveInitializer&&) noexcept = default;

void LiveInitializer::add_gyroscope(std::int64_t timestamp_ns, const Eigen::Vector3d& rate_rad_s) {
  impl_->add_sample(timestamp_ns, rate_rad_s, std::nullopt);
}

void LiveInitializer::add_imu(std::int64_t timestamp_ns,
                              const Eigen::Vector3d& rate_rad_s,
                              const Eigen::Vector3d& acceleration_m_s2) {
  impl_->add_sample(timestamp_ns, rate_rad_s, acceleration_m_s2);
}

LiveStatus LiveInitializer::add_frame(const Frame& frame) {
  Impl& impl = *impl_;
  const Frame* before = impl.frames.empty() ? nullptr : impl.frames.back().get();
  check_frame(frame, impl.added, before);
  if (impl.append(frame)) {
    Impl::Task task{impl.status.frames, impl.samples_now()};
    if (impl.options.background) {
      impl.solve_in_background(std::move(task));
    } else {
      impl.solve(task, {});
    }
  }
  return impl.latest();
}

LiveStatus LiveInitializer::status() const { return impl_->latest(); }

LiveStatus LiveInitializer::wait() {
  {
    auto lock = impl_->job.lock();
    impl_->job.wait_until_idle(lock);
  }
  return impl_->latest();
}

}  // namespace gpo
