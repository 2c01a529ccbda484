// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/files/text_file.h"
#include "engine/geometry/pose.h"
#include "engine/recording/recording.h"
#include "tests/engine/recording/images/made_video.h"
#include "tests/engine/recording/recording_folder.h"

#include <atomic>
#include <cmath>
#include <thread>

namespace gpo::test {
namespace {

using testing::Contains, testing::ElementsAre, testing::EndsWith, testing::HasSubstr;

constexpr int kVideoFrames = 60;

/// Encodes a number as black and white columns, which survive compression.
cv::Mat numbered(int number) {
  cv::Mat image(48, 64, CV_8UC3, cv::Scalar::all(0));
  for (int bit = 0; bit < 8; ++bit)
    if ((number >> bit & 1) != 0) image.colRange(8 * bit, 8 * bit + 8).setTo(255);
  return image;
}

int number_of(const cv::Mat& image) {
  int number = 0;
  for (int bit = 0; bit < 8; ++bit)
    number |= (image.at<cv::Vec3b>(24, 8 * bit + 4)[1] > 127 ? 1 : 0) << bit;
  return number;
}

void write_video(const std::filesystem::path& file) {
  std::vector<cv::Mat> images;
  for (int i = 0; i < kVideoFrames; ++i) images.push_back(numbered(i));
  make_video(file, images);
}

class ImagesReader : public RecordingFolder {
 protected:
  ImagesReader() { folder.write("camera.yaml", kCameraYaml); }

