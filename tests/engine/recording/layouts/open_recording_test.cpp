// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/layouts/open_recording.h"

#include "tests/engine/largest.h"
#include "tests/engine/test_folder.h"

#include <cmath>
#include <random>

#include <gmock/gmock.h>
#include <opencv2/imgproc.hpp>

namespace gpo::test {
namespace {

using testing::HasSubstr;

/// Returns the title of the first layout that fits.
std::string title_of(const std::filesystem::path& path) {
  for (const Layout& layout : layouts())
    if (layout.find(path)) return layout.title;
  return "none";
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

TEST(FileKinds, AreRecognizedByEndingsInAnyCase) {
  EXPECT_TRUE(is_video_name("clip.MP4"));
  EXPECT_TRUE(is_bag_name("a/b.Db3"));
  EXPECT_TRUE(is_image_name("1.TIFF"));
  for (const char* other : {"", "mp4", ".mp4", "clip.mp", "clip.mp4.txt"})
    EXPECT_FALSE(is_video_name(other)) << other;
  EXPECT_EQ(recording_endings(),
            "mp4, mov, m4v, 3gp, mkv, webm, avi, ts, m2ts, mpg, bag, db3, mcap");
  EXPECT_FALSE(is_video_name("program.ts"));  // TypeScript, unless its content is a video
  EXPECT_TRUE(is_yaml_name("desk.yml"));
  EXPECT_FALSE(is_recipe("no such file.yaml"));
}

const Eigen::Vector3d kBias(-0.0022, 0.0215, 0.0776);  // EuRoC's

/// Smoothed noise, shifted horizontally.
cv::Mat image(double shift_px) {
  cv::Mat noise(240, 320, CV_8UC3);
  cv::RNG random(3);
  random.fill(noise, cv::RNG::UNIFORM, 0, 255);
  cv::GaussianBlur(noise, noise, {}, 2);
  const cv::Mat move = (cv::Mat_<double>(2, 3) << 1, 0, shift_px, 0, 1, 0);
  cv::warpAffine(noise, noise, move, noise.size(), cv::INTER_LINEAR, cv::BORDER_REFLECT);
  cv::normalize(noise, noise, 0, 255, cv::NORM_MINMAX);
  return noise;
}

struct Made {
  double stationary_s = 2;       ///< from the beginning of 4 s
  double noise_rad_s = 0.004;    ///< each sample
  double images_px_per_s = 0;    ///< meanwhile
  Eigen::Vector3d rate = kBias;  ///< measured meanwhile
  std::uint64_t seed = 1;
};

Recording made(const Made& options) {
  constexpr std::int64_t kStart_ns = 1'500'000'000'000'000'000;
  Recording recording;
  recording.camera = {320, 240, 250, 250, 160, 120, Distortion::none, {}};
  for (int i = 0; i < 80; ++i) recording.timestamps_ns.push_back(kStart_ns + i * 50'000'000LL);
  recording.images = std::make_shared<FrameCache>(80, [options](int i) {
    const double moving_s = std::max(0.0, i / 20.0 - options.stationary_s);
    return image(options.images_px_per_s * i / 20.0 + 30 * moving_s);
  });
  Gyroscope gyroscope;
  std::mt19937_64 random(options.seed);
  std::normal_distribution<double> noise(0, options.noise_rad_s);
  for (int k = 0; k < 800; ++k) {
    const double t = k / 200.0;
    const double turning =
        t > options.stationary_s ? 0.5 * std::sin(9 * (t - options.stationary_s)) : 0;
    gyroscope.timestamps_ns.push_back(kStart_ns + k * 5'000'000LL);
    gyroscope.rates_rad_s.push_back(options.rate + Eigen::Vector3d(turning, 0, -turning) +
                                    Eigen::Vector3d(noise(random), noise(random), noise(random)));
  }
  recording.gyroscope = gyroscope;
  return recording;
}

TEST(StationaryInterval, EstimatesTheBias) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Recording recording = made({.seed = seed});
    const auto rest = find_stationary_interval(recording);
    ASSERT_TRUE(rest);
    EXPECT_NEAR(1e-9 * static_cast<double>(rest->last_ns - rest->first_ns), 2, 0.3);
    EXPECT_LT(largest(rest->mean_rad_s - kBias), 4 * rest->sigma_rad_s);
    EXPECT_LT((rest->mean_rad_s - kBias).norm(), 0.001);
    EXPECT_NEAR(rest->sigma_rad_s, 0.002, 0.0005);  // the bias changes
  }
}

TEST(StationaryInterval, IsMissingIfImagesMoveRatesVaryOrItIsShort) {
  // On a turntable the constant rate is not the bias.
  EXPECT_FALSE(find_stationary_interval(made({.images_px_per_s = 10})));
  EXPECT_FALSE(find_stationary_interval(made({.noise_rad_s = 0.05})));
  EXPECT_TRUE(find_stationary_interval(made({.stationary_s = 0.6})));
  EXPECT_FALSE(find_stationary_interval(made({.stationary_s = 0.3})));
  Recording without_gyroscope = made({});
  without_gyroscope.gyroscope.reset();
  EXPECT_FALSE(find_stationary_interval(without_gyroscope));
}

TEST(StationaryInterval, UsesTracksIfThereAreNoImages) {
  Recording recording = made({});
  recording.images.reset();
  EXPECT_FALSE(find_stationary_interval(recording));
  for (int i = 0; i < 80; ++i)
    for (int j = 0; j < 20; ++j)
      recording.tracks.push_back({i, j, {10.0 * j + (i > 40 ? i - 40 : 0), 5.0 * j}});
  ASSERT_TRUE(find_stationary_interval(recording));
  for (TrackObservation& one : recording.tracks) one.raw_px.x() += one.frame;
  EXPECT_FALSE(find_stationary_interval(recording));
}

}  // namespace
}  // namespace gpo::test
