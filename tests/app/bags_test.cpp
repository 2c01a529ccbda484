// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// Bags of ROS and Python give the results of the recording; ROS can read our bags.
#include "engine/recording/images/images.h"
#include "tests/app/program.h"
#include "tests/engine/opencv_images.h"

#include <regex>

#include <gmock/gmock.h>
#include <opencv2/imgproc.hpp>
#include <zstd.h>

namespace gpo::test {
namespace {

using testing::AllOf, testing::HasSubstr;

constexpr const char* kBagWindow = " --frames 20 --lens exact ";

/// The room, which we must not publish, if it exists, else the bundled desk.
fs::path source_recording() {
  return fs::exists(shared("euroc-room")) ? shared("euroc-room") : desk();
}

/// Writes the images of the recording in gray and without compression.
fs::path gray_images(const fs::path& folder) {
  fs::create_directories(folder);
  for (const auto& file : fs::directory_iterator(source_recording() / "mav0/cam0/data")) {
    cv::Mat gray;
    cv::cvtColor(read_image(file.path()), gray, cv::COLOR_BGR2GRAY);
    imwrite((folder / file.path().stem()).concat(".pgm"), gray, {});
  }
  return folder;
}

/// The result and the table, without names, times, the uncertainty of the lens, for which ROS has
/// no message, and the gravity error: a bag does not define which way is up.
json result_of(const fs::path& path, const fs::path& file) {
  const Outcome outcome = succeeding("run {}{}--json {}", path, kBagWindow, file);
  EXPECT_THAT(outcome.err, Not(HasSubstr("truncated")));
  json result = read_json(file);
  for (const char* key : {"recording", "timing_ms"}) result.erase(key);
  result["metrics"].erase("gravity_error_deg");
  for (const char* key : {"lens", "typical_lens_sigma_deg"}) result["uncertainty"].erase(key);
  result["uncertainty"]["parts_deg"].erase("lens");
  if (result.contains("truth")) result["truth"].erase("source");
  const std::regex omitted("(recording|time|truth|up error|uncertainty) .*\n");
  result["table"] = std::regex_replace(outcome.out, omitted, "");
  return result;
}

void expect_results_of_folder(const fs::path& bag, const fs::path& folder) {
  const json of_folder = result_of(source_recording(), folder / "folder.json");
  expect_same_json(of_folder, result_of(bag, folder / "bag.json"), 1e-9, bag.filename().string());
}

/// Makes the bag by a script in tests/app/bags. Copies the files for which bags have no message.
void expect_results_of_made_bag(const char* script, const fs::path& bag, const std::string& more) {
  const fs::path source = source_recording(), folder = bag.parent_path();
  const Outcome run = shell(DEBIANS_PYTHON "tests/app/bags/{} {} {} {}", script, source, bag, more);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  for (const auto& [from, to] : {std::pair("plane.yaml", "plane.yaml"),
                                 std::pair("board.yaml", "board.yaml"),
                                 std::pair("mav0/imu0/sensor.yaml", "imu.yaml")})
    if (fs::exists(source / from)) fs::copy_file(source / from, folder / to);
  expect_results_of_folder(bag, folder);
}

class RosBag : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Compressions, RosBag, testing::Values("none", "bz2", "lz4"));

TEST_P(RosBag, WrittenByRosbagGivesTheResultOfTheFolder) {
  SKIP_WITHOUT_PYTHONS("rosbag, sensor_msgs.msg, geometry_msgs.msg, tf2_msgs.msg, numpy, yaml");
  const fs::path folder = fresh_folder(), bag = folder / "room.bag";
  const bool raw = std::string(GetParam()) == "lz4";
  const fs::path images = raw ? gray_images(folder / "gray") : fs::path();
  expect_results_of_made_bag("make_ros1_bag.py", bag, fmt::format("{} {}", GetParam(), images));
  EXPECT_THAT(
      program("info {}", bag).out,
      AllOf(HasSubstr("topics        /cam0/camera_info (sensor_msgs/CameraInfo, 1): camera_info"),
            HasSubstr("/truth (geometry_msgs/TransformStamped, ")));
}

TEST(Ros2Database, WrittenByPythonGivesTheResultOfTheFolder) {
  SKIP_WITHOUT_PYTHONS("sqlite3, numpy, yaml");
  const fs::path folder = fresh_folder(), bag = folder / "room.db3";
  expect_results_of_made_bag("make_ros2_db3.py", bag, gray_images(folder / "gray").string());
  const std::string bytes = read_file(bag);
  std::string packed(ZSTD_compressBound(bytes.size()), '\0');
  packed.resize(ZSTD_compress(packed.data(), packed.size(), bytes.data(), bytes.size(), 1));
  write_file(folder / "packed.db3.zstd", packed);
  expect_results_of_folder(folder / "packed.db3.zstd", folder);
  // A truncated bag is read as far as possible.
  write_file(folder / "cut.db3", bytes.substr(0, bytes.size() * 6 / 10));
  EXPECT_THAT(succeeding("run {}{}", folder / "cut.db3", kBagWindow).err,
              HasSubstr("the bag is truncated or broken"));
}

class ConvertedBag : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Formats, ConvertedBag, testing::Values("rosbag", "mcap"));