  void write_images(int count) const {
    for (int i = 0; i < count; ++i) folder.write("img" + std::to_string(i) + ".png", numbered(i));
  }
};

TEST_F(ImagesReader, ReturnsTheFramesOfAVideoInAnyOrderToSeveralThreads) {
  write_video(folder.path() / "clip.avi");
  const OpenOptions options{.tracks = {}, .cache_bytes = 3 * 64 * 48 * 3};
  for (const auto& path : {folder.path(), folder.path() / "clip.avi"}) {
    const auto recording = open_recording(path, options);
    EXPECT_EQ(recording->layout, "pictures");
    ASSERT_EQ(recording->frame_count(), kVideoFrames);
    EXPECT_EQ(recording->timestamps_ns[25], 1000000000);
    for (int i = 0; i < kVideoFrames; ++i) EXPECT_EQ(number_of(recording->images->bgr(i)), i);
    for (int i = kVideoFrames - 1; i >= 0; --i) EXPECT_EQ(number_of(recording->images->bgr(i)), i);
    for (int i = 0; i < 200; ++i) {
      const int frame = (i * 37) % kVideoFrames;
      EXPECT_EQ(number_of(recording->images->bgr(frame)), frame);
      EXPECT_LE(recording->images->bytes(), options.cache_bytes);
    }
    std::atomic<int> wrong = 0;
    const auto read = [&](int step) {
      for (int i = 0; i < kVideoFrames; ++i) {
        const int frame = i * step % kVideoFrames;
        if (number_of(recording->images->bgr(frame)) != frame) ++wrong;
      }
    };
    std::vector<std::jthread> threads;
    for (const int step : {1, 7, 37}) threads.emplace_back(read, step);
    threads.clear();
    EXPECT_EQ(wrong, 0);
  }
}

TEST_F(ImagesReader, RefusesATruncatedVideoWithoutNoise) {
  write_video(folder.path() / "clip.avi");
  folder.cut("clip.avi", 0.6);
  testing::internal::CaptureStderr();
  EXPECT_THAT(error(), testing::MatchesRegex(".*clip.avi: found .* truncated.*expected .*"));
  folder.write("clip.avi", "no video at all");
  EXPECT_THAT(error(), EndsWith("clip.avi: cannot decode: truncated, or not a video"));
  folder.write("clip.avi", "");
  EXPECT_THAT(error(), HasSubstr("clip.avi: cannot decode"));
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST_F(ImagesReader, SortsImagesByTheirNumbers) {
  write_images(12);
  folder.write("mask.png", numbered(200));
  const auto recording = open();
  ASSERT_EQ(recording->frame_count(), 12);
  for (int i = 0; i < 12; ++i) EXPECT_EQ(number_of(recording->images->bgr(i)), i);
  EXPECT_EQ(recording->timestamps_ns[3], 100000000);
  EXPECT_THAT(recording->notes,
              ElementsAre("no frame_timestamps.txt and no rate_hz in camera.yaml: assuming 30 "
                          "frames per second",
                          "no gyroscope: rotations from the images alone",
                          "no ground truth: no metrics"));
}

TEST_F(ImagesReader, PrefersTheLongerSequenceAndNamesTheOther) {
  write_images(3);
  for (const char* copy : {"img0 (1).png", "img1 (1).png"}) folder.write(copy, numbered(99));
  const auto recording = open();
  ASSERT_EQ(recording->frame_count(), 3);
  EXPECT_EQ(number_of(recording->images->bgr(1)), 1);
  EXPECT_THAT(recording->notes, Contains("not read: img0 (1).png (2 images: another sequence)"));
}

TEST_F(ImagesReader, ScalesImagesOf16BitsAlikeAlsoIfTheFirstIsDark) {
  for (int i = 0; i < 12; ++i)
    folder.write(std::to_string(i) + ".tiff",
                 cv::Mat(48, 64, CV_16UC1, cv::Scalar::all(i == 0 ? 500 : 2000 + 100 * i)));
  const auto recording = open();
  const auto gray = [&](int i) { return int(recording->images->gray(i).at<std::uint8_t>(9, 9)); };
  EXPECT_EQ(gray(0), 31);  // 500 / 4095 * 255
  EXPECT_EQ(gray(11), 193);
}

TEST_F(ImagesReader, NeverMakesImagesOf16BitsWhiteAmongThoseOf8) {
  for (int i = 0; i < 4; ++i)
    folder.write(std::to_string(i) + ".tiff",
                 i % 2 == 0 ? cv::Mat(48, 64, CV_8UC1, cv::Scalar::all(70))
                            : cv::Mat(48, 64, CV_16UC1, cv::Scalar::all(18'000)));
  const auto recording = open();
  for (int i = 0; i < 4; ++i)
    EXPECT_EQ(int(recording->images->gray(i).at<std::uint8_t>(9, 9)), 70) << i;
}

TEST_F(ImagesReader, RefusesAnotherSizeThanThatOfTheFirstImage) {
  std::filesystem::remove(folder.path() / "camera.yaml");
  write_images(4);
  folder.write("img3.png", cv::Mat(24, 32, CV_8UC1, cv::Scalar::all(9)));
  const auto recording = open();
  EXPECT_THAT(error_of([&] { recording->images->bgr(3); }),
              HasSubstr("found an image of 32x24, expected the first image's resolution 64x48"));
}

TEST_F(ImagesReader, UsesTheRateOfTheCalibration) {
  write_images(3);
  folder.write("camera.yaml", std::string(kCameraYaml) + "rate_hz: 20\n");
  EXPECT_THAT(open()->timestamps_ns, ElementsAre(0, 50000000, 100000000));
}

TEST_F(ImagesReader, ReadsStoredTimesAndTheGyroscope) {
  write_images(3);
  folder.write("frame_timestamps.txt", "timestamp [s]\n10.5\n10.6\n10.7\n");
  folder.write("gyro.csv", "timestamp_ns,wx,wy,wz\n10400000000,1,2,3\n10500000001,1,2,3\n");
  const auto recording = open();
  EXPECT_THAT(recording->timestamps_ns, ElementsAre(10500000000, 10600000000, 10700000000));
  ASSERT_TRUE(recording->gyroscope);
  EXPECT_THAT(recording->gyroscope->timestamps_ns, ElementsAre(10400000000, 10500000001));
  EXPECT_TRUE(recording->gyroscope->R_gyro_camera.isIdentity(0));
  EXPECT_THAT(
      recording->notes,
      Contains("no T_BS in camera.yaml: assuming that the gyroscope has the camera's axes"));
}

TEST_F(ImagesReader, RotatesTheGyroscopeByKalibrsTransform) {
  write_images(1);
  folder.write("gyro.csv", "timestamp,wx,wy,wz\n0,1,2,3\n0.01,1,2,3\n");
  folder.write("camera.yaml", R"(cam0:
  resolution: [64, 48]
  intrinsics: [60, 60, 32, 24]
  distortion_model: radtan
  distortion_coeffs: [0, 0, 0, 0]
  timeshift_cam_imu: 0.25
  T_cam_imu: [[0, 1, 0, 0], [-1, 0, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]
)");
  const auto recording = open();
  const Gyroscope& gyroscope = recording->gyroscope.value();
  EXPECT_EQ(gyroscope.time_offset_ns, 250000000);
  EXPECT_TRUE(
      (gyroscope.R_gyro_camera * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d::UnitY()));
}

TEST_F(ImagesReader, NamesBothCountsOfTimes) {
  write_images(3);
  folder.write("frame_timestamps.txt", "1\n2\n");
  EXPECT_EQ(error(),
            file("frame_timestamps.txt") + ": found 2 time stamps, expected 3, one for each image");
}

TEST_F(ImagesReader, NamesAVideoOfAnotherSize) {
  write_video(folder.path() / "clip.avi");
  folder.write("camera.yaml",
               "resolution: [128, 96]\nintrinsics: [60, 60, 64, 48]\ndistortion_model: none\n");
  EXPECT_EQ(
      error(),
      file("clip.avi") + ": found an image of 64x48, expected the calibrated resolution 128x96");
}

TEST_F(ImagesReader, NamesMissingFiles) {
  EXPECT_THAT(error(), HasSubstr(": found no recording, expected cam0/data.csv (EuRoC), "));
  EXPECT_THAT(error_of([&] { open_recording(folder.write("notes.txt", "")); }),
              HasSubstr("notes.txt: unsupported file, expected a folder, "));
}

TEST_F(ImagesReader, NamesTheFoldersBelowThatHaveARecording) {
  for (const std::string name : {"above/set/first/", "above/set/deeper/still/"})
    for (int i = 0; i < 2; ++i) folder.write(name + std::to_string(i) + ".png", numbered(i));
  EXPECT_EQ(error_of([&] { open_recording(folder.path() / "above"); }),
            file("above") + ": found no recording, but in set/first. Open such a folder");
}

TEST_F(ImagesReader, GuessesTheCameraWithANote) {
  write_images(1);
  EXPECT_EQ(open()->camera_source, CameraSource::file);
  std::filesystem::remove(folder.path() / "camera.yaml");
  const auto recording = open();
  const Camera& camera = recording->camera;
  EXPECT_EQ(recording->camera_source, CameraSource::guess);
  EXPECT_EQ(cv::Size(camera.width, camera.height), recording->images->bgr(0).size());
  const double seen_rad = 2 * std::atan(std::hypot(camera.width, camera.height) / 2 / camera.fx);
  EXPECT_NEAR(degrees(seen_rad), 70, 1e-9);
  EXPECT_THAT(recording->notes,
              testing::Contains(
                  testing::StartsWith("no calibration: assuming a 70 deg diagonal field of view")));
}

TEST_F(ImagesReader, GuessesTheCameraOfPixelsThatAreNotSquare) {
  std::filesystem::remove(folder.path() / "camera.yaml");
  for (const int degrees : {0, 90}) {
    make_video(folder.path() / "clip.mp4",
               {numbered(0), numbered(1)},
               {.clockwise_degrees = degrees, .pixel_aspect = {4, 3}});
    const auto recording = open();
    const Camera& camera = recording->camera;
    EXPECT_NEAR(camera.fy / camera.fx, degrees == 0 ? 4.0 / 3 : 3.0 / 4, 1e-9);
    EXPECT_EQ(camera.cx, (camera.width - 1) / 2.0);
    EXPECT_THAT(recording->notes, Contains(HasSubstr(" times as wide as high")));
  }
}

TEST_F(ImagesReader, NotesThatACalibrationMustBeOfTheTurnedImages) {
  const auto turned = testing::StartsWith("the video asks to be turned");
  make_video(folder.path() / "clip.mp4", {numbered(0)}, {.clockwise_degrees = 180});
  EXPECT_THAT(open()->notes,
              Contains("the video asks to be turned by 180 deg: camera.yaml must be the "
                       "calibration of the turned images"));
  make_video(folder.path() / "clip.mp4", {numbered(0)});
  EXPECT_THAT(open()->notes, testing::Not(Contains(turned)));
}

TEST_F(ImagesReader, NotesAVideoThatLacksData) {
  std::filesystem::remove(folder.path() / "camera.yaml");
  std::vector<cv::Mat> images;
  for (int i = 0; i < 24; ++i) {
    images.emplace_back(240, 320, CV_8UC3);
    cv::RNG(static_cast<std::uint64_t>(i + 1)).fill(images.back(), cv::RNG::UNIFORM, 0, 256);
  }
  const auto clip = folder.path() / "clip.ts";
  make_video(clip, images);
  std::string bytes = read_file(clip);
  constexpr std::size_t kPacket = 188;
  std::size_t lost = bytes.size() / kPacket / 2 * kPacket;
  while (bytes.substr(lost + 1, 2) != std::string("\x01\0", 2)) lost += kPacket;  // the video's
  folder.write("clip.ts", bytes.erase(lost, kPacket));
  const auto recording = open();
  EXPECT_EQ(recording->frame_count(), 23);
  EXPECT_THAT(recording->notes,
              Contains(testing::StartsWith("the video lacks data of 1 frame, first at ")));
}

TEST_F(ImagesReader, RecognizesASelfCalibratedCamera) {
  write_images(1);
  folder.write("camera.yaml", std::string(kCameraYaml) + "source: self-calibrated\n");
  const auto recording = open();
  EXPECT_EQ(recording->camera_source, CameraSource::self_calibrated);
  EXPECT_EQ(recording->camera.fx, 60);
}

TEST_F(ImagesReader, RefusesTwoVideos) {
  folder.write("a.mp4", "");
  folder.write("b.MOV", "");
  EXPECT_EQ(error(),
            folder.path().string() +
                ": found 2 videos (a.mp4, b.MOV), expected one; name the file to open");
}

TEST_F(ImagesReader, UsesTracksWithoutImagesOrTimes) {
  folder.write("tracks.csv", "frame,track,x,y\n0,1,2,3\n4,1,2,3\n");
  const auto recording = open();
  EXPECT_EQ(recording->layout, "tracks");
  EXPECT_EQ(recording->frame_count(), 5);
  folder.write("frame_timestamps.txt", "1\n2\n3\n");
  EXPECT_EQ(error(),
            file("tracks.csv") + ":3: found frame 4, expected 0 to 2, the frames of the recording");
  std::filesystem::remove(folder.path() / "camera.yaml");
  EXPECT_THAT(error(), HasSubstr("found no calibration, expected camera.yaml"));
}

TEST_F(ImagesReader, UsesTheBoardsPlane) {
  write_images(1);
  folder.write("board.yaml", "{pattern: chessboard, columns: 9, rows: 6, square: 0.025}\n");
  const auto recording = open();
  ASSERT_TRUE(recording->plane);
  EXPECT_EQ(recording->plane->normal, Eigen::Vector3d(0, 0, -1));
  EXPECT_EQ(recording->plane->distance, 0);
  EXPECT_THAT(recording->notes,
              Contains("no stored ground truth: computing it from the chessboard"));
}

}  // namespace
}  // namespace gpo::test
