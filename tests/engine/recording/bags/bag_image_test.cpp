// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// Layouts of pixels that drivers send, made from the formulas of their colors.
#include "engine/recording/bags/messages.h"
#include "tests/engine/test_folder.h"

#include <gmock/gmock.h>

namespace gpo::test {
namespace {

constexpr int kImageColumns = 16, kImageRows = 12;
const cv::Vec3d kOrange(30, 120, 220);  // blue, green, red

/// BT.601 with the limited range, as the drivers' cameras send it.
struct Yuv {
  char y, u, v;
};
Yuv yuv_of(const cv::Vec3d& bgr) {
  const double luma = 0.299 * bgr[2] + 0.587 * bgr[1] + 0.114 * bgr[0];
  const auto byte = [](double value) { return static_cast<char>(std::lround(value)); };
  return {byte(16 + luma * 219 / 255),
          byte(128 + (bgr[0] - luma) / 1.772 * 224 / 255),
          byte(128 + (bgr[2] - luma) / 1.402 * 224 / 255)};
}

std::string text_repeated(const std::string& pattern, int times) {
  std::string all;
  for (int i = 0; i < times; ++i) all += pattern;
  return all;
}

ImageMessage raw_image_message(const std::string& encoding,
                               std::uint32_t step,
                               const std::string& data) {
  ImageMessage message;
  message.header = {1, "camera"};
  message.height = kImageRows;
  message.width = kImageColumns;
  message.encoding = encoding;
  message.step = step;
  message.data = data;
  return message;
}

cv::Mat decoded(const ImageMessage& message) {
  const MessageEncoding encoding = MessageEncoding::cdr;
  return bag_image(
      image_bytes(message, encoding), {"/camera", "sensor_msgs/Image", encoding, 1}, "camera");
}

void expect_orange(const cv::Mat& image) {
  ASSERT_EQ(image.size(), cv::Size(kImageColumns, kImageRows));
  for (const cv::Point at : {cv::Point(0, 0), cv::Point(15, 11), cv::Point(7, 6)})
    EXPECT_LT(cv::norm(cv::Vec3d(image.at<cv::Vec3b>(at)) - kOrange, cv::NORM_INF), 4) << at;
}

TEST(PixelLayouts, DecodeColorDifferences) {
  const auto [y, u, v] = yuv_of(kOrange);
  const std::string yuyv = {y, u, y, v}, uyvy = {u, y, v, y};
  const std::string luma(kImageColumns * kImageRows, y);
  const auto below = [&](char first, char second) {
    return luma + text_repeated({first, second}, kImageColumns * kImageRows / 4);
  };
  for (const char* name : {"yuyv", "yuv422_yuy2"})
    expect_orange(decoded(raw_image_message(
        name, 2 * kImageColumns, text_repeated(yuyv, kImageColumns * kImageRows / 2))));
  for (const char* name : {"uyvy", "yuv422"})
    expect_orange(decoded(raw_image_message(
        name, 2 * kImageColumns, text_repeated(uyvy, kImageColumns * kImageRows / 2))));
  expect_orange(decoded(raw_image_message("nv12", kImageColumns, below(u, v))));
  expect_orange(decoded(raw_image_message("nv21", kImageColumns, below(v, u))));
}

TEST(PixelLayouts, MayHavePaddedRowsAndTrailingBytes) {
  const auto [y, u, v] = yuv_of(kOrange);
  const std::string padding(5, '\xAA');
  const std::string row = text_repeated({char(30), char(120), char(220)}, kImageColumns) + padding;
  expect_orange(decoded(raw_image_message(
      "bgr8", 3 * kImageColumns + 5, text_repeated(row, kImageRows) + std::string(777, 'x'))));
  const std::string luma = std::string(kImageColumns, y) + padding;
  const std::string colors = text_repeated({u, v}, kImageColumns / 2) + padding;
  expect_orange(decoded(raw_image_message(
      "nv12",
      kImageColumns + 5,
      text_repeated(luma, kImageRows) + text_repeated(colors, kImageRows / 2) + padding)));
}

TEST(PixelLayouts, DecodeBayerWithSixteenBits) {
  // Red, green / green, blue; little-endian.
  const auto row = [](int even, int odd) {
    const std::string pair = {char(even & 255), char(even >> 8), char(odd & 255), char(odd >> 8)};
    return text_repeated(pair, kImageColumns / 2);
  };
  const cv::Mat image =
      decoded(raw_image_message("bayer_rggb16",
                                2 * kImageColumns,
                                text_repeated(row(2200, 1200) + row(1200, 300), kImageRows / 2)));
  ASSERT_EQ(image.type(), CV_16UC3);
  EXPECT_EQ(image.at<cv::Vec3w>(6, 6), cv::Vec3w(300, 1200, 2200));
}

TEST(PixelLayouts, AreRefusedWithTheSizesIfBytesAreMissing) {
  const std::string data(kImageColumns * kImageRows, 'y');
  EXPECT_THAT(error_of([&] { decoded(raw_image_message("nv12", kImageColumns, data)); }),
              testing::HasSubstr("found 192 bytes in rows of 16, expected an image of 16x12 nv12"));
}

CameraInfoMessage info_with(const std::string& model, const std::vector<double>& D) {
  CameraInfoMessage info;
  info.width = 640;
  info.height = 480;
  info.distortion_model = model;
  info.D = D;
  info.K.assign(9, 0);
  return info;
}

TEST(CameraInfo, TakesAMatrixOfZerosFromTheRectifiedCamera) {
  CameraInfoMessage info = info_with("plumb_bob", std::vector<double>(5, 0));
  info.P.assign(12, 0);
  EXPECT_FALSE(is_calibrated(info));
  info.K[8] = 1;
  EXPECT_FALSE(is_calibrated(info));
  info.P = {500, 0, 322, 0, 0, 501, 237, 0, 0, 0, 1, 0};
  EXPECT_TRUE(is_calibrated(info) && lacks_matrix(info));
  const auto read =
      read_camera_info(camera_info_bytes(info, MessageEncoding::cdr), MessageEncoding::cdr);
  ASSERT_TRUE(read);
  const Camera camera = camera_of(*read, "info");
  EXPECT_EQ(camera, (Camera{640, 480, 500, 501, 322, 237, Distortion::none, {}}));
}

TEST(CameraInfo, KeepsAFisheyeWithoutDistortion) {
  CameraInfoMessage info = info_with("equidistant", {0, 0, 0, 0});
  info.K = {300, 0, 320, 0, 300, 240, 0, 0, 1};
  EXPECT_EQ(camera_of(info, "info").distortion, Distortion::equidistant);
  EXPECT_EQ(camera_of(info, "info").coefficients, std::vector<double>(4, 0));
  info.D.clear();
  EXPECT_EQ(camera_of(info, "info").coefficients, std::vector<double>(4, 0));
  info.distortion_model = "plumb_bob";
  EXPECT_EQ(camera_of(info, "info").distortion, Distortion::none);
}

}  // namespace
}  // namespace gpo::test
