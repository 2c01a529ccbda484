// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "app/recordings/recordings.h"

#include "app/terminal/terminal.h"
#include "engine/base/error.h"
#include "engine/base/stop.h"
#include "engine/calibration/calibration_report.h"
#include "engine/experiment/row.h"
#include "engine/files/text_file.h"
#include "engine/files/yaml_entry.h"
#include "engine/recording/companions/companion_files.h"
#include "engine/recording/images/images.h"
#include "engine/synthesis/synthesize.h"
#include "ui/workbench/session/session_file.h"

#include <algorithm>
#include <chrono>
#include <system_error>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gpo {
namespace {

/// Returns what a YAML or JSON file beside a recording describes; null for other or broken files.
const char* kind_of_companion(const fs::path& file) {
  constexpr const char* kCamera = "the calibration of a camera";
  constexpr std::pair<const char*, const char*> kKinds[] = {
      {"pattern", "the description of a printed board"},
      {"normal", "the true plane of a recording"},
      {"T_truth_camera", "the mounting of a ground truth"},
      {"intrinsics", kCamera},
      {"camera_matrix", kCamera},
      {"cam0", kCamera},
      {"K", kCamera},
      {"distortion_model", kCamera}};
  if (!is_yaml_name(file) && file.extension() != ".json") return nullptr;
  try {
    const YamlEntry root = load_yaml(file);
    for (const auto& [key, kind] : kKinds)
      if (find(root, key)) return kind;
  } catch (const InputError&) {
  }
  return nullptr;
}

/// Refuses files that a recording or this program uses, such as board.yaml. Throws InputError.
void refuse_known_file(const fs::path& path) {
  if (!is_file(path)) return;
  const auto refuse = [&](const char* found, const char* expected) {
    throw InputError(fmt::format("{}: found {}, expected {}", path.string(), found, expected));
  };
  if (is_session(path)) refuse("a session", "a recording; `view --session` opens it");
  if (is_results(path)) refuse("results of `evaluate`", "a recording; the window opens it");
  if (kind_of(path) == FileKind::image)
    refuse("a single image", "a recording, such as a folder of numbered images");
  if (const char* kind = kind_of_companion(path))
    refuse(kind, "a recording, such as the folder that contains it");
}

/// Returns the folder of the program that users start, in both of our programs.
fs::path program_folder() {
  std::error_code none;
  const fs::path folder = fs::read_symlink("/proc/self/exe", none).parent_path();
  const fs::path above = folder.parent_path();
  return above.filename() == "libexec" ? above.parent_path() / "bin" : folder;
}

/// Returns the folder of rendered recordings: in the build tree, or in the cache if installed.
fs::path made_recordings_folder() {
  const fs::path built = GPO_RECORDINGS_DIR, tree = built.parent_path();
  const bool is_built = std::ranges::mismatch(tree, program_folder()).in1 == tree.end();
  return is_built ? built : user_cache_folder() / "recordings";
}

/// Returns the recordings that do not exist yet, "orbit, approach", or only their number.
std::string names_of_missing(const std::vector<fs::path>& recipes, const fs::path& cache) {
  std::vector<std::string> names;
  for (const fs::path& recipe : recipes) {
    const fs::path folder = synthesized_folder(recipe, cache);
    if (!fs::exists(folder)) names.push_back(folder.filename().string());
  }
  constexpr std::size_t kMaxLength = 30;  // keeps the progress line below 80 columns
  const std::string all = fmt::format("{}", fmt::join(names, ", "));
  return all.size() <= kMaxLength ? all : fmt::format("{} recordings", names.size());
}

/// Synthesizes missing recordings.
std::vector<fs::path> make_recordings(const std::vector<fs::path>& recipes,
                                      const Progress& progress) {
  if (recipes.empty()) return {};
  const fs::path cache = made_recordings_folder();
  const int threads = static_cast<int>(std::thread::hardware_concurrency());
  const std::string title = "synthesizing " + names_of_missing(recipes, cache);
  return synthesized_recordings(recipes, cache, threads, [&](int done, int of) {
    progress(title, done, of);
    check_stop();
  });
}

/// The same with a progress bar on standard error.
std::vector<fs::path> make_recordings(const std::vector<fs::path>& recipes) {
  std::optional<ProgressBar> bar;
  const Progress progress = [&](const std::string& title, int done, int of) {
    if (!bar) bar.emplace(title);
    (*bar)(done, of);
  };
  return saying("the synthesis was discarded", [&] { return make_recordings(recipes, progress); });
}

/// Version of the self-calibration. Raise it whenever the same images give another camera.
constexpr int kAlgorithm = 5;

/// Returns the file of the camera of a live source.
fs::path cache_file(const std::string& device, cv::Size size) {
  const std::string key = fmt::format("{} {}x{}", device, size.width, size.height);
  return user_cache_folder() / "cameras" / fmt::format("live-{:016x}.yaml", fnv1a(key));
}

fs::path cache_file(const Recording& recording) {
  if (recording.layout == kLiveLayout)
    return cache_file(recording.name, {recording.camera.width, recording.camera.height});
  std::string key;
  for (const auto& [part, content] : content_of(recording))
    if (part == "pictures" || part == "time stamps" || part == "gyroscope") key += content;
  return recording.cache_folder / "cameras" /
         fmt::format("{}-{:016x}.yaml", kAlgorithm, fnv1a(key));
}

/// Returns the cached camera; nullopt if the file is missing, truncated or another program's.
std::optional<Camera> cached_camera(const fs::path& file) {
  try {
    if (!fs::exists(file)) return std::nullopt;
    return read_calibration(file).camera;
  } catch (const InputError&) {
    return std::nullopt;
  }
}

PlaneLens calibrate(const Recording& recording, const CalibrationProgress& progress) {
  // Rotations need axes that are known in the camera.
  const bool rotations = recording.gyroscope && recording.T_body_camera;
  // A guess may use the metadata of the camera; any other camera is replaced.
  const Camera& known = recording.camera;
  Camera start = recording.camera_source == CameraSource::guess
                     ? known
                     : camera_of_view(known.width, known.height);
  if (recording.camera_source != CameraSource::self_calibrated) start.readout = known.readout;
  start.readout_direction = known.readout_direction;
  return calibrate_from_plane(*recording.images,
                              start,
                              recording.timestamps_ns,
                              rotations ? &*recording.gyroscope : nullptr,
                              progress);
}

/// Caches the camera and sets it as read back from the file, so that later runs get equal bits.
void cache_camera(const PlaneLens& found, Recording& recording) {
  const fs::path file = cache_file(recording);
  write_output(file, to_yaml(found, recording.name));
  const Camera camera = cached_camera(file).value_or(found.camera);
  set_camera(recording, camera, CameraSource::self_calibrated, "cached in " + file.string());
}

/// A cached camera as it was, to be restored if a new one is discarded.
class CachedFile {
 public:
  explicit CachedFile(fs::path file) : file_(std::move(file)) {
    if (is_file(file_)) content_ = read_file(file_);
  }
  void restore() const {
    std::error_code none;
    if (content_)
      write_file(file_, *content_);
    else
      fs::remove(file_, none);
  }

