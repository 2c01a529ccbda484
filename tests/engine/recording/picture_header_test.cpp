// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/picture_header.h"

#include "engine/recording/picture_files.h"
#include "test_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace gpo {
namespace {

using test::error_of;
using test::TestFolder;
using testing::HasSubstr;

class PictureHeaders : public testing::TestWithParam<const char*> {};

TEST_P(PictureHeaders, SayWhatOpenCvDecodes) {
  const TestFolder folder;
  const cv::Mat picture(46, 62, CV_8UC3, cv::Scalar(10, 100, 200));
  const auto file = folder.write(std::string("1") + GetParam(), picture);
  const auto header = read_picture_header(folder.read(file.filename()));
  ASSERT_TRUE(header);
  EXPECT_EQ(header->width, 62);
  EXPECT_EQ(header->height, 46);
  EXPECT_EQ(header->bits, 8);
  EXPECT_EQ(read_picture(file).size(), cv::Size(62, 46));
}

INSTANTIATE_TEST_SUITE_P(All,
                         PictureHeaders,
                         testing::Values(".png", ".jpg", ".bmp", ".ppm", ".tiff", ".webp"));

TEST(PictureHeader, HugePicturesAreRefusedBeforeTheyAreDecoded) {
  const TestFolder folder;
  const auto error = [&](const std::string& bytes) {
    return error_of([&] { read_picture(folder.write("1.pgm", bytes)); });
  };
  EXPECT_THAT(error("P2 99999 99999 255\n0 0 0"),
              HasSubstr("1.pgm: found a picture of 99999x99999, expected at most 64 million"));
  EXPECT_THAT(error("P2 9999 9999 255\n0 0 0"), HasSubstr("at most 64 million pixels"));
  EXPECT_THAT(error(std::string("II*\0\x08\0\0\0\x01\0\0\x01\x04\0\x01\0\0\0\xFF\xFF\xFF\xFF", 22)),
              HasSubstr("cannot be decoded"));
  EXPECT_THAT(error("/* XPM */ static char * x[]"), HasSubstr("cannot be decoded"));
}

}  // namespace
}  // namespace gpo
