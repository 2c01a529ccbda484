// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/engine/recording/bags/small_bag.h"
#include "tests/engine/test_folder.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>

#include <gmock/gmock.h>

namespace gpo::test {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre, testing::HasSubstr, testing::IsEmpty;

struct Container {
  const char* ending;
  BagWriter (*open)(const fs::path& file, const std::vector<BagTopic>& topics);
};

class Bags : public testing::TestWithParam<Container> {
 protected:
  std::string name() const { return std::string("small") + GetParam().ending; }
  fs::path write(int images = 20) const {
    return write_small_bag(folder_.path() / name(), GetParam().open, images);
  }
  /// Returns a bag of 1000 images, several chunks, after `change`.
  Bag changed(const std::function<std::string(std::string)>& change) const {
    write(1000);
    return open_bag(
        folder_.write("changed" + std::string(GetParam().ending), change(folder_.read(name()))));
  }

  TestFolder folder_;
};
INSTANTIATE_TEST_SUITE_P(Containers,
                         Bags,
                         testing::Values(Container{".bag", ros1_writer},
                                         Container{".mcap", mcap_writer}),
                         [](const auto& info) { return std::string(info.param.ending + 1); });

std::int64_t count_of(const Bag& bag, const std::string& topic) {
  return std::ranges::find(bag.topics, topic, &BagTopic::name)->messages;
}

TEST_P(Bags, AreReadAsWritten) {
  const Bag bag = open_bag(write());
  EXPECT_THAT(bag.notes, IsEmpty());
  std::vector<std::string> topics;
  for (const BagTopic& topic : bag.topics) topics.push_back(topic.name + " " + topic.type);
  EXPECT_THAT(topics,
              ElementsAre("/cam0/camera_info sensor_msgs/CameraInfo",
                          "/cam0/image_raw sensor_msgs/Image",
                          "/imu0 sensor_msgs/Imu",
                          "/tf_static tf2_msgs/TFMessage",
                          "/truth geometry_msgs/TransformStamped"));
  EXPECT_EQ(count_of(bag, "/cam0/image_raw"), 20);
  int k = 0;
  for (const BagMessage& message : bag.messages) {
    if (bag.topics[message.topic].name != "/cam0/image_raw") continue;
    EXPECT_EQ(message.recorded_ns, kStart_ns + k * kPeriod_ns + 3'000'000);
    const std::string bytes = bag.read(message, kWholeMessage);
    const auto image = read_image(bytes, bag.topics[message.topic].encoding);
    ASSERT_TRUE(image);
    EXPECT_EQ(image->data, pixels_of(k, 64, 48));
    EXPECT_EQ(bag.read(message, 10), bytes.substr(0, 10));
    ++k;
  }
}

TEST_P(Bags, AreReadAsFarAsPossibleIfTruncated) {
  for (const double part : {0.3, 0.6, 0.95}) {
    const Bag bag = changed([&](const std::string& all) {
      return all.substr(0, static_cast<std::size_t>(part * double(all.size())));
    });
    ASSERT_EQ(bag.notes.size(), 1U);
    EXPECT_THAT(bag.notes[0], HasSubstr("the bag is truncated or broken in the record at byte "));
    // Up to one zstd block of 128 KiB is lost.
    EXPECT_NEAR(double(count_of(bag, "/cam0/image_raw")), 1000 * part, 50) << part;
    for (const BagMessage& message : bag.messages)
      EXPECT_NO_THROW(bag.read(message, kWholeMessage));
  }
}

TEST_P(Bags, AreReadWithoutAnIndex) {
  const bool ros1 = std::string(GetParam().ending) == ".bag";
  const Bag bag = changed([&](std::string all) {
    if (ros1) {
      const auto place = all.find("index_pos=") + 10;
      std::uint64_t index = 0;
      std::memcpy(&index, all.data() + place, sizeof(index));
      all.replace(place, sizeof(index), sizeof(index), '\0');
      return all.substr(0, index);
    }
    return all.replace(all.size() - 28, 20, 20, '\0');  // place of the summary
  });
  ASSERT_EQ(bag.notes.size(), 1U);
  EXPECT_THAT(bag.notes[0], testing::ContainsRegex("no (complete )?index"));
  EXPECT_EQ(count_of(bag, "/cam0/image_raw"), 1000);
  EXPECT_EQ(count_of(bag, "/imu0"), 1000);
}

/// Returns the file's bytes without some records of the summary, and without its checksum.
std::string without_summary_records(const std::string& file, const std::set<McapOp>& dropped) {
  const std::size_t footer = file.size() - kMcapMagic.size() - kMcapRecordHead - 20;
  const auto number = [&](std::size_t place) {
    std::uint64_t value = 0;
    std::memcpy(&value, file.data() + place, sizeof value);
    return value;
  };
  const std::size_t start = number(footer + kMcapRecordHead);
  std::string bytes = file.substr(0, start);
  for (std::size_t at = start, end = 0; at < footer; at = end) {
    end = at + kMcapRecordHead + number(at + 1);
    if (!dropped.contains(static_cast<McapOp>(file[at]))) bytes += file.substr(at, end - at);
  }
  return bytes + file.substr(footer, kMcapRecordHead + 16) + std::string(4, '\0') +
         std::string(kMcapMagic);
}

TEST(Mcap, IsReadWithoutStatisticsAndWithoutRepeatedChannels) {
  const TestFolder folder;
  const Bag whole = open_bag(test::write_small_bag(folder.path() / "small.mcap", mcap_writer));
  const std::string all = folder.read("small.mcap");
  for (const std::set<McapOp>& dropped :
       {std::set{McapOp::statistics},
        std::set{McapOp::channel, McapOp::schema},
        std::set{McapOp::channel, McapOp::schema, McapOp::statistics},
        std::set{McapOp::chunk_index}}) {
    const Bag bag = open_bag(folder.write("part.mcap", without_summary_records(all, dropped)));
    EXPECT_EQ(bag.messages.size(), whole.messages.size());
    EXPECT_EQ(count_of(bag, "/cam0/image_raw"), 20);
  }
}

TEST(Mcap, RefusesChunksThatExpandBeyondReason) {
  const TestFolder folder;
  const fs::path file = folder.path() / "small.mcap";
  const BagWriter writer = mcap_writer(file, {{"/imu", "sensor_msgs/Imu"}});
  writer.write(0, 0, std::string(std::size_t{5} << 20, '\0'));
  writer.finish();
  const std::string all = folder.read("small.mcap");
  std::string bytes(kMcapMagic), chunk;
  for (std::size_t at = bytes.size(), end = 0; chunk.empty(); at = end) {
    std::uint64_t length = 0;
    std::memcpy(&length, &all[at + 1], sizeof length);
    end = at + kMcapRecordHead + length;
    (static_cast<McapOp>(all[at]) == McapOp::chunk ? chunk : bytes) += all.substr(at, end - at);
  }
  for (int i = 0; i < 60; ++i) bytes += chunk;
  ASSERT_LT(bytes.size(), 2'000'000U);
  EXPECT_THAT(test::error_of([&] { open_bag(folder.write("bomb.mcap", bytes)); }),
              testing::ContainsRegex("bomb.mcap: expands to more than [0-9]+ MiB"));
}

TEST(Mcap, RefusesAWrongChecksum) {
  const TestFolder folder;
  const fs::path file = write_small_bag(folder.path() / "small.mcap", mcap_writer, 20);
  std::string all = folder.read("small.mcap");
  // The checksum is before the name of the compression.
  const std::size_t chunk = all.find(std::string("\4\0\0\0zstd", 8));
  all[chunk - 1] = static_cast<char>(all[chunk - 1] ^ 1);
  const Bag bag = open_bag(folder.write("broken.mcap", all));
  EXPECT_THAT(error_of([&] { bag.read(bag.messages.front(), kWholeMessage); }),
              HasSubstr("broken chunk at byte"));
}

TEST(OpenBag, RefusesOtherFiles) {
  const TestFolder folder;
  const auto error = [&](const std::string& bytes) {
    const fs::path file = folder.write("some.bag", bytes);
    return error_of([&] { open_bag(file); });
  };
  EXPECT_THAT(error(""), HasSubstr("some.bag: not a bag, expected ROS 1"));
  EXPECT_THAT(error("#ROSRECORD V1.1\n"), HasSubstr("found an old bag format"));
  EXPECT_THAT(error("#ROSBAG V2.0\n"), HasSubstr("found no header of a ROS 1 bag"));
  EXPECT_THAT(error(std::string("SQLite format 3\0", 16) + std::string(500, 'x')),
              HasSubstr("unreadable database"));
  EXPECT_THAT(error_of([&] { open_bag(folder.path()); }), HasSubstr("expected a bag"));
  EXPECT_THAT(open_bag(folder.write("empty.mcap", "\x89MCAP0\r\n")).topics, IsEmpty());
}

/// Bags that we may not publish.
const fs::path kSharedBags = GPO_SHARED_DIR "/data/bags";

/// Returns all messages with their topics, sorted since the order of equal times depends on the
/// writer.
std::vector<std::string> sorted_messages(const Bag& bag) {
  std::vector<std::string> all;
  for (const BagMessage& message : bag.messages)
    all.push_back(bag.topics[message.topic].name + " " + bag.read(message, kWholeMessage));
  std::ranges::sort(all);
  return all;
}

TEST(RealBags, AreEqualInAllCompressions) {
  if (!fs::exists(kSharedBags)) GTEST_SKIP() << "no recordings in " << GPO_SHARED_DIR;
  const auto plain = sorted_messages(open_bag(kSharedBags / "rosbagjs_example.bag"));
  EXPECT_EQ(plain.size(), 8647U);
  for (const char* name : {"rosbagjs_example-bz2.bag", "rosbagjs_example-lz4.bag"}) {
    const Bag bag = open_bag(kSharedBags / name);
    EXPECT_THAT(bag.notes, IsEmpty());
    EXPECT_EQ(sorted_messages(bag), plain) << name;
  }
}

TEST(RealBags, AreEqualInBothContainersOfRos2) {
  if (!fs::exists(kSharedBags)) GTEST_SKIP() << "no recordings in " << GPO_SHARED_DIR;
  const Bag mcap = open_bag(kSharedBags / "geocam.mcap");
  const Bag database = open_bag(kSharedBags / "geocam.db3");
  ASSERT_EQ(mcap.topics.size(), 94U);
  ASSERT_EQ(database.topics.size(), 94U);
  ASSERT_EQ(mcap.messages.size(), database.messages.size());
  EXPECT_THAT(mcap.notes, IsEmpty());
  for (std::size_t i = 0; i < mcap.topics.size(); ++i) {
    EXPECT_EQ(mcap.topics[i].name, database.topics[i].name);
    EXPECT_EQ(mcap.topics[i].type, database.topics[i].type);
    EXPECT_EQ(mcap.topics[i].messages, database.topics[i].messages);
  }
}

class Messages : public testing::TestWithParam<MessageEncoding> {};
INSTANTIATE_TEST_SUITE_P(Encodings,
                         Messages,
                         testing::Values(MessageEncoding::ros1, MessageEncoding::cdr));

TEST_P(Messages, AreReadAsWritten) {
  const MessageHeader header{1'403'715'286'762'142'976, "odd"};
  const auto imu =
      read_imu(imu_bytes({header, Eigen::Vector3d(1, 2, 3), Eigen::Vector3d(4, 5, 6)}, GetParam()),
               GetParam());
  ASSERT_TRUE(imu);
  EXPECT_EQ(imu->header.stamp_ns, header.stamp_ns);
  EXPECT_EQ(imu->header.frame_id, "odd");
  EXPECT_EQ(imu->angular_velocity, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(imu->linear_acceleration, Eigen::Vector3d(4, 5, 6));
  const auto absent = read_imu(imu_bytes({header, {}, {}}, GetParam()), GetParam());
  ASSERT_TRUE(absent);
  EXPECT_FALSE(absent->angular_velocity || absent->linear_acceleration);

  const PoseMessage pose{header, "camera", {0.1, 0.2, 0.3}, {0, 0.6, 0, 0.8}};
  const auto read =
      read_pose(transform_bytes(pose, GetParam()), GetParam(), "geometry_msgs/TransformStamped");
  ASSERT_TRUE(read);
  EXPECT_EQ(read->child_frame_id, "camera");
  EXPECT_EQ(read->position, pose.position);
  EXPECT_EQ(read->quaternion_xyzw, pose.quaternion_xyzw);
  const auto tree = read_transforms(transforms_bytes({pose, pose}, GetParam()), GetParam());
  ASSERT_TRUE(tree);
  EXPECT_EQ(tree->size(), 2U);
  EXPECT_EQ(tree->back().quaternion_xyzw, pose.quaternion_xyzw);

  const std::string pixels = pixels_of(3, 5, 4);
  const std::string bytes = image_bytes(image_of(3, pixels, 5, 4), GetParam());
  const auto image = read_image(bytes, GetParam());
  ASSERT_TRUE(image);
  EXPECT_EQ(image->data, pixels);
  EXPECT_EQ(image->encoding, "mono8");
}

TEST_P(Messages, AreMissingIfTruncated) {
  const Eigen::Vector3d rate(1, 2, 3), acceleration(4, 5, 6);
  const std::string imu = imu_bytes({{1, "imu"}, rate, acceleration}, GetParam());
  for (std::size_t size = 0; size < imu.size(); ++size)
    EXPECT_FALSE(read_imu(imu.substr(0, size), GetParam())) << size;
}

TEST_P(Messages, PreserveTheCalibration) {
  for (const auto& [model, coefficients] :
       {std::pair(Distortion::radial_tangential, std::vector<double>{0.1, 0.2, 0.3, 0.4}),
        std::pair(Distortion::radial_tangential, std::vector<double>{0.1, 0.2, 0.3, 0.4, 0.5}),
        std::pair(Distortion::radial_tangential, std::vector<double>{1, 2, 3, 4, 5, 6, 7, 8}),
        std::pair(Distortion::equidistant, std::vector<double>{0.1, 0.2, 0.3, 0.4}),
        std::pair(Distortion::none, std::vector<double>{})}) {
    Camera camera = small_camera();
    camera.distortion = model;
    camera.coefficients = coefficients;
    const auto info = read_camera_info(camera_info_of(GetParam(), camera), GetParam());
    ASSERT_TRUE(info);
    EXPECT_EQ(camera_of(*info, "info"), camera) << coefficients.size();
  }
}

TEST(MessagesOfRos2, MayBeBigEndian) {
  // Header (7 s, 8 ns, "a"), then a pose's seven numbers.
  std::string bytes("\0\0\0\0\0\0\0\7\0\0\0\10\0\0\0\2a\0\0\0", 20);
  for (int i = 0; i < 7; ++i) {
    bytes.resize((bytes.size() - 4 + 7) / 8 * 8 + 4);
    const std::string number = std::string("\x3F\xF0", 2) + std::string(6, '\0');  // 1
    bytes += number;
  }
  const auto pose = read_pose(bytes, MessageEncoding::cdr, "geometry_msgs/PoseStamped");
  ASSERT_TRUE(pose);
  EXPECT_EQ(pose->header.stamp_ns, 7'000'000'008);
  EXPECT_EQ(pose->header.frame_id, "a");
  EXPECT_EQ(pose->position, Eigen::Vector3d(1, 1, 1));
  EXPECT_FALSE(pose->pose());  // no unit quaternion
}

TEST(CameraInfo, RefusesUnsupportedCameras) {
  const auto info = [](auto change) {
    CameraInfoMessage message = camera_info_of(small_camera());
    change(message);
    return error_of([&] { camera_of(message, "bag: /info"); });
  };
  EXPECT_THAT(info([](auto& m) { m.distortion_model = "fov"; }),
              HasSubstr("bag: /info: `distortion_model`: found \"fov\", expected plumb_bob"));
  EXPECT_THAT(info([](auto& m) { m.D.resize(7, 1); }),
              HasSubstr("`D`: found 7 numbers, expected 4 or 5"));
  EXPECT_THAT(info([](auto& m) { m.K[0] = -1; }),
              HasSubstr("`K`: found -1, 61, expected plausible fx"));
  EXPECT_THAT(info([](auto& m) { m.K[1] = 3; }), HasSubstr("`K`: found a matrix of another form"));
  EXPECT_THAT(info([](auto& m) { m.K[2] = 1e5; }),
              HasSubstr("`K`: found 100000, 23.5, expected cx, cy"));
}

/// Returns the middle pixel of a uniform image; `pattern` has the bytes of two rows, repeated.
cv::Vec<double, 3> middle_pixel(const std::string& encoding,
                                const std::string& pattern,
                                int channels,
                                int depth) {
  constexpr int kSide = 8;
  const auto step = static_cast<std::uint32_t>(kSide * channels * depth);
  const std::size_t half = pattern.size() / 2;
  std::string pixels;
  for (int y = 0; y < kSide; ++y)
    for (std::size_t x = 0; x < step; ++x) pixels += pattern[(y % 2) * half + x % half];
  const std::string bytes =
      image_bytes({{1, "c"}, kSide, kSide, encoding, false, step, pixels}, MessageEncoding::ros1);
  const cv::Mat image =
      bag_image(bytes, {"/c", "sensor_msgs/Image", MessageEncoding::ros1, 1}, "c");
  if (image.depth() == CV_16U) return image.at<cv::Vec<std::uint16_t, 3>>(4, 4);
  return image.at<cv::Vec3b>(4, 4);
}

TEST(BagImage, DecodesRosEncodings) {
  const cv::Vec<double, 3> red(10, 20, 200);  // blue, green, red
  const std::string r = "\xC8", g = "\x14", b = "\x0A";
  EXPECT_EQ(middle_pixel("bgr8", b + g + r + b + g + r, 3, 1), red);
  EXPECT_EQ(middle_pixel("rgb8", r + g + b + r + g + b, 3, 1), red);
  EXPECT_EQ(middle_pixel("rgba8", r + g + b + "x" + r + g + b + "x", 4, 1), red);
  EXPECT_EQ(middle_pixel("bayer_rggb8", r + g + g + b, 1, 1), red);
  EXPECT_EQ(middle_pixel("bayer_bggr8", b + g + g + r, 1, 1), red);
  EXPECT_EQ(middle_pixel("bayer_gbrg8", g + b + r + g, 1, 1), red);
  EXPECT_EQ(middle_pixel("bayer_grbg8", g + r + b + g, 1, 1), red);
  EXPECT_EQ(middle_pixel("mono8", r + r, 1, 1), cv::Vec3d(200, 200, 200));
  const std::string gray16 = g + "\x01";  // 0x0114
  EXPECT_EQ(middle_pixel("mono16", gray16 + gray16, 1, 2), cv::Vec3d(276, 276, 276));
}

TEST(BagImage, RefusesInvalidImages) {
  const auto error = [](ImageMessage image) {
    const std::string bytes = image_bytes(image, MessageEncoding::ros1);
    return error_of([&] {
      bag_image(bytes, {"/c", "sensor_msgs/Image", MessageEncoding::ros1, 1}, "bag: /c: image 3");
    });
  };
  const std::string pixels(20, 'x');
  ImageMessage image = image_of(0, pixels, 5, 4);
  image.encoding = "32FC1";
  EXPECT_THAT(error(image), HasSubstr("bag: /c: image 3: found pixel encoding \"32FC1\""));
  image = image_of(0, pixels, 5, 5);
  EXPECT_THAT(error(image), HasSubstr("found 20 bytes in rows of 5, expected an image of 5x5"));
  image = image_of(0, pixels, 65535, 65535);
  EXPECT_THAT(error(image), HasSubstr("found an image of 65535x65535, expected at most"));
}

TEST(FrameTree, FollowsTransformsInBothDirections) {
  const std::vector<PoseMessage> transforms = {
      {{0, "base"}, "/imu", {1, 0, 0}, {0, 0, 0, 1}},
      {{0, "base"}, "mount", {0, 2, 0}, {0, 0, std::sqrt(0.5), std::sqrt(0.5)}},
      {{0, "mount"}, "camera", {1, 0, 0}, {0, 0, 0, 1}}};
  const auto T_imu_camera = transform_between(transforms, "imu", "camera");
  ASSERT_TRUE(T_imu_camera);
  EXPECT_LT((T_imu_camera->p_wc - Eigen::Vector3d(-1, 3, 0)).norm(), 1e-12);
  EXPECT_LT((T_imu_camera->R_wc.col(0) - Eigen::Vector3d(0, 1, 0)).norm(), 1e-12);
  EXPECT_FALSE(transform_between(transforms, "imu", "elsewhere"));
  EXPECT_TRUE(transform_between({}, "same", "same"));
}

}  // namespace
}  // namespace gpo::test
