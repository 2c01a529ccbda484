// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inspection/inspector.h"

#include "engine/base/error.h"
#include "engine/files/refuse.h"
#include "engine/inspection/rolling_cameras.h"
#include "engine/methods/plane/rolling_shutter.h"
#include "engine/methods/recording_method.h"
#include "engine/pipeline/method_defaults.h"
#include "engine/planes/readout_compensation.h"
#include "engine/recording/images/frame_faults.h"

#include <algorithm>

namespace gpo {
namespace {

void check_window(const Recording& recording, const Settings& settings) {
  const int count = recording.frame_count();
  if (count < 2)
    throw InputError(fmt::format("Needs at least 2 frames; the recording has {}", count));
  if (settings.frames < 2) refuse_setting("frames", "{}, expected at least 2", settings.frames);
  const int start = settings.start;
  if (start < 0 || start >= count)
    refuse_setting(
        "start", "frame {} is not in the recording, which has frames 0 to {}", start, count - 1);
  constexpr const char* kTooLong =
      "{} frames from frame {} on do not fit; the recording has {} frames, use at most {} here";
  if (start + settings.frames > count)
    refuse_setting("frames", kTooLong, settings.frames, start, count, count - start);
}

void compare(const InertialAlignment& inertial, const WindowTruth& truth, Evaluation& evaluation) {
  if (!inertial.ok) return;
  if (!truth.upright || !truth.cameras.front()) return;
  const Eigen::Vector3d down = -truth.cameras.front()->R_wc.row(2).transpose();
  evaluation.gravity_error_deg = angle_deg(inertial.gravity_m_s2, down);
}

FrameSpan covering(const std::optional<FrameSpan>& cached, const FrameSpan& span) {
  const bool covers = cached && cached->start == span.start && cached->frames >= span.frames;
  return covers ? *cached : span;
}

/// Returns the settings that act until the stage, with RANSAC as used here: it is the same for
/// methods that use all tracks in the end and for those that never do.
Settings rejecting(SettingStage stage, const Settings& settings) {
  Settings acting = acting_until(stage, settings);
  acting.options.ransac = ransac_options(settings.options).enabled;
  return acting;
}

void check_excluded(const Tracks& tracks, const Settings& settings) {
  for (const std::int64_t id : settings.exclude) {
    if (std::ranges::find(tracks.ids, id) != tracks.ids.end()) continue;
    if (tracks.ids.empty())
      refuse_setting("exclude", "track {} is not in the window, which has no tracks", id);
    const auto [least, most] = std::ranges::minmax(tracks.ids);
    refuse_setting(
        "exclude", "track {} is not in the window, which has tracks {} to {}", id, least, most);
  }
}

Watch watch_of(const Settings& settings, const std::stop_token& stop, const Progress& progress) {
  if (!progress) return {stop};
  constexpr double kPause_ms = 40;
  const std::string title = settings.options.method.row().title;
  return {stop, [=, last = std::chrono::steady_clock::now()](int iteration, double cost) mutable {
            if (milliseconds_since(last) < kPause_ms) return;
            last = std::chrono::steady_clock::now();
            progress(fmt::format("{}: iteration {}, cost {:.4g} px\u00b2", title, iteration, cost),
                     0,
                     0);
          }};
}

Sources sources_of(const Recording& recording,
                   const Window& window,
                   const WindowRotations& rotations) {
  Sources sources;
  sources.camera = &recording.camera;
  sources.gyroscope = rotations.usable(recording.gyroscope ? &*recording.gyroscope : nullptr);
  sources.T_body_camera = recording.T_body_camera;
  const auto& files = recording.image_files;
  if (std::ssize(files) == recording.frame_count()) {
    sources.images.assign(files.begin() + window.start,
                          files.begin() + window.start + window.frame_count());
  } else if (files.size() == 1) {
    sources.images = files;
  }
  return sources;
}

/// Returns the camera of images that were resized by this factor after its calibration.
Camera with_scaled_intrinsics(Camera camera, double scale) {
  camera.fx *= scale;
  camera.fy *= scale;
  camera.cx = (camera.cx + 0.5) * scale - 0.5;  // the first pixel's center is 0
  camera.cy = (camera.cy + 0.5) * scale - 0.5;
  if (camera.covariance.empty()) {
    for (std::size_t k = 0; k < std::min<std::size_t>(4, camera.sigmas.size()); ++k)
      camera.sigmas[k] *= scale;
  } else {
    Eigen::MatrixXd covariance = from_upper_triangle(camera.covariance);
    covariance.topRows<4>() *= scale;
    covariance.leftCols<4>() *= scale;
    set_lens_covariance(camera, covariance);
  }
  return camera;
}

/// Adds the verdicts of the growing window, judged by its findings.
void add_growth(const Window& window,
                std::span<const Verdict> numbers,
                const Finished& end,
                Inspection& inspection) {
  inspection.growth = growth_verdicts(numbers, end.findings);
  if (std::ssize(numbers) + 1 != window.frame_count()) return;
  const Verdict& whole = *end.initialization.verdict;
  inspection.comparable_growth = growth_verdicts(comparable_numbers(numbers, whole), end.findings);
  if (!inspection.comparable_growth.empty()) inspection.comparable_growth.back() = whole;
  inspection.growth.back() = whole;
}

std::optional<int> metric_scale_from(const Window& window,
                                     const Sources& sources,
                                     const InitializeOptions& options,
                                     const Finished& end) {
  if (!end.inertial || !end.inertial->ok || !end.inertial->scale_known) return std::nullopt;
  const auto count = poses_that_determine_scale(
      end.poses, *sources.gyroscope, sources.T_body_camera, inertial_options(options));
  if (!count) return std::nullopt;
  const auto at = std::ranges::find(window.timestamps_ns, end.poses.times_ns[*count - 1]);
  return static_cast<int>(at - window.timestamps_ns.begin());
}

}  // namespace

template <class Key, class Value>
struct Cached {
  std::optional<Key> key;
  Value value{};
  double milliseconds = 0;

