// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/frame_cache.h"

#include "engine/base/error.h"

#include <atomic>
#include <future>
#include <memory>
#include <semaphore>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace gpo {
namespace {

constexpr std::size_t kImageBytes = 64 * 48 * 3;

cv::Mat image_of(int index) { return {48, 64, CV_8UC3, cv::Scalar::all(index)}; }

struct Counted {
  std::shared_ptr<std::atomic<int>> decoded = std::make_shared<std::atomic<int>>(0);
  FrameCache cache;
  explicit Counted(std::size_t limit)
      : cache(
            100,
            [count = decoded](int index) {
              ++*count;
              return image_of(index);
            },
            limit) {}
};

TEST(FrameCache, DecodesAImageOnce) {
  const Counted counted(10 * kImageBytes);
  EXPECT_EQ(counted.cache.count(), 100);
  const cv::Mat first = counted.cache.bgr(7);
  const cv::Mat again = counted.cache.bgr(7);
  EXPECT_EQ(first.data, again.data);
  EXPECT_EQ(*counted.decoded, 1);
  EXPECT_EQ(counted.cache.gray(7).at<std::uint8_t>(3, 4), 7);
  EXPECT_EQ(*counted.decoded, 1);
}

TEST(FrameCache, StaysWithinItsLimit) {
  const Counted counted(10 * kImageBytes + 5);
  for (int i = 0; i < 100; ++i) {
    counted.cache.bgr(i);
    EXPECT_LE(counted.cache.bytes(), 10 * kImageBytes);
  }
  EXPECT_EQ(counted.cache.bytes(), 10 * kImageBytes);
}

TEST(FrameCache, ForgetsTheLeastRecentlyUsed) {
  const Counted counted(3 * kImageBytes);
  for (const int i : {0, 1, 2, 0, 3}) counted.cache.bgr(i);  // 3 drives out 1
  EXPECT_EQ(*counted.decoded, 4);
  for (const int i : {0, 2, 3}) counted.cache.bgr(i);
  EXPECT_EQ(*counted.decoded, 4);
  counted.cache.bgr(1);
  EXPECT_EQ(*counted.decoded, 5);
}

TEST(FrameCache, HoldsTheNewestImageWhateverTheLimit) {
  const Counted counted(1);
  counted.cache.bgr(4);
  counted.cache.bgr(5);
  counted.cache.bgr(5);
  EXPECT_EQ(*counted.decoded, 2);
  EXPECT_EQ(counted.cache.bytes(), kImageBytes);
}

TEST(FrameCache, LetsGoOfAllAndDecodesAgain) {
  const Counted counted(10 * kImageBytes);
  for (const int i : {0, 1, 2}) counted.cache.bgr(i);
  const cv::Mat held = counted.cache.bgr(2);
  counted.cache.forget();
  EXPECT_EQ(counted.cache.bytes(), 0U);
  EXPECT_EQ(held.at<cv::Vec3b>(5, 5)[1], 2);
  EXPECT_EQ(counted.cache.bgr(2).at<cv::Vec3b>(5, 5)[1], 2);
  EXPECT_EQ(*counted.decoded, 4);
}

TEST(FrameCache, GivesManyThreadsTheRightImages) {
  const Counted counted(5 * kImageBytes);
  std::atomic<int> wrong = 0;
  {
    std::vector<std::jthread> threads;
    for (int t = 0; t < 8; ++t) {
      threads.emplace_back([&, t] {
        for (int i = 0; i < 400; ++i) {
          const int index = (i * (t + 1)) % 100;
          if (counted.cache.bgr(index).at<cv::Vec3b>(5, 5)[1] != index) ++wrong;
        }
      });
    }
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_LE(counted.cache.bytes(), 5 * kImageBytes);
}

/// Decodes picture 1 only when it is let go; all others at once.
struct Held {
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

TEST(FrameCache, GivesOthersWhileOneIsDecoded) {
  Held held;
  held.cache.bgr(0);
  std::jthread slow([&] { held.cache.bgr(1); });
  held.begun.acquire();
  auto others = std::async(std::launch::async, [&] {
    return held.cache.bgr(0).at<cv::Vec3b>(0, 0)[0] == 0 &&  // kept
           held.cache.bgr(2).at<cv::Vec3b>(0, 0)[0] == 2 &&  // decoded beside it
           !held.cache.find(2).empty() && held.cache.find(1).empty() && held.cache.bytes() > 0;
  });
  // Were it held up by the slow one this would never be; the test's own time limit says so then.
  EXPECT_TRUE(others.get());
  held.let_go.release();
}

TEST(FrameCache, DecodesOnceWhatTwoThreadsAskFor) {
  Held held;
  {
    std::jthread first([&] { held.cache.bgr(1); });
    held.begun.acquire();
    std::jthread second([&] { held.cache.bgr(1); });
    held.let_go.release(2);
  }
  EXPECT_EQ(held.decoded, 1);
  EXPECT_FALSE(held.begun.try_acquire());
}

TEST(FrameCache, FindsOnlyWhatIsKept) {
  const Counted counted(3 * kImageBytes);
  EXPECT_TRUE(counted.cache.find(7).empty());
  EXPECT_EQ(*counted.decoded, 0);
  const cv::Mat image = counted.cache.bgr(7);
  EXPECT_EQ(counted.cache.find(7).data, image.data);
  EXPECT_EQ(*counted.decoded, 1);
}

TEST(FrameCache, LetsTheNextOneTryWhatFailed) {
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

TEST(FrameCache, ForgetsNothingWhenDecodingFails) {
  int calls = 0;
  const FrameCache cache(
      3,
      [&calls](int index) {
        if (++calls == 2) throw InputError("cut");
        return image_of(index);
      },
      10 * kImageBytes);
  cache.bgr(0);
  EXPECT_THROW(cache.bgr(1), InputError);
  EXPECT_EQ(cache.bytes(), kImageBytes);
  EXPECT_EQ(cache.bgr(1).at<cv::Vec3b>(0, 0)[0], 1);
}

}  // namespace
}  // namespace gpo
