// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/images/images.h"
#include "tests/engine/recording/bags/small_bag.h"
#include "tests/engine/recording/images/made_video.h"
#include "tests/engine/recording/recording_folder.h"

#include <sys/stat.h>

namespace gpo::test {
namespace {

namespace fs = std::filesystem;

const std::vector<cv::Mat> kImages(3, cv::Mat(48, 64, CV_8UC3, cv::Scalar(20, 60, 90)));

class KindOfFile : public RecordingFolder {
 protected:
  KindOfFile() { folder.write("camera.yaml", kCameraYaml); }
  FileKind kind(const std::string& bytes) const { return kind_of(folder.write("a file", bytes)); }
};

TEST_F(KindOfFile, IsAVideoForEachContainerWhateverTheName) {
  for (const char* name : {"a.mp4", "a.mov", "a.3gp", "a.mkv", "a.avi", "a.ts"}) {
    // libavformat recognizes a transport stream by some packets only.
    const std::size_t count = std::string(name) == "a.ts" ? 60 : 3;
    make_video(folder.path() / name,
               std::vector<cv::Mat>(count, kImages[0]),
               {.b_frames = std::string(name) == "a.3gp"});
    const fs::path renamed = folder.path() / (std::string(name) + ".bin");
    fs::rename(folder.path() / name, renamed);
    EXPECT_EQ(kind_of(renamed), FileKind::video) << name;
    EXPECT_EQ(open_recording(renamed)->frame_count(), count) << name;
    EXPECT_EQ(open()->frame_count(), count) << name;
    fs::remove(renamed);
  }
}

TEST_F(KindOfFile, IsABagOrAnImageByTheFirstBytes) {
  fs::rename(write_small_bag(folder.path() / "b.mcap", mcap_writer), folder.path() / "bag.bin");
  EXPECT_EQ(kind_of(folder.path() / "bag.bin"), FileKind::bag);
  EXPECT_EQ(open_recording(folder.path() / "bag.bin")->frame_count(), 20);
  EXPECT_EQ(kind("#ROSBAG V2.0\nrest of the bag"), FileKind::bag);
  folder.write("1.png", kImages[0]);
  EXPECT_EQ(kind(folder.read("1.png")), FileKind::image);
}

TEST_F(KindOfFile, IsOtherForWhatOnlyResemblesAVideo) {
  EXPECT_EQ(kind(""), FileKind::other);
  EXPECT_EQ(kind("not free of text, but free of images"), FileKind::other);
  EXPECT_EQ(kind(std::string(2000, 'G')), FileKind::other);
  EXPECT_EQ(kind(std::string("\0\0\0\x18", 4) + "ftypheic" + std::string(12, '\0')),
            FileKind::other);
  EXPECT_EQ(kind("#EXTM3U\nfile:///etc/passwd\n"), FileKind::other);
  EXPECT_EQ(kind("II*" + std::string(50, '\0')), FileKind::other) << "a raw photo";
  const fs::path pipe = folder.path() / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_EQ(kind_of(pipe), FileKind::other);
}

TEST_F(KindOfFile, IsThatOfTheNameIfTheContentIsUnknown) {
  EXPECT_EQ(kind_of(folder.write("a.webm", "broken")), FileKind::video);
  EXPECT_EQ(kind_of(folder.write("a.db3", "broken")), FileKind::bag);
  EXPECT_EQ(kind_of(folder.path() / "missing.MOV"), FileKind::video);
}

TEST_F(KindOfFile, PrefersUsualNamesInAFolder) {
  make_video(folder.path() / "GX010001.mp4", kImages);
  folder.write("GX010001.LRV", folder.read("GX010001.mp4"));
  folder.write("1.png", kImages[0]);
  folder.write("GX010001.THM", folder.read("1.png"));
  EXPECT_EQ(open()->image_files, std::vector<fs::path>{folder.path() / "GX010001.mp4"});
}

TEST_F(KindOfFile, ReadsNumberedImagesWithoutUsualNames) {
  for (const char* name : {"1.png", "2.png"}) {
    folder.write(name, kImages[0]);
    fs::rename(folder.path() / name, folder.path() / (std::string("frame") + name[0]));
  }
  EXPECT_EQ(open()->frame_count(), 2);
}

}  // namespace
}  // namespace gpo::test
