// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/work/disk_readers.h"

#include "engine/base/error.h"

#include <algorithm>
#include <chrono>
#include <map>
#include <mutex>
#include <semaphore>
#include <thread>
#include <tuple>

#include <gmock/gmock.h>

namespace gpo {
namespace {

using testing::ElementsAre, testing::IsEmpty;

cv::Mat image_of(int index) { return {48, 64, CV_8UC3, cv::Scalar::all(index)}; }
int number_of(const cv::Mat& image) { return image.at<cv::Vec3b>(5, 5)[0]; }

/// Decodes images one by one when the test allows it. From 50 on decoding fails.
class ImageFetcherTest : public testing::Test {
 protected:
  ~ImageFetcherTest() override { let_go_.release(100); }

  cv::Mat decode(int index) {
    {
      const std::scoped_lock lock(mutex_);
      decoded_.push_back(index);
      by_test_ = by_test_ || std::this_thread::get_id() == test_;
    }
    begun_.release();
    let_go_.acquire();
    if (index >= 50) throw InputError("truncated");
    return image_of(index);
  }
  FetchedImage get(int index) { return fetcher_.get(images_, index); }
  void let_one_go() {
    let_go_.release();
    come_.acquire();
  }
  std::vector<int> decoded() {
    const std::scoped_lock lock(mutex_);
    return decoded_;
  }

