// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/geometry/pose.h"
#include "engine/recording/images/images.h"
#include "engine/recording/layouts/open_recording.h"
#include "engine/recording/recording.h"
#include "tests/app/program.h"
#include "tests/engine/opencv_images.h"
#include "tests/engine/recording/images/made_video.h"
#include "tests/engine/synthesis/small_recipe.h"

#include <functional>

#include <Eigen/Geometry>
#include <fmt/ranges.h>
#include <gmock/gmock.h>

namespace gpo::test {
namespace {

using testing::HasSubstr;

constexpr int kFrames = 30;

/// The bundled recording, which every layout below contains in its own format.
const Recording& original() {
  static const auto kDesk = open_recording(desk());
  return *kDesk;
}

fs::path image_file(int frame) {
  return desk() / "mav0/cam0/data" / fmt::format("{}.jpg", original().timestamps_ns[frame]);
}

std::int64_t since_start_ns(std::int64_t ns) { return ns - original().timestamps_ns.front(); }

std::string seconds(std::int64_t ns) {
  return fmt::format("{}.{:09d}", ns / 1000000000, ns % 1000000000);
}

void copy_images(const fs::path& folder, const std::function<std::string(int)>& name) {
  fs::create_directories(folder);
  for (int i = 0; i < kFrames; ++i) fs::copy_file(image_file(i), folder / name(i));
}

/// Writes gray images in another format; `scale` converts 8 to 16 bits.
void write_gray(const fs::path& folder, const char* ending, int depth, double scale) {
  for (int i = 0; i < kFrames; ++i) {
    cv::Mat image;
    original().images->gray(i).convertTo(image, depth, scale);
    ASSERT_TRUE(imwrite(folder / fmt::format("{}.{}", i, ending), image, {}));
  }
}

void write_euroc_camera(const fs::path& folder) {
  fs::copy_file(desk() / "mav0/cam0/sensor.yaml", folder / "camera.yaml");
}

const char* const kKalibrCamera =
    "cam0:\n  T_cam_imu:\n  - [0, -1, 0, 0.058]\n  - [-1, 0, 0, 0.021]\n  - [0, 0, -1, -0.004]\n"
    "  - [0, 0, 0, 1]\n  camera_model: pinhole\n  intrinsics: [498.2, 497.6, 322.4, 238.1]\n"
    "  distortion_model: radtan\n  distortion_coeffs: [0.092, -0.184, 0.0006, -0.0009]\n"
    "  resolution: [640, 480]\n  timeshift_cam_imu: 0.0\n";

void write_opencv_camera(const fs::path& file) {
  cv::FileStorage storage(file.string(), cv::FileStorage::WRITE);
  storage << "image_width" << 640 << "image_height" << 480 << "camera_matrix"
          << (cv::Mat_<double>(3, 3) << 498.2, 0, 322.4, 0, 497.6, 238.1, 0, 0, 1)
          << "distortion_coefficients"
          << (cv::Mat_<double>(1, 5) << 0.092, -0.184, 0.0006, -0.0009, 0);
}

/// Writes camera poses in the TUM format; `time` converts nanoseconds.
void write_truth(const fs::path& folder, const std::function<std::string(std::int64_t)>& time) {
  std::string text = "# ground truth trajectory\n# timestamp tx ty tz qx qy qz qw\n";
  for (int i = 0; i < original().frame_count(); ++i) {
    const Pose& camera = original().truth->poses[i].value();
    const Eigen::Quaterniond q(camera.R_wc);
    text += fmt::format("{} {} {}\n",
                        time(original().timestamps_ns[i]),
                        fmt::join(camera.p_wc, " "),
                        fmt::join(q.coeffs(), " "));
  }
  write_file(folder / "groundtruth.txt", text);
  write_file(folder / "plane.yaml", "normal: [0, 0, 1]\ndistance: 0\n");
}

/// Writes the gyroscope in its own axes, with the bias of the calibration of the bundled recording.
void write_gyroscope(const fs::path& file,
                     const std::string& header,
                     const std::function<std::string(std::int64_t)>& time,
                     double unit = 1) {
  const Gyroscope& gyroscope = original().gyroscope.value();
  std::string text = header + "\n";
  for (std::size_t i = 0; i < gyroscope.timestamps_ns.size(); ++i) {
    const Eigen::Vector3d w = unit * (gyroscope.rates_rad_s[i] - gyroscope.bias_rad_s);
    text += fmt::format("{},{},0,0,9.81\n", time(gyroscope.timestamps_ns[i]), fmt::join(w, ","));
  }
  write_file(file, text);
}

void write_frame_times(const fs::path& folder,
                       const std::string& header,
                       const std::function<std::string(std::int64_t)>& time) {
  std::string text = header + "\n";
  for (int i = 0; i < kFrames; ++i) text += time(original().timestamps_ns[i]) + "\n";
  write_file(folder / "frame_timestamps.txt", text);
}

std::string nanoseconds(std::int64_t ns) { return std::to_string(ns); }
std::string milliseconds_of_a_day(std::int64_t ns) {
  return fmt::format("{:.6f}", static_cast<double>(since_start_ns(ns) + 36'000'000'000'000) * 1e-6);
}
std::string seconds_since_start(std::int64_t ns) {
  return fmt::format("{:.9f}", static_cast<double>(since_start_ns(ns)) * 1e-9);
}

struct Fixture {
  const char* name;
  const char* layout;  ///< in `info`
  std::function<void(const fs::path& folder)> make;
  bool gyroscope = true;

