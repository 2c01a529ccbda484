// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/files/image_codec.h"
#include "engine/files/text_file.h"
#include "engine/recording/images/images.h"
#include "tests/engine/recording/images/made_video.h"

#include <filesystem>

#include <gmock/gmock.h>
#include <opencv2/imgcodecs.hpp>
#include <zlib.h>

namespace gpo {
namespace {

namespace fs = std::filesystem;
using test::big_endian;

/// Returns a smooth image with noise, so that all filters of PNG and all bits matter.
cv::Mat made_image(int type) {
  cv::Mat image(46, 61, type);
  cv::RNG random(7);
  random.fill(image, cv::RNG::UNIFORM, 0, image.depth() == CV_8U ? 40 : 9000);
  for (int row = 0; row < image.rows; ++row)
    image.row(row) += cv::Scalar::all(4.0 * row * (image.depth() == CV_8U ? 1 : 250));
  return image;
}

std::string opencv_encoded(const char* ending,
                           const cv::Mat& image,
                           const std::vector<int>& parameters = {}) {
  std::vector<unsigned char> bytes;
  cv::imencode(ending, image, bytes, parameters);
  return {bytes.begin(), bytes.end()};
}

cv::Mat opencv_decoded(const std::string& bytes) {
  return cv::imdecode(std::vector<char>(bytes.begin(), bytes.end()),
                      cv::IMREAD_COLOR | cv::IMREAD_ANYDEPTH);
}

void expect_same(const cv::Mat& found, const cv::Mat& expected) {
  ASSERT_FALSE(expected.empty());
  ASSERT_EQ(found.size(), expected.size());
  ASSERT_EQ(found.type(), expected.type());
  EXPECT_EQ(cv::norm(found, expected, cv::NORM_INF), 0);
}

/// Inserts a segment with the orientation of a camera that was turned.
std::string turned(const std::string& jpeg, char orientation) {
  const std::string tiff =
      std::string("II*\0\x08\0\0\0\x01\0\x12\x01\x03\0\x01\0\0\0", 18) + orientation;
  const std::string content = std::string("Exif\0\0", 6) + tiff + std::string(7, '\0');
  return jpeg.substr(0, 2) + "\xFF\xE1" + big_endian({std::ssize(content) + 2}, 2) + content +
         jpeg.substr(2);
}

std::string png_chunk(const std::string& kind, const std::string& content) {
  const std::string summed = kind + content;
  const auto sum = static_cast<std::int64_t>(
      crc32_z(0, reinterpret_cast<const Bytef*>(summed.data()), summed.size()));
  return big_endian({std::ssize(content)}, 4) + summed + big_endian({sum}, 4);
}

/// Returns a PNG of 4x1 pixels; `row` are its bytes.
std::string small_png(char bits, char color, const std::string& chunks, const std::string& row) {
  const std::string header = big_endian({4, 1}, 4) + bits + color + std::string(3, '\0');
  const std::string raw = '\0' + row;
  std::string packed(compressBound(raw.size()), '\0');
  uLongf size = packed.size();
  compress(reinterpret_cast<Bytef*>(packed.data()),
           &size,
           reinterpret_cast<const Bytef*>(raw.data()),
           raw.size());
  packed.resize(size);
  return "\x89PNG\r\n\x1A\n" + png_chunk("IHDR", header) + chunks + png_chunk("IDAT", packed) +
         png_chunk("IEND", "");
}

TEST(ImageCodec, WritesAndReadsPngsLikeOpenCv) {
  for (const int type : {CV_8UC1, CV_8UC3, CV_8UC4, CV_16UC1, CV_16UC3, CV_16UC4}) {
    SCOPED_TRACE(type);
    const std::string bytes = encode_png(made_image(type));
    expect_same(opencv_decoded(bytes), opencv_decoded(opencv_encoded(".png", made_image(type))));
    expect_same(decode_png(bytes), opencv_decoded(bytes));
  }
}

TEST(ImageCodec, ReadsPalettesFewBitsAndTransparencyLikeOpenCv) {
  const std::string palette = png_chunk("PLTE", "\x10\x20\x30\xFF\x01\x02\x7F\x80\x81");
  const std::string clear = png_chunk("tRNS", std::string("\x00\x80", 2));
  const std::string indices("\2\1\0\1", 4);
  for (const std::string& bytes :
       {small_png(8, 3, palette, indices),
        small_png(8, 3, palette + clear, indices),
        small_png(2, 3, palette + clear, "\x91"),
        small_png(1, 0, "", "\xA0"),
        small_png(4, 0, "", "\x1F\x73"),
        small_png(8, 0, png_chunk("tRNS", std::string("\0\x40", 2)), "@ABC"),
        small_png(8, 4, "", "a\1b\2c\3d\4"),
        small_png(8, 2, "", "abcdefghijkl")})
    expect_same(decode_png(bytes), opencv_decoded(bytes));
}

TEST(ImageCodec, WritesAndReadsJpegsLikeOpenCv) {
  for (const int type : {CV_8UC1, CV_8UC3})
    for (const int quality : {30, 95}) {
      const cv::Mat image = made_image(type);
      const std::string bytes = encode_jpeg(image, quality);
      const std::string other = opencv_encoded(
          ".jpg", image, {cv::IMWRITE_JPEG_QUALITY, quality, cv::IMWRITE_JPEG_PROGRESSIVE, 1});
      expect_same(decode_jpeg(bytes), opencv_decoded(bytes));
      expect_same(decode_jpeg(other), opencv_decoded(other));
      expect_same(decode_jpeg(bytes), decode_jpeg(other));
    }
}

// A calibration describes the sensor.
TEST(ImageCodec, DoesNotTurnImagesAsTheirMetadataSay) {
  const std::string jpeg = encode_jpeg(made_image(CV_8UC3), 90);
  for (char orientation = 1; orientation <= 8; ++orientation) {
    SCOPED_TRACE(int{orientation});
    expect_same(decode_image(turned(jpeg, orientation), "turned"), opencv_decoded(jpeg));
  }
}

TEST(ImageCodec, ReturnsNoImageOfBrokenBytes) {
  const std::string png = encode_png(made_image(CV_8UC3)),
                    jpeg = encode_jpeg(made_image(CV_8UC3), 90);
  EXPECT_TRUE(decode_png(png.substr(0, png.size() / 2)).empty());
  EXPECT_TRUE(decode_png(jpeg).empty());
  EXPECT_TRUE(decode_jpeg(jpeg.substr(0, jpeg.size() / 2)).empty());
  EXPECT_TRUE(decode_jpeg(png).empty());
}

TEST(ImageCodec, ReadsTheExampleRecordingLikeOpenCv) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(GPO_SOURCE_DIR "/sequences"))
    if (is_image_name(entry.path())) files.push_back(entry.path());
  EXPECT_GE(files.size(), 30U);
  for (const fs::path& file : files) {
    SCOPED_TRACE(file);
    expect_same(read_image(file), opencv_decoded(read_file(file)));
  }
}

}  // namespace
}  // namespace gpo