  /// Recomputes if the key differs. `compute` returns nullopt if stopped; then this returns false.
  template <class Compute>
  bool update(const Key& wanted, Compute&& compute) {
    if (key == wanted) return true;
    key.reset();
    const auto begin = std::chrono::steady_clock::now();
    auto computed = compute();
    if (!computed) return false;
    value = std::move(*computed);
    milliseconds = milliseconds_since(begin);
    key = wanted;
    return true;
  }
};

struct Request {
  const Settings& settings;
  const std::stop_token& stop;
  const Progress& progress;
};

/// The cached stages; each `update` returns false if stopped. The key of a stage is the settings
/// that act until then (`acting_until`), so a setting's row decides which stages it recomputes.
struct Inspector::Stages {
  std::shared_ptr<const Recording> recording;  // with the camera of `intrinsics_scale`
  double intrinsics_scale = 1;
  std::array<Cached<FrameSpan, Tracked>, 2> longest_tracks;  // for windows from one start
  Cached<FrameSpan, std::shared_ptr<const WindowTruth>> longest_truth;
  Cached<Settings, std::shared_ptr<const Tracks>> tracks;
  Cached<FrameSpan, std::shared_ptr<const WindowTruth>> truth;
  Cached<int, std::vector<Eigen::Vector2d>> board_corners;  // in the reference image
  Cached<Settings, std::shared_ptr<const Window>> outliers;
  Cached<Settings, WindowRotations> rotations;
  Cached<Settings, std::vector<Verdict>> growth;  // numbers, not judged
  std::optional<RecordingFacts> facts;

  bool update_tracks(const Request& request) {
    const Settings& settings = request.settings;
    auto& cached = longest_tracks[static_cast<std::size_t>(settings.tracking)];
    const FrameSpan longest = covering(cached.key, {settings.start, settings.frames});
    const bool done = cached.update(longest, [&] {
      return recording->tracks.empty()
                 ? followed_tracks(
                       *recording, longest, settings.tracking, request.stop, request.progress)
                 : std::optional(chosen_tracks(*recording, longest));
    });
    return done && tracks.update(acting_until(SettingStage::tracks, settings), [&] {
      return std::optional(beginning(cached.value.tracks, settings.frames));
    });
  }

  bool update_truth(const Request& request) {
    const FrameSpan span{request.settings.start, request.settings.frames};
    const FrameSpan longest = covering(longest_truth.key, span);
    const bool done = longest_truth.update(longest, [&] {
      auto computed = window_truth(*recording, longest, request.stop, request.progress);
      return request.stop.stop_requested() ? std::nullopt : std::optional(std::move(computed));
    });
    if (!done) return false;
    truth.update(span, [&] { return std::optional(beginning(longest_truth.value, span.frames)); });
    return board_corners.update(span.start,
                                [&] { return std::optional(corners_in(*recording, span.start)); });
  }

