// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/frame_cache.h"

#include "engine/base/error.h"

#include <atomic>
#include <future>
#include <semaphore>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace gpo {
namespace {

constexpr std::size_t kImageBytes = 64 * 48 * 3;

cv::Mat image_of(int index) { return {48, 64, CV_8UC3, cv::Scalar::all(index)}; }

/// Images as bright as their index, which record the order of decoding; `broken` fails.
class Numbered {
 public:
  explicit Numbered(std::size_t limit = 1, int broken = -1)
      : cache_(
            100, [this, broken](int index) { return decode(index, broken); }, limit) {}

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
    return image_of(index);
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<int> decoded_;
  FrameCache cache_;
};

TEST(FrameCache, DecodesAnImageOnceWhenRequested) {
  Numbered counted(10 * kImageBytes);
  EXPECT_EQ(counted.cache().count(), 100);
  EXPECT_TRUE(counted.cache().find(7).empty());
  EXPECT_EQ(counted.decoded().size(), 0U);
  const cv::Mat first = counted.cache().bgr(7);
  EXPECT_EQ(counted.cache().find(7).data, first.data);
  EXPECT_EQ(counted.cache().bgr(7).data, first.data);
  EXPECT_EQ(counted.cache().gray(7).at<std::uint8_t>(3, 4), 7);
  EXPECT_EQ(counted.decoded().size(), 1U);
}

TEST(FrameCache, StaysWithinItsLimit) {
  Numbered counted(10 * kImageBytes + 5);
  for (int i = 0; i < 100; ++i) {
    counted.cache().bgr(i);
    EXPECT_LE(counted.cache().bytes(), 10 * kImageBytes);
  }
  EXPECT_EQ(counted.cache().bytes(), 10 * kImageBytes);
}

TEST(FrameCache, DropsTheLeastRecentlyUsed) {
  Numbered counted(3 * kImageBytes);
  for (const int i : {0, 1, 2, 0, 3}) counted.cache().bgr(i);  // 3 replaces 1
  EXPECT_EQ(counted.decoded().size(), 4U);
  for (const int i : {0, 2, 3}) counted.cache().bgr(i);
  EXPECT_EQ(counted.decoded().size(), 4U);
  counted.cache().bgr(1);
  EXPECT_EQ(counted.decoded().size(), 5U);
}

TEST(FrameCache, KeepsTheNewestImageBeyondTheLimit) {
  Numbered counted(1);
  counted.cache().bgr(4);
  counted.cache().bgr(5);
  counted.cache().bgr(5);
  EXPECT_EQ(counted.decoded().size(), 2U);
  EXPECT_EQ(counted.cache().bytes(), kImageBytes);
}

TEST(FrameCache, DecodesAgainAfterForget) {
  Numbered counted(10 * kImageBytes);
  for (const int i : {0, 1, 2}) counted.cache().bgr(i);
  const cv::Mat held = counted.cache().bgr(2);
  counted.cache().forget();
  EXPECT_EQ(counted.cache().bytes(), 0U);
  EXPECT_EQ(held.at<cv::Vec3b>(5, 5)[1], 2);
  EXPECT_EQ(counted.cache().bgr(2).at<cv::Vec3b>(5, 5)[1], 2);
  EXPECT_EQ(counted.decoded().size(), 4U);
}

TEST(FrameCache, ReturnsTheRightImagesToManyThreads) {
  Numbered counted(5 * kImageBytes);
  std::atomic<int> wrong = 0;
  {
    std::vector<std::jthread> threads;
    for (int t = 0; t < 8; ++t)
      threads.emplace_back([&, t] {
        for (int i = 0; i < 400; ++i) {
          const int index = (i * (t + 1)) % 100;
          if (counted.cache().bgr(index).at<cv::Vec3b>(5, 5)[1] != index) ++wrong;
        }
      });
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_LE(counted.cache().bytes(), 5 * kImageBytes);
}

/// Delays decoding image 1 until `let_go`.
struct Delayed {
  std::counting_semaphore<> begun{0}, let_go{0};
  std::atomic<int> decoded = 0;
  FrameCache cache{100, [this](int index) {
                     if (index == 1) {
                       begun.release();
                       let_go.acquire();
                     }
                     ++decoded;
                     return image_of(index);
                   }};
};

TEST(FrameCache, ReturnsOtherImagesWhileOneIsDecoded) {
  Delayed held;
  held.cache.bgr(0);
  std::jthread slow([&] { held.cache.bgr(1); });
  held.begun.acquire();
  auto others = std::async(std::launch::async, [&] {
    return held.cache.bgr(0).at<cv::Vec3b>(0, 0)[0] == 0 &&  // cached
           held.cache.bgr(2).at<cv::Vec3b>(0, 0)[0] == 2 &&  // decoded meanwhile
           !held.cache.find(2).empty() && held.cache.find(1).empty() && held.cache.bytes() > 0;
  });
  // Times out if the slow thread blocks the others.
  EXPECT_TRUE(others.get());
  held.let_go.release();
}

TEST(FrameCache, DecodesOnceForTwoThreads) {
  Delayed held;
  {
    std::jthread first([&] { held.cache.bgr(1); });
    held.begun.acquire();
    std::jthread second([&] { held.cache.bgr(1); });
    held.let_go.release(2);
  }
  EXPECT_EQ(held.decoded, 1);
  EXPECT_FALSE(held.begun.try_acquire());
}

TEST(FrameCache, RetriesAfterAnotherThreadFailed) {
  std::counting_semaphore<> begun{0}, let_go{0};
  std::atomic<int> calls = 0;
  const FrameCache cache(3, [&](int index) {
    begun.release();
    let_go.acquire();
    if (++calls == 1) throw InputError("cut");
    return image_of(index);
  });
  auto first = std::async(std::launch::async, [&] { return cache.bgr(1); });
  begun.acquire();
  auto second = std::async(std::launch::async, [&] { return cache.bgr(1); });
  let_go.release(2);
  EXPECT_THROW(first.get(), InputError);
  EXPECT_EQ(second.get().at<cv::Vec3b>(0, 0)[0], 1);
  EXPECT_EQ(calls, 2);
}

TEST(FrameCache, KeepsCachedImagesWhenDecodingFails) {
  int calls = 0;
  const FrameCache cache(3, [&calls](int index) {
    if (++calls == 2) throw InputError("cut");
    return image_of(index);
  });
  cache.bgr(0);
  EXPECT_THROW(cache.bgr(1), InputError);
  EXPECT_EQ(cache.bytes(), kImageBytes);
  EXPECT_EQ(cache.bgr(1).at<cv::Vec3b>(0, 0)[0], 1);
}

constexpr int kCount = 12;

int number(const cv::Mat& gray) {
  EXPECT_EQ(gray.type(), CV_8UC1);
  return gray.at<unsigned char>(0, 0);
}

TEST(ImagesAhead, DecodesEachRequestedImageOnce) {
  Numbered images;
  {
    ImagesAhead ahead(images.cache(), 2, kCount);
    for (int i = 2; i < kCount; ++i) EXPECT_EQ(number(ahead.gray(i)), i);
  }
  EXPECT_EQ(images.decoded(), (std::vector<int>{2, 3, 4, 5, 6, 7, 8, 9, 10, 11}));
}

TEST(ImagesAhead, DecodesAFewImagesInAdvance) {
  Numbered images;
  {
    ImagesAhead ahead(images.cache(), 0, kCount);
    images.wait_for(ImagesAhead::kAhead);
    EXPECT_EQ(number(ahead.gray(0)), 0);
    images.wait_for(ImagesAhead::kAhead + 1);
  }
  EXPECT_EQ(std::ssize(images.decoded()), ImagesAhead::kAhead + 1);
}

TEST(ImagesAhead, FailsOnlyForTheBrokenImage) {
  Numbered images(1, 5);
  ImagesAhead ahead(images.cache(), 3, kCount);
  EXPECT_EQ(number(ahead.gray(3)), 3);
  EXPECT_EQ(number(ahead.gray(4)), 4);
  EXPECT_THROW(ahead.gray(5), InputError);
  EXPECT_THROW(ahead.gray(5), InputError);
  EXPECT_EQ(number(ahead.gray(6)), 6);
}

TEST(ImagesAhead, ReturnsImagesOutOfOrder) {
  Numbered images;
  ImagesAhead ahead(images.cache(), 0, 4);
  for (const int i : {7, 0, 1, 2, 3, 4, 0}) EXPECT_EQ(number(ahead.gray(i)), i);
}

TEST(ImagesAhead, EndsAtOnceWithoutRequests) {
  Numbered images;
  for (int round = 0; round < 50; ++round) ImagesAhead(images.cache(), 0, kCount);
  EXPECT_LE(std::ssize(images.decoded()), 50 * ImagesAhead::kAhead);
  ImagesAhead(images.cache(), 3, 3);
}

}  // namespace
}  // namespace gpo
