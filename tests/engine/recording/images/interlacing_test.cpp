// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// The first fields of an interlaced video are used, whatever its stream declares.
#include "engine/recording/images/interlacing.h"

#include "engine/recording/images/images.h"
#include "tests/engine/recording/images/made_video.h"
#include "tests/engine/test_folder.h"
#include "tests/engine/tracking/texture.h"

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace gpo {
namespace {

using Eigen::Vector2d;

const Vector2d kMotion_px(5, 1.5);  // from frame to frame
constexpr int kMadeFrames = 20;

/// The texture at a time in frames, which moves by `motion_px` a frame.
cv::Mat scene(double time, const Vector2d& motion_px = kMotion_px) {
  cv::Mat bgr;
  const auto place = [&](const Vector2d& px) -> Vector2d { return 0.5 * (px - time * motion_px); };
  cv::cvtColor(test::image_of({160, 128}, place), bgr, cv::COLOR_GRAY2BGR);
  return bgr;
}

enum class Scan { progressive, top_first, bottom_first };

std::vector<cv::Mat> filmed(Scan scan, const Vector2d& motion_px = kMotion_px) {
  std::vector<cv::Mat> images;
  for (int i = 0; i < kMadeFrames; ++i) {
    cv::Mat& image = images.emplace_back(scene(i, motion_px));
    if (scan == Scan::progressive) continue;
    const cv::Mat later = scene(i + 0.5, motion_px);
    for (int y = scan == Scan::top_first ? 1 : 0; y < image.rows; y += 2)
      later.row(y).copyTo(image.row(y));
  }
  return images;
}

VideoFile open(const std::filesystem::path& file,
               const std::vector<cv::Mat>& images,
               const test::VideoOptions& options = {}) {
  test::make_video(file, images, options);
  Camera camera;
  return open_video(file, camera, 1 << 24);
}

/// Largest error of coding; rows of the other field would differ by more than 20.
constexpr double kMostError = 8;

/// RMS difference of the images to what the scene is at the frames' times.
double error_of(const VideoFile& video, int frame) {
  const cv::Mat expected = scene(frame), found = video.images->bgr(frame);
  const cv::Rect inner(8, 8, 144, 112);
  return cv::norm(found(inner), expected(inner)) / std::sqrt(3.0 * inner.area());
}

TEST(Interlacing, FirstFieldsAreUsedWithoutADeclaration) {
  const test::TestFolder folder;
  for (const auto& [scan, first] :
       {std::pair(Scan::top_first, "top"), std::pair(Scan::bottom_first, "bottom")})
    for (const char* name : {"a.avi", "a.mov"}) {
      const VideoFile video = open(folder.path() / name, filmed(scan));
      EXPECT_EQ(video.first_field, first) << name;
      for (const int frame : {0, 7, kMadeFrames - 1})
        EXPECT_LT(error_of(video, frame), kMostError) << frame;
    }
}

TEST(Interlacing, FirstFieldsAreUsedIfDeclaredAsTheyAreAndOtherwise) {
  const test::TestFolder folder;
  for (const bool top_first : {true, false})
    for (const bool declared : {true, false})
      EXPECT_EQ(open(folder.path() / "a.ts",
                     filmed(top_first ? Scan::top_first : Scan::bottom_first),
                     {.top_field_first = declared})
                    .first_field,
                top_first ? "top" : "bottom");
}

TEST(Interlacing, ProgressiveImagesStayWholeWhateverIsDeclared) {
  const test::TestFolder folder;
  const auto images = filmed(Scan::progressive);
  for (const bool top_first : {true, false}) {
    const VideoFile video = open(folder.path() / "a.ts", images, {.top_field_first = top_first});
    EXPECT_EQ(video.first_field, "");
    EXPECT_LT(error_of(video, 7), kMostError);
  }
  EXPECT_EQ(open(folder.path() / "a.avi", images).first_field, "");
}

TEST(Interlacing, ACameraAtRestKeepsAllRows) {
  const test::TestFolder folder;
  const auto images = filmed(Scan::top_first, Vector2d::Zero());
  EXPECT_EQ(open(folder.path() / "a.ts", images, {.top_field_first = true}).first_field, "");
}

TEST(Interlacing, FieldsAreThoseOfTheStoredImageOfARotatedVideo) {
  const test::TestFolder folder;
  for (const int degrees : {90, 180, 270}) {
    const VideoFile video =
        open(folder.path() / "a.mov", filmed(Scan::top_first), {.clockwise_degrees = degrees});
    EXPECT_EQ(video.first_field, "top") << degrees;
    cv::Mat stored;
    cv::rotate(video.images->bgr(7), stored, 3 - degrees / 90);
    const cv::Rect inner(8, 8, 144, 112);
    EXPECT_LT(cv::norm(stored(inner), scene(7)(inner)) / std::sqrt(3.0 * inner.area()), kMostError);
  }
}

TEST(Interlacing, VerticalMotionIsRecognized) {
  const test::TestFolder folder;
  EXPECT_EQ(open(folder.path() / "a.avi", filmed(Scan::bottom_first, {0, 4})).first_field,
            "bottom");
}

TEST(Interlacing, FirstFieldKeepsItsRowsAndInterpolatesTheOthersInPlace) {
  cv::Mat ramp(12, 3, CV_8UC3);  // brightness is 10 times the row
  for (int y = 0; y < ramp.rows; ++y) ramp.row(y) = cv::Scalar::all(10 * y);
  for (const auto& [order, first] :
       {std::pair(FieldOrder::top_first, 0), std::pair(FieldOrder::bottom_first, 1)}) {
    cv::Mat frame = ramp.clone();
    for (int y = 1 - first; y < ramp.rows; y += 2) frame.row(y) = cv::Scalar::all(255);
    const cv::Mat image = first_field(frame, order);
    ASSERT_EQ(image.size(), frame.size());
    EXPECT_EQ(cv::norm(image.rowRange(4, 8), ramp.rowRange(4, 8), cv::NORM_INF), 0) << first;
    for (int y = first; y < ramp.rows; y += 2)
      EXPECT_EQ(cv::norm(image.row(y), ramp.row(y), cv::NORM_INF), 0) << y;
    // The other field is gone.
    EXPECT_LE(image.at<cv::Vec3b>(1 - first, 0)[0], 25) << first;
  }
}

}  // namespace
}  // namespace gpo
