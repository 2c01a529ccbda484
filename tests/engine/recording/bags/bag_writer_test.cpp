// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/files/byte_cursor.h"
#include "engine/recording/bags/messages.h"
#include "tests/engine/test_folder.h"

#include <gmock/gmock.h>
#include <yaml-cpp/yaml.h>

namespace gpo::test {
namespace {

const std::vector<BagTopic> kOtherAndLatched = {{"/imu", "sensor_msgs/Imu"},
                                                {"/tf_static", "tf2_msgs/TFMessage"}};
constexpr McapOp kMetadata{12}, kMetadataIndex{13};

/// Writes one message of each topic. Returns the bytes of the file.
std::string written(const TestFolder& folder, const char* name, decltype(mcap_writer)& open) {
  const BagWriter writer = open(folder.path() / name, kOtherAndLatched);
  writer.write(0, 1'000, imu_bytes({{1'000, "imu"}, Eigen::Vector3d::Zero(), {}}, writer.encoding));
  writer.write(
      1,
      2'000,
      transforms_bytes({{{2'000, "imu"}, "camera", {1, 2, 3}, {0, 0, 0, 1}}}, writer.encoding));
  writer.finish();
  return folder.read(name);
}

struct StoredRecord {
  std::uint64_t place = 0;
  std::uint64_t bytes = 0;  ///< with its head
  std::string content;
};

/// Returns the records of a kind in the order of the file.
std::vector<StoredRecord> records_of(const std::string& mcap, McapOp op) {
  std::vector<StoredRecord> found;
  const std::size_t end = mcap.size() - kMcapMagic.size();
  for (std::size_t at = kMcapMagic.size(); at < end;) {
    ByteCursor cursor(std::string_view(mcap).substr(at));
    const auto kind = static_cast<McapOp>(cursor.number<std::uint8_t>());
    const std::string content(cursor.text<std::uint64_t>());
    const std::uint64_t size = kMcapRecordHead + content.size();
    if (kind == op) found.push_back({at, size, content});
    at += size;
  }
  return found;
}

std::map<std::string, std::string> map_of(std::string_view bytes) {
  std::map<std::string, std::string> map;
  ByteCursor cursor(bytes);
  while (cursor.more()) {
    const std::string key(cursor.text());
    map[key] = cursor.text();
  }
  return map;
}

/// Returns the profile of a channel's only publisher.
YAML::Node offered_profile(const std::string& channel) {
  ByteCursor cursor(channel);
  cursor.take(4);                // ids of channel and schema
  cursor.text(), cursor.text();  // topic, encoding
  const auto profiles = YAML::Load(map_of(cursor.text()).at("offered_qos_profiles"));
  EXPECT_EQ(profiles.size(), 1U);
  return profiles[0];
}

TEST(McapWriter, OffersALatchedTopicAsTransientLocal) {
  const TestFolder folder;
  const auto channels = records_of(written(folder, "new.mcap", mcap_writer), McapOp::channel);
  ASSERT_EQ(channels.size(), 4U);  // the data section and the summary list both
  for (std::size_t i = 0; i < channels.size(); ++i) {
    const YAML::Node profile = offered_profile(channels[i].content);
    EXPECT_EQ(profile["durability"].as<int>(), i % 2 == 1 ? 1 : 2);  // transient local, volatile
    EXPECT_EQ(profile["history"].as<int>(), 1);
    EXPECT_EQ(profile["reliability"].as<int>(), 1);
    EXPECT_EQ(profile["liveliness"].as<int>(), 1);
    EXPECT_GT(profile["depth"].as<int>(), 0);
    EXPECT_FALSE(profile["avoid_ros_namespace_conventions"].as<bool>());
    for (const char* duration : {"deadline", "lifespan", "liveliness_lease_duration"}) {
      const auto nsec = profile[duration]["nsec"].as<std::int64_t>();
      EXPECT_EQ(profile[duration]["sec"].as<std::int64_t>() * 1'000'000'000 + nsec, INT64_MAX);
    }
  }
}

TEST(McapWriter, IndexesAnEmptyDescriptionForRosbag2) {
  const TestFolder folder;
  const std::string file = written(folder, "new.mcap", mcap_writer);
  const auto metadata = records_of(file, kMetadata);
  ASSERT_EQ(metadata.size(), 1U);
  ByteCursor cursor(metadata[0].content);
  EXPECT_EQ(cursor.text(), "rosbag2");
  EXPECT_EQ(map_of(cursor.text()).at("serialized_metadata"), "");
  const auto indices = records_of(file, kMetadataIndex);
  ASSERT_EQ(indices.size(), 1U);
  ByteCursor index(indices[0].content);
  EXPECT_EQ(index.number<std::uint64_t>(), metadata[0].place);
  EXPECT_EQ(index.number<std::uint64_t>(), metadata[0].bytes);
  EXPECT_EQ(index.text(), "rosbag2");
  EXPECT_EQ(open_bag(folder.path() / "new.mcap").messages.size(), 2U);
}

TEST(Ros1Writer, MarksOnlyLatchedConnections) {
  const TestFolder folder;
  const std::string file = written(folder, "new.bag", ros1_writer);
  std::size_t marked = 0;
  for (std::size_t at = 0; (at = file.find("latching=1", at)) != std::string::npos; ++at) ++marked;
  EXPECT_EQ(marked, 2U);  // in the chunk and in the index
  EXPECT_EQ(open_bag(folder.path() / "new.bag").messages.size(), 2U);
}

}  // namespace
}  // namespace gpo::test