  bool same_pixels() const { return std::string(name) != "phone"; }  ///< not compressed again
};

void make_euroc_without_mav0(const fs::path& folder) {
  fs::copy(desk() / "mav0", folder, fs::copy_options::recursive);
  fs::copy(desk() / "plane.yaml", folder);
}

void make_euroc_without_list(const fs::path& folder) {
  copy_of_desk(folder, {"mav0/cam0/data.csv"});
}

void make_tum_rgbd(const fs::path& folder) {
  std::string list = "# color images\n# file: 'desk.bag'\n# timestamp filename\n";
  for (int i = 0; i < kFrames; ++i)
    list += fmt::format("{} rgb/{}.jpg\n", seconds(original().timestamps_ns[i]), i);
  copy_images(folder / "rgb", [](int i) { return fmt::format("{}.jpg", i); });
  write_file(folder / "rgb.txt", list);
  write_opencv_camera(folder / "camera.yaml");
  write_truth(folder, seconds);
}

void make_tum_vi(const fs::path& folder) {
  copy_of_desk(folder, {"mav0/cam0/sensor.yaml"});
  fs::rename(folder / "mav0/state_groundtruth_estimate0", folder / "mav0/mocap0");
  write_file(folder / "dso/camchain.yaml", kKalibrCamera);
}

void make_images_and_seconds(const fs::path& folder) {
  copy_images(folder / "images", [](int i) { return fmt::format("frame{}.jpg", i); });
  write_euroc_camera(folder);
  write_frame_times(folder, "timestamp", seconds_since_start);
  write_gyroscope(folder / "gyro.csv", "timestamp,wx,wy,wz,ax,ay,az", seconds_since_start);
  write_truth(folder, seconds_since_start);
}

void make_images_degrees_and_milliseconds(const fs::path& folder) {
  copy_images(folder, [](int i) { return fmt::format("{}.jpg", i); });
  write_file(folder / "camchain-imucam-desk.yaml", kKalibrCamera);
  write_frame_times(folder, "time_ms", milliseconds_of_a_day);
  write_gyroscope(folder / "gyro.csv",
                  "t,gyro_x [deg/s],gyro_y [deg/s],gyro_z [deg/s],acc_x,acc_y,acc_z",
                  milliseconds_of_a_day,
                  180 / EIGEN_PI);
  write_truth(folder, [](std::int64_t ns) {
    return fmt::format("{:.9f}", static_cast<double>(since_start_ns(ns)) * 1e-9 + 36000 + 1.5);
  });
  write_file(folder / "groundtruth.yaml", "time_offset_s: 1.5\n");
}

auto make_gray(const char* ending, int depth, double scale, const char* camera) {
  return [=](const fs::path& folder) {
    write_gray(folder, ending, depth, scale);
    write_opencv_camera(folder / camera);
    write_frame_times(folder, "timestamp [ns]", nanoseconds);
    write_truth(folder, seconds);
  };
}

void make_phone(const fs::path& folder) {
  std::vector<cv::Mat> images;
  for (int i = 0; i < kFrames; ++i) images.push_back(original().images->bgr(i));
  make_video(folder / "movie.mp4", images);
  write_euroc_camera(folder);
  write_frame_times(folder, "Frame timestamp[nanosec],Unix time[nanosec]", [](std::int64_t ns) {
    return fmt::format("{},{}", ns, ns + 5);
  });
  write_gyroscope(
      folder / "gyro_accel.csv",
      "Timestamp[nanosec], gx[rad/s], gy[rad/s], gz[rad/s], ax[m/s^2], ay[m/s^2], az[m/s^2]",
      nanoseconds);
  write_truth(folder, seconds);
}

const std::vector<Fixture> kFixtures = {
    {"euroc_without_mav0", "EuRoC", make_euroc_without_mav0},
    {"euroc_without_a_list", "EuRoC", make_euroc_without_list},
    {"tum_vi", "EuRoC", make_tum_vi},
    {"tum_rgbd", "TUM RGB-D", make_tum_rgbd, false},
    {"images_and_seconds", "pictures", make_images_and_seconds},
    {"images_degrees_and_milliseconds", "pictures", make_images_degrees_and_milliseconds},
    {"png_of_16_bits", "pictures", make_gray("png", CV_16U, 257, "calibration.xml"), false},
    {"tiff_of_12_bits", "pictures", make_gray("tiff", CV_16U, 4095.0 / 255, "camera.yml"), false},
    {"pgm", "pictures", make_gray("pgm", CV_8U, 1, "camera.xml"), false},
    {"phone", "pictures", make_phone}};

TEST(Layouts, OpenInInfoRunAndWindow) {
  for (const Fixture& fixture : kFixtures) {
    SCOPED_TRACE(fixture.name);
    const fs::path top = fresh_folder(), folder = top / fixture.name, image = top / "window.png";
    fs::create_directories(folder);
    fixture.make(folder);

    const json found = json::parse(succeeding("info --json {}", folder).out);
    EXPECT_EQ(found["layout"], fixture.layout);
    EXPECT_EQ(found.contains("gyroscope"), fixture.gyroscope);
    EXPECT_EQ(found["camera"]["intrinsics"], json::parse("[498.2, 497.6, 322.4, 238.1]"));
    EXPECT_GE(found["frames"], kFrames);
    EXPECT_NEAR(found["rate_hz"], 30, 0.1);

    const std::string rotations = fixture.gyroscope ? "gyro" : "averaging";
    const json expected = run_json("{} --rotations {}", kDesk, rotations)["metrics"];
    const json metrics = run_json(folder.string())["metrics"];
    EXPECT_NEAR(metrics["pne_deg"], expected["pne_deg"], fixture.same_pixels() ? 1e-3 : 0.5);
    EXPECT_NEAR(metrics["ate_m"], expected["ate_m"], fixture.same_pixels() ? 1e-6 : 1e-3);

    succeeding("snapshot {} --view window --output {}", folder, image);
    EXPECT_FALSE(read_image(image).empty());
    fs::remove_all(top);
  }
}

/// The TUM-VI layout with a similar lens, calibrated by Kalibr.
TEST(Layouts, TumViWithWideLens) {
  const fs::path folder = fresh_folder(), recording = folder / "recording";
  // With enough frames to initialize.
  write_file(folder / "wide.yaml",
             replaced(small_recipe_text(),
                      {{"[160, 120]", "[320, 240]"},
                       {"[125, 124, 80.4, 59.2]", "[150, 149, 160.4, 119.2]"},
                       {"radial-tangential", "equidistant"},
                       {"[0.1, -0.2, 0.001, -0.001]", "[0.0034, 0.0007, -0.002, 0.0002]"},
                       {"count: 4", "count: 20"},
                       {"end: [0.03, -0.35, 0.42]", "end: [0.25, -0.35, 0.42]"}}));
  succeeding("synthesize {} --output {}", folder / "wide.yaml", recording);
  fs::rename(recording / "mav0/state_groundtruth_estimate0", recording / "mav0/mocap0");
  fs::remove(recording / "mav0/cam0/sensor.yaml");
  write_file(recording / "dso/camchain.yaml",
             "cam0:\n  T_cam_imu: [[0, -1, 0, 0.06], [-1, 0, 0, 0.02], [0, 0, -1, -0.004], "
             "[0, 0, 0, 1]]\n  camera_model: pinhole\n  intrinsics: [150, 149, 160.4, 119.2]\n"
             "  distortion_model: equidistant\n"
             "  distortion_coeffs: [0.0034, 0.0007, -0.002, 0.0002]\n  resolution: [320, 240]\n");
  const json result = run_json("{} --frames 20 --tracking anchored --rotations truth", recording);
  EXPECT_EQ(result["truth"]["source"], "mocap0/data.csv");
  EXPECT_LT(result["metrics"]["pne_deg"], 0.3);
  EXPECT_LT(result["metrics"]["ate_m"], 0.0005);
}

TEST(Layouts, TracksMayStartAfterTheFirstFrame) {
  const fs::path folder = fresh_folder();
  write_euroc_camera(folder);
  write_file(folder / "tracks.csv", [] {
    std::string text = "frame,track,x,y\n";
    std::srand(1);
    for (int track = 0; track < 120; ++track) {
      const Eigen::Vector3d point_w(0.3 * Eigen::Vector2d::Random().homogeneous() -
                                    0.3 * Eigen::Vector3d::UnitZ());
      for (int i = 5 + track % 2; i < kFrames; ++i) {
        const Eigen::Vector3d p_c = to_camera(original().truth->poses[i].value(), point_w);
        const Eigen::Vector2d px = project(original().camera, p_c);
        const bool seen = p_c.z() > 0 && px.x() >= 0 && px.x() < 640 && px.y() >= 0 && px.y() < 480;
        if (seen) text += fmt::format("{},{},{},{}\n", i, track, px.x(), px.y());
      }
    }
    return text;
  }());
  write_frame_times(folder, "timestamp [ns]", nanoseconds);
  write_truth(folder, seconds);
  const json result = run_json("{} --start 6 --frames 20", folder);
  EXPECT_EQ(result["window"]["start"], 6);
  EXPECT_LT(result["metrics"]["pne_deg"], 0.1);
  const Outcome early = program("run {} --frames 20", folder);
  expect_exit(1, early, "too few tracks: frame 0, the first of the window, has 0");
  EXPECT_THAT(early.err, HasSubstr("tracks begin in frame 5"));
}

}  // namespace
}  // namespace gpo::test
