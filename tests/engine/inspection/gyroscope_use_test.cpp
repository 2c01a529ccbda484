// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inspection/inspector.h"
#include "engine/inspection/report/report.h"
#include "tests/engine/desk.h"
#include "tests/engine/test_folder.h"

#include <gmock/gmock.h>

namespace gpo::test {
namespace {

using testing::HasSubstr, testing::Not;

using Change = std::function<void(Gyroscope&)>;

std::shared_ptr<const Inspection> inspected(const Change& change,
                                            RotationSource source,
                                            const char* method = "gpo_joint") {
  auto recording = std::make_shared<Recording>(*desk());
  change(*recording->gyroscope);
  Settings settings;
  settings.options.rotations = source;
  settings.options.method = method;
  return Inspector(std::move(recording)).inspect(settings);
}

/// Removes 80 ms of samples in the middle of the first window.
void remove_samples(Gyroscope& gyroscope) {
  const std::int64_t begin_ns = desk()->timestamps_ns[12] + gyroscope.time_offset_ns,
                     end_ns = begin_ns + 80'000'000;
  Gyroscope rest = gyroscope;
  rest.timestamps_ns.clear();
  rest.rates_rad_s.clear();
  rest.lines.clear();
  rest.accelerations_m_s2.clear();
  for (std::size_t k = 0; k < gyroscope.timestamps_ns.size(); ++k) {
    if (gyroscope.timestamps_ns[k] > begin_ns && gyroscope.timestamps_ns[k] < end_ns) continue;
    rest.timestamps_ns.push_back(gyroscope.timestamps_ns[k]);
    rest.rates_rad_s.push_back(gyroscope.rates_rad_s[k]);
    rest.lines.push_back(gyroscope.lines[k]);
    if (!gyroscope.accelerations_m_s2.empty())
      rest.accelerations_m_s2.push_back(gyroscope.accelerations_m_s2[k]);
  }
  gyroscope = std::move(rest);
}

TEST(GyroscopeUse, AGapCostsTheGyroscopeButNotTheRun) {
  const auto found = inspected(remove_samples, RotationSource::automatic);
  EXPECT_TRUE(found->initialization->ok) << found->initialization->reason;
  EXPECT_FALSE(found->inertial);
  EXPECT_THAT(to_text(*found), HasSubstr("the gyroscope is not used: "));
  EXPECT_THAT(to_text(*found), HasSubstr("in the gyroscope's samples"));
  EXPECT_THAT(error_of([] { inspected(remove_samples, RotationSource::gyro); }),
              HasSubstr("gap of 0.08"));
}

std::string misfit_of(const Inspection& inspection) {
  const Finding* found = find_finding(inspection.findings, "gyroscope-misfit");
  return found == nullptr ? "" : found->sentence;
}

TEST(GyroscopeUse, AWrongClockIsCorrectedAndNamed) {
  const auto shift = [](Gyroscope& gyroscope) { gyroscope.time_offset_ns -= 40'000'000; };
  const auto right = inspected([](Gyroscope&) {}, RotationSource::automatic);
  const auto late = inspected(shift, RotationSource::automatic);
  EXPECT_EQ(misfit_of(*right), "");
  EXPECT_THAT(to_text(*late),
              HasSubstr("the gyroscope does not fit the images: its clock is about +"));
  EXPECT_EQ(late->rotations_used, RotationSource::gyro_calibrated);
  ASSERT_TRUE(late->evaluation && late->evaluation->pne_deg);
  EXPECT_LT(*late->evaluation->pne_deg, *right->evaluation->pne_deg + 0.1);
}

TEST(GyroscopeUse, WrongAxesCostTheGyroscope) {
  const auto swap = [](Gyroscope& gyroscope) {
    gyroscope.R_gyro_camera = gyroscope.R_gyro_camera * so3_exp({0, 0, M_PI / 2});
  };
  const auto found = inspected(swap, RotationSource::automatic);
  EXPECT_THAT(misfit_of(*found),
              HasSubstr("the gyroscope is not used, it does not fit the images: "));
  EXPECT_FALSE(found->inertial);
}

TEST(GyroscopeUse, ADeadGyroscopeIsNotUsed) {
  const auto found = inspected(
      [](Gyroscope& gyroscope) {
        for (Eigen::Vector3d& rate : gyroscope.rates_rad_s) rate.setZero();
      },
      RotationSource::automatic,
      "gpo");
  EXPECT_THAT(
      misfit_of(*found),
      HasSubstr("the gyroscope is not used, it does not fit the images: the images rotate"));
  EXPECT_EQ(found->initialization->verdict->readiness, Readiness::ready);
}

TEST(GyroscopeUse, AClockThatIsOffByUpToHalfAFrameIsTheReasonOfAWeakVerdict) {
  for (const int late_ms : {13, 15, -13, -15}) {
    const auto shift = [&](Gyroscope& gyroscope) {
      gyroscope.time_offset_ns -= 1'000'000LL * late_ms;
    };
    const auto found = inspected(shift, RotationSource::automatic, "gpo");
    EXPECT_EQ(misfit_of(*found), "");
    EXPECT_THAT(found->initialization->verdict->reason,
                HasSubstr("the clock of the gyroscope is about "))
        << late_ms;
  }
}

}  // namespace
}  // namespace gpo::test
