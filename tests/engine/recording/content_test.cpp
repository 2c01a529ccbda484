// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/layouts/open_recording.h"
#include "tests/engine/test_folder.h"

#include <gmock/gmock.h>

namespace gpo {
namespace {

namespace fs = std::filesystem;
using test::error_of;
using test::kCameraYaml;
using test::TestFolder;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

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
  const auto differs = [&] { return differing_parts(before, content("one")); };
  std::string yaml = kCameraYaml;
  yaml.replace(yaml.find("[60,"), 4, "[61,");
  folder_.write("one/camera.yaml", yaml);
  EXPECT_THAT(differs(), ElementsAre("fx"));
  write("one");
  EXPECT_THAT(differs(), IsEmpty());
  folder_.write("one/groundtruth.txt",
                std::string("0 0 0 0 0 0 0 1\n0.02 2 0 0 0 0 0 1\n0.1 1 0 0 0 0 0 1\n"));
  EXPECT_THAT(differs(), ElementsAre("truth"));
  write("one");
  cv::Mat noise(48, 64, CV_8UC3);
  cv::randu(noise, 0, 255);
  folder_.write("one/2.png", noise);  // another file size
  EXPECT_THAT(differs(), ElementsAre("pictures"));
  write("one");
  folder_.write("one/plane.yaml", std::string("normal: [0, 0, 1]\ndistance: 1\n"));
  EXPECT_THAT(differs(), ElementsAre("plane"));
}

TEST_F(Content, IncludesARecipesText) {
  Recording made = *open_recording(folder_.path() / "one");
  made.path = folder_.write("one.yaml", std::string("seed: 1"));
  const RecordingContent first = content_of(made);
  folder_.write("one.yaml", std::string("seed: 2"));
  EXPECT_THAT(differing_parts(first, content_of(made)), ElementsAre("recipe"));
}

TEST_F(Content, NamesAMissingImage) {
  const auto recording = open_recording(folder_.path() / "one");
  fs::remove(folder_.path() / "one" / "2.png");
  EXPECT_THAT(error_of([&] { content_of(*recording); }), HasSubstr("2.png: cannot be read"));
}

TEST_F(Content, IncludesTheGyroscope) {
  const std::string desk = std::string(GPO_SOURCE_DIR) + "/sequences/desk";
  Recording recording = *open_recording(desk);
  const RecordingContent before = content_of(recording);
  const Gyroscope gyroscope = *recording.gyroscope;
  recording.gyroscope->rates_rad_s[7].x() += 1e-9;
  EXPECT_THAT(differing_parts(before, content_of(recording)), ElementsAre("gyroscope"));
  recording.gyroscope = gyroscope;
  recording.gyroscope->noise_density *= 2;
  EXPECT_THAT(differing_parts(before, content_of(recording)), ElementsAre("gyroscope"));
}

}  // namespace
}  // namespace gpo
