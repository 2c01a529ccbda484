// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/bags/containers/bag.h"
#include "tests/engine/recording/bags/small_bag.h"
#include "tests/engine/test_folder.h"

#include <algorithm>
#include <cstring>

#include <gmock/gmock.h>

namespace gpo {
namespace {

namespace fs = std::filesystem;
using test::TestFolder;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

struct Container {
  const char* ending;
  BagWriter (*open)(const fs::path& file, const std::vector<WrittenTopic>& topics);
};

class Bags : public testing::TestWithParam<Container> {
 protected:
  std::string name() const { return std::string("small") + GetParam().ending; }
  fs::path write(int images = 20) const {
    return test::write_small_bag(folder_.path() / name(), GetParam().open, images);
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
    EXPECT_EQ(message.recorded_ns, test::kStart_ns + k * test::kPeriod_ns + 3'000'000);
    const std::string bytes = bag.read(message, kWholeMessage);
    const auto image = read_image(bytes, bag.topics[message.topic].encoding);
    ASSERT_TRUE(image);
    EXPECT_EQ(image->data, test::pixels_of(k, 64, 48));
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

TEST(Mcap, RefusesAWrongChecksum) {
  const TestFolder folder;
  const fs::path file = test::write_small_bag(folder.path() / "small.mcap", mcap_writer, 20);
  std::string all = folder.read("small.mcap");
  // The checksum is before the name of the compression.
  const std::size_t chunk = all.find(std::string("\4\0\0\0zstd", 8));
  all[chunk - 1] = static_cast<char>(all[chunk - 1] ^ 1);
  const Bag bag = open_bag(folder.write("broken.mcap", all));
  EXPECT_THAT(test::error_of([&] { bag.read(bag.messages.front(), kWholeMessage); }),
              HasSubstr("broken chunk at byte"));
}

TEST(OpenBag, RefusesOtherFiles) {
  const TestFolder folder;
  const auto error = [&](const std::string& bytes) {
    const fs::path file = folder.write("some.bag", bytes);
    return test::error_of([&] { open_bag(file); });
  };
  EXPECT_THAT(error(""), HasSubstr("some.bag: not a bag, expected ROS 1"));
  EXPECT_THAT(error("#ROSRECORD V1.1\n"), HasSubstr("found an old bag format"));
  EXPECT_THAT(error("#ROSBAG V2.0\n"), HasSubstr("found no header of a ROS 1 bag"));
  EXPECT_THAT(error(std::string("SQLite format 3\0", 16) + std::string(500, 'x')),
              HasSubstr("unreadable database"));
  EXPECT_THAT(test::error_of([&] { open_bag(folder.path()); }), HasSubstr("expected a bag"));
  EXPECT_THAT(open_bag(folder.write("empty.mcap", "\x89MCAP0\r\n")).topics, IsEmpty());
}

/// Returns all messages with their topics, sorted since the order of equal times depends on the
/// writer.
std::vector<std::string> sorted_messages(const Bag& bag) {
  std::vector<std::string> all;
  for (const BagMessage& message : bag.messages)
    all.push_back(bag.topics[message.topic].name + " " + bag.read(message, kWholeMessage));
  std::ranges::sort(all);
  return all;
}

// Bags that we may not publish: one recording with three compressions.
TEST(RealBags, AreEqualInAllCompressions) {
  const fs::path folder = fs::path(GPO_SHARED_DIR) / "data" / "bags";
  if (!fs::exists(folder)) GTEST_SKIP() << "no recordings in " << GPO_SHARED_DIR;
  const auto plain = sorted_messages(open_bag(folder / "rosbagjs_example.bag"));
  EXPECT_EQ(plain.size(), 8647U);
  for (const char* name : {"rosbagjs_example-bz2.bag", "rosbagjs_example-lz4.bag"}) {
    const Bag bag = open_bag(folder / name);
    EXPECT_THAT(bag.notes, IsEmpty());
    EXPECT_EQ(sorted_messages(bag), plain) << name;
  }
}

TEST(RealBags, AreEqualInBothContainersOfRos2) {
  const fs::path folder = fs::path(GPO_SHARED_DIR) / "data" / "bags";
  if (!fs::exists(folder)) GTEST_SKIP() << "no recordings in " << GPO_SHARED_DIR;
  const Bag mcap = open_bag(folder / "geocam.mcap");
  const Bag database = open_bag(folder / "geocam.db3");
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

}  // namespace
}  // namespace gpo