 private:
  fs::path file_;
  std::optional<std::string> content_;  ///< nullopt: there was no file
};

std::string failure_of(const PlaneLens& found) {
  return "calibration from the plane failed: " + found.reason;
}

/// Sets the cached camera, else estimates one if `calibrates`; if that fails, adds a note.
void use_found_camera(Recording& recording, bool calibrates) {
  if (!recording.images) return;
  const fs::path file = cache_file(recording);
  if (const auto camera = cached_camera(file)) {
    set_camera(recording, *camera, CameraSource::self_calibrated, "cached in " + file.string());
    return;
  }
  if (!calibrates) return;
  const PlaneLens found = self_calibrate(recording);
  if (found.ok)
    cache_camera(found, recording);
  else
    recording.notes.push_back(failure_of(found));
}

/// Opens the recording in `folder`, which the user named `path` (a recipe has another folder).
std::shared_ptr<const Recording> open_resolved(const fs::path& path,
                                               const fs::path& folder,
                                               const OpenOptions& options,
                                               bool calibrates,
                                               const SearchedFrames& searched = {}) {
  OpenOptions with_cache = options;
  with_cache.cache_folder = user_cache_folder();
  Recording recording = *open_recording(folder, with_cache);
  recording.path = path;
  leave_out_faulty_frames(recording, searched);
  if (recording.camera_source == CameraSource::guess && recording.complete)
    use_found_camera(recording, calibrates);
  return std::make_shared<const Recording>(std::move(recording));
}

/// More than `leave_out_faulty_frames` compares: it leaves none out of a long video.
constexpr int kFirstFrames = 500;

/// Reports the progress of reading at each percent.
ReadProgress in_percent(const fs::path& path, const Progress& progress) {
  return
      [stage = "reading " + path.filename().string(), progress, shown = -1](double share) mutable {
        const int percent = static_cast<int>(100 * share);
        if (std::exchange(shown, percent) != percent) progress(stage, percent, 100);
      };
}

/// Returns the folder of the recording, synthesized first if it is a recipe's.
fs::path folder_for_window(const fs::path& path, const Progress& progress) {
  refuse_known_file(path);
  return is_recipe(path) ? make_recordings({path}, progress).front() : path;
}

}  // namespace