  const std::thread::id test_ = std::this_thread::get_id();
  std::counting_semaphore<> begun_{0}, let_go_{0}, come_{0};
  std::mutex mutex_;
  std::vector<int> decoded_;
  bool by_test_ = false;
  /// Caches only the last image.
  std::shared_ptr<const FrameCache> images_ = std::make_shared<const FrameCache>(
      100, [this](int i) { return decode(i); }, 1);
  ImageFetcher fetcher_{[this] { come_.release(); }};
};

TEST_F(ImageFetcherTest, ReturnsAnImageOnceDecodedAndNeverBlocks) {
  const FetchedImage first = get(7);
  EXPECT_TRUE(first.waiting && first.bgr.empty());
  begun_.acquire();
  EXPECT_TRUE(get(7).waiting) << "it is being decoded";
  let_one_go();
  const FetchedImage then = get(7);
  ASSERT_FALSE(then.waiting || then.bgr.empty());
  EXPECT_EQ(number_of(then.bgr), 7);
  EXPECT_THAT(decoded(), ElementsAre(7));
  EXPECT_FALSE(by_test_);
}

TEST_F(ImageFetcherTest, LatestRequestComesFirstAndOldestAreDiscarded) {
  get(0);
  begun_.acquire();
  for (int i = 1; i <= 9; ++i) get(i);
  for (int i = 0; i < 5; ++i) let_one_go();
  EXPECT_THAT(decoded(), ElementsAre(0, 9, 8, 7, 6));
}

TEST_F(ImageFetcherTest, KeepsTheImagesOfSeveralViews) {
  for (const int i : {3, 4, 5}) {
    get(i);
    let_one_go();
  }
  for (const int i : {3, 4, 5}) EXPECT_EQ(number_of(get(i).bgr), i);
  EXPECT_EQ(decoded().size(), 3U);
}

TEST_F(ImageFetcherTest, ReportsAFailureAndDoesNotRetry) {
  get(60);
  let_one_go();
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(get(60).error, "truncated");
    EXPECT_FALSE(get(60).waiting);
  }
  EXPECT_THAT(decoded(), ElementsAre(60));
}

TEST_F(ImageFetcherTest, AnotherRecordingDiscardsAllRequests) {
  get(7);
  begun_.acquire();
  get(8);
  const auto others = std::make_shared<const FrameCache>(9, [](int i) { return image_of(i); });
  EXPECT_TRUE(fetcher_.get(others, 7).waiting);
  let_one_go();  // the obsolete one of the first recording, then the other
  const FetchedImage image = fetcher_.get(others, 7);
  ASSERT_FALSE(image.bgr.empty());
  EXPECT_EQ(number_of(image.bgr), 7);
  EXPECT_THAT(decoded(), ElementsAre(7)) << "8 is no longer requested";
}

TEST_F(ImageFetcherTest, ReturnsCachedImagesAtOnce) {
  let_go_.release();
  images_->bgr(2);
  EXPECT_EQ(number_of(get(2).bgr), 2);
  EXPECT_TRUE(by_test_) << "decoded on the thread of the test";
}

TEST(FetchImage, DecodesOnTheCallingThread) {
  const FrameCache images(3, [](int i) {
    if (i == 2) throw InputError("truncated");
    return image_of(i);
  });
  EXPECT_EQ(number_of(fetch_image(images, 1).bgr), 1);
  EXPECT_THAT(fetch_image(images, 1).error, IsEmpty());
  EXPECT_EQ(fetch_image(images, 2).error, "truncated");
}

namespace fs = std::filesystem;

const std::vector<FolderEntry> kEntries = {
    {"desk", true}, {"Desk-2", true}, {"orbit", true}, {".git", true}, {"desk.yaml"}};

std::vector<std::string> names(const std::vector<FolderEntry>& entries) {
  std::vector<std::string> all;
  for (const FolderEntry& entry : entries) all.push_back(entry.name);
  return all;
}

TEST(Browsing, SplitsATypedPath) {
  for (const auto& [text, folder, name] : {std::tuple{"/a/b", fs::path("/a/"), "b"},
                                           {"/a/b/", "/a/b/", ""},
                                           {"/a/../c/d", "/c/", "d"},
                                           {"x", fs::current_path() / "", "x"},
                                           {"/a/b//c/d", "/c/", "d"},
                                           {"/a/~b/c", "/a/~b/", "c"},
                                           {"/a/~b", "/a/", "~b"}}) {
    EXPECT_EQ(typed_path(text).folder, folder) << text;
    EXPECT_EQ(typed_path(text).name, name) << text;
  }
  EXPECT_EQ(typed_path("/a/~/d").folder, typed_path("~/").folder);
  EXPECT_EQ(typed_path("~").folder, typed_path("~/").folder.parent_path().parent_path() / "");
}

TEST(Browsing, ShortNamesTellPathsApart) {
  const std::vector<fs::path> paths = {"/data/a/desk", "/data/b/desk", "/data/b/room", "/desk"};
  EXPECT_THAT(short_names(paths), ElementsAre("a/desk", "b/desk", "room", "desk"));
}

TEST(Browsing, MatchesAnyPartAndHiddenEntriesOnRequest) {
  EXPECT_THAT(names(matching(kEntries, "")), ElementsAre("desk", "Desk-2", "orbit", "desk.yaml"));
  EXPECT_THAT(names(matching(kEntries, "DESK")), ElementsAre("desk", "Desk-2", "desk.yaml"));
  EXPECT_THAT(names(matching(kEntries, "bit")), ElementsAre("orbit"));
  EXPECT_THAT(names(matching(kEntries, ".")), ElementsAre(".git", "desk.yaml"));
}

TEST(Browsing, CompletesAsFarAsNamesAgree) {
  EXPECT_EQ(completed("/w/or", kEntries), "/w/orbit/");
  EXPECT_EQ(completed("/w/desk", kEntries), "/w/desk");
  EXPECT_EQ(completed("/w/desk.", kEntries), "/w/desk.yaml");
  EXPECT_EQ(completed("/w/nothing", kEntries), "/w/nothing");
  EXPECT_EQ(completed("/w/", kEntries), "/w/");
}

FolderList whole_list(FolderLister& lister, const fs::path& folder) {
  while (lister.list(folder).reading) std::this_thread::sleep_for(std::chrono::milliseconds(2));
  return lister.list(folder);
}

TEST(FolderLister, DescribesRecordings) {
  FolderLister lister;
  const FolderList list = whole_list(lister, fs::path(GPO_SOURCE_DIR) / "sequences");
  EXPECT_EQ(list.error, "");
  std::map<std::string, std::string> what;
  for (const FolderEntry& entry : list.entries) what[entry.name] = entry.what;
  EXPECT_EQ(what.at("desk"), "EuRoC \u00b7 60 frames \u00b7 2.0 s");
  EXPECT_EQ(what.at("companions"), "");
  EXPECT_EQ(what.at("orbit.yaml"), "recipe, rendered when opened");
  EXPECT_TRUE(list.entries.front().folder);
}

TEST(FolderLister, ListsTheLastRequestedFolderOrReportsThatItIsMissing) {
  FolderLister lister;
  EXPECT_EQ(whole_list(lister, "/no/such/folder").error, "No such file or directory");
  for (int i = 0; i < 20; ++i) {
    lister.list("/usr");
    lister.list(GPO_SOURCE_DIR);
  }
  const FolderList list = whole_list(lister, GPO_SOURCE_DIR);
  EXPECT_EQ(std::ranges::count(list.entries, "engine", &FolderEntry::name), 1);
}

}  // namespace
}  // namespace gpo