  bool update_window(const Settings& settings, const std::stop_token& stop) {
    check_excluded(*tracks.value, settings);
    outliers.update(rejecting(SettingStage::inliers, settings), [&] {
      const Tracks& all = *tracks.value;
      return std::optional(std::make_shared<const Window>(
          window_of(without(without(all, settings.exclude), left_out(all, settings.mask)),
                    recording->camera,
                    recording->timestamps_ns,
                    settings.options,
                    on_first_plane(all, settings.mask))));
    });
    const Settings acting = rejecting(SettingStage::rotations, settings);
    return rotations.update(acting, [&]() -> std::optional<WindowRotations> {
      WindowRotations found =
          window_rotations(*recording, *outliers.value, truth.value.get(), settings.options, stop);
      return found.chosen.rotations.stopped ? std::nullopt : std::optional(std::move(found));
    });
  }

  /// The numbers of the window as it grows; unchanged without rotations.
  bool update_growth(const Window& window,
                     const Rotations& given,
                     const InitializeOptions& options,
                     const std::stop_token& stop) {
    if (given.R_wc.empty()) return true;
    Settings acting = *rotations.key;
    acting.options.lens = options.lens;
    if (window.R_wc == given.R_wc_other)
      acting.options.rotations = RotationSource::averaging_second;
    return growth.update(acting, [&] {
      auto numbers = growing_numbers(window, options.lens, stop);
      return stop.stop_requested() ? std::nullopt : std::optional(std::move(numbers));
    });
  }

  void initialize(const Request& request, Inspection& inspection) {
    const auto& [settings, stop, progress] = request;
    const Rotations& given = rotations.value.chosen.rotations;
    InitializeOptions options = settings.options;
    if (recording->camera_source == CameraSource::guess) options.camera_is_guess = true;
    ImportedResult imported;
    const bool imports = bind_to_recording(options.method, imported);
    const Sources sources = sources_of(*recording, *outliers.value, rotations.value);
    const auto begin = std::chrono::steady_clock::now();
    MethodRun of_method = run_method(with_rotations(*outliers.value, given, options),
                                     given,
                                     sources,
                                     options,
                                     watch_of(settings, stop, progress));
    Window& window = of_method.window;
    Initialization& found = of_method.result;
    inspection.timing = timing(settings, milliseconds_since(begin), found.solver.milliseconds);
    if (imports) inspection.imported = imported;
    add_own_noise(window, sources, options, stop, found);
    if (!update_growth(window, given, options, stop)) return;
    std::vector<Verdict> numbers = given.R_wc.empty() ? std::vector<Verdict>() : growth.value;
    if (!given.R_wc.empty()) inspection.motion = frame_motion(window);
    const std::vector<Remark> remarks = remarks_on_window(settings, window);
    if (truth.value) inspection.truth_convention = convention_of_truth(request);
    Evidence known = evidence(remarks);
    if (const auto& one = inspection.truth_convention) known.truth_convention = &*one;
    Finished end = finished(window, sources, options, known, numbers, std::move(found));
    if (!numbers.empty() && end.initialization.ok && end.initialization.row_delay_s) {
      numbers = growing_numbers(
          as_seen_at_time_stamps(window, end.initialization), options.lens, request.stop);
      if (request.stop.stop_requested()) return;
    }
    add_growth(window, numbers, end, inspection);
    inspection.metric_scale_from = metric_scale_from(window, sources, settings.options, end);
    inspection.inertial = std::move(end.inertial);
    if (window.gyro) inspection.gyroscope_bias_rad_s = window.gyro->bias_rad_s;
    inspection.truth = truth.value;
    inspection.rotations_used = rotations.value.chosen.source;
    inspection.rotations_note = rotations.value.chosen.note;
    inspection.findings = std::move(end.findings);
    inspection.tracks = tracks.value;
    if (window.selection_row_delay_s != 0)
      inspection.selection = std::make_shared<const Window>(at_time_stamps(window));
    inspection.window = std::make_shared<const Window>(std::move(window));
    inspection.initialization =
        std::make_shared<const Initialization>(std::move(end.initialization));
    if (inspection.imported && !inspection.initialization->ok)
      inspection.imported->meters_per_unit.reset();
  }

