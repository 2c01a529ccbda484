// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/images/images.h"

#include <gmock/gmock.h>

namespace gpo::test {
namespace {

using testing::ElementsAre;

struct Names {
  const char* first;
  const char* second;
  std::int64_t first_ns, second_ns;
};

TEST(TimesInNames, AreReadInAllUnits) {
  for (const auto& [first, second, first_ns, second_ns] :
       {Names{"1403636579763555584.png",
              "1403636579813555456.png",
              1403636579763555584,
              1403636579813555456},
        Names{"img_1403636579763555.png",
              "img_1403636579813555.png",
              1403636579763555000,
              1403636579813555000},
        Names{"1403636579763.jpg", "1403636579813.jpg", 1403636579763000000, 1403636579813000000},
        Names{"1305031102.175304.png",
              "1305031102.211214.png",
              1305031102175304000,
              1305031102211214000},
        Names{"left_1305031102_175304000.png",
              "left_1305031102_211214000.png",
              1305031102175304000,
              1305031102211214000},
        Names{"1305031102-75304000.png",
              "1305031102-211214000.png",
              1305031102075304000,
              1305031102211214000},
        Names{"0.033333.png", "0.066667.png", 33333000, 66667000},
        Names{"123456789012.png", "123490122345.png", 123456789012, 123490122345}}) {
    std::vector<std::filesystem::path> files = {second, first};
    const auto found = times_in_names(files);
    ASSERT_TRUE(found) << first;
    EXPECT_THAT(found->times_ns, ElementsAre(first_ns, second_ns));
    EXPECT_EQ(files.front(), first);
  }
}

TEST(TimesInNames, AreThoseOfAClockAlsoAcrossAMinute) {
  constexpr std::int64_t kNoon_ns = 1'706'702'400'000'000'000;  // 2024-01-31 12:00
  constexpr std::int64_t kOfDay_ns = 43'200'000'000'000;
  for (const auto& [first, second, noon_ns] :
       {std::tuple("2024-01-31_12-00-59.933.jpg", "2024-01-31_12-01-00.000.jpg", kNoon_ns),
        {"2024-01-31T12:00:59.933Z.jpg", "2024-01-31T12:01:00Z.jpg", kNoon_ns},
        {"20240131_120059933.jpg", "20240131_120100000.jpg", kNoon_ns},
        {"IMG_20240131120059933.jpg", "IMG_20240131120100000.jpg", kNoon_ns},
        {"cam12_20240131-120059-933.jpg", "cam12_20240131-120100-000.jpg", kNoon_ns},
        {"12_00_59.933000.jpg", "12_01_00.000000.jpg", kOfDay_ns}}) {
    std::vector<std::filesystem::path> files = {first, second};
    const auto found = times_in_names(files);
    ASSERT_TRUE(found) << first;
    EXPECT_THAT(found->times_ns, ElementsAre(noon_ns + 59'933'000'000, noon_ns + 60'000'000'000));
    EXPECT_STREQ(found->unit, "hours, minutes and seconds");
    EXPECT_THAT(files, ElementsAre(first, second));
  }
}

TEST(TimesInNames, NeverChangeTheOrderIfAnotherNumberPrecedesThem) {
  std::vector<std::filesystem::path> files = {
      "run1-58.900.png", "run1-59.933.png", "run2-00.000.png", "run2-00.033.png"};
  const auto given = files;
  EXPECT_FALSE(times_in_names(files));
  EXPECT_EQ(files, given);
}

TEST(TimesInNames, CountFromZeroIfTheirStepsAreRounded) {
  using Files = std::vector<std::filesystem::path>;
  for (const auto& [unit, names] :
       {std::pair("milliseconds",
                  Files{"0000.png", "0033.png", "0067.png", "0133.png", "0167.png"}),
        {"microseconds", Files{"0.png", "66667.png", "133333.png", "200000.png", "266667.png"}},
        {"", Files{"00.png", "33.png", "66.png", "99.png", "132.png"}},
        {"", Files{"1.png", "2.png", "4.png", "5.png", "6.png"}},
        {"", Files{"10.png", "35.png", "41.png", "90.png", "97.png"}}}) {
    Files files = names;
    const auto found = times_in_names(files);
    EXPECT_STREQ(found ? found->unit : "", unit) << names[1];
  }
}

TEST(TimesInNames, AreNotReadFromNumbersOfFrames) {
  for (const auto& [first, second] :
       {std::pair("frame_000001.png", "frame_000002.png"),
        {"IMG_2041.JPG", "IMG_2047.JPG"},
        {"IMG_20240101_120000.jpg", "IMG_20240101_120000_1.jpg"},
        {"IMG_20240101_120000_001.jpg", "IMG_20240101_120000_002.jpg"},
        {"IMG_20241301_120000123.jpg", "IMG_20241301_120005123.jpg"},
        {"20240101_000001.png", "20240101_000002.png"},
        {"10_20_30.png", "10_20_31.png"},
        {"30.png", "60.png"}}) {
    std::vector<std::filesystem::path> files = {first, second};
    EXPECT_FALSE(times_in_names(files)) << first;
  }
}

TEST(TimesInNames, AreNotReadIfOneDoesNotFitIntoNanoseconds) {
  std::vector<std::filesystem::path> files = {
      "1600000000000.png", "1600000000033.png", "1600000000066.png", "99999999999999.png"};
  EXPECT_FALSE(times_in_names(files));
}

}  // namespace
}  // namespace gpo::test
