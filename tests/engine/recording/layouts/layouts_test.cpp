// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/layouts/layouts.h"

#include "engine/recording/layouts/open_recording.h"
#include "tests/engine/test_folder.h"

#include <set>

#include <gmock/gmock.h>

namespace gpo {
namespace {

using test::error_of;
using test::TestFolder;
using testing::HasSubstr;

/// The title of the layout that is found first.
std::string title_of(const std::filesystem::path& path) {
  for (const Layout& layout : layouts())
    if (layout.find(path)) return layout.title;
  return "none";
}

TEST(Layouts, AreCompleteAndDifferent) {
  std::set<std::string> titles;
  for (const Layout& layout : layouts()) {
    EXPECT_TRUE(titles.insert(layout.title).second) << layout.title;
    EXPECT_TRUE(layout.find != nullptr && layout.has_images != nullptr);
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

TEST(Layouts, AreAllNamedWhereNoneIsFound) {
  const TestFolder folder;
  const std::string message = error_of([&] { open_recording(folder.path()); });
  for (const Layout& layout : layouts()) EXPECT_THAT(message, HasSubstr(layout.expected));
  EXPECT_THAT(message, testing::EndsWith(", or tracks.csv"));
}

}  // namespace
}  // namespace gpo
