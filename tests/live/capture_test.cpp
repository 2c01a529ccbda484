// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/live/capture.h"

#include "engine/files/text_file.h"
#include "engine/recording/live/live_recording.h"
#include "tests/engine/recording/images/made_video.h"
#include "tests/live/sender.h"

#include <cerrno>
#include <filesystem>
#include <limits>

#include <gmock/gmock.h>
#include <unistd.h>

namespace gpo::test {
namespace {

using testing::HasSubstr;

const cv::Size kSize(160, 128);

/// A transport stream of the images.
std::string transport_stream(const std::vector<cv::Mat>& images) {
  const fs::path file =
      fs::path(GPO_TEST_OUTPUT_DIR) / ("stream-" + std::to_string(::getpid()) + ".ts");
  fs::create_directories(file.parent_path());
  make_video(file, images);
  std::string bytes = read_file(file);
  fs::remove(file);
  return bytes;
}

/// Mean difference of two images [gray levels].
double difference(const cv::Mat& a, const cv::Mat& b) {
  return cv::norm(a, b, cv::NORM_L1) / static_cast<double>(a.total() * 3);
}

CaptureOptions keep_all(HandClock& clock) { return {.queue = 1000, .clock = clock.clock()}; }

std::shared_ptr<const Recording> recording_of(const std::vector<cv::Mat>& images) {
  LiveImages live;
  for (std::size_t i = 0; i < images.size(); ++i)
    live.timestamps_ns.push_back(1'000'000'000 + 40'000'000 * static_cast<std::int64_t>(i));
  live.images = images_in_memory(images);
  return std::make_shared<const Recording>(
      live_recording({.address = "a.mp4", .device = ""}, live));
}

TEST(Capture, ReceivesATransportStreamByHttp) {
  const auto sent = moving_images(40, kSize);
  const std::string stream = transport_stream(sent);
  HttpSender sender([&](const Client& client, int number) {
    if (number == 0) client.send(http_head("video/mp2t") + stream);
  });
  HandClock clock;
  Capture capture({sender.address()}, keep_all(clock));
  const auto received = take_all(capture);
  ASSERT_EQ(received.size(), sent.size());
  for (std::size_t i = 0; i < sent.size(); ++i) {
    EXPECT_EQ(received[i].bgr.size(), kSize);
    EXPECT_LT(difference(received[i].bgr, sent[i]), 6);
    EXPECT_EQ(received[i].timestamp_ns - received[0].timestamp_ns,
              40'000'000 * static_cast<std::int64_t>(i));
  }
  EXPECT_EQ(capture.status().state, CaptureState::failed) << "the sender ended";
  EXPECT_EQ(capture.status().dropped, 0);
  EXPECT_EQ(capture.status().device, sender.address());
}

TEST(Capture, ReceivesATransportStreamByUdp) {
  const auto sent = moving_images(60, kSize);
  const std::string stream = transport_stream(sent);
  const int port = free_port();
  HandClock clock;
  Capture capture({"udp://127.0.0.1:" + std::to_string(port)}, keep_all(clock));
  const std::jthread sender([&](const std::stop_token& stop) {
    // The system may drop datagrams, and only the next stream completes the last images of one.
    while (!stop.stop_requested()) send_datagrams(port, stream, stop);
  });
  std::optional<LiveImage> before;
  for (std::size_t i = 0; i < sent.size(); ++i) {
    const auto received = capture.take({});
    ASSERT_TRUE(received);
    EXPECT_EQ(received->bgr.size(), kSize);
    if (before) {
      EXPECT_GT(received->timestamp_ns, before->timestamp_ns);
    }
    double least = 255;
    for (const cv::Mat& image : sent) least = std::min(least, difference(image, received->bgr));
    EXPECT_LT(least, 6);
    before = received;
  }
  EXPECT_LE(capture.status().dropped, capture.status().broken);
}

TEST(Capture, ReceivesJpegsWithTheTimesOfTheirArrival) {
  const auto sent = moving_images(6, kSize);
  const auto jpegs = jpegs_of(sent);
  ASSERT_EQ(jpegs.size(), sent.size());
  HandClock clock;
  HttpSender sender([&](const Client& client, int number) {
    if (number > 0) return;
    client.send(http_head("multipart/x-mixed-replace; boundary=frame"));
    for (const std::string& jpeg : jpegs) client.send(jpeg_part(jpeg));
  });
  Capture capture({sender.address()}, keep_all(clock));
  const auto received = take_all(capture);
  ASSERT_EQ(received.size(), sent.size());
  for (std::size_t i = 0; i < sent.size(); ++i)
    EXPECT_LT(difference(received[i].bgr, sent[i]), 6) << i;
  EXPECT_GE(received[0].timestamp_ns, 1'700'000'000'000'000'000);
}

TEST(Capture, ReportsAStallAndContinues) {
  const auto jpegs = jpegs_of(moving_images(8, kSize));
  std::atomic<bool> goes_on = false;
  HttpSender sender([&](const Client& client, int number) {
    if (number > 0) return;
    client.send(http_head("multipart/x-mixed-replace; boundary=frame"));
    for (int i = 0; i < 8; ++i) {
      client.send(jpeg_part(jpegs[i]));
      if (i == 4) client.wait([&] { return goes_on.load(); });
    }
  });
  HandClock clock;
  // The time never suffices to connect again.
  Capture capture({sender.address()},
                  {.queue = 1000, .reconnect_s = 1e6, .give_up_s = 1e6, .clock = clock.clock()});
  int captured = 0;
  std::string message;
  wait_for(capture, [&](const CaptureStatus& now) {
    if (std::exchange(captured, now.captured) != now.captured) clock.advance(3);
    message = now.message;
    return now.captured >= 4 && now.state == CaptureState::stalled;
  });
  EXPECT_THAT(message, HasSubstr("no image for 2 s"));
  goes_on = true;
  for (int i = 0; i < 8; ++i) EXPECT_TRUE(capture.take({})) << i;
}

TEST(Capture, ConnectsAgainToAStreamThatComesBack) {
  const auto jpegs = jpegs_of(moving_images(4, kSize));
  HttpSender sender([&](const Client& client, int number) {
    if (number == 1) client.send("HTTP/1.0 503 Service Unavailable\r\n\r\n");
    if (number == 1 || number > 2) return;
    client.send(http_head("multipart/x-mixed-replace; boundary=frame"));
    for (const std::string& jpeg : jpegs) client.send(jpeg_part(jpeg));
  });
  HandClock clock;
  Capture capture({sender.address()}, keep_all(clock));
  const auto received = take_all(capture);
  EXPECT_EQ(received.size(), 8U);
  for (std::size_t i = 1; i < received.size(); ++i)
    EXPECT_GT(received[i].timestamp_ns, received[i - 1].timestamp_ns);
  EXPECT_TRUE(capture.status().is_over()) << "it did not come back a second time";
}

TEST(Capture, BeginsASegmentWhenTheSizeChanges) {
  const auto small = jpegs_of(moving_images(3, kSize));
  const auto large = jpegs_of(moving_images(3, {320, 256}));
  HttpSender sender([&](const Client& client, int number) {
    if (number > 0) return;
    client.send(http_head("multipart/x-mixed-replace; boundary=frame"));
    for (const std::string& jpeg : small) client.send(jpeg_part(jpeg));
    for (const std::string& jpeg : large) client.send(jpeg_part(jpeg));
  });
  HandClock clock;
  Capture capture({sender.address()}, keep_all(clock));
  LiveBuffer buffer(20, std::size_t{1} << 30);
  std::vector<int> segments;
  for (const LiveImage& image : take_all(capture)) {
    segments.push_back(image.segment);
    buffer.add(image);
  }
  EXPECT_EQ(segments, (std::vector<int>{0, 0, 0, 1, 1, 1}));
  EXPECT_EQ(buffer.count(), 3);
  EXPECT_EQ(buffer.images().images->bgr(0).size(), cv::Size(320, 256));
}

TEST(Capture, SkipsDamagedImages) {
  auto jpegs = jpegs_of(moving_images(7, kSize));
  jpegs[3] = std::string(500, 'x');
  jpegs[5].resize(jpegs[5].size() / 2);
  HttpSender sender([&](const Client& client, int number) {
    if (number > 0) return;
    client.send(http_head("multipart/x-mixed-replace; boundary=frame"));
    for (const std::string& jpeg : jpegs) client.send(jpeg_part(jpeg));
  });
  HandClock clock;
  Capture capture({sender.address()}, keep_all(clock));
  EXPECT_EQ(take_all(capture).size(), 5U);
  EXPECT_EQ(capture.status().broken, 2);
  EXPECT_EQ(capture.status().dropped, 2);
}

TEST(Capture, RefusesGarbageInOneLine) {
  HttpSender sender([](const Client& client, int) {
    client.send(http_head("text/html") + "<html>" + std::string(20'000, '?') + "</html>");
  });
  HandClock clock;
  Capture capture({sender.address()}, keep_all(clock));
  EXPECT_TRUE(take_all(capture).empty());
  EXPECT_EQ(capture.status().state, CaptureState::failed);
  EXPECT_EQ(capture.status().message,
            sender.address() +
                ": sends no video in MPEG-TS, MJPEG or RTSP; check the sender and the address");
}

TEST(Capture, RefusesASenderThatIsAbsent) {
  const std::string port = std::to_string(free_port());
  for (const std::string& address :
       {"http://127.0.0.1:" + port + "/a", "rtsp://127.0.0.1:" + port + "/a"}) {
    HandClock clock;
    Capture capture({address}, keep_all(clock));
    EXPECT_TRUE(take_all(capture).empty());
    EXPECT_EQ(capture.status().message,
              address + ": Connection refused; check the sender and the address");
  }
}

TEST(Capture, NamesWhatIsWrongWithACamera) {
  HandClock clock;
  Capture absent({"camera:63"}, keep_all(clock));
  EXPECT_TRUE(take_all(absent).empty());
  EXPECT_THAT(absent.status().message, HasSubstr("camera:63: no such camera; found "));
  Capture wrong({"camera:first"}, keep_all(clock));
  EXPECT_TRUE(take_all(wrong).empty());
  EXPECT_EQ(wrong.status().message,
            "camera:first: expected camera:0, camera:0,640x480 or camera:0,640x480,30");
  EXPECT_EQ(camera_error("camera:0", EBUSY), "camera:0: another program uses it; close that one");
  EXPECT_EQ(camera_error("camera:0", EACCES),
            "camera:0: no permission; add your user to the group video");
}

TEST(Capture, EndsWhileASenderIsSilent) {
  HttpSender sender([](const Client& client, int) { client.wait([] { return false; }); });
  HandClock clock;
  const Capture capture({sender.address()}, keep_all(clock));
  EXPECT_EQ(capture.status().state, CaptureState::connecting);
}

TEST(Capture, DropsTheOldestImages) {
  HandClock clock;
  Capture capture({"a.mp4", recording_of(moving_images(9, kSize))},
                  {.queue = 2, .clock = clock.clock()});
  wait_for(capture, [](const CaptureStatus& now) { return now.is_over(); });
  const auto received = take_all(capture);
  ASSERT_EQ(received.size(), 2U);
  EXPECT_EQ(received.back().timestamp_ns, 1'000'000'000 + 8 * 40'000'000LL);
  EXPECT_EQ(capture.status().captured, 9);
  EXPECT_EQ(capture.status().dropped, 7);
}

TEST(Capture, PlaysARecordingAtItsOwnPace) {
  HandClock clock;
  const std::int64_t begin_ns = clock.now_ns;
  const auto sent = moving_images(5, kSize);
  Capture capture({"a.mp4", recording_of(sent)}, keep_all(clock));
  const auto received = take_all(capture);
  ASSERT_EQ(received.size(), 5U);
  EXPECT_EQ(difference(received[3].bgr, sent[3]), 0);
  EXPECT_EQ(clock.now_ns - begin_ns, 4 * 40'000'000);
  EXPECT_EQ(capture.status().message, "a.mp4: ended after 5 images");
}

TEST(CaptureTimes, FollowTheSendersClockUntilItJumps) {
  CaptureTimes times;
  EXPECT_EQ(times.next(1'000'000'000, 50), 1'000'000'000);
  EXPECT_EQ(times.next(1'400'000'000, 40'000'050), 1'040'000'000);
  EXPECT_EQ(times.next(1'500'000'000, 40'000'050), 1'040'000'001) << "repeated by the sender";
  EXPECT_EQ(times.next(2'000'000'000, 90'000'000'000), 2'000'000'000) << "jumped";
  EXPECT_EQ(times.next(2'100'000'000, std::nullopt), 2'100'000'000);
}

TEST(CaptureTimes, KeepTheStepsOfASenderThatStartsAnew) {
  CaptureTimes times;
  EXPECT_EQ(times.next(1'000'000'000, 1'400'000'000), 1'000'000'000);
  EXPECT_EQ(times.next(1'050'000'000, 1'500'000'000), 1'100'000'000);
  EXPECT_EQ(times.next(1'600'000'000, 1'400'000'000), 1'600'000'000) << "later";
  EXPECT_EQ(times.next(1'700'000'000, 1'500'000'000), 1'700'000'000);
  EXPECT_EQ(times.next(1'650'000'000, 1'400'000'000), 1'700'000'001) << "before the last image";
  EXPECT_EQ(times.next(1'660'000'000, 1'500'000'000), 1'800'000'001);
}

TEST(LiveBuffer, KeepsTheLastSecondsWithinItsMemory) {
  const auto images = moving_images(10, kSize);
  LiveBuffer by_time(0.5, std::size_t{1} << 30);
  LiveBuffer by_memory(100, std::size_t{3} * kSize.area() * 4);
  for (int i = 0; i < 10; ++i) {
    by_time.add({images[i], i * 100'000'000LL});
    by_memory.add({images[i], i * 100'000'000LL});
  }
  EXPECT_EQ(by_time.images().timestamps_ns.front(), 400'000'000);
  EXPECT_EQ(by_memory.count(), 4);
  EXPECT_EQ(difference(by_memory.images().images->bgr(3), images[9]), 0);
}

TEST(LiveBuffer, KeepsGrayImagesInAThirdOfTheMemory) {
  cv::Mat gray, bgr;
  cv::extractChannel(moving_images(1, kSize)[0], gray, 0);
  cv::merge(std::vector<cv::Mat>{gray, gray, gray}, bgr);
  LiveBuffer buffer(10, std::size_t{1} << 30);
  buffer.add({bgr, 0});
  EXPECT_EQ(buffer.bytes(), static_cast<std::size_t>(kSize.area()));
  EXPECT_EQ(difference(buffer.images().images->bgr(0), bgr), 0);
}

TEST(FrameSpool, ReturnsItsImagesAndLeavesNoFile) {
  const fs::path folder = fs::path(GPO_TEST_OUTPUT_DIR) / "spool";
  fs::remove_all(folder);
  const auto images = moving_images(3, kSize);
  {
    FrameSpool spool(folder / "out");
    for (int i = 0; i < 3; ++i) spool.add({images[i], i * 10LL});
    const LiveImages live = spool.images();
    EXPECT_EQ(live.timestamps_ns, (std::vector<std::int64_t>{0, 10, 20}));
    for (int i = 0; i < 3; ++i) EXPECT_EQ(difference(live.images->bgr(i), images[i]), 0);
  }
  EXPECT_TRUE(fs::is_empty(folder));
}

TEST(Player, SurvivesTimesThatAreCenturiesApart) {
  auto recording = std::make_shared<Recording>(*recording_of(moving_images(2, kSize)));
  recording->timestamps_ns = {0, std::numeric_limits<std::int64_t>::max()};
  constexpr std::int64_t kNow_ns = 2'000'000'000'000'000'000;
  std::int64_t due_ns = 0;
  const LiveClock clock{[] { return kNow_ns; },
                        [&](std::int64_t time_ns, const std::stop_token&) { due_ns = time_ns; }};
  const SourceContext context{.clock = clock, .stop = {}, .interrupted = {}};
  const OpenSource source = open_player({"a.mp4", recording}, context);
  EXPECT_TRUE(source.read());
  EXPECT_EQ(due_ns, kNow_ns);
  EXPECT_TRUE(source.read());
  EXPECT_GT(due_ns, kNow_ns);
}

}  // namespace
}  // namespace gpo::test
