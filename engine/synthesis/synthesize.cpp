// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/synthesis/synthesize.h"

#include "engine/base/parallel.h"
#include "engine/files/image_codec.h"
#include "engine/files/output_file.h"
#include "engine/files/refuse.h"
#include "engine/files/text_file.h"
#include "engine/recording/companions/companion_files.h"
#include "engine/recording/layouts/write_recording.h"
#include "engine/synthesis/random.h"
#include "engine/synthesis/renderer.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <exception>
#include <numbers>
#include <system_error>
#include <thread>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace gpo {
namespace {

constexpr double kMargin_s = 0.1;
constexpr double kPhase = 0.37;  // shift of samples relative to frames [sample periods]
constexpr std::uint64_t kGyroscopeStream = 1;
constexpr int kDecimals = 9;  // in rates, accelerations and velocities

std::string camera_yaml(const Recipe& recipe) {
  std::string text = fmt::format(
      "# Synthesized: exact.\nsensor_type: camera\ncomment: synthesized\n\n"
      "# Camera in the axes of the body (the IMU).\n{}\nrate_hz: {}\n{}",
      transformation_yaml(recipe.T_body_camera),
      recipe.frame_rate,
      lens_yaml(recipe.camera));
  if (recipe.image.rolling_shutter > 0)
    text += fmt::format("rolling_shutter: {}  # [s] from first to last row; stamp: middle row\n",
                        recipe.image.rolling_shutter);
  return text;
}

std::string imu_yaml(const GyroscopeRecipe& gyroscope) {
  std::string text = fmt::format(
      "# Synthesized: the gyroscope has white noise and a constant bias, the accelerometer is "
      "perfect.\nsensor_type: imu\ncomment: synthesized\n\n{}\nrate_hz: {}\n"
      "gyroscope_noise_density: {}  # [rad/s/sqrt(Hz)]\n"
      "gyroscope_random_walk: 0.0\naccelerometer_noise_density: 0.0\n"
      "accelerometer_random_walk: 0.0\n",
      transformation_yaml(Pose{}),
      gyroscope.rate,
      gyroscope.noise_density);
  if (gyroscope.calibrated_bias)
    text += fmt::format("gyroscope_bias: {}  # [rad/s], as calibrated, not as it is\n",
                        yaml_list(*gyroscope.calibrated_bias));
  return text;
}

std::string imu_csv(const Recipe& recipe) {
  std::string text = std::string(kGyroscopeHead) + kAccelerometerHead + "\n";
  for (const ImuSample& sample : simulate_imu(recipe))
    text += std::to_string(sample.timestamp_ns) + cells(sample.rate_b, kDecimals) +
            cells(sample.specific_force_b, kDecimals) + "\n";
  return text;
}

std::string truth_csv(const Recipe& recipe) {
  std::string text = std::string("#timestamp") + kPoseHead +
                     ",v_RS_R_x [m s^-1],v_RS_R_y [m s^-1],v_RS_R_z [m s^-1],"
                     "b_w_RS_S_x [rad s^-1],b_w_RS_S_y [rad s^-1],b_w_RS_S_z [rad s^-1],"
                     "b_a_RS_S_x [m s^-2],b_a_RS_S_y [m s^-2],b_a_RS_S_z [m s^-2]\n";
  SteadyQuaternions steady;
  for (int frame = 0; frame < recipe.frame_count; ++frame) {
    const std::int64_t timestamp = frame_timestamp_ns(recipe, frame);
    const BodyMotion body =
        body_motion(recipe.trajectory, recipe.T_body_camera, trajectory_seconds(recipe, timestamp));
    text += std::to_string(timestamp) + cells(body.pose.p_wc, 12) +
            quaternion_cells(steady(body.pose.R_wc), 15) + cells(body.velocity_w, kDecimals) +
            cells(recipe.gyroscope.bias, kDecimals) + ",0,0,0\n";
  }
  return text;
}

std::vector<Pose> exposure_poses(const Recipe& recipe, double seconds) {
  const ImageRecipe& image = recipe.image;
  const int count = image.exposure > 0 ? image.samples * image.samples : 1;
  std::vector<Pose> poses;
  for (int k = 0; k < count; ++k) {
    const double offset = image.exposure * ((k + 0.5) / count - 0.5);
    poses.push_back(camera_motion(recipe.trajectory, seconds + offset).pose);
  }
  return poses;
}

void write_images(const Recipe& recipe,
                  const fs::path& folder,
                  const SynthesisProgress& progress,
                  int threads) {
  if (progress) progress(0, recipe.frame_count);
  const bool columns = readout_direction(recipe.camera).x() != 0;
  const Scene scene = make_scene(recipe, threads);
  const RayMap rays = make_ray_map(recipe.camera, recipe.image.samples, threads);
  std::string list = kImageListHead;
  for (int frame = 0; frame < recipe.frame_count; ++frame) {
    const std::int64_t timestamp = frame_timestamp_ns(recipe, frame);
    const double seconds = trajectory_seconds(recipe, timestamp);
    const LinePoses poses = [&](int line) {
      return exposure_poses(recipe, row_seconds(recipe, timestamp, line));
    };
    const cv::Mat light = recipe.image.rolling_shutter > 0
                              ? render_lines(scene, rays, poses, columns, threads)
                              : render(scene, rays, poses(0), threads);
    const double gain =
        1 + recipe.image.gain_variation * std::sin(2 * std::numbers::pi * 0.6 * seconds);
    const std::uint64_t noise_seed = Random(recipe.seed, 1000 + frame).bits();
    const cv::Mat image = expose(light, recipe.image, gain, noise_seed, threads);
    const std::string name = fmt::format("{}.{}", timestamp, recipe.image.format);
    write_file(folder / "data" / name,
               recipe.image.format == "jpg" ? encode_jpeg(image, recipe.image.quality)
                                            : encode_png(image));
    list += fmt::format("{},{}\n", timestamp, name);
    if (progress) progress(frame + 1, recipe.frame_count);
  }
  write_file(folder / "data.csv", list);
}

void write_recording(const Recipe& recipe,
                     const fs::path& folder,
                     const SynthesisProgress& progress,
                     int threads) {
  const fs::path mav = folder / "mav0";
  for (const char* name : {"cam0/data", "imu0", "state_groundtruth_estimate0"})
    make_folder(mav / name);
  write_file(mav / "cam0" / "sensor.yaml", camera_yaml(recipe));
  write_file(mav / "imu0" / "sensor.yaml", imu_yaml(recipe.gyroscope));
  write_file(mav / "imu0" / "data.csv", imu_csv(recipe));
  write_file(mav / "state_groundtruth_estimate0" / "data.csv", truth_csv(recipe));
  if (has_desk(recipe))
    write_file(folder / "plane.yaml",
               fmt::format("# The {}, in the world of the ground truth.\n"
                           "normal: [0, 0, 1]\ndistance: 0\n",
                           recipe.desk.walls.empty() ? "desk" : "floor"));
  if (recipe.desk.board) {
    const BoardRecipe& board = *recipe.desk.board;
    write_file(folder / "board.yaml", board_yaml({board.columns, board.rows, board.square}));
  }
  write_images(recipe, mav / "cam0", progress, threads);
}

/// Locks a folder against others, makes it, and removes it at the end if it is still empty.
class FolderLock {
 public:
  /// Waits for the lock and calls `waiting` meanwhile, which may throw. Throws InputError if the
  /// folder cannot be made or locked.
  FolderLock(fs::path folder, const std::function<void()>& waiting) : folder_(std::move(folder)) {
    do {
      if (descriptor_ >= 0) close(std::exchange(descriptor_, -1));
      std::error_code error;
      fs::create_directories(folder_, error);
      if (error) fail(error);
      descriptor_ = open(folder_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
      if (descriptor_ < 0 && errno != ENOENT) fail({errno, std::generic_category()});
      if (descriptor_ >= 0) lock(waiting);
    } while (!is_in_place());
  }
  ~FolderLock() {
    std::error_code not_empty;
    fs::remove(folder_, not_empty);
    close(descriptor_);
  }
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  void lock(const std::function<void()>& waiting) {
    try {
      while (flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
        if (errno != EWOULDBLOCK && errno != EINTR) fail({errno, std::generic_category()});
        waiting();
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
      }
    } catch (...) {
      close(descriptor_);
      throw;
    }
  }
  [[noreturn]] void fail(const std::error_code& why) const {
    refuse(folder_, "cannot be made ({}), expected a folder to write into", why.message());
  }
  /// False if the last owner removed the folder, even if there is another one in its place.
  bool is_in_place() const {
    struct stat held {
    }, named{};
    return descriptor_ >= 0 && fstat(descriptor_, &held) == 0 &&
           stat(folder_.c_str(), &named) == 0 && held.st_dev == named.st_dev &&
           held.st_ino == named.st_ino;
  }

  fs::path folder_;
  int descriptor_ = -1;
};

constexpr int kFormat = 2;  // increases when the same recipe makes other bytes

}  // namespace

std::vector<ImuSample> simulate_imu(const Recipe& recipe) {
  const GyroscopeRecipe& gyroscope = recipe.gyroscope;
  const double duration = (recipe.frame_count - 1) / recipe.frame_rate;
  const double sigma = gyroscope.noise_density * std::sqrt(gyroscope.rate);
  Random random(recipe.seed, kGyroscopeStream);
  std::vector<ImuSample> samples;
  const auto first = static_cast<std::int64_t>(-std::ceil(kMargin_s * gyroscope.rate));
  const auto last = static_cast<std::int64_t>(std::ceil((duration + kMargin_s) * gyroscope.rate));
  for (std::int64_t i = first; i <= last; ++i) {
    const double ideal = (static_cast<double>(i) + kPhase) / gyroscope.rate;
    const std::int64_t timestamp = recipe.start_ns + std::llround(ideal * 1e9);
    const BodyMotion body =
        body_motion(recipe.trajectory, recipe.T_body_camera, trajectory_seconds(recipe, timestamp));
    Eigen::Vector3d noise;
    for (double& n : noise) n = sigma * random.normal();
    samples.push_back({timestamp, body.rate_b + gyroscope.bias + noise, body.specific_force_b});
  }
  return samples;
}

void synthesize(const Recipe& recipe,
                const fs::path& output,
                const SynthesisProgress& progress,
                int threads) {
  AtomicFolder unfinished(output);
  write_recording(recipe, unfinished.path(), progress, threads);
  unfinished.finish();
}

fs::path synthesized_folder(const fs::path& recipe, const fs::path& cache) {
  const std::string stem = recipe.stem().string();
  const std::uint64_t key =
      fnv1a(fmt::format("{} {}", kFormat, read_file(recipe, limits().hand_bytes)));
  return cache / fmt::format("{}-{:016x}", stem, key) / stem;
}

std::vector<fs::path> synthesized_recordings(std::span<const fs::path> recipes,
                                             const fs::path& cache,
                                             int threads,
                                             const SynthesisProgress& progress) {
  struct Missing {
    fs::path folder;
    Recipe recipe;
  };
  std::vector<fs::path> folders;
  std::vector<Missing> missing;  // each once
  int frames = 0;
  for (const fs::path& recipe : recipes) folders.push_back(synthesized_folder(recipe, cache));
  for (std::size_t i = 0; i < folders.size(); ++i) {
    if (fs::exists(folders[i]) || std::ranges::count(missing, folders[i], &Missing::folder) > 0)
      continue;
    missing.push_back({folders[i], read_recipe(recipes[i])});
    frames += missing.back().recipe.frame_count;
  }
  int done = 0;
  std::exception_ptr error = nullptr;  // the first one, which stops all threads
  std::mutex mutex;
  const auto report = [&](int more_frames) {
    const std::lock_guard lock(mutex);
    if (error) throw std::runtime_error("another recording failed");
    done += more_frames;
    try {
      if (progress) progress(done, frames);
    } catch (...) {
      error = std::current_exception();  // before another thread continues
      throw;
    }
  };
  const int count = static_cast<int>(missing.size());
  const int at_a_time = std::max(1, std::min(count, threads));
  in_parallel(count, at_a_time, [&](int i) {
    const auto& [folder, recipe] = missing[i];
    try {
      int made = 0;
      const auto report_made = [&](int now, int) { report(now - std::exchange(made, now)); };
      const FolderLock lock(folder.parent_path(), [&] { report(0); });
      report(0);
      if (fs::exists(folder)) return report_made(recipe.frame_count, 0);
      synthesize(recipe, folder, report_made, threads / at_a_time);
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!error) error = std::current_exception();
    }
  });
  if (error) std::rethrow_exception(error);
  return folders;
}

}  // namespace gpo
