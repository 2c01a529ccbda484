// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/layouts/open_recording.h"
#include "tests/app/program.h"
#include "tests/engine/recording/images/made_video.h"
#include "tests/live/sender.h"

#include <gmock/gmock.h>
#include <opencv2/imgproc.hpp>

namespace gpo::test {
namespace {

using testing::HasSubstr;

const cv::Size kSmall(160, 128);

double mean_difference(const cv::Mat& a, const cv::Mat& b) {
  return cv::norm(a, b, cv::NORM_L1) / static_cast<double>(a.total() * 3);
}

TEST(Record, WritesAStreamThatAnotherProgramSends) {
  const fs::path folder = fresh_folder();
  const auto sent = moving_images(40, kSmall);
  make_video(folder / "sent.ts", sent);
  const std::string stream = read_file(folder / "sent.ts");
  HttpSender sender([&](const Client& client, int number) {
    if (number == 0) client.send(http_head("video/mp2t") + stream);
  });
  const Outcome outcome =
      succeeding("record {} --output {} --seconds 1.5", sender.address(), folder / "euroc");
  EXPECT_THAT(outcome.out, HasSubstr(" frames, 160x128, 1.5 s, 0 dropped"));
  const auto recording = open_recording(folder / "euroc");
  ASSERT_GE(recording->frame_count(), 37);
  EXPECT_EQ(recording->camera_source, CameraSource::guess);
  for (int i = 0; i < recording->frame_count(); ++i) {
    EXPECT_LT(mean_difference(recording->images->bgr(i), sent[i]), 6) << i;
    EXPECT_EQ(recording->timestamps_ns[i] - recording->timestamps_ns[0], i * 40'000'000LL);
  }
}

TEST(Record, WritesABagOfARecordingThatItPlays) {
  const fs::path folder = fresh_folder();
  make_video(folder / "played.avi", moving_images(12, kSmall));
  succeeding("record {} --output {}", folder / "played.avi", folder / "out.mcap");
  const auto recording = open_recording(folder / "out.mcap");
  EXPECT_EQ(recording->frame_count(), 12);
  EXPECT_EQ(recording->timestamps_ns[11] - recording->timestamps_ns[0], 11 * 40'000'000LL);
}

TEST(Record, GivesABagAFolderOfItsOwnBesideABagOfAnotherCamera) {
  const fs::path folder = fresh_folder();
  make_video(folder / "small.avi", moving_images(12, kSmall));
  make_video(folder / "large.avi", moving_images(12, kSmall * 2));
  fs::create_directory(folder / "out");
  succeeding("record {} --output {}", folder / "small.avi", folder / "out" / "a.mcap");
  const Outcome outcome =
      succeeding("record {} --output {}", folder / "large.avi", folder / "out" / "b.mcap");
  EXPECT_THAT(outcome.err, HasSubstr("camera.yaml: belongs to another recording"));
  EXPECT_EQ(open_recording(folder / "out" / "a.mcap")->camera.width, kSmall.width);
  EXPECT_EQ(open_recording(folder / "out" / "b" / "b.mcap")->camera.width, 2 * kSmall.width);
}

TEST(Record, KeepsWhatWasRecordedWhenItIsInterrupted) {
  const fs::path folder = fresh_folder();
  const auto jpegs = jpegs_of(moving_images(10, kSmall));
  HttpSender sender([&](const Client& client, int) {
    client.send(http_head("multipart/x-mixed-replace; boundary=frame"));
    for (const std::string& jpeg : jpegs) client.send(jpeg_part(jpeg));
    client.send("--frame\r\n");
    client.wait([] { return false; });
  });
  const Outcome outcome =
      signaled("INT",
               fmt::format("find {} -name '*.frames' -size +539k | grep -q .", folder),  // 9 images
               fmt::format("record {} --output {}/out", sender.address(), folder));
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr(" frames, 160x128"));
  EXPECT_GE(open_recording(folder / "out")->frame_count(), 9);
}

TEST(Record, RefusesWhatItCannotOpenOrWrite) {
  const fs::path folder = fresh_folder();
  const std::string none = "http://127.0.0.1:" + std::to_string(free_port()) + "/a";
  expect_refused(program("record {} --output {}/a", none, folder), none + ": Connection refused");
  expect_refused(program("record camera:63 --output {}/a", folder), "camera:63: no such camera");
  expect_refused(program("record nothing.mp4 --output {}/a", folder), "nothing.mp4: no such file");
  write_file(folder / "old" / "file", "");
  expect_refused(program("record camera:63 --output {}/old", folder), "not empty");
  EXPECT_FALSE(fs::exists(folder / "a"));
}

TEST(Record, RefusesNumbersAndPortsThatMeanNothing) {
  const std::string output = " --output '" + (fresh_folder() / "a").string() + "'";
  for (const char* seconds : {"0", "-1", "nan", "x"})
    expect_refused(
        program("record udp://127.0.0.1:5000 --seconds " + std::string(seconds) + output),
        "--seconds: '" + std::string(seconds) + "', expected a number from 0.001 to");
  for (const char* address : {"udp://127.0.0.1", "udp://127.0.0.1:99999", "udp://:0"})
    expect_refused(program("record " + std::string(address) + output),
                   std::string(address) + ": expected udp://HOST:PORT with a port from 1 to 65535");
}

TEST(LiveSnapshot, DrawsTheSameTwice) {
  const fs::path folder = fresh_folder();
  for (const char* name : {"one", "two"})
    succeeding(
        "snapshot --live sequences/desk --view image --frame 25 --output {}/{}.png", folder, name);
  EXPECT_EQ(read_file(folder / "one.png"), read_file(folder / "two.png"));
  const Outcome outcome =
      program("snapshot --live sequences/desk --view window --frame 25 --output {}/w.png", folder);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("ready from "));
  EXPECT_THAT(outcome.err, HasSubstr("640x480 \u00b7 26 images \u00b7 0 dropped"));
}

TEST(LiveSnapshot, NamesWhatItCannotDraw) {
  const fs::path folder = fresh_folder();
  const auto refused = [&](const std::string& arguments, const std::string& message) {
    expect_refused(program("snapshot --view image --output {}/a.png {}", folder, arguments),
                   message);
  };
  refused("--live camera:0", "--live: 'camera:0', expected a video or a recording");
  refused("--live nothing.mp4", "nothing.mp4: no such file");
  refused("--live sequences/desk --frame 900", "frame: 900 is not in the recording");
  refused("--live sequences/desk sequences/desk", "--live: give no recording besides it");
}

TEST(LiveView, RefusesTwoSources) {
  expect_refused(program("view --live sequences/desk sequences/desk"),
                 "--live: give no recording and no session besides it");
}

TEST(LiveScript, OpensNoCamera) {
  const fs::path folder = fresh_folder();
  write_file(folder / "script.txt", "live camera:63\n");
  const Outcome outcome = program("snapshot --script {}/script.txt", folder);
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("script.txt:1: live: only a user at the window opens"));
}

}  // namespace
}  // namespace gpo::test
