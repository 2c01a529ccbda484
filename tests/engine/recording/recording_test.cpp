// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inspection/report/report.h"
#include "engine/recording/board/board.h"
#include "engine/recording/layouts/open_recording.h"
#include "tests/engine/recording/bags/small_bag.h"
#include "tests/engine/recording/images/made_video.h"
#include "tests/engine/test_folder.h"

#include <algorithm>

#include <gmock/gmock.h>

namespace gpo::test {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre, testing::HasSubstr, testing::IsEmpty;

class Content : public ::testing::Test {
 protected:
  Content() { write("one"); }

  void write(const std::string& name) const {
    folder_.write(name + "/camera.yaml", kCameraYaml);
    for (const char* image : {"1.png", "2.png"})
      folder_.write(name + "/" + image, cv::Mat(48, 64, CV_8UC3, cv::Scalar(90, 90, 90)));
    folder_.write(name + "/groundtruth.txt",
                  std::string("0 0 0 0 0 0 0 1\n0.02 1 0 0 0 0 0 1\n0.1 1 0 0 0 0 0 1\n"));
  }
  RecordingContent content(const std::string& name) const {
    return content_of(*open_recording(folder_.path() / name));
  }

  const TestFolder folder_;
};

TEST_F(Content, IsEqualForACopyAndAnotherPath) {
  write("two");
  EXPECT_EQ(content("one"), content("two"));
  EXPECT_EQ(content("one"), content("two/../one/."));
  EXPECT_EQ(content("one").at("fx"), "60");
  EXPECT_EQ(content("one").at("pictures").size(), 64U);
}

TEST_F(Content, NamesThePartThatDiffers) {
  const RecordingContent before = content("one");
  std::string yaml = kCameraYaml;
  yaml.replace(yaml.find("[60,"), 4, "[61,");
  const std::string moved = "0 0 0 0 0 0 0 1\n0.02 2 0 0 0 0 0 1\n0.1 1 0 0 0 0 0 1\n";
  const auto expect = [&](const std::string& part, const std::string& file, const auto& changed) {
    folder_.write("one/" + file, changed);
    EXPECT_THAT(differing_parts(before, content("one")), ElementsAre(part));
    write("one");
  };
  expect("fx", "camera.yaml", yaml);
  EXPECT_THAT(differing_parts(before, content("one")), IsEmpty());
  expect("truth", "groundtruth.txt", moved);
  cv::Mat noise(48, 64, CV_8UC3);
  cv::randu(noise, 0, 255);
  expect("pictures", "2.png", noise);
  std::string bytes = folder_.read("one/2.png");
  bytes.back() = static_cast<char>(bytes.back() ^ 1);  // size and pixels stay the same
  expect("pictures", "2.png", bytes);
  expect("plane", "plane.yaml", std::string("normal: [0, 0, 1]\ndistance: 1\n"));
}

TEST_F(Content, IncludesARecipesText) {
  Recording made = *open_recording(folder_.path() / "one");
  made.path = folder_.write("one.yaml", std::string("seed: 1"));
  const RecordingContent first = content_of(made);
  folder_.write("one.yaml", std::string("seed: 2"));
  EXPECT_THAT(differing_parts(first, content_of(made)), ElementsAre("recipe"));
}

TEST_F(Content, SamplesLargeFilesAndNotesWhenTheyChanged) {
  Recording recording = *open_recording(folder_.path() / "one");
  std::string bytes(std::size_t{65} << 20, 'a');
  const fs::path file = folder_.write("large.mp4", bytes);
  recording.image_files = {file};
  const auto time = fs::last_write_time(file);
  const RecordingContent before = content_of(recording);
  bytes.back() = 'b';
  folder_.write("large.mp4", bytes);
  fs::last_write_time(file, time);
  EXPECT_THAT(differing_parts(before, content_of(recording)), ElementsAre("pictures"));
  bytes.back() = 'a';
  bytes[std::size_t{33} << 20] = 'b';  // between samples
  folder_.write("large.mp4", bytes);
  fs::last_write_time(file, time + std::chrono::seconds(1));
  EXPECT_THAT(differing_parts(before, content_of(recording)), ElementsAre("pictures"));
}

TEST_F(Content, NamesAMissingImage) {
  const auto recording = open_recording(folder_.path() / "one");
  fs::remove(folder_.path() / "one" / "2.png");
  EXPECT_THAT(error_of([&] { content_of(*recording); }), HasSubstr("2.png: cannot be read"));
}

TEST_F(Content, IncludesTheGyroscope) {
  Recording recording = *open_recording(GPO_SOURCE_DIR "/sequences/desk");
  const RecordingContent before = content_of(recording);
  const Gyroscope gyroscope = *recording.gyroscope;
  recording.gyroscope->rates_rad_s[7].x() += 1e-9;
  EXPECT_THAT(differing_parts(before, content_of(recording)), ElementsAre("gyroscope"));
  recording.gyroscope = gyroscope;
  recording.gyroscope->accelerations_m_s2.assign(gyroscope.rates_rad_s.size(), {0, 0, 9.8});
  EXPECT_THAT(differing_parts(before, content_of(recording)), ElementsAre("gyroscope"));
  recording.gyroscope = gyroscope;
  recording.gyroscope->noise_density *= 2;
  EXPECT_THAT(differing_parts(before, content_of(recording)), ElementsAre("gyroscope"));
}

/// An input file of which one byte changes: the first digit behind `key`.
struct OneByte {
  const char* part;  ///< part of the recording that differs
  const char* file;
  const char* key;
};

void change_digit(const TestFolder& folder, const OneByte& one) {
  std::string text = folder.read(one.file);
  const std::size_t key = text.find(one.key);
  ASSERT_NE(key, std::string::npos) << one.file;
  const std::size_t at = text.find_first_of("0123456789", key + std::string(one.key).size());
  text[at] = text[at] == '9' ? '8' : static_cast<char>(text[at] + 1);
  folder.write(one.file, text);
}

TEST(ContentOfFiles, NoticesOneChangedByteOfEachInput) {
  const TestFolder folder;
  const fs::path desk = folder.path() / "desk";
  const auto copy = [&] {
    fs::remove_all(desk);
    fs::copy(GPO_SOURCE_DIR "/sequences/desk", desk, fs::copy_options::recursive);
    folder.write("desk/tracks.csv", std::string("frame,track,x,y\n0,1,20.5,30\n1,1,21,30\n"));
  };
  const auto content = [&] {
    return content_of(*open_recording(desk, {.tracks = desk / "tracks.csv"}));
  };
  copy();
  const RecordingContent before = content();
  for (const OneByte& one :
       {OneByte{"fx", "desk/mav0/cam0/sensor.yaml", "intrinsics: ["},
        OneByte{"lens", "desk/mav0/cam0/sensor.yaml", "coefficients: [0."},
        OneByte{"gyroscope", "desk/mav0/imu0/data.csv", ",0."},
        OneByte{"gyroscope", "desk/mav0/imu0/data.csv", ",6."},
        OneByte{"gyroscope", "desk/mav0/imu0/sensor.yaml", "_bias: [0."},
        OneByte{"truth", "desk/mav0/state_groundtruth_estimate0/data.csv", "-0."},
        OneByte{"plane", "desk/plane.yaml", "distance: "},
        OneByte{"board", "desk/board.yaml", "square: 0."},
        OneByte{"tracks", "desk/tracks.csv", "0,1,20."}}) {
    SCOPED_TRACE(one.file);
    copy();
    change_digit(folder, one);
    EXPECT_THAT(differing_parts(before, content()), ElementsAre(one.part));
  }
  copy();
  const std::string yaml = folder.read("desk/mav0/cam0/sensor.yaml");
  folder.write("desk/mav0/cam0/sensor.yaml", yaml + "source: guess\n");
  EXPECT_THAT(differing_parts(before, content()), ElementsAre("lens source"));
}

TEST(ContentOfFiles, NoticesOneChangedByteOfAVideoAndOfABag) {
  const TestFolder folder;
  make_video(folder.path() / "v.mp4",
             std::vector<cv::Mat>(30, cv::Mat(48, 64, CV_8UC3, cv::Scalar(9, 200, 90))));
  write_small_bag(folder.path() / "small.bag", ros1_writer);
  for (const char* name : {"v.mp4", "small.bag"}) {
    const RecordingContent before = content_of(*open_recording(folder.path() / name));
    std::string bytes = folder.read(name);
    char& middle = bytes[bytes.size() / 2];
    middle = static_cast<char>(middle ^ 1);
    folder.write(name, bytes);
    EXPECT_THAT(differing_parts(before, content_of(*open_recording(folder.path() / name))),
                testing::Contains("pictures"))
        << name;
  }
}

/// A recording that we may not publish; null if it is missing, so that the test is skipped.
std::shared_ptr<const Recording> open_shared(const std::string& name) {
  const fs::path folder = fs::path(GPO_SHARED_DIR) / "data" / name;
  return fs::exists(folder) ? open_recording(folder) : nullptr;
}

#define SKIP_IF_ABSENT(recording) \
  if (!(recording)) GTEST_SKIP() << "no recordings in " << GPO_SHARED_DIR

TEST(RealRecordings, ChessboardFloorHasTruthInEveryFrame) {
  const auto recording = open_shared("chessboard-floor");
  SKIP_IF_ABSENT(recording);
  EXPECT_EQ(recording->layout, "pictures");
  ASSERT_EQ(recording->frame_count(), 260);
  EXPECT_NEAR(1e-9 * double(recording->timestamps_ns[24]), 1.0, 1e-6);
  // The RMS is near the calibration's (0.54 px), and the path is continuous.
  const auto truth = board_truth(*recording, 0, 260);
  for (int i = 0; i < 260; ++i) {
    ASSERT_TRUE(truth.poses[i]) << i;
    EXPECT_LT(truth.uncertainties[i]->rms_px, 1.2) << i;
    if (i == 0) continue;
    const Pose& last = *truth.poses[i - 1];
    EXPECT_LT((truth.poses[i]->p_wc - last.p_wc).norm(), 0.03) << i;
    EXPECT_LT(degrees(so3_log(last.R_wc.transpose() * truth.poses[i]->R_wc).norm()), 4) << i;
  }
}

TEST(RealRecordings, ChessboardDarkHasTimesToItsEnd) {
  const auto recording = open_shared("chessboard-dark");
  SKIP_IF_ABSENT(recording);
  ASSERT_EQ(recording->frame_count(), 386);  // the last two have no time
  EXPECT_NEAR(1e-9 * double(recording->timestamps_ns.back()), 385 / 29.75, 1e-6);
  const auto truth = board_truth(*recording, 285, 30);
  const auto known = std::ranges::count_if(truth.poses, [](auto& pose) { return !!pose; });
  // The board leaves the image at frame 295 and is completely visible again at 305.
  EXPECT_NEAR(static_cast<double>(known), 20, 2);
}

TEST(RealRecordings, PaintingAndPostcardOpenWithoutTruth) {
  for (const auto& [name, frames] : {std::pair("painting", 62), std::pair("postcard", 161)}) {
    const auto recording = open_shared(name);
    SKIP_IF_ABSENT(recording);
    EXPECT_EQ(recording->frame_count(), frames);
    EXPECT_EQ(recording->notes.size(), 2U);
    EXPECT_TRUE(find_board(recording->images->gray(30), {8, 6, 0.025}).empty());
  }
}

TEST(RealRecordings, CardsTracksHasTracksAndGyroscope) {
  const auto recording = open_shared("cards-tracks");
  SKIP_IF_ABSENT(recording);
  EXPECT_EQ(recording->layout, "tracks");
  EXPECT_EQ(recording->images, nullptr);
  const auto info = describe(*recording);
  EXPECT_EQ(recording->frame_count(), 361);
  EXPECT_NEAR(info.rate_hz, 10, 0.01);
  EXPECT_NEAR(info.gyroscope->rate_hz, 100, 0.1);
  EXPECT_EQ(recording->gyroscope->timestamps_ns.size(), 3685U);
  EXPECT_TRUE(info.gyroscope->covers_frames);
  EXPECT_EQ(info.tracks->observations, 18924);
  const Eigen::Matrix3d expected = Eigen::Vector3d(1, -1, -1).asDiagonal();
  EXPECT_TRUE(recording->gyroscope->R_gyro_camera.isApprox(expected, 1e-12));
}

}  // namespace
}  // namespace gpo::test
