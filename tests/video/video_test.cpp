// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/images/images.h"
#include "tests/engine/recording/images/made_video.h"
#include "tests/engine/test_folder.h"

#include <gmock/gmock.h>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

namespace gpo {
namespace {

namespace fs = std::filesystem;
using test::error_of, test::make_video, test::TestFolder, testing::ElementsAre, testing::HasSubstr;

/// Returns images of a moving disc, so that all frames differ.
std::vector<cv::Mat> moving(int count, cv::Size size = {96, 64}) {
  std::vector<cv::Mat> images;
  for (int i = 0; i < count; ++i) {
    cv::Mat image(size, CV_8UC3, cv::Scalar(40, 90, 10));
    cv::circle(image, {(7 * i) % size.width, (3 * i) % size.height}, 12, {200, 30, 220}, -1);
    images.push_back(image);
  }
  return images;
}

/// Reads a file with OpenCV, from beginning to end.
std::vector<cv::Mat> by_opencv(const fs::path& file) {
  cv::VideoCapture capture(file.string(), cv::CAP_FFMPEG);
  std::vector<cv::Mat> frames;
  for (cv::Mat frame; capture.read(frame);) frames.push_back(frame.clone());
  return frames;
}

bool is_same(VideoDecoder& decoder, int frame, const cv::Mat& image) {
  return cv::norm(decoder.decode(frame), image, cv::NORM_INF) == 0;
}

void expect_same_in_any_order(const fs::path& file, int frames) {
  const auto expected = by_opencv(file);
  ASSERT_EQ(static_cast<int>(expected.size()), frames);
  VideoDecoder decoder(file);
  ASSERT_EQ(static_cast<int>(decoder.index().times.size()), frames);
  const auto same = [&](int frame) { return is_same(decoder, frame, expected[frame]); };
  for (int i = 0; i < frames; ++i) ASSERT_TRUE(same(i)) << "forward, " << i;
  for (int i = frames - 1; i >= 0; --i) ASSERT_TRUE(same(i)) << "backward, " << i;
  for (int i = 0; i < 150; ++i) ASSERT_TRUE(same(i * 37 % frames)) << "jump to " << i * 37 % frames;
}

TEST(VideoDecoder, GivesOpenCvsPixelsInAnyOrderWithAndWithoutBFrames) {
  const TestFolder folder;
  const auto images = moving(61);
  for (const bool b_frames : {false, true})
    for (const char* name : {"a.mp4", "a.avi", "a.mkv", "a.mov"}) {
      SCOPED_TRACE(name);
      make_video(folder.path() / name, images, {.b_frames = b_frames});
      expect_same_in_any_order(folder.path() / name, 61);
    }
}

TEST(VideoDecoder, GivesOpenCvsPixelsOfRealVideos) {
  for (const char* name : {"chessboard-floor", "chessboard-dark", "painting", "postcard"}) {
    SCOPED_TRACE(name);
    const auto file = fs::path(GPO_SHARED_DIR) / "data" / name / "video.mp4";
    if (!fs::exists(file)) GTEST_SKIP() << "no recordings in " << GPO_SHARED_DIR;
    cv::VideoCapture capture(file.string(), cv::CAP_FFMPEG);
    VideoDecoder sequential(file);
    const int frames = static_cast<int>(sequential.index().times.size());
    std::map<int, cv::Mat> some;
    cv::Mat expected;
    int frame = 0;
    for (; capture.read(expected); ++frame) {
      ASSERT_TRUE(is_same(sequential, frame, expected)) << frame;
      if (frame % 17 == 5) some[frame] = expected.clone();
    }
    EXPECT_EQ(frame, frames);
    VideoDecoder jumping(file);
    for (auto last = some.rbegin(); last != some.rend(); ++last)
      EXPECT_TRUE(is_same(jumping, last->first, last->second));
  }
}

TEST(VideoDecoder, DecodesFramesAroundABrokenOne) {
  const TestFolder folder;
  make_video(folder.path() / "whole.mkv", moving(40));
  const std::string bytes = folder.read("whole.mkv");
  folder.write("broken.mkv", std::string(bytes).replace(bytes.size() / 2, 3000, 3000, '\0'));
  const auto expected = by_opencv(folder.path() / "whole.mkv");
  VideoDecoder decoder(folder.path() / "broken.mkv");
  const int frames = static_cast<int>(decoder.index().times.size());
  EXPECT_LT(frames, 40);
  for (int repeat = 0; repeat < 2; ++repeat) {
    EXPECT_TRUE(is_same(decoder, frames - 1, expected.back()));
    EXPECT_TRUE(is_same(decoder, 3, expected[3]));
    for (int i = 0; i < frames; ++i)
      EXPECT_THAT(error_of([&] { decoder.decode(i); }),
                  testing::AnyOf("no error", HasSubstr("broken.mkv: frame ")));
  }
}

TEST(VideoFile, ReadsVariableTimesFromTheContainer) {
  const TestFolder folder;
  for (const char* name : {"v.mkv", "v.mp4"}) {
    make_video(folder.path() / name, moving(5), {.times_ms = {0, 33, 71, 300, 334}});
    Camera camera;
    const auto video = open_video(folder.path() / name, camera, 1 << 20);
    EXPECT_THAT(video.timestamps_ns, ElementsAre(0, 33000000, 71000000, 300000000, 334000000));
    EXPECT_EQ(cv::Size(camera.width, camera.height), cv::Size(96, 64));
  }
}

/// OpenCV 4.6 rotates in the wrong direction (its issue 22088).
TEST(VideoFile, RotatesImagesByThePhonesOrientation) {
  const TestFolder folder;
  const auto images = moving(3);
  make_video(folder.path() / "plain.mp4", images);
  VideoDecoder plain(folder.path() / "plain.mp4");
  for (const auto& [degrees, code] : {std::pair(90, cv::ROTATE_90_CLOCKWISE),
                                      std::pair(180, cv::ROTATE_180),
                                      std::pair(270, cv::ROTATE_90_COUNTERCLOCKWISE)}) {
    const auto file = folder.path() / (std::to_string(degrees) + ".mp4");
    make_video(file, images, {.clockwise_degrees = degrees});
    VideoDecoder turned(file);
    cv::Mat expected;
    cv::rotate(plain.decode(1), expected, code);
    ASSERT_EQ(turned.index().size, expected.size());
    EXPECT_TRUE(is_same(turned, 1, expected)) << degrees;
  }
}

/// Times of some frames, 40 ms apart.
std::vector<int> times_from(int first_ms, int count) {
  std::vector<int> times;
  for (int i = 0; i < count; ++i) times.push_back(first_ms + 40 * i);
  return times;
}

TEST(VideoFile, OpensATrimmedVideoWithItsShownFrames) {
  const TestFolder folder;
  const auto file = folder.path() / "trimmed.mp4";
  const auto images = moving(61);
  for (const bool b_frames : {false, true}) {
    make_video(file, images, {.b_frames = b_frames, .times_ms = times_from(-13 * 40, 61)});
    Camera camera;
    const auto video = open_video(file, camera, 1 << 20);
    const auto expected = by_opencv(file);
    ASSERT_EQ(expected.size(), 48U);
    ASSERT_EQ(video.images->count(), 48);
    EXPECT_EQ(video.timestamps_ns.back(), 47 * 40'000'000LL);
    for (const int frame : {47, 0, 20})
      EXPECT_EQ(cv::norm(video.images->bgr(frame), expected[frame], cv::NORM_INF), 0) << frame;
  }
}

TEST(VideoFile, OpensAVideoWhoseImagesBeginLate) {
  const TestFolder folder;
  const auto file = folder.path() / "late.mkv";
  make_video(file, moving(50), {.times_ms = times_from(4000, 50)});
  Camera camera;
  const auto video = open_video(file, camera, 1 << 20);
  EXPECT_EQ(video.timestamps_ns.front(), 0);
  EXPECT_EQ(video.timestamps_ns.size(), 50U);
  EXPECT_NEAR(video.first_frame_s, 4, 1e-9);
  folder.cut("late.mkv", 0.5);
  EXPECT_THAT(error_of([&] { open_video(file, camera, 1 << 20); }),
              testing::ContainsRegex("late.mkv: found [0-9]+ frames .the file seems truncated., "
                                     "expected about [0-9]+"));
}

TEST(VideoFile, LeavesOutFramesWhoseReferencesWereCutOff) {
  const TestFolder folder;
  make_video(folder.path() / "whole.ts", moving(61));
  const std::string bytes = folder.read("whole.ts");
  const std::size_t packets = bytes.size() / 188;
  const auto expected = by_opencv(folder.path() / "whole.ts");
  for (const double part : {0.3, 0.45, 0.6}) {
    const auto file =
        folder.write("cut.ts", bytes.substr(188 * static_cast<std::size_t>(part * packets)));
    VideoDecoder decoder(file);
    const int count = static_cast<int>(decoder.index().times.size());
    ASSERT_GT(count, 10) << part;
    ASSERT_LT(count, 61) << part;
    for (int i = 0; i < count; ++i)
      EXPECT_TRUE(is_same(decoder, i, expected[expected.size() - count + i])) << part << ", " << i;
  }
}

TEST(VideoFile, DoesNotMirrorImagesForThePlayer) {
  const TestFolder folder;
  const auto images = moving(3);
  make_video(folder.path() / "plain.mp4", images);
  VideoDecoder plain(folder.path() / "plain.mp4");
  make_video(folder.path() / "front.mp4", images, {.mirrored = true});
  VideoDecoder front(folder.path() / "front.mp4");
  EXPECT_TRUE(front.index().mirrored);
  EXPECT_FALSE(plain.index().mirrored);
  EXPECT_TRUE(is_same(front, 1, plain.decode(1)));
  make_video(folder.path() / "upright.mp4", images, {.mirrored = true, .clockwise_degrees = 90});
  VideoDecoder upright(folder.path() / "upright.mp4");
  cv::Mat expected;
  cv::rotate(plain.decode(1), expected, cv::ROTATE_90_CLOCKWISE);
  EXPECT_TRUE(upright.index().mirrored);
  EXPECT_TRUE(is_same(upright, 1, expected));
}

TEST(VideoFile, KeepsTheDepthOfTheFullRange) {
  const TestFolder folder;
  // OpenCV converts white to 235, which is the white of the limited range only.
  const std::vector<cv::Mat> white(3, cv::Mat(64, 96, CV_8UC3, cv::Scalar::all(255)));
  for (const auto& [full, value] : {std::pair(false, 255), std::pair(true, 235)}) {
    const auto file = folder.path() / "range.mkv";
    make_video(file, white, {.b_frames = true, .full_range = full});
    VideoDecoder decoder(file);
    EXPECT_NEAR(decoder.decode(1).at<cv::Vec3b>(30, 40)[1], value, 1.5) << full;
  }
}

/// HDR images are reduced to 8 bits on their own curve.
TEST(VideoFile, KeepsTheGrayValuesOfWebmAndHdr) {
  const TestFolder folder;
  const std::vector<int> grays = {30, 80, 130, 180, 230};
  cv::Mat bands(64, 160, CV_8UC3);
  for (int k = 0; k < 5; ++k) bands.colRange(32 * k, 32 * k + 32) = cv::Scalar::all(grays[k]);
  for (const auto& [codec, pq] :
       {std::pair("libvpx", false), {"libvpx-vp9", false}, {"libvpx-vp9", true}}) {
    const auto file = folder.path() / "bands.webm";
    make_video(file, std::vector<cv::Mat>(4, bands), {.codec = codec, .pq = pq});
    VideoDecoder decoder(file);
    ASSERT_EQ(decoder.index().times.size(), 4U) << codec;
    for (int k = 0; k < 5; ++k)
      EXPECT_NEAR(decoder.decode(3).at<cv::Vec3b>(32, 32 * k + 16)[1], grays[k], 3) << codec << pq;
  }
}

TEST(VideoFile, OpensALongVideoWithoutDecodingIt) {
  const TestFolder folder;
  constexpr int kFrames = 20000;
  const auto images = moving(1, {32, 32});
  make_video(folder.path() / "long.mp4", std::vector<cv::Mat>(kFrames, images[0]));
  Camera camera;
  const auto video = open_video(folder.path() / "long.mp4", camera, 1 << 20);
  ASSERT_EQ(video.images->count(), kFrames);
  for (const int frame : {0, kFrames - 1, kFrames / 2, 7}) video.images->bgr(frame);
  EXPECT_LE(video.images->bytes(), std::size_t{1} << 20);
  double read = 0;
  const auto stop = [&](double share) {
    EXPECT_GE(share, read);
    read = share;
    if (share > 0.5) throw InputError("stopped");
  };
  make_video(folder.path() / "long.mkv", std::vector<cv::Mat>(kFrames, images[0]));
  EXPECT_EQ(error_of([&] { open_video(folder.path() / "long.mkv", camera, 0, stop); }), "stopped");
  EXPECT_LT(read, 1);
}

cv::Mat disc(int i) {
  cv::Mat image(48, 64, CV_8UC3, cv::Scalar(30, 60, 90));
  cv::circle(image, {8 + 4 * i, 24}, 6, {20, 200, 240}, cv::FILLED);
  return image;
}

TEST(VideoEncoder, WritesACompleteFileOrNone) {
  const TestFolder folder;
  const fs::path file = folder.path() / "a.mp4";
  {
    VideoEncoder video(file, 25, {64, 48});
    video.add(disc(0));
    EXPECT_FALSE(fs::exists(file));
  }
  EXPECT_TRUE(fs::is_empty(folder.path())) << "not finished";
  VideoEncoder video(file, 25, {64, 48});
  const auto finish_empty = [&] { VideoEncoder(folder.path() / "b.mp4", 25, {64, 48}).finish(); };
  EXPECT_THAT(error_of(finish_empty), HasSubstr("b.mp4: not written: there are no images"));
  video.add(disc(0));
  video.finish();
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 1);
}

TEST(VideoEncoder, OpenCvReadsItsVideos) {
  const TestFolder folder;
  constexpr int kFrames = 10;
  for (const double rate_hz : {25.0, 29.97, 12.5, 1.0, 240.0}) {
    const std::string file = (folder.path() / "a.mp4").string();
    VideoEncoder video(file, rate_hz, {64, 48});
    for (int i = 0; i < kFrames; ++i) video.add(disc(i));
    video.finish();
    cv::VideoCapture capture(file, cv::CAP_FFMPEG);
    EXPECT_NEAR(capture.get(cv::CAP_PROP_FPS), rate_hz, 1e-3 * rate_hz);
    int frames = 0;
    for (cv::Mat read; capture.read(read); ++frames) {
      ASSERT_EQ(read.size(), cv::Size(64, 48));
      const double difference = cv::norm(read, disc(frames), cv::NORM_L1) / (3 * 64 * 48);
      EXPECT_LT(difference, 4) << "frame " << frames << " at " << rate_hz << " Hz";
    }
    EXPECT_EQ(frames, kFrames);
  }
}

TEST(VideoEncoder, ReportsFilesAndImagesThatItCannotWrite) {
  const TestFolder folder;
  const auto open_nowhere = [] { VideoEncoder("/nowhere/at/all.mp4", 25, {64, 48}); };
  EXPECT_THAT(error_of(open_nowhere), HasSubstr("/nowhere/at/all.mp4: cannot be written"));
  const auto add_small = [&] {
    VideoEncoder(folder.path() / "a.mp4", 25, {64, 48}).add(cv::Mat(2, 2, CV_8UC3));
  };
  EXPECT_THAT(error_of(add_small), HasSubstr("size changed"));
}

TEST(VideoEncoder, RoundsSizesUpToEvenOnes) {
  EXPECT_EQ(even_size({639, 480}), cv::Size(640, 480));
}

}  // namespace
}  // namespace gpo
