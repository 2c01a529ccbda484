// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// Foxglove's messages in protobuf and JSON, and an MCAP of them, assembled from their
// specifications without the reader's code.
#include "engine/files/image_codec.h"
#include "tests/engine/recording/recording_folder.h"

#include <cstring>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gpo::test {
namespace {

using testing::Contains, testing::HasSubstr;

template <class T>
std::string raw(T value) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  return bytes;
}

std::string varint(std::uint64_t value) {
  std::string bytes;
  for (; value > 127; value >>= 7) bytes += static_cast<char>((value & 127) | 128);
  return bytes + static_cast<char>(value);
}
std::string delimited(int field, const std::string& bytes) {
  return varint(field << 3 | 2) + varint(bytes.size()) + bytes;
}
std::string fixed32(int field, std::uint32_t value) { return varint(field << 3 | 5) + raw(value); }
std::string fixed64(int field, double value) { return varint(field << 3 | 1) + raw(value); }
std::string packed(int field, const std::vector<double>& values) {
  std::string bytes;
  for (const double value : values) bytes += raw(value);
  return delimited(field, bytes);
}

constexpr std::int64_t kTime_ns = 1'700'000'001'250'000'000;

std::string timestamp(std::int64_t ns) {
  return delimited(
      1, varint(8) + varint(ns / 1'000'000'000) + varint(16) + varint(ns % 1'000'000'000));
}

std::string base64(const std::string& bytes) {
  const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t three = 0;
    for (std::size_t k = 0; k < 3; ++k)
      three = three << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k > bytes.size() ? '=' : digits[three >> (18 - 6 * k) & 63];
  }
  return text;
}

std::string time_json(std::int64_t ns) {
  return fmt::format(
      R"("timestamp": {{"sec": {}, "nsec": {}}})", ns / 1'000'000'000, ns % 1'000'000'000);
}

std::string png_of(int value) { return encode_png(cv::Mat(48, 64, CV_8UC1, cv::Scalar(value))); }

const std::vector<double> kK = {60, 0, 31, 0, 61, 23, 0, 0, 1};
const std::vector<double> kP = {60, 0, 31, 0, 0, 61, 23, 0, 0, 0, 1, 0};

std::string compressed(bool json, std::int64_t ns, const std::string& file) {
  return json ? fmt::format(R"({{{}, "frame_id": "cam", "data": "{}", "format": "png"}})",
                            time_json(ns),
                            base64(file))
              : delimited(2, file) + delimited(4, "cam") + delimited(3, "png") + timestamp(ns);
}

std::string calibration(bool json) {
  return json ? fmt::format(
                    R"({{{}, "frame_id": "cam", "width": 64, "height": 48, )"
                    R"("distortion_model": "plumb_bob", "D": [0.1, -0.02, 0, 0, 0], "K": {}}})",
                    time_json(kTime_ns),
                    kK)
              : timestamp(kTime_ns) + fixed32(2, 64) + fixed32(3, 48) + delimited(4, "plumb_bob") +
                    packed(5, {0.1, -0.02, 0, 0, 0}) + packed(6, kK) + packed(8, kP);
}

std::string pose(bool json, std::int64_t ns, double x) {
  if (json)
    return fmt::format(
        R"({{{}, "frame_id": "map", "pose": {{"position": {{"x": {}, "y": 0.5, "z": 0}}, )"
        R"("orientation": {{"x": 0, "y": 0.6, "z": 0, "w": 0.8}}}}}})",
        time_json(ns),
        x);
  const std::string position = fixed64(1, x) + fixed64(2, 0.5);  // zeros are not stored
  const std::string orientation = fixed64(2, 0.6) + fixed64(4, 0.8);
  return timestamp(ns) + delimited(2, "map") +
         delimited(3, delimited(1, position) + delimited(2, orientation));
}

/// An MCAP without chunks and index.
class PlainMcap {
 public:
  explicit PlainMcap(std::string encoding) : encoding_(std::move(encoding)) {
    add(1, text("") + text("test"));
  }
  void channel(int number, const std::string& topic, const std::string& schema) {
    const auto id = static_cast<std::uint16_t>(number);
    add(3, raw(id) + text(schema) + text("any") + text(""));
    add(4, raw(id) + raw(id) + text(topic) + text(encoding_) + text(""));
  }
  void message(int number, std::int64_t ns, const std::string& bytes) {
    const auto time = static_cast<std::uint64_t>(ns);
    add(5,
        raw(static_cast<std::uint16_t>(number)) + raw(std::uint32_t{0}) + raw(time) + raw(time) +
            bytes);
  }
  std::string finished() {
    add(15, raw(std::uint32_t{0}));
    add(2, raw(std::uint64_t{0}) + raw(std::uint64_t{0}) + raw(std::uint32_t{0}));
    return kMagic + bytes_ + kMagic;
  }

 private:
  const std::string kMagic = "\x89MCAP0\r\n";

  static std::string text(const std::string& value) {
    return raw(static_cast<std::uint32_t>(value.size())) + value;
  }
  void add(char op, const std::string& content) {
    bytes_ += op + raw(static_cast<std::uint64_t>(content.size())) + content;
  }

  std::string encoding_;
  std::string bytes_;
};

