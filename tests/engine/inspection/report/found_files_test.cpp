// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inspection/report/report.h"
#include "tests/engine/recording/recording_folder.h"

#include <filesystem>

#include <fmt/format.h>

namespace gpo::test {
namespace {

using testing::Contains, testing::HasSubstr;

constexpr int kListedImages = 5;

cv::Mat listed_image() { return {48, 64, CV_8UC3, cv::Scalar::all(10)}; }

class FoundFiles : public RecordingFolder {};

TEST_F(FoundFiles, NameASequenceOnceThatIsNotRead) {
  constexpr int kMany = 130;
  for (int i = 0; i < kMany; ++i)
    for (const char* side : {"left", "right"})
      folder.write(fmt::format("{}_{}.jpg", side, i), listed_image());
  std::vector<std::string> not_read;
  for (const FoundFile& one : describe(*open()).files)
    if (one.use.empty()) not_read.push_back(to_text(one));
  EXPECT_THAT(not_read,
              testing::ElementsAre("right_0.jpg: not read, 130 images: another sequence"));
}

TEST_F(FoundFiles, NameImagesThatAreNoFiles) {
  for (int i = 0; i < kListedImages; ++i) folder.write(fmt::format("{}.png", i), listed_image());
  std::filesystem::create_symlink("nowhere", folder.path() / "7.png");
  std::filesystem::create_symlink("nowhere", folder.path() / "depth7.png");
  std::filesystem::create_directory(folder.path() / "10.png");
  const auto recording = open();
  EXPECT_EQ(recording->frame_count(), kListedImages);
  EXPECT_THAT(recording->notes, Contains("not read: 7.png (a broken link), 10.png (a folder)"));
  const std::string text = to_text(describe(*recording));
  EXPECT_THAT(text, HasSubstr("              7.png: not read, a broken link\n"));
  EXPECT_THAT(text, HasSubstr("              10.png: not read, a folder\n"));
  for (int i = 20; i < 30; ++i)
    std::filesystem::create_symlink("nowhere", file(fmt::format("{}.png", i)));
  EXPECT_THAT(open()->notes,
              Contains("not read: 7.png (a broken link), 10.png (a folder), "
                       "20.png (a broken link), 9 more names of images"));
}

TEST_F(FoundFiles, NameImagesThatAreNoFilesWithoutEurocsList) {
  for (int i = 0; i < kListedImages; ++i)
    folder.write(fmt::format("mav0/cam0/data/100{}000000.png", i), listed_image());
  folder.write("mav0/cam0/sensor.yaml", kCameraYaml);
  std::filesystem::create_symlink("nowhere", file("mav0/cam0/data/1007000000.png"));
  EXPECT_THAT(open()->notes, Contains("not read: 1007000000.png (a broken link)"));
}

}  // namespace
}  // namespace gpo::test
