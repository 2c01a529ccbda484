// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/images/images.h"
#include "tests/engine/recording/images/made_video.h"
#include "tests/engine/test_folder.h"

#include <gmock/gmock.h>
#include <zlib.h>

namespace gpo::test {
namespace {

using testing::HasSubstr;

TEST(ImageHeader, AgreesWithOpenCv) {
  const TestFolder folder;
  for (const char* ending : {".png", ".jpg", ".bmp", ".ppm", ".tiff", ".webp"}) {
    const cv::Mat image(46, 62, CV_8UC3, cv::Scalar(10, 100, 200));
    const auto file = folder.write(std::string("1") + ending, image);
    const auto header = read_image_header(folder.read(file.filename()));
    ASSERT_TRUE(header) << ending;
    EXPECT_EQ(cv::Size(int(header->width), int(header->height)), cv::Size(62, 46)) << ending;
    EXPECT_EQ(header->bits, 8) << ending;
    EXPECT_EQ(read_image(file).size(), cv::Size(62, 46)) << ending;
  }
}

TEST(ImageHeader, RefusesHugeImagesWithoutDecoding) {
  const TestFolder folder;
  const auto error = [&](const std::string& bytes) {
    return error_of([&] { read_image(folder.write("1.pgm", bytes)); });
  };
  EXPECT_THAT(error("P2 99999 99999 255\n0 0 0"),
              HasSubstr("1.pgm: found an image of 99999x99999, expected at most 64 million"));
  EXPECT_THAT(error("P2 9999 9999 255\n0 0 0"), HasSubstr("at most 64 million pixels"));
  EXPECT_THAT(error(std::string("II*\0\x08\0\0\0\x01\0\0\x01\x04\0\x01\0\0\0\xFF\xFF\xFF\xFF", 22)),
              HasSubstr("cannot decode"));
  EXPECT_THAT(error("/* XPM */ static char * x[]"), HasSubstr("cannot decode"));
}

std::string png_chunk(const std::string& kind, const std::string& content) {
  const std::string summed = kind + content;
  const auto* start = reinterpret_cast<const Bytef*>(summed.data());
  const auto sum = static_cast<std::int64_t>(crc32(0, start, static_cast<uInt>(summed.size())));
  return big_endian({std::ssize(content)}, 4) + summed + big_endian({sum}, 4);
}

TEST(ImageFile, RemovesChunksThatLibpngWarnsAbout) {
  const TestFolder folder;
  const cv::Mat image(46, 62, CV_8UC3, cv::Scalar(10, 100, 200));
  std::string bytes = folder.read(folder.write("1.png", image).filename());
  constexpr std::size_t kFirst = 8 + 25;  // after IHDR
  bytes.insert(kFirst, png_chunk("iCCP", "a profile that is none") + png_chunk("gAMA", "?"));
  const auto file = folder.write("2.png", bytes);
  testing::internal::CaptureStderr();
  EXPECT_EQ(cv::norm(read_image(file), image, cv::NORM_INF), 0);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace gpo::test
