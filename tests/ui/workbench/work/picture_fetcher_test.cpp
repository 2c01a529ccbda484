// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/work/picture_fetcher.h"

#include "engine/base/error.h"

#include <atomic>
#include <memory>
#include <mutex>
#include <semaphore>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace gpo {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

cv::Mat picture_of(int index) { return {48, 64, CV_8UC3, cv::Scalar::all(index)}; }
int number_of(const cv::Mat& picture) { return picture.at<cv::Vec3b>(5, 5)[0]; }

/// Pictures that are decoded one by one, as the test lets them go, and a fetcher of them. Of 50 the
/// decoder cannot read any more.
class PictureFetcherTest : public testing::Test {
 protected:
  ~PictureFetcherTest() override { let_go_.release(100); }

  cv::Mat decode(int index) {
    {
      const std::scoped_lock lock(mutex_);
      decoded_.push_back(index);
      by_test_ = by_test_ || std::this_thread::get_id() == test_;
    }
    begun_.release();
    let_go_.acquire();
    if (index >= 50) throw InputError("cut");
    return picture_of(index);
  }
  FetchedPicture get(int index) { return fetcher_.get(pictures_, index); }
  /// Lets one be decoded, and waits until it is there.
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
  /// Of which the cache keeps only the last.
  std::shared_ptr<const FrameCache> pictures_ = std::make_shared<const FrameCache>(
      100, [this](int i) { return decode(i); }, 1);
  PictureFetcher fetcher_{[this] { come_.release(); }};
};

TEST_F(PictureFetcherTest, GivesAPictureWhenItHasComeAndNeverWaits) {
  const FetchedPicture first = get(7);
  EXPECT_TRUE(first.waiting);
  EXPECT_TRUE(first.bgr.empty());
  begun_.acquire();
  EXPECT_TRUE(get(7).waiting) << "it is on its way";
  let_one_go();
  const FetchedPicture then = get(7);
  EXPECT_FALSE(then.waiting);
  ASSERT_FALSE(then.bgr.empty());
  EXPECT_EQ(number_of(then.bgr), 7);
  EXPECT_THAT(decoded(), ElementsAre(7));
  EXPECT_FALSE(by_test_);
}

TEST_F(PictureFetcherTest, TheNewestWishComesFirstAndTheOldestAreForgotten) {
  get(0);
  begun_.acquire();
  for (int i = 1; i <= 9; ++i) get(i);
  for (int i = 0; i < 5; ++i) let_one_go();
  EXPECT_THAT(decoded(), ElementsAre(0, 9, 8, 7, 6));
}

TEST_F(PictureFetcherTest, KeepsWhatSeveralViewsShowThoughTheCacheDoesNot) {
  for (const int i : {3, 4, 5}) {
    get(i);
    let_one_go();
  }
  for (const int i : {3, 4, 5}) EXPECT_EQ(number_of(get(i).bgr), i);
  EXPECT_EQ(decoded().size(), 3U);
}

TEST_F(PictureFetcherTest, SaysWhyThereIsNoneAndDoesNotTryAgain) {
  get(60);
  let_one_go();
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(get(60).error, "cut");
    EXPECT_FALSE(get(60).waiting);
  }
  EXPECT_THAT(decoded(), ElementsAre(60));
}

TEST_F(PictureFetcherTest, AnotherRecordingsPicturesTakeThePlaceOfAll) {
  get(7);
  begun_.acquire();
  get(8);
  const auto others = std::make_shared<const FrameCache>(9, [](int i) { return picture_of(i); });
  EXPECT_TRUE(fetcher_.get(others, 7).waiting);
  let_one_go();  // of the first recording: of no interest any more; then the other's
  const FetchedPicture picture = fetcher_.get(others, 7);
  ASSERT_FALSE(picture.bgr.empty());
  EXPECT_EQ(number_of(picture.bgr), 7);
  EXPECT_THAT(decoded(), ElementsAre(7)) << "nobody asks for 8 any more";
}

TEST_F(PictureFetcherTest, HasAtOnceWhatIsThereAlready) {
  let_go_.release();
  pictures_->bgr(2);
  EXPECT_EQ(number_of(get(2).bgr), 2);
  EXPECT_TRUE(by_test_) << "the test itself had it decoded";
}

TEST(FetchPicture, WaitsForIt) {
  const FrameCache pictures(3, [](int i) {
    if (i == 2) throw InputError("cut");
    return picture_of(i);
  });
  EXPECT_EQ(number_of(fetch_picture(pictures, 1).bgr), 1);
  EXPECT_THAT(fetch_picture(pictures, 1).error, IsEmpty());
  EXPECT_EQ(fetch_picture(pictures, 2).error, "cut");
}

}  // namespace
}  // namespace gpo