std::string recording_of(bool json) {
  PlainMcap mcap(json ? "json" : "protobuf");
  mcap.channel(1, "/camera", "foxglove.CompressedImage");
  mcap.channel(2, "/calibration", "foxglove.CameraCalibration");
  mcap.channel(3, "/pose", "foxglove.PoseInFrame");
  mcap.channel(4, "/log", "foxglove.Log");
  mcap.message(2, kTime_ns, calibration(json));
  for (int i = 0; i < 5; ++i) {
    const std::int64_t ns = kTime_ns + i * 50'000'000LL;
    mcap.message(4, ns, "anything");
    mcap.message(1, ns + 7, compressed(json, ns, png_of(10 * i)));
    mcap.message(3, ns + 7, pose(json, ns, 0.25 * i));
  }
  return mcap.finished();
}

class Foxglove : public RecordingFolder, public testing::WithParamInterface<bool> {};
INSTANTIATE_TEST_SUITE_P(Encodings, Foxglove, testing::Bool(), [](const auto& info) {
  return info.param ? "json" : "protobuf";
});

TEST_P(Foxglove, OpensAsARecordingWithCalibrationAndTruth) {
  folder.write("a.mcap", recording_of(GetParam()));
  const auto recording = open();
  ASSERT_EQ(recording->frame_count(), 5);
  EXPECT_EQ(recording->timestamps_ns[3], kTime_ns + 150'000'000);
  EXPECT_EQ(int(recording->images->bgr(3).at<cv::Vec3b>(5, 5)[0]), 30);
  EXPECT_EQ(recording->camera.fy, 61);
  EXPECT_EQ(recording->camera.coefficients, (std::vector<double>{0.1, -0.02, 0, 0}));
  ASSERT_TRUE(recording->truth && recording->truth->poses[3]);
  EXPECT_LT((recording->truth->poses[3]->p_wc - Eigen::Vector3d(0.75, 0.5, 0)).norm(), 1e-12);
  EXPECT_NEAR(recording->truth->poses[3]->R_wc(0, 0), 0.28, 1e-12);
}

TEST_P(Foxglove, IsRefusedWithTheTopicIfAMessageIsBroken) {
  PlainMcap mcap(GetParam() ? "json" : "protobuf");
  mcap.channel(1, "/camera", "foxglove.CompressedImage");
  mcap.message(1, kTime_ns, GetParam() ? "{\"data\": " : "\x12\xFF\xFF");
  folder.write("a.mcap", mcap.finished());
  EXPECT_THAT(error(),
              HasSubstr("a.mcap: /camera: broken message, expected foxglove.CompressedImage"));
}

using FoxgloveImages = RecordingFolder;

TEST_F(FoxgloveImages, AreReadAtOpeningOnlyUpToTheirTimes) {
  const std::string data(10'000, 'p');
  PlainMcap mcap("protobuf");
  mcap.channel(1, "/camera", "foxglove.CompressedImage");
  for (int i = 0; i < 3; ++i)
    mcap.message(1, 5, timestamp(kTime_ns + i) + delimited(2, data) + delimited(4, "cam"));
  folder.write("a.mcap", mcap.finished());
  const Bag bag = open_recorded_bag(find_bag_files(folder.path() / "a.mcap"), {});
  EXPECT_LT(bag.read(bag.messages[1], kMostSmallBytes).size(), 100U);
  EXPECT_GT(bag.read(bag.messages[1], kWholeMessage).size(), data.size());
  const BagContents contents = read_contents(bag, topic_roles(bag, {}), {});
  EXPECT_EQ(contents.image_times_ns,
            (std::vector<std::int64_t>{kTime_ns, kTime_ns + 1, kTime_ns + 2}));
  EXPECT_EQ(contents.camera_frame, "cam");
}

TEST(FoxgloveRawImage, IsConvertedInItsEncoding) {
  const std::string pixels(12, 'p');
  const std::string bytes = timestamp(kTime_ns) + fixed32(2, 4) + fixed32(3, 3) +
                            delimited(4, "mono8") + fixed32(5, 4) + delimited(6, pixels) +
                            delimited(7, "cam");
  const auto made = converted_foxglove(bytes, "foxglove.RawImage", MessageEncoding::protobuf);
  ASSERT_TRUE(made);
  const auto image = read_image(*made, MessageEncoding::cdr);
  ASSERT_TRUE(image);
  EXPECT_EQ(image->header.stamp_ns, kTime_ns);
  EXPECT_EQ(image->header.frame_id, "cam");
  EXPECT_EQ(cv::Size(int(image->width), int(image->height)), cv::Size(4, 3));
  EXPECT_EQ(image->data, pixels);
  for (std::size_t size = 1; size < bytes.size(); ++size)
    EXPECT_NO_THROW(
        converted_foxglove(bytes.substr(0, size), "foxglove.RawImage", MessageEncoding::protobuf));
  EXPECT_FALSE(converted_foxglove(bytes, "foxglove.Log", MessageEncoding::protobuf));
}

TEST(FoxgloveMessagesOfRos, AreConvertedInTheOrderOfTheirFields) {
  // foxglove_msgs/CompressedImage in CDR: timestamp, frame_id, data, format.
  std::string bytes("\0\1\0\0", 4);
  bytes += raw(std::int32_t{7}) + raw(std::uint32_t{8}) + raw(std::uint32_t{4}) +
           std::string("cam\0", 4) + raw(std::uint32_t{3}) + "abc" + '\0' + raw(std::uint32_t{4}) +
           std::string("png\0", 4);
  const auto made =
      converted_foxglove(bytes, "foxglove_msgs/CompressedImage", MessageEncoding::cdr);
  ASSERT_TRUE(made);
  EXPECT_EQ(read_compressed_image(*made, MessageEncoding::cdr), "abc");
  EXPECT_EQ(read_header(*made, MessageEncoding::cdr)->stamp_ns, 7'000'000'008);
}

}  // namespace
}  // namespace gpo::test