TEST_P(ConvertedBag, GivesTheResultOfTheFolder) {
  const fs::path folder = fresh_folder();
  const std::string format = GetParam();
  const fs::path bag = folder / (format == "mcap" ? "new/room.mcap" : "new/room.bag");
  const std::string line =
      fmt::format("convert {} --format {} --output {}", source_recording(), format, bag);
  succeeding(line);
  expect_results_of_folder(bag, folder);
  EXPECT_THAT(program(line).err, HasSubstr("already exists; choose a new file"));
  // ROS' viewers want a calibration with each image.
  const json topics = json::parse(succeeding("info {} --json", bag).out)["topics"];
  const auto messages = [&](const std::string& name) {
    const auto is_it = [&](const json& topic) { return topic["name"] == name; };
    return std::ranges::find_if(topics, is_it)->at("messages").get<int>();
  };
  EXPECT_GT(messages("/image_raw"), 1);
  EXPECT_EQ(messages("/camera_info"), messages("/image_raw"));
}

TEST(ConvertedBag, IsReadByRos) {
  SKIP_WITHOUT_PYTHONS("rosbag, sensor_msgs.msg, geometry_msgs.msg, tf2_msgs.msg");
  const fs::path folder = fresh_folder(), bag = folder / "desk.bag";
  succeeding("convert {} --format rosbag --output {}", kDesk, bag);
  // Compares the checksums of the message types with those that are installed.
  write_file(folder / "read.py",
             "import rosbag, sys, sensor_msgs.msg as s, tf2_msgs.msg as t, geometry_msgs.msg as g\n"
             "known = {c._type: c for c in (s.Image, s.CameraInfo, s.Imu, t.TFMessage, "
             "g.TransformStamped)}\n"
             "bag = rosbag.Bag(sys.argv[1])\n"
             "for name, about in sorted(bag.get_type_and_topic_info().topics.items()):\n"
             "    print(name, about.message_count, known[about.msg_type]._md5sum == "
             "bag.get_type_and_topic_info().msg_types[about.msg_type])\n"
             "for topic, message, time in bag.read_messages('/image_raw'):\n"
             "    assert len(message.data) == message.height * message.step\n"
             "    assert message.header.stamp == time\n"
             "stamps = lambda topic: [m.header.stamp for _, m, _ in bag.read_messages(topic)]\n"
             "assert stamps('/camera_info') == stamps('/image_raw')\n"
             "for topic, message, time in bag.read_messages('/camera_info'):\n"
             "    assert message.header.stamp == time\n"
             "    print(message.distortion_model, message.K[0])\n"
             "print('latched', *[c.topic for c in bag._get_connections() "
             "if c.header.get('latching') == b'1'])\n");
  const Outcome read = shell(DEBIANS_PYTHON "{} {}", folder / "read.py", bag);
  EXPECT_EQ(read.exit_code, 0) << read.err;
  for (const char* text : {"/image_raw 60 True",
                           "/camera_info 60 True",
                           "/imu ",
                           "plumb_bob 498.2",
                           "latched /tf_static\n"})
    EXPECT_THAT(read.out, HasSubstr(text));
  EXPECT_THAT(read.out, Not(HasSubstr("False")));
}

TEST(RealBags, AreDescribedOrRefused) {
  const fs::path folder = shared("bags");
  SKIP_WITHOUT(folder);
  for (const char* name :
       {"rosbagjs_example.bag", "rosbagjs_example-bz2.bag", "rosbagjs_example-lz4.bag"}) {
    const Outcome outcome = program("info {}", folder / name);
    expect_exit(2, outcome, std::string(name) + ": found no images among /rosout");
    EXPECT_THAT(outcome.out, HasSubstr("/turtle1/pose (turtlesim/Pose, 1344)"));
  }
  for (const char* name : {"klintan_sample.db3", "geocam.db3", "geocam.mcap"}) {
    const Outcome outcome = program("info {}", folder / name);
    EXPECT_THAT(outcome.out, HasSubstr("(sensor_msgs/Image, ")) << name;
    EXPECT_THAT(outcome.out, HasSubstr(": imu\n")) << name;
    // The images of geocam are only headers.
    if (std::string(name).starts_with("geocam"))
      expect_exit(2, outcome, "image 0: the image is truncated or broken");
  }
}

TEST(HostileBag, IsRefusedWithOneLine) {
  const fs::path folder = fresh_folder(), seeds = GPO_SOURCE_DIR "/tests/fuzz/seeds/bag";
  const auto expect_refused_bag = [](const Outcome& outcome, const std::string& message) {
    expect_refused(outcome, message);
    EXPECT_LT(outcome.peak_kib, 1 << 20);
  };
  const std::string of_4_gib = std::string("\xFF\xFF\xFF\xFF", 4) + std::string(20, 'x');
  for (const std::string& bytes : {std::string(),
                                   std::string("no bag at all"),
                                   std::string("#ROSBAG V2.0\n"),
                                   "#ROSBAG V2.0\n" + of_4_gib,
                                   std::string("\x89MCAP0\r\n") + of_4_gib,
                                   std::string("SQLite format 3\0", 16) + of_4_gib}) {
    write_file(folder / "hostile.bag", bytes);
    expect_refused_bag(program("run {}", folder / "hostile.bag"), "hostile.bag: ");
  }
  for (const char* name : {"bomb.bag", "claims_4_GiB.bag"})
    expect_refused_bag(program("info {}", seeds / name), "");
}

}  // namespace
}  // namespace gpo::test