std::vector<fs::path> resolve_recordings(const std::vector<fs::path>& paths) {
  std::vector<fs::path> recipes;
  for (const fs::path& path : paths) {
    refuse_known_file(path);
    if (is_recipe(path)) recipes.push_back(path);
  }
  const std::vector<fs::path> made = make_recordings(recipes);
  auto next = made.begin();
  std::vector<fs::path> resolved = paths;
  for (fs::path& path : resolved)
    if (is_recipe(path)) path = *next++;
  return resolved;
}

std::shared_ptr<const Recording> open_given(const fs::path& path,
                                            const OpenOptions& options,
                                            bool calibrates,
                                            const SearchedFrames& searched) {
  const fs::path folder = resolve_recordings({path}).front();
  OpenOptions watched = options;
  std::optional<ProgressBar> bar;
  const auto begin = std::chrono::steady_clock::now();
  watched.progress = [&](double share) {
    check_stop();
    if (std::chrono::steady_clock::now() - begin < std::chrono::seconds(1)) return;
    if (!bar) bar.emplace("reading " + path.string(), "%");
    (*bar)(static_cast<int>(100 * share), 100);
  };
  return saying("nothing was opened",
                [&] { return open_resolved(path, folder, watched, calibrates, searched); });
}

Worker::Opened opened_for_window(const std::shared_ptr<const Recording>& recording) {
  Worker::Opened opened = Worker::with_inspector(recording);
  opened.calibrate = [recording](const std::stop_token&, const Progress& progress) {
    const PlaneLens found = calibrate(*recording, progress);
    if (!found.ok) throw InputError(failure_of(found));
    Recording calibrated = *recording;
    const CachedFile before(cache_file(*recording));
    cache_camera(found, calibrated);
    auto next = opened_for_window(std::make_shared<const Recording>(std::move(calibrated)));
    next.calibration =
        std::make_shared<const CalibrationResult>(CalibrationResult{recording, to_text(found)});
    next.undo_calibration = [recording, before] {
      before.restore();
      return opened_for_window(recording);
    };
    return next;
  };
  return opened;
}

SourceAddress live_source(const std::string& address) {
  if (is_live_address(address)) return {address};
  if (!fs::exists(address))
    throw InputError(
        address + ": no such file; expected camera:0, rtsp://, http:// or udp://, or a recording");
  return {address, open_given(address)};
}

std::optional<LiveCamera> camera_of_source(const SourceAddress& address,
                                           const std::string& device,
                                           cv::Size size) {
  if (const auto& recording = address.recording)
    return LiveCamera{recording->camera, recording->camera_source, "as in " + address.text};
  const fs::path file = cache_file(device.empty() ? address.text : device, size);
  const auto camera = cached_camera(file);
  if (!camera) return std::nullopt;
  return LiveCamera{*camera, CameraSource::self_calibrated, "cached in " + file.string()};
}

Worker::Open opener_for_window(std::size_t cache_mib, const GivenRecording& given) {
  return [=](const fs::path& path, const std::stop_token&, const Progress& progress) {
    OpenOptions options{.tracks = {}, .cache_bytes = cache_mib << 20};
    const GivenRecording of = path == given.path ? given : GivenRecording{path};
    options.topics = of.topics;
    options.progress = in_percent(path, progress);
    const fs::path folder = folder_for_window(path, progress);
    const auto open = [=](const OpenOptions& how) {
      return open_resolved(path, folder, how, false, of.searched);
    };
    OpenOptions first = options;
    first.first_frames = kFirstFrames;
    const auto recording = open(first);
    Worker::Opened opened = opened_for_window(recording);
    if (recording->complete) return opened;
    opened.rest = [=](const std::stop_token&, const Progress& report) {
      OpenOptions whole = options;
      whole.progress = in_percent(path, report);
      return opened_for_window(open(whole));
    };
    return opened;
  };
}

fs::path drawing_program() {
  return program_folder().parent_path() / "libexec" / "gpo-inspector" / "gpo-inspector";
}

fs::path example_recording() {
  std::error_code none;
  const fs::path here = program_folder();
  fs::path example = fs::path("sequences") / "desk";
  for (const fs::path& root : {here.parent_path() / "share" / "gpo-inspector",
                               fs::path(GPO_SOURCE_DIR),
                               here,
                               here.parent_path(),
                               fs::current_path(none)}) {
    if (fs::exists(root / example, none)) return root / example;
  }
  return example;
}

PlaneLens self_calibrate(const Recording& recording) {
  std::optional<ProgressBar> bar;
  std::string shown;
  const auto progress = [&](const char* what, int done, int of) {
    check_stop();
    if (shown != what) bar.emplace(what);
    shown = what;
    (*bar)(done, of);
  };
  return calibrate(recording, progress);
}

}  // namespace gpo
