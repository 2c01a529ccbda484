// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/experiment/window_files.h"
#include "engine/methods/methods.h"
#include "tests/app/program.h"

#include <gmock/gmock.h>

namespace gpo::test {
namespace {

using testing::HasSubstr;

/// Errors that no method exceeds by much where there is enough parallax: those of drifting tracks,
/// some three times what was seen.
constexpr double kMostPne_deg = 6;
constexpr double kMostAte_m = 0.006;

// Synthesizes the recordings where that has not been done yet, which takes some minutes.
TEST(NineRecordings, EveryMethodSucceedsWithParallaxAndRefusesRotationWithAReason) {
  const std::vector<std::string> names = rendered_recordings();
  std::string recipes;
  for (const std::string& name : names) recipes += "sequences/" + name + ".yaml ";
  const fs::path folder = fresh_folder() / "evaluation";
  const Outcome outcome =
      program("evaluate " + recipes + "--lengths 30 --starts 0:30:30 --output " + folder.string());
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const Experiment experiment = read_experiment(folder);
  const std::vector<Row> rows = collect_rows(experiment, std::span(&folder, 1));
  EXPECT_EQ(rows.size(), names.size() * 2 * experiment.configurations.size());
  EXPECT_GE(experiment.configurations.size(), methods().size() + 4);
  for (const Row& row : rows) {
    SCOPED_TRACE(row.recording + " " + row.configuration);
    if (row.recording == "rotation-dominant") {
      EXPECT_FALSE(row.ok());
      EXPECT_THAT(row.reason, HasSubstr("no parallax"));
      continue;
    }
    const bool of_all_tracks =
        row.configuration.ends_with("five-point") || row.configuration.ends_with("direct");
    if (of_all_tracks && !row.ok()) {
      EXPECT_THAT(row.reason, HasSubstr("nearly all tracks lie on one plane"));
      continue;
    }
    EXPECT_TRUE(row.ok()) << row.reason;
    // What lies off the plane makes the plane wrong where it is not rejected: that is its point.
    if (!row.ok() || row.configuration == "gpo+no-ransac") continue;
    EXPECT_LT(row.pne_deg, kMostPne_deg);
    EXPECT_LT(row.ate_m, kMostAte_m);
  }
}

}  // namespace
}  // namespace gpo::test
