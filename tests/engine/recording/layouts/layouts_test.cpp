// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/file_kinds.h"
#include "engine/recording/layouts/open_recording.h"
#include "tests/engine/test_folder.h"

#include <set>

#include <gmock/gmock.h>

namespace gpo {
namespace {

using test::error_of;
using test::TestFolder;
using testing::HasSubstr;

/// Returns the title of the first layout that fits.
std::string title_of(const std::filesystem::path& path) {
  for (const Layout& layout : layouts())
    if (layout.find(path)) return layout.title;
  return "none";
}

TEST(Layouts, HaveReadersAndDifferentTitles) {
  std::set<std::string> titles;
  for (const Layout& layout : layouts()) {
    EXPECT_TRUE(titles.insert(layout.title).second) << layout.title;
    EXPECT_NE(layout.find, nullptr) << layout.title;
    EXPECT_NE(layout.read, nullptr) << layout.title;
  }
}

TEST(Layouts, AreRecognizedInTheirOrder) {
  const TestFolder folder;
  EXPECT_EQ(title_of(folder.path() / "nowhere"), "none");
  EXPECT_EQ(title_of(folder.path() / "a.mp4"), "pictures");
  EXPECT_EQ(title_of(folder.path()), "tracks");
  folder.write("0.png", "not decoded");
  EXPECT_EQ(title_of(folder.path()), "pictures");
  folder.write("rgb.txt", "");
  EXPECT_EQ(title_of(folder.path()), "TUM RGB-D");
  folder.write("mav0/cam0/data.csv", "");
  EXPECT_EQ(title_of(folder.path()), "EuRoC");
  EXPECT_EQ(layouts().front().find(folder.path()), folder.path() / "mav0");
}

TEST(Layouts, AreAllNamedIfNoneFits) {
  const TestFolder folder;
  const std::string message = error_of([&] { open_recording(folder.path()); });
  for (const Layout& layout : layouts()) EXPECT_THAT(message, HasSubstr(layout.expected));
  EXPECT_THAT(message, testing::EndsWith(", or tracks.csv"));
}

TEST(FileKinds, IgnoresTheCaseOfEndings) {
  EXPECT_TRUE(is_video_name("clip.MP4"));
  EXPECT_TRUE(is_bag_name("a/b.Db3"));
  EXPECT_TRUE(is_image_name("1.TIFF"));
  for (const char* other : {"", "mp4", ".mp4", "clip.mp", "clip.mp4.txt"})
    EXPECT_FALSE(is_video_name(other)) << other;
}

TEST(FileKinds, ListsTheEndingsOfRecordings) {
  EXPECT_EQ(recording_endings(), "mp4, avi, mov, mkv, bag, db3, mcap");
}

TEST(FileKinds, AcceptsOnlyFilesAsRecipes) {
  EXPECT_TRUE(is_yaml_name("desk.yml"));
  EXPECT_FALSE(is_recipe("no such file.yaml"));
}

}  // namespace
}  // namespace gpo