  /// Compares the truth with rotations by images. Rotations by the gyroscope alone
  /// are no evidence: they may be wrong themselves.
  std::optional<TruthConvention> convention_of_truth(const Request& request) const {
    const RotationSource used = rotations.value.chosen.source;
    const bool by_truth = used == RotationSource::truth;
    Rotations images = rotations.value.chosen.rotations;
    if (by_truth || used == RotationSource::gyro) {
      InitializeOptions options = request.settings.options;
      options.rotations = RotationSource::automatic;
      ChosenRotations chosen =
          window_rotations(*recording, *outliers.value, nullptr, options, request.stop).chosen;
      if (chosen.source == RotationSource::gyro) return std::nullopt;
      images = std::move(chosen.rotations);
    }
    const auto& R_wc = images.R_wc_images.empty() ? images.R_wc : images.R_wc_images;
    auto found = truth_convention(*truth.value, R_wc, images.sigma_rad);
    if (found) found->is_used = by_truth;
    return found;
  }

  /// A result of another program may have other files for each recording, and needs its clock.
  /// Returns whether the method is such a result.
  bool bind_to_recording(MethodChoice& method, ImportedResult& imported) {
    const RecordingMethod* result = recording_method(method.row());
    if (result == nullptr) return false;
    if (!facts) facts = facts_for_results(*recording);
    Method bound = method.row();
    bound.initialize_from = [initialize = result->bind(*facts), &imported](
                                const Window& window, const Sources& sources, const Watch&) {
      return initialize(window, sources, imported);
    };
    method = MethodChoice(std::make_shared<const Method>(std::move(bound)));
    return true;
  }

  Evidence evidence(const std::vector<Remark>& remarks) const {
    Evidence known = evidence_of(*recording);
    known.intrinsics_scale = intrinsics_scale;
    known.remarks = remarks;
    known.tracks = tracks.value.get();
    known.ids = tracks.value->ids;
    return known;
  }

  std::vector<Remark> remarks_on_window(const Settings& settings, const Window& window) const {
    std::vector<Remark> remarks;
    const auto add = [&](std::string_view key, std::string sentence) {
      if (!sentence.empty()) remarks.push_back({key, std::move(sentence)});
    };
    const auto& [chosen, corrected, usable, note, advice, misfit] = rotations.value;
    using enum GyroscopeMisfit;
    const bool named = misfit == unit || misfit == mirrored || misfit == inverted;
    if (!note.empty())
      remarks.push_back({named ? "gyroscope-units" : "gyroscope-misfit", note, advice});
    add("faulty-frames", frames_note(settings));
    if (const auto missing = missing_plane(window, settings.options); !missing.empty())
      add("missing-plane", fmt::format("{}; plane {} leads", missing, window.leader + 1));
    return remarks;
  }

  std::string frames_note(const Settings& settings) const {
    const auto& faults = longest_tracks[static_cast<std::size_t>(settings.tracking)].value.faults;
    const auto in_window =
        std::span(faults).first(std::min(faults.size(), static_cast<std::size_t>(settings.frames)));
    const std::string faulty = text_of(in_window, settings.start);
    if (faulty.empty()) return "";
    if (is_searched_whole(*recording)) return "faulty frames: " + faulty;
    return fmt::format("faulty frames: {}; `--start {}` leaves them out", faulty, settings.start);
  }

