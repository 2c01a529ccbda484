// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/companions/companion_files.h"
#include "engine/recording/layouts/open_recording.h"
#include "engine/recording/loggers/logs.h"
#include "engine/window/timestamps.h"
#include "tests/engine/recording/images/made_video.h"
#include "tests/engine/test_folder.h"

#include <limits>

#include <gmock/gmock.h>

namespace gpo::test {
namespace {

using testing::HasSubstr, testing::IsEmpty;

std::string letters(const std::string& key, const std::string& text) {
  return gpmf_item(key, 'c', 1, text);
}

std::string stream(const std::string& items) { return gpmf_item("STRM", '\0', 1, items); }

/// Returns a stream of rates in units of 1/100 rad/s.
std::string gyro_stream(const std::string& before, const std::vector<std::int64_t>& samples) {
  return stream(before + gpmf_item("SCAL", 's', 2, big_endian({100}, 2)) +
                gpmf_item("GYRO", 's', 6, big_endian(samples, 2)));
}

std::string device(const std::string& name, const std::string& streams) {
  return gpmf_item("DEVC", '\0', 1, letters("DVNM", name) + streams);
}

GpmfPayload parsed(const std::string& bytes) {
  GpmfCount counted;
  return parse_gpmf(bytes, "GX010001.MP4", counted);
}

/// Rates about x left, y back and z up.
const Eigen::Vector3d kRates(1, 2, 3);

TEST(Gpmf, UsesTheAxesStoredByTheCamera) {
  // The stored order is y, -x, z.
  const auto named =
      parsed(device("HERO8 Black", gyro_stream(letters("ORIN", "YxZ"), {200, -100, 300})));
  ASSERT_EQ(named.rates_rad_s.values.size(), 1U);
  EXPECT_LT((named.rates_rad_s.values[0] - kRates).norm(), 1e-12);
  // A GoPro Max stores x, -z, y and the matrix that converts them to z, x, y.
  const std::string one = big_endian({0x3F800000}, 4), minus = big_endian({0xBF800000}, 4);
  const std::string zero(4, '\0');
  const std::string matrix =
      gpmf_item("MTRX", 'f', 36, zero + minus + zero + one + zero + zero + zero + zero + one);
  const auto turned = parsed(device(
      "GoPro Max",
      gyro_stream(matrix + letters("ORIN", "XzY") + letters("ORIO", "ZXY"), {100, -300, 200})));
  EXPECT_LT((turned.rates_rad_s.values.at(0) - kRates).norm(), 1e-12);
}

TEST(Gpmf, ReadsTheAccelerometerInTheSameAxes) {
  const std::string axes = letters("ORIN", "YxZ");
  const auto payload =
      parsed(device("HERO8 Black",
                    gyro_stream(axes, {200, -100, 300}) +
                        stream(axes + gpmf_item("SCAL", 's', 2, big_endian({100}, 2)) +
                               gpmf_item("ACCL", 's', 6, big_endian({0, 0, 981, 0, 0, 981}, 2)))));
  ASSERT_EQ(payload.accelerations_m_s2.values.size(), 2U);
  EXPECT_LT((payload.accelerations_m_s2.values[0] - Eigen::Vector3d(0, 0, 9.81)).norm(), 1e-12);
}

TEST(Gpmf, NamesStabilizationThatIsOn) {
  const auto settings = [](const std::string& flags) { return device("HERO9 Black", flags); };
  EXPECT_EQ(stabilization_of_gpmf(settings(letters("EISE", "Y") + letters("EISA", "HS Boost"))),
            "EISE Y, EISA HS Boost");
  EXPECT_EQ(stabilization_of_gpmf(settings(letters("EISE", "N") + letters("EISA", "N/A"))), "");
  EXPECT_EQ(stabilization_of_gpmf(""), "");
}

TEST(AddAccelerations, InterpolatesOnlyWhatTheAccelerometerCovers) {
  Gyroscope gyroscope;
  gyroscope.timestamps_ns = {0, 50'000'000, 100'000'000, 500'000'000};
  gyroscope.rates_rad_s.assign(4, kRates);
  Gyroscope uncovered = gyroscope;
  add_accelerations({{0, 100'000'000, 600'000'000}, {{0, 0, 9}, {0, 0, 10}, {0, 0, 11}}},
                    gyroscope);
  ASSERT_EQ(gyroscope.accelerations_m_s2.size(), 4U);
  EXPECT_NEAR(gyroscope.accelerations_m_s2[1].z(), 9.5, 1e-12);
  EXPECT_NEAR(gyroscope.accelerations_m_s2[2].z(), 10, 1e-12);
  EXPECT_FALSE(gyroscope.accelerations_m_s2[3].allFinite());  // in a gap of 0.5 s
  add_accelerations({{0, 300'000'000}, {{0, 0, 9}, {0, 0, 10}}}, uncovered);
  EXPECT_THAT(uncovered.accelerations_m_s2, IsEmpty());
}

TEST(Gpmf, KnowsTheAxesOfOlderModels) {
  using Samples = std::vector<std::int64_t>;
  for (const auto& [model, samples] : {std::pair("Camera", Samples{300, 100, 200}),
                                       std::pair("Hero6 Black", Samples{200, -100, 300}),
                                       std::pair("Fusion", Samples{-200, 100, 300})}) {
    const auto rates = parsed(device(model, gyro_stream("", samples))).rates_rad_s.values;
    EXPECT_LT((rates.at(0) - kRates).norm(), 1e-12) << model;
  }
}

TEST(Gpmf, IgnoresDevicesWithoutAGyroscope) {
  const std::string other = device("SENSORB6", stream(letters("STNM", "heart")));
  EXPECT_EQ(parsed(other + device("Camera", gyro_stream("", {1, 2, 3}))).rates_rad_s.values.size(),
            1U);
  EXPECT_THAT(parsed(other).rates_rad_s.values, IsEmpty());
}

TEST(Gpmf, FitsTimesToTheCamerasStampsFromTheFirstExposure) {
  std::vector<GpmfPayload> payloads;
  GpmfCount counted;
  for (int i = 0; i < 5; ++i) {
    const int count = i == 1 ? 199 : 200;  // varying payloads
    const int total = 200 * i + count - (i > 1 ? 1 : 0);
    const std::int64_t stamp_us = 80'000 + 5'000 * (total - count);
    const std::string stamps = gpmf_item("STMP", 'J', 8, big_endian({stamp_us}, 8)) +
                               gpmf_item("TSMP", 'L', 4, big_endian({total}, 4));
    const std::string frames = gpmf_item("STMP", 'J', 8, big_endian({90'000 + 1'000'000 * i}, 8)) +
                               gpmf_item("TSMP", 'L', 4, big_endian({30 * i + 30}, 4)) +
                               gpmf_item("SHUT", 'f', 4, std::string(std::size_t{4} * 30, '\0'));
    const std::vector<std::int64_t> samples(std::size_t{3} * count, 1);
    const std::string streams = gyro_stream(stamps, samples) + gpmf_item("STRM", '\0', 4, frames);
    payloads.push_back(parse_gpmf(device("HERO9 Black", streams), "GX010001.MP4", counted));
  }
  const auto times = gpmf_times_ns(payloads, {0, 1, 2, 3, 4, 5});
  ASSERT_EQ(times.size(), 999U);
  for (std::size_t k = 0; k < times.size(); ++k)
    ASSERT_NEAR(static_cast<double>(times[k]), -10e6 + 5e6 * static_cast<double>(k), 1e3) << k;
}

TEST(Gpmf, UsesTheTracksTimesWithoutStamps) {
  GpmfCount counted;
  const std::string bytes = device("Camera", gyro_stream("", std::vector<std::int64_t>(300, 1)));
  std::vector<GpmfPayload> payloads = {parse_gpmf(bytes, "", counted)};
  const auto alone = gpmf_times_ns(payloads, {0.5, 1.5});
  ASSERT_EQ(alone.size(), 100U);
  EXPECT_EQ(alone[0], 500'000'000);
  EXPECT_EQ(alone[99], 1'490'000'000);
  payloads.push_back(parse_gpmf(bytes, "", counted));
  EXPECT_EQ(gpmf_times_ns(payloads, {0, 1, 2}).at(150), 1'500'000'000);
}

TEST(Gpmf, NamesKeysOfErrors) {
  const std::string scaled = gpmf_item("SCAL", 's', 2, big_endian({0}, 2));
  const std::string no_rotation = gpmf_item("MTRX", 'f', 36, std::string(36, '\0'));
  const std::string no_samples = gpmf_item("TSMP", 'L', 4, big_endian({0}, 4));
  const std::string not_rates =
      "GYRO: found samples that are not three numbers, expected values of three axes";
  const std::vector<std::pair<std::string, std::string>> errors = {
      {device("Camera", gyro_stream("", {1, 2, 3})).substr(0, 40),
       "DEVC: found 32 bytes (truncated), expected 52"},
      {device("C", stream(std::string("GYRO\x73\x06\x7f\xff", 8))),
       "GYRO: found 0 bytes (truncated), expected 196602"},
      {device("C", gyro_stream(letters("ORIN", "YXZ"), {1, 2, 3})),
       "ORIN: found no axes, expected three right-handed axes such as ZXY"},
      {device("C", gyro_stream(no_rotation + letters("ORIO", "ZXY"), {1, 2, 3})),
       "MTRX: found a matrix that is not a rotation, expected a rotation"},
      {device("C", stream(scaled + gpmf_item("GYRO", 's', 6, big_endian({1, 2, 3}, 2)))),
       "SCAL: found 0, expected a divisor"},
      {device("C", stream(gpmf_item("GYRO", 's', 4, big_endian({1, 2}, 2)))), not_rates},
      {device("C", stream(gpmf_item("GYRO", 'U', 16, std::string(16, '1')))), not_rates},
      {device("C", stream(gpmf_item("GYRO", 'f', 12, big_endian({0x7F800000, 0, 0}, 4)))),
       "GYRO: found a number that is not finite, expected numbers"},
      {device("C", gyro_stream(no_samples, {1, 2, 3})),
       "TSMP: found 0, expected a count of all samples so far"}};
  for (const auto& [bytes, message] : errors)
    EXPECT_EQ(error_of([&, bytes = bytes] { parsed(bytes); }), "GX010001.MP4: " + message);
}

TEST(Camm, ReadsRatesAndExposures) {
  EXPECT_EQ(*parse_camm(camm_rates(1, -2, 3), "").rates_rad_s, Eigen::Vector3d(1, -2, 3));
  EXPECT_NEAR(*parse_camm(camm_exposure(1'000'000, 20'000'000), "").readout_s, 0.02, 1e-12);
  EXPECT_FALSE(parse_camm(std::string("\0\0\x07\0", 4), "").rates_rad_s);
}

TEST(Camm, RefusesBadSamples) {
  const auto error = [](const std::string& bytes) {
    return error_of([&] { parse_camm(bytes, "a.mp4"); });
  };
  EXPECT_EQ(error(camm_rates(1, 2, 3).substr(0, 12)),
            "a.mp4: found a sample of 12 bytes (truncated), expected 16");
  EXPECT_EQ(error(""), "a.mp4: found a sample of 0 bytes (truncated), expected 4");
  EXPECT_EQ(error(camm_rates(1, std::numeric_limits<float>::infinity(), 3)),
            "a.mp4: a rate is not finite");
}

class VideoWithTelemetry : public testing::Test {
 protected:
  static constexpr int kFrames = 50;  // two seconds

  std::shared_ptr<const Recording> open(const std::string& format,
                                        const std::vector<TelemetryPiece>& pieces,
                                        int clockwise_degrees = 0) const {
    folder.write("camera.yaml", kCameraYaml);
    const std::vector<cv::Mat> images(kFrames, cv::Mat(48, 64, CV_8UC3, cv::Scalar::all(90)));
    VideoOptions options{.clockwise_degrees = clockwise_degrees, .telemetry_format = format};
    options.telemetry = pieces;
    make_video(file, images, options);
    return open_recording(folder.path());
  }
  /// Two payloads of a second each.
  static std::vector<TelemetryPiece> gopro() {
    std::vector<std::int64_t> samples;
    for (int k = 0; k < 100; ++k) samples.insert(samples.end(), {300, 100, 200});
    const std::string bytes = device("Camera", gyro_stream("", samples));
    return {{0, 1000, bytes}, {1000, 1000, bytes}};
  }

  TestFolder folder;
  std::filesystem::path file = folder.path() / "GX010001.mp4";
};

TEST_F(VideoWithTelemetry, ReadsAGoProsGyroscopeAndAxes) {
  // Left, back, up at 1, 2, 3 rad/s. Right and down in a stored image that the player turns upside
  // down are left and up.
  for (const auto& [clockwise_degrees, rates_rad_s] :
       {std::pair(0, Eigen::Vector3d(-1, -3, -2)), std::pair(180, Eigen::Vector3d(1, 3, -2))}) {
    const auto recording = open("gpmd", gopro(), clockwise_degrees);
    ASSERT_TRUE(recording->gyroscope);
    const Gyroscope& gyroscope = *recording->gyroscope;
    ASSERT_EQ(gyroscope.timestamps_ns.size(), 200U);
    EXPECT_NEAR(static_cast<double>(gyroscope.timestamps_ns[150]), 1.5e9, 1e6);
    const Eigen::Vector3d camera = gyroscope.R_gyro_camera.transpose() * gyroscope.rates_rad_s[0];
    EXPECT_LT((camera - rates_rad_s).norm(), 1e-12) << clockwise_degrees;
    EXPECT_THAT(recording->notes, testing::Not(testing::Contains(HasSubstr("T_BS"))));
  }
}

TEST_F(VideoWithTelemetry, ReadsRatesAndReadoutOfCameraMotionMetadata) {
  std::vector<TelemetryPiece> pieces = {{0, 1, camm_exposure(1'000'000, 15'000'000)}};
  for (int k = 1; k < 200; ++k) {
    const auto x = static_cast<float>(k);
    pieces.push_back({10 * k, 10, camm_rates(0.01F * x, 2, -3)});
  }
  const auto recording = open("camm", pieces);
  ASSERT_TRUE(recording->gyroscope);
  ASSERT_EQ(recording->gyroscope->timestamps_ns.size(), 199U);
  EXPECT_EQ(recording->gyroscope->timestamps_ns[99], 1'000'000'000);
  EXPECT_NEAR(recording->gyroscope->rates_rad_s[99].x(), 1, 1e-6);
  EXPECT_NEAR(recording->camera.readout->seconds, 0.015, 1e-12);
  EXPECT_FALSE(recording->camera.readout_direction);
  const Camera turned = open("camm", pieces, 180)->camera;
  EXPECT_EQ(turned.readout, recording->camera.readout);
  EXPECT_EQ(turned.readout_direction, ReadoutDirection::up);
  EXPECT_THAT(recording->notes,
              testing::Contains("no T_BS in camera.yaml: assuming that the gyroscope has "
                                "the camera's axes"));
}

TEST_F(VideoWithTelemetry, RefusesBrokenTelemetry) {
  const std::string name = file.string();
  auto pieces = gopro();
  pieces[1].bytes.resize(60);
  EXPECT_THAT(
      error_of([&] { open("gpmd", pieces); }),
      testing::StartsWith(name + ": telemetry: DEVC: found 52 bytes (truncated), expected "));
  pieces = {{0, 10, "abc"}, {10, 10, camm_rates(1, 2, 3)}};
  EXPECT_EQ(error_of([&] { open("camm", pieces); }),
            name + ": telemetry: found a sample of 3 bytes (truncated), expected 4");
}

TEST(RealTelemetry, ReadsAGoProOnADrone) {
  const auto file = std::filesystem::path(GPO_SHARED_DIR) / "data/gopro/karma.mp4";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no recordings in " << GPO_SHARED_DIR;
  const auto log = log_inside(file, 0);
  ASSERT_TRUE(log && log->gyroscope);
  const Gyroscope& gyroscope = *log->gyroscope;
  EXPECT_EQ(gyroscope.rates_rad_s.size(), 4795U);
  EXPECT_NEAR(rate_hz(gyroscope.timestamps_ns), 397.3, 0.5);
  const double first_s = 1e-9 * static_cast<double>(gyroscope.timestamps_ns.front());
  EXPECT_NEAR(1e-9 * static_cast<double>(gyroscope.timestamps_ns.back()) - first_s, 12.07, 0.05);
  EXPECT_NEAR(first_s, -0.018, 0.005);
  ASSERT_TRUE(log->T_body_camera);
  // The first sample is stored as 172, 70, 125 (z, x, y) with 3755 units per rad/s.
  EXPECT_LT((3755 * gyroscope.rates_rad_s[0] - Eigen::Vector3d(70, 125, 172)).norm(), 1e-9);
  ASSERT_EQ(gyroscope.accelerations_m_s2.size(), gyroscope.rates_rad_s.size());
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const auto& a : gyroscope.accelerations_m_s2) mean += a / 4795;
  EXPECT_NEAR(mean.norm(), 9.8, 0.5);
}

}  // namespace
}  // namespace gpo::test
