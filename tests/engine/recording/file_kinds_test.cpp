// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/file_kinds.h"

#include <gtest/gtest.h>

namespace gpo {
namespace {

TEST(FileKinds, IgnoreTheCaseOfEndings) {
  EXPECT_TRUE(is_video_name("clip.MP4"));
  EXPECT_TRUE(is_bag_name("a/b.Db3"));
  EXPECT_TRUE(is_image_name("1.TIFF"));
  for (const char* other : {"", "mp4", ".mp4", "clip.mp", "clip.mp4.txt"})
    EXPECT_FALSE(is_video_name(other)) << other;
}

TEST(FileKinds, NameTheEndingsOfRecordings) {
  EXPECT_EQ(recording_endings(), "mp4, avi, mov, mkv, bag, db3, mcap");
}

TEST(FileKinds, TakeOnlyFilesForRecipes) {
  EXPECT_TRUE(is_yaml_name("desk.yml"));
  EXPECT_FALSE(is_recipe("no such file.yaml"));
}

}  // namespace
}  // namespace gpo
