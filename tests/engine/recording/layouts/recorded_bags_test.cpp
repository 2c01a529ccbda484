// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// Bags as people record them: in parts, compressed, with an IMU in two topics.
#include "engine/window/gyroscope.h"
#include "tests/engine/recording/bags/small_bag.h"
#include "tests/engine/recording/recording_folder.h"

#include <zstd.h>

namespace gpo::test {
namespace {

namespace fs = std::filesystem;
using testing::Contains, testing::ElementsAre, testing::HasSubstr, testing::Not;

std::string zstd_of(const std::string& bytes) {
  std::string made(ZSTD_compressBound(bytes.size()), '\0');
  made.resize(ZSTD_compress(made.data(), made.size(), bytes.data(), bytes.size(), 3));
  return made;
}

/// Writes messages of images by their numbers.
void write_images(const fs::path& file, std::initializer_list<int> numbers, bool zstd = false) {
  const BagWriter writer = mcap_writer(file, {{"/image", "sensor_msgs/Image"}});
  for (const int i : numbers) {
    const std::string pixels(64 * 48, static_cast<char>(10 * i));
    const std::string bytes = image_bytes(image_of(i, pixels, 64, 48), writer.encoding);
    writer.write(0, kStart_ns + i * kPeriod_ns, zstd ? zstd_of(bytes) : bytes);
  }
  writer.finish();
}

std::string metadata_of(const std::vector<std::string>& files) {
  std::string text =
      "rosbag2_bagfile_information:\n  version: 5\n  storage_identifier: mcap\n"
      "  relative_file_paths:\n";
  for (const std::string& file : files) text += "    - " + file + "\n";
  return text;
}

class RecordedBag : public RecordingFolder {
 protected:
  RecordedBag() { folder.write("camera.yaml", kCameraYaml); }
  void write_parts() const {
    write_images(folder.path() / "rec_0.mcap", {0, 1, 2});
    write_images(folder.path() / "rec_1.mcap", {3, 4});
  }
  static int value(const Recording& recording, int frame) {
    return recording.images->bgr(frame).at<cv::Vec3b>(9, 9)[0];
  }
};

TEST_F(RecordedBag, OpensAsOneFromItsParts) {
  write_parts();
  folder.write("other.mcap", "not listed");
  folder.write("metadata.yaml", metadata_of({"rec_0.mcap", "/elsewhere/rec_1.mcap"}));
  for (const fs::path& path : {folder.path(), folder.path() / "metadata.yaml"}) {
    const auto recording = open_recording(path);
    EXPECT_EQ(recording->layout, "ROS bag");
    EXPECT_EQ(recording->name, folder.path().filename());
    ASSERT_EQ(recording->frame_count(), 5);
    EXPECT_EQ(recording->timestamps_ns.back(), kStart_ns + 4 * kPeriod_ns);
    for (int i = 0; i < 5; ++i) EXPECT_EQ(value(*recording, i), 10 * i);
    EXPECT_EQ(recording->image_files.size(), 2U);
  }
  EXPECT_THAT(open_recording(folder.path() / "rec_1.mcap")->notes,
              Contains("one of the 2 files of a recording: open its folder to read all"));
}

TEST_F(RecordedBag, OpensNumberedPartsWithoutMetadata) {
  write_parts();
  const auto recording = open();
  EXPECT_EQ(recording->frame_count(), 5);
  EXPECT_THAT(recording->notes,
              Contains("no metadata.yaml: reading rec_0.mcap to rec_1.mcap as one recording"));
  fs::rename(folder.path() / "rec_0.mcap", folder.path() / "rec_2.mcap");
  EXPECT_THAT(error(), HasSubstr("found 2 bags (rec_1.mcap, rec_2.mcap), expected one"));
}

TEST_F(RecordedBag, NamesAMissingPart) {
  write_parts();
  folder.write("metadata.yaml", metadata_of({"rec_0.mcap", "rec_1.mcap", "rec_2.mcap"}));
  const auto recording = open();
  EXPECT_EQ(recording->frame_count(), 5);
  EXPECT_THAT(recording->notes, Contains("rec_2.mcap is missing, metadata.yaml lists it"));
}

TEST_F(RecordedBag, MayBeCompressedAsAWhole) {
  write_images(folder.path() / "rec_0.mcap", {0, 1, 2, 3, 4});
  const std::string bytes = zstd_of(folder.read("rec_0.mcap"));
  fs::remove(folder.path() / "rec_0.mcap");
  const fs::path file = folder.write("rec_0.mcap.zstd", bytes);
  folder.write("metadata.yaml", metadata_of({"rec_0.mcap"}));
  for (const fs::path& path : {file, folder.path()}) {
    const auto recording = open_recording(path);
    ASSERT_EQ(recording->frame_count(), 5);
    EXPECT_EQ(value(*recording, 4), 40);
    EXPECT_EQ(recording->image_files, std::vector{file});
  }
  folder.write("rec_0.mcap.zstd", zstd_of("no bag, but compressed"));
  EXPECT_THAT(error(), HasSubstr("rec_0.mcap.zstd: not a bag, expected ROS 1"));
  folder.write("rec_0.mcap.zstd", zstd_of(std::string(80 << 20, '\0')));
  EXPECT_THAT(error(), HasSubstr("expands to more than 64 MiB, which is implausible for its size"));
}

TEST_F(RecordedBag, MayHaveCompressedMessages) {
  write_images(folder.path() / "rec_0.mcap", {0, 1, 2}, true);
  const auto recording = open();
  ASSERT_EQ(recording->frame_count(), 3);
  EXPECT_EQ(recording->timestamps_ns[2], kStart_ns + 2 * kPeriod_ns);
  EXPECT_EQ(value(*recording, 2), 20);
}

/// Samples of two sensors in topics of their own. Accelerations are (t, 2 t, 9.8) [m/s^2].
struct TwoTopics {
  std::int64_t accelerometer_from_ns = -8'000'000;
  std::int64_t gap_ns = 0;  ///< without accelerations, from 0.1 s on
  bool turned = false;      ///< the accelerometer's axes, by 90 deg about z
};

fs::path write_two_topics(const fs::path& file, const TwoTopics& options) {
  const BagWriter writer = mcap_writer(file,
                                       {{"/d400/color/image_raw", "sensor_msgs/Image"},
                                        {"/d400/accel/sample", "sensor_msgs/Imu"},
                                        {"/d400/gyro/sample", "sensor_msgs/Imu"},
                                        {"/tf_static", "tf2_msgs/TFMessage"}});
  const MessageEncoding encoding = writer.encoding;
  if (options.turned)
    writer.write(
        3,
        kStart_ns,
        transforms_bytes(
            {{{kStart_ns, "gyro"}, "accel", {0, 0, 0}, {0, 0, std::sqrt(0.5), std::sqrt(0.5)}}},
            encoding));
  const std::string pixels(64 * 48, 'p');
  for (int i = 0; i < 8; ++i)
    writer.write(0, kStart_ns, image_bytes(image_of(i, pixels, 64, 48), encoding));
  const Eigen::Vector3d zero(0, 0, 0);
  for (int i = -1; i < 80; ++i) {
    const std::int64_t time = kStart_ns + i * 5'000'000LL;
    writer.write(
        2, time, imu_bytes({{time, "gyro"}, Eigen::Vector3d(0.1, 0, 0.2), zero}, encoding));
  }
  for (std::int64_t at = options.accelerometer_from_ns; at < 420'000'000; at += 16'000'000) {
    if (at > 100'000'000 && at < 100'000'000 + options.gap_ns) continue;
    const double t = 1e-9 * static_cast<double>(at);
    const Eigen::Vector3d a(t, 2 * t, 9.8), turned(a.y(), -a.x(), a.z());
    writer.write(
        1,
        kStart_ns + at,
        imu_bytes({{kStart_ns + at, "accel"}, zero, options.turned ? turned : a}, encoding));
  }
  writer.finish();
  return file;
}

void expect_joined(const Recording& recording) {
  ASSERT_TRUE(recording.gyroscope);
  const Gyroscope& gyroscope = *recording.gyroscope;
  ASSERT_EQ(gyroscope.accelerations_m_s2.size(), gyroscope.timestamps_ns.size());
  for (std::size_t i = 0; i < gyroscope.timestamps_ns.size(); ++i) {
    const double t = 1e-9 * static_cast<double>(gyroscope.timestamps_ns[i] - kStart_ns);
    EXPECT_LT((gyroscope.accelerations_m_s2[i] - Eigen::Vector3d(t, 2 * t, 9.8)).norm(), 1e-9);
    EXPECT_EQ(gyroscope.rates_rad_s[i], Eigen::Vector3d(0.1, 0, 0.2));
  }
}

TEST_F(RecordedBag, JoinsAnAccelerometerInATopicOfItsOwn) {
  for (const bool turned : {false, true}) {
    const auto recording =
        open_recording(write_two_topics(folder.path() / "a.mcap", {.turned = turned}));
    expect_joined(*recording);
    EXPECT_EQ(recording->gyroscope->timestamps_ns.size(), 81U);
    EXPECT_THAT(recording->notes, Not(Contains(HasSubstr("topics with"))));
  }
}

TEST_F(RecordedBag, DropsRatesBeforeTheFirstAcceleration) {
  const auto recording = open_recording(
      write_two_topics(folder.path() / "a.mcap", {.accelerometer_from_ns = 52'000'000}));
  expect_joined(*recording);
  EXPECT_EQ(recording->gyroscope->timestamps_ns.front(), kStart_ns + 55'000'000);
}

TEST_F(RecordedBag, DoesNotBridgeALongGapInTheAccelerations) {
  const auto recording =
      open_recording(write_two_topics(folder.path() / "a.mcap", {.gap_ns = 150'000'000}));
  ASSERT_TRUE(recording->gyroscope);
  EXPECT_TRUE(recording->gyroscope->accelerations_m_s2.empty());
  EXPECT_EQ(recording->gyroscope->timestamps_ns.size(), 81U);
  EXPECT_THAT(recording->notes, Contains("accelerations not used: a gap of 0.18 s"));
}

TEST_F(RecordedBag, UsesTheChosenTopicsForEachSensor) {
  const fs::path file = write_two_topics(folder.path() / "a.mcap", {});
  const auto with = [&](const std::vector<std::string>& topics) {
    OpenOptions options;
    options.topics = parse_topic_choices(topics);
    return open_recording(file, options);
  };
  expect_joined(*with({"gyroscope=/d400/gyro/sample", "accelerometer=/d400/accel/sample"}));
  expect_joined(*with({"accelerometer=/d400/accel/sample"}));
  const auto alone = with({"imu=/d400/gyro/sample"});
  ASSERT_TRUE(alone->gyroscope);
  EXPECT_TRUE(alone->gyroscope->accelerations_m_s2.empty());
  EXPECT_THAT(with({"imu=/d400/accel/sample"})->notes,
              Contains("/d400/accel/sample: not used, it has no angular velocities"));
  EXPECT_THAT(error_of([&] { with({"pose=/d400/gyro/sample"}); }),
              HasSubstr("in /d400/gyro/sample, expected geometry_msgs/PoseStamped"));
}

TEST_F(RecordedBag, DoesNotUseACalibrationOfZeros) {
  fs::remove(folder.path() / "camera.yaml");
  const BagWriter writer =
      mcap_writer(folder.path() / "a.mcap",
                  {{"/image", "sensor_msgs/Image"}, {"/camera_info", "sensor_msgs/CameraInfo"}});
  CameraInfoMessage info = camera_info_of(small_camera());
  info.K.assign(9, 0);
  info.P.assign(12, 0);
  const std::string pixels(64 * 48, 'p');
  writer.write(0, kStart_ns, image_bytes(image_of(0, pixels, 64, 48), writer.encoding));
  writer.write(1, kStart_ns, camera_info_bytes(info, writer.encoding));
  writer.finish();
  const auto recording = open();
  EXPECT_EQ(recording->camera_source, CameraSource::guess);
  EXPECT_THAT(recording->notes, Contains("/camera_info: not used, its matrices K and P are zero"));
  const Bag bag = open_recorded_bag(find_bag_files(folder.path()));
  EXPECT_FALSE(topic_roles(bag, {}).of(TopicRole::camera_info));
}

}  // namespace
}  // namespace gpo::test