  Timing timing(const Settings& settings, double initialize_ms, double optimize_ms) const {
    const Tracked& tracked = longest_tracks[static_cast<std::size_t>(settings.tracking)].value;
    Timing t{.track = tracked.milliseconds[settings.frames - 1],
             .ransac = outliers.milliseconds,
             .rotations = rotations.milliseconds,
             .initialize = initialize_ms,
             .optimize = optimize_ms};
    t.total = t.track + t.ransac + t.rotations + t.initialize;
    return t;
  }
};

Inspector::Inspector(std::shared_ptr<const Recording> recording)
    : Inspector(std::move(recording), nullptr) {}

Inspector::Inspector(std::shared_ptr<const Recording> recording,
                     std::shared_ptr<const Tracks> tracks)
    : recording_(std::move(recording)), tracks_(std::move(tracks)), stages_(new_stages(1)) {}

Inspector::~Inspector() = default;

/// Even the tracks depend on the camera.
std::unique_ptr<Inspector::Stages> Inspector::new_stages(double intrinsics_scale) const {
  auto stages = std::make_unique<Stages>();
  stages->recording = recording_;
  stages->intrinsics_scale = intrinsics_scale;
  if (intrinsics_scale != 1) {
    Recording scaled = *recording_;
    scaled.camera = with_scaled_intrinsics(scaled.camera, intrinsics_scale);
    stages->recording = std::make_shared<const Recording>(std::move(scaled));
  }
  if (!tracks_) return stages;
  const Tracking tracking = tracks_->anchored ? Tracking::anchored : Tracking::frame_to_frame;
  auto& cached = stages->longest_tracks[static_cast<std::size_t>(tracking)];
  cached.key = FrameSpan{tracks_->start, tracks_->frame_count()};
  cached.value.milliseconds.assign(tracks_->raw_px.size(), 0);
  cached.value.tracks = tracks_;
  return stages;
}

namespace {

/// Compares the result with the ground truth. Returns whether that describes the leading plane.
bool add_evaluation(Inspection& inspection) {
  const InitializeOptions& options = inspection.settings.options;
  Evaluation& e = inspection.evaluation.emplace(evaluate(*inspection.initialization,
                                                         *inspection.window,
                                                         *inspection.truth,
                                                         options.seed,
                                                         options.lens));
  const bool of_main_plane = e.plane == inspection.window->leader && !inspection.truth_convention;
  if (inspection.truth_convention) {
    const Alignment alignment = e.alignment;
    e = Evaluation();
    e.alignment = alignment;
    e.plane = inspection.window->leader;
  } else if (inspection.inertial) {
    compare(*inspection.inertial, *inspection.truth, e);
  }
  if (const auto scale = known_scale(inspection); scale && e.scale)
    e.scale_error_percent = 100 * (*scale / *e.scale - 1);
  return of_main_plane;
}

/// Places the cube on the estimated plane and, if the truth describes it, on the true one.
void place_main_cubes(const std::vector<Eigen::Vector2d>& board,
                      bool main_plane_is_true,
                      Inspection& inspection) {
  const auto place = [&](const Plane& plane, const Pose& reference, const RollingCamera& camera) {
    return place_cube(plane,
                      reference,
                      *inspection.recording,
                      *inspection.window,
                      at_time_stamp(board, plane, reference, camera));
  };
  inspection.cube = place(inspection.initialization->plane, Pose{}, rolling_camera(inspection, 0));
  const WindowTruth* truth = inspection.truth.get();
  if (main_plane_is_true && truth != nullptr && truth->plane && truth->cameras.front())
    inspection.true_cube =
        place(*truth->plane, *truth->cameras.front(), true_rolling_camera(inspection, 0));
}

}  // namespace

std::shared_ptr<const Inspection> Inspector::inspect(const Settings& settings,
                                                     const std::stop_token& stop,
                                                     const Progress& progress) {
  if (settings.intrinsics_scale != stages_->intrinsics_scale)
    stages_ = new_stages(settings.intrinsics_scale);
  Stages& stages = *stages_;
  const Request request{settings, stop, progress};
  check_window(*stages.recording, settings);
  // These two throw before any work is done.
  settings.options.method.row();
  rotation_source_used(*stages.recording, settings.options.rotations);
  Inspection inspection;
  inspection.recording = stages.recording;
  inspection.settings = settings;
  const bool prepared = stages.update_tracks(request) && stages.update_truth(request) &&
                        stages.update_window(settings, stop);
  if (!prepared) return nullptr;
  if (progress) progress("initializing", 0, 0);
  stages.initialize(request, inspection);
  if (stop.stop_requested()) return nullptr;
  if (inspection.initialization->ok) {
    if (inspection.initialization->row_delay_s || readout_of_truth(inspection))
      inspection.row_motions = row_motions(*inspection.window, *inspection.initialization);
    inspection.measured_scale = measure_scale(inspection);
    inspection.chosen_world = choose_world(inspection);
    inspection.other_cubes = place_other_cubes(inspection);
    const bool main_plane_is_true = !inspection.truth || add_evaluation(inspection);
    // The board is on the true plane, too.
    place_main_cubes(
        main_plane_is_true ? stages.board_corners.value : std::vector<Eigen::Vector2d>{},
        main_plane_is_true,
        inspection);
  }
  add_findings(inspection);
  return std::make_shared<const Inspection>(std::move(inspection));
}

}  // namespace gpo
