// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/error.h"
#include "engine/recording/frame_cache.h"

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace gpo {
namespace {

constexpr int kCount = 12;

/// Pictures as bright as their index, of which it is known which were decoded; `broken` is not.
class Numbered {
 public:
  explicit Numbered(int broken = -1)
      : cache_(
            kCount, [this, broken](int index) { return decode(index, broken); }, 1) {}

  const FrameCache& cache() const { return cache_; }
  std::vector<int> decoded() {
    const std::scoped_lock lock(mutex_);
    return decoded_;
  }
  void wait_for(int count) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&]() { return std::ssize(decoded_) >= count; });
  }

 private:
  cv::Mat decode(int index, int broken) {
    const std::scoped_lock lock(mutex_);
    decoded_.push_back(index);
    changed_.notify_all();
    if (index == broken) throw InputError(fmt::format("picture {}", index));
    return {4, 4, CV_8UC3, cv::Scalar::all(index)};
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<int> decoded_;
  FrameCache cache_;
};

int number(const cv::Mat& gray) {
  EXPECT_EQ(gray.type(), CV_8UC1);
  return gray.at<unsigned char>(0, 0);
}

TEST(ImagesAhead, AreThoseThatAreAskedForEachDecodedOnce) {
  Numbered images;
  {
    ImagesAhead ahead(images.cache(), 2, kCount);
    for (int i = 2; i < kCount; ++i) EXPECT_EQ(number(ahead.gray(i)), i);
  }
  EXPECT_EQ(images.decoded(), (std::vector<int>{2, 3, 4, 5, 6, 7, 8, 9, 10, 11}));
}

TEST(ImagesAhead, AreDecodedBeforeTheyAreAskedForButNotTooMany) {
  Numbered images;
  {
    ImagesAhead ahead(images.cache(), 0, kCount);
    images.wait_for(ImagesAhead::kAhead);
    EXPECT_EQ(number(ahead.gray(0)), 0);
    images.wait_for(ImagesAhead::kAhead + 1);
  }
  EXPECT_EQ(std::ssize(images.decoded()), ImagesAhead::kAhead + 1);
}

TEST(ImagesAhead, FailWhereTheBrokenOneIsAskedFor) {
  Numbered images(5);
  ImagesAhead ahead(images.cache(), 3, kCount);
  EXPECT_EQ(number(ahead.gray(3)), 3);
  EXPECT_EQ(number(ahead.gray(4)), 4);
  EXPECT_THROW(ahead.gray(5), InputError);
  EXPECT_THROW(ahead.gray(5), InputError);
  EXPECT_EQ(number(ahead.gray(6)), 6);
}

TEST(ImagesAhead, AreGivenOutOfOrderToo) {
  Numbered images;
  ImagesAhead ahead(images.cache(), 0, 4);
  EXPECT_EQ(number(ahead.gray(7)), 7);
  for (int i = 0; i < 4; ++i) EXPECT_EQ(number(ahead.gray(i)), i);
  EXPECT_EQ(number(ahead.gray(4)), 4);
  EXPECT_EQ(number(ahead.gray(0)), 0);
}

TEST(ImagesAhead, NobodyAsksForEndAtOnce) {
  Numbered images;
  for (int round = 0; round < 50; ++round) ImagesAhead(images.cache(), 0, kCount);
  EXPECT_LE(std::ssize(images.decoded()), 50 * ImagesAhead::kAhead);
  ImagesAhead(images.cache(), 3, 3);
}

}  // namespace
}  // namespace gpo
