// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/error.h"
#include "engine/recording/layouts/write_recording.h"
#include "engine/truth/truth.h"
#include "engine/window/gyroscope.h"
#include "tests/engine/recording/bags/small_bag.h"
#include "tests/engine/recording/recording_folder.h"

namespace gpo::test {
namespace {

namespace fs = std::filesystem;
using testing::Contains, testing::ElementsAre, testing::HasSubstr, testing::Not;

std::shared_ptr<const Recording> open_with(const fs::path& path,
                                           TopicRole role,
                                           const std::string& topic) {
  return open_recording(path, {.tracks = {}, .topics = {{role, topic}}});
}

std::string error_with(const fs::path& path, TopicRole role, const std::string& topic) {
  return error_of([&] { open_with(path, role, topic); });
}

/// Writes a bag with different images on several topics.
fs::path images_on(const TestFolder& folder, const std::vector<std::string>& names) {
  std::vector<BagTopic> topics;
  for (const std::string& name : names) topics.push_back({name, "sensor_msgs/Image"});
  const fs::path file = folder.path() / "pictures.mcap";
  const BagWriter writer = mcap_writer(file, topics);
  for (int i = 0; i < 3; ++i)
    for (std::size_t topic = 0; topic < names.size(); ++topic) {
      const std::string pixels(64 * 48, static_cast<char>(10 * topic + i));
      writer.write(static_cast<int>(topic),
                   kStart_ns,
                   image_bytes(image_of(2 - i, pixels, 64, 48), writer.encoding));
    }
  writer.finish();
  return file;
}

class BagReader : public RecordingFolder {
 protected:
  fs::path small_bag() const { return write_small_bag(folder.path() / "small.bag", ros1_writer); }
};

TEST_F(BagReader, ReadsACompleteRecording) {
  const auto recording = open_recording(small_bag());
  EXPECT_EQ(recording->layout, "ROS bag");
  EXPECT_EQ(recording->name, "small.bag");
  ASSERT_EQ(recording->frame_count(), 20);
  EXPECT_EQ(recording->timestamps_ns[7], kStart_ns + 7 * kPeriod_ns);
  EXPECT_EQ(recording->camera, small_camera());
  const std::string pixels = pixels_of(7, 64, 48);
  EXPECT_EQ(recording->images->bgr(7).at<cv::Vec3b>(0, 1)[0], static_cast<uchar>(pixels[1]));
  ASSERT_TRUE(recording->gyroscope);
  EXPECT_EQ(recording->gyroscope->rates_rad_s[7], Eigen::Vector3d(0.1 * 7, 0.2, 0.3));
  // The camera is rotated by 2 atan(0.6 / 0.8) about z.
  ASSERT_TRUE(recording->T_body_camera);
  EXPECT_LT((recording->gyroscope->R_gyro_camera.col(0) - Eigen::Vector3d(0.28, 0.96, 0)).norm(),
            1e-12);
  EXPECT_EQ(recording->T_body_camera->p_wc, Eigen::Vector3d(0.1, 0.2, 0.3));
  ASSERT_TRUE(recording->truth && recording->truth->poses[7]);
  EXPECT_LT((recording->truth->poses[7]->p_wc - Eigen::Vector3d(4.6, 2.2, 3.3)).norm(), 1e-12);
  EXPECT_THAT(recording->notes, ElementsAre("no plane.yaml: no plane errors"));
}

/// Writes a bag with samples of an IMU's sensors.
fs::path bag_of_imu(const TestFolder& folder, const ImuMessage& sample) {
  const fs::path file = folder.path() / "imu.mcap";
  const BagWriter writer =
      mcap_writer(file, {{"/image", "sensor_msgs/Image"}, {"/imu", "sensor_msgs/Imu"}});
  for (int i = 0; i < 3; ++i) {
    const std::string pixels = test::pixels_of(i, 64, 48);
    writer.write(0, kStart_ns, image_bytes(test::image_of(i, pixels, 64, 48), writer.encoding));
    ImuMessage now = sample;
    now.header.stamp_ns = kStart_ns + i * kPeriod_ns;
    writer.write(1, kStart_ns, imu_bytes(now, writer.encoding));
  }
  writer.finish();
  return file;
}

TEST_F(BagReader, CanBeStoppedByItsProgress) {
  const ReadProgress stop = [](double share) {
    EXPECT_GE(share, 0);
    EXPECT_LE(share, 1);
    throw InputError("stopped");
  };
  for (const auto& open : {ros1_writer, mcap_writer}) {
    const fs::path bag = test::write_small_bag(folder.path() / "small.bag", open);
    EXPECT_EQ(error_of([&] { open_recording(bag, {.tracks = {}, .progress = stop}); }), "stopped");
    EXPECT_EQ(probe_path(bag, std::chrono::milliseconds(-1)).frames, 0);
    EXPECT_EQ(probe_path(bag, std::chrono::milliseconds(-1)).layout, "ROS bag");
    EXPECT_EQ(probe_path(bag, std::chrono::hours(1)).frames, 20);
  }
}

TEST_F(BagReader, TakesZerosOfAnAbsentAccelerometerForAbsent) {
  const Eigen::Vector3d rate(0.1, 0, 0), zero(0, 0, 0);
  const auto recording = open_recording(bag_of_imu(folder, {{}, rate, zero}));
  ASSERT_TRUE(recording->gyroscope);
  EXPECT_EQ(recording->gyroscope->rates_rad_s[2], rate);
  EXPECT_TRUE(recording->gyroscope->accelerations_m_s2.empty());
}

TEST_F(BagReader, NotesDescribeAFrameWithoutAName) {
  const Eigen::Vector3d rate(0.1, 0, 0), zero(0, 0, 0);
  const auto recording = open_recording(bag_of_imu(folder, {{}, rate, zero}));
  EXPECT_THAT(recording->notes,
              Contains("no /tf_static from the gyroscope to cam0: assuming that the gyroscope has "
                       "the camera's axes"));
}

TEST_F(BagReader, DoesNotUseAnAccelerometerAsAGyroscope) {
  const auto recording =
      open_recording(bag_of_imu(folder, {{}, std::nullopt, Eigen::Vector3d(0, 0, 9.8)}));
  EXPECT_FALSE(recording->gyroscope);
  EXPECT_THAT(recording->notes, Contains("/imu: not used, it has no angular velocities"));
}

TEST_F(BagReader, ReadsTheChosenCamera) {
  folder.write("camera.yaml", kCameraYaml);
  const fs::path file = images_on(folder, {"/cam1/depth", "/cam1/image", "/cam0/image"});
  const auto first = open_recording(file);
  EXPECT_EQ(int(first->images->bgr(0).at<cv::Vec3b>(0, 0)[0]), 22);
  EXPECT_THAT(first->notes,
              Contains("3 topics with images: using /cam0/image; choose another with --topic "
                       "image=/cam1/depth"));
  const auto second = open_with(file, TopicRole::image, "/cam1/image");
  EXPECT_EQ(int(second->images->bgr(0).at<cv::Vec3b>(0, 0)[0]), 12);
  EXPECT_THAT(second->notes, Not(Contains(HasSubstr("topics with images"))));
  EXPECT_THAT(error_with(file, TopicRole::imu, "/cam1/image"),
              HasSubstr("--topic: found 3 messages of sensor_msgs/Image in /cam1/image, expected "
                        "sensor_msgs/Imu"));
  EXPECT_THAT(error_with(file, TopicRole::image, "/cam2"),
              HasSubstr("--topic: found no topic /cam2 among /cam0/image (sensor_msgs/Image, 3)"));
}

TEST(TopicChoices, AreParsed) {
  EXPECT_EQ(parse_topic_choices({"image=/a=b", "imu=/c"}),
            (TopicChoices{{TopicRole::image, "/a=b"}, {TopicRole::imu, "/c"}}));
  const auto error = [](const std::vector<std::string>& texts) {
    return error_of([&] { parse_topic_choices(texts); });
  };
  EXPECT_THAT(error({"/cam0"}), HasSubstr("topic: found '/cam0', expected ROLE=NAME"));
  EXPECT_THAT(
      error({"picture=/cam0"}),
      HasSubstr("expected one of image, camera_info, imu, truth, gyroscope, accelerometer"));
  EXPECT_THAT(error({"imu=/a", "imu=/b"}), HasSubstr("topic: found imu twice"));
}

TEST_F(BagReader, SortsImagesByTheirTimeStamps) {
  folder.write("camera.yaml", kCameraYaml);
  const auto recording = open_recording(images_on(folder, {"/image"}));
  EXPECT_THAT(recording->timestamps_ns,
              ElementsAre(kStart_ns, kStart_ns + kPeriod_ns, kStart_ns + 2 * kPeriod_ns));
  EXPECT_EQ(int(recording->images->bgr(0).at<cv::Vec3b>(0, 0)[0]), 2);
  EXPECT_EQ(int(recording->images->bgr(2).at<cv::Vec3b>(0, 0)[0]), 0);
}

TEST_F(BagReader, GuessesTheCameraWithoutCalibration) {
  const fs::path file = images_on(folder, {"/image"});
  const auto recording = open_recording(file);
  EXPECT_EQ(recording->camera_source, CameraSource::guess);
  EXPECT_GT(recording->camera.fx, 0);
  EXPECT_EQ(open_bag_images(file, 1 << 20, {})->count(), 3);
}

TEST_F(BagReader, PrefersACameraYamlBesideTheBag) {
  const fs::path file = small_bag();
  folder.write("camera.yaml", kCameraYaml);
  const auto recording = open_recording(file);
  EXPECT_EQ(recording->camera.fx, 60);
  EXPECT_THAT(recording->notes, Contains("using camera.yaml instead of /cam0/camera_info"));
}

TEST_F(BagReader, NamesTheTruncationOfABagWithoutImages) {
  write_small_bag(folder.path() / "whole.mcap", mcap_writer);
  const std::string bytes = folder.read("whole.mcap");
  for (const std::size_t size : {std::size_t{8}, bytes.size() / 3}) {
    const auto head = folder.write("head.mcap", bytes.substr(0, size));
    EXPECT_THAT(error_of([&] { open_recording(head); }),
                testing::ContainsRegex(
                    "found no images among .*; the bag is truncated or broken in the record at "
                    "byte [0-9]+ of [0-9]+: later messages are ignored"));
    EXPECT_THAT(error_with(head, TopicRole::image, "/cam0/image_raw"),
                HasSubstr("; the bag is truncated or broken"));
  }
}

TEST_F(BagReader, OpensAFolderWithOneBag) {
  small_bag();
  EXPECT_EQ(open()->frame_count(), 20);
  write_small_bag(folder.path() / "small.mcap", mcap_writer);
  EXPECT_THAT(error(),
              HasSubstr("found 2 bags (small.bag, small.mcap), expected one; name the file"));
}

TEST_F(BagReader, RefusesTopicsForOtherLayouts) {
  folder.write("camera.yaml", kCameraYaml);
  folder.write("1.png", cv::Mat(48, 64, CV_8UC1, cv::Scalar(7)));
  EXPECT_THAT(error_with(folder.path(), TopicRole::imu, "/imu"),
              HasSubstr("found the layout pictures without topics, expected a bag for --topic"));
}

}  // namespace
}  // namespace gpo::test
