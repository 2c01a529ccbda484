// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/experiment/row.h"

#include "engine/frontend/tracking/tracking.h"
#include "engine/inspection/inspector.h"
#include "engine/inspection/report/result_json.h"
#include "engine/recording/layouts/open_recording.h"
#include "engine/window/window.h"
#include "tests/engine/experiment/made_rows.h"

#include <map>
#include <set>
#include <sstream>

#include <gmock/gmock.h>

namespace gpo {
namespace {

using test::made_row;
using ::testing::HasSubstr;
using ::testing::StartsWith;

std::vector<std::string> column_names() {
  std::vector<std::string> names;
  std::istringstream header(to_csv({}));
  for (std::string name; std::getline(header, name, ',');) {
    names.push_back(name.substr(0, name.find('\n')));
  }
  return names;
}

TEST(Row, HasEveryNumberOfTheReportAndTimesLast) {
  const auto recording = open_recording(std::string(GPO_SOURCE_DIR) + "/sequences/desk");
  const auto inspection = Inspector(recording).inspect({.frames = 6});
  const nlohmann::ordered_json report = to_json(*inspection);
  const std::vector<std::string> names = column_names();
  const std::set<std::string> columns(names.begin(), names.end());
  for (const char* part : {"settings", "window", "solver", "metrics"}) {
    for (const auto& [key, value] : report[part].items()) EXPECT_TRUE(columns.contains(key)) << key;
  }
  for (const auto& [key, value] : report["timing_ms"].items()) {
    EXPECT_TRUE(columns.contains(key + "_ms")) << key;
  }
  const std::size_t first_time = names.size() - 8;
  for (std::size_t i = first_time; i < first_time + 6; ++i) {
    EXPECT_TRUE(names[i].ends_with("_ms")) << names[i];
  }
  EXPECT_EQ(names[first_time + 6], "jobs");
  EXPECT_EQ(names[first_time + 7], "processor");
}

/// The cells of one row by their columns.
std::map<std::string, std::string> cells_of(const Row& row) {
  const std::string csv = to_csv(std::vector{row});
  std::istringstream line(csv.substr(csv.find('\n') + 1));
  std::map<std::string, std::string> cells;
  for (const std::string& name : column_names()) std::getline(line, cells[name], ',');
  return cells;
}

TEST(Row, IsLabeledByTheSettingsThatWereUsed) {
  const auto recording = open_recording(std::string(GPO_SOURCE_DIR) + "/sequences/desk");
  const auto inspection = Inspector(recording).inspect(
      {.frames = 6, .tracking = Tracking::frame_to_frame, .options = {.method = "gpo"}});
  const Row row = make_row(*inspection);
  EXPECT_EQ(row.configuration, "gpo+frame-to-frame");
  EXPECT_EQ(row.settings.tracking, Tracking::frame_to_frame);
  EXPECT_EQ(row.settings.options.rotations, RotationSource::gyro_calibrated);
  EXPECT_EQ(row.settings.options.ransac, true);
}

TEST(Row, HasNoCellOfWhatTheMethodDoesNotRead) {
  Settings settings{.options = {.method = "gpo"}};
  settings.options.method_options.loss = Loss::squared;
  settings.options.gravity = Gravity::joint;
  auto cells = cells_of(refused_row("desk", settings, ""));
  EXPECT_EQ(cells.at("configuration"), "gpo");
  EXPECT_EQ(cells.at("solver"), "schur");
  EXPECT_EQ(cells.at("gravity"), "after");
  EXPECT_EQ(cells.at("loss"), "");
  EXPECT_EQ(cells.at("shutter"), "");
  settings.options.method = "gpo_joint";
  cells = cells_of(refused_row("desk", settings, ""));
  EXPECT_EQ(cells.at("configuration"), "gpo_joint+squared+joint-gravity");
  EXPECT_EQ(cells.at("gravity"), "joint");
  EXPECT_EQ(cells.at("loss"), "squared");
  EXPECT_EQ(cells.at("shutter"), "estimated");
  EXPECT_EQ(cells.at("time_offset"), "false");
}

TEST(Row, ComesBackFromJsonToTheBit) {
  Row row = made_row("gpo+no-ransac", 3, 7, 0.1 + 0.2);
  row.settings.options.rotations = RotationSource::averaging;
  row.settings.options.ransac = false;
  row.settings.tracking = Tracking::anchored;
  row.settings.options.inliers = Inliers::consistent;
  row.inliers = 118;
  row.iterations = 9;
  const auto text = to_json(row).dump();
  const Row back = row_from_json(nlohmann::ordered_json::parse(text));
  EXPECT_EQ(back.pne_deg, row.pne_deg);
  EXPECT_EQ(to_csv(std::vector{back}), to_csv(std::vector{row}));
  EXPECT_EQ(back.settings, row.settings);
  EXPECT_EQ(back.inliers, row.inliers);
}

TEST(Row, QuotesReasonsAndLeavesTheUnknownEmpty) {
  const std::string csv = to_csv(std::vector{made_row("gpo", 3, 7, {})});
  EXPECT_THAT(csv.substr(csv.find('\n') + 1), StartsWith("made,gpo,3,7,gpo_joint,automatic,"));
  EXPECT_THAT(csv, HasSubstr("failed,\"no parallax, \"\"none\"\"\",,,"));
}

}  // namespace
}  // namespace gpo
