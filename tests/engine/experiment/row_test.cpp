// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/experiment/row.h"

#include "engine/experiment/experiment.h"
#include "engine/frontend/tracking/tracking.h"
#include "engine/inspection/inspector.h"
#include "engine/inspection/report/result.h"
#include "engine/window/window.h"
#include "tests/engine/desk.h"
#include "tests/engine/experiment/made_rows.h"
#include "tests/engine/test_folder.h"

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
  for (std::string name; std::getline(header, name, ',');)
    names.push_back(name.substr(0, name.find('\n')));
  return names;
}

TEST(Row, HasAllNumbersOfTheReportAndTimesLast) {
  const auto inspection = Inspector(test::desk()).inspect({.frames = 6});
  const nlohmann::ordered_json report = to_json(*inspection);
  const std::vector<std::string> names = column_names();
  const std::set<std::string> columns(names.begin(), names.end());
  for (const char* part : {"settings", "window", "solver", "metrics"})
    for (const auto& [key, value] : report[part].items()) EXPECT_TRUE(columns.contains(key)) << key;
  for (const auto& [key, value] : report["timing_ms"].items())
    EXPECT_TRUE(columns.contains(key + "_ms")) << key;
  const std::size_t first_time = names.size() - 8;
  for (std::size_t i = first_time; i < first_time + 6; ++i)
    EXPECT_TRUE(names[i].ends_with("_ms")) << names[i];
  EXPECT_EQ(names[first_time + 6], "jobs");
  EXPECT_EQ(names[first_time + 7], "processor");
}

/// Returns the cells of one row by column.
std::map<std::string, std::string> cells_of(const Row& row) {
  const std::string csv = to_csv(std::vector{row});
  std::istringstream line(csv.substr(csv.find('\n') + 1));
  std::map<std::string, std::string> cells;
  for (const std::string& name : column_names()) std::getline(line, cells[name], ',');
  return cells;
}

TEST(Row, IsLabeledByUsedSettings) {
  const Settings settings{
      .frames = 6, .tracking = Tracking::frame_to_frame, .options = {.method = "gpo"}};
  const Row row = make_row(*Inspector(test::desk()).inspect(settings));
  EXPECT_EQ(row.configuration, "gpo+frame-to-frame");
  EXPECT_EQ(row.settings.tracking, Tracking::frame_to_frame);
  EXPECT_EQ(row.settings.options.rotations, RotationSource::gyro_calibrated);
  EXPECT_EQ(row.settings.options.ransac, true);
}

TEST(Row, LeavesUnreadSettingsEmpty) {
  Settings settings{.options = {.method = "gpo"}};
  settings.options.method_options.loss = Loss::squared;
  settings.options.gravity = Gravity::joint;
  const auto expect = [&](const std::map<std::string, std::string>& expected) {
    const auto cells = cells_of(refused_row("desk", settings, ""));
    for (const auto& [column, cell] : expected) EXPECT_EQ(cells.at(column), cell) << column;
  };
  expect({{"configuration", "gpo"},
          {"solver", "schur"},
          {"gravity", "after"},
          {"loss", ""},
          {"shutter", ""}});
  settings.options.method = "gpo_joint";
  expect({{"configuration", "gpo_joint+squared+joint-gravity"},
          {"gravity", "joint"},
          {"loss", "squared"},
          {"shutter", "estimated"},
          {"time_offset", "false"}});
}

TEST(Row, SurvivesJsonExactly) {
  Row row = made_row("gpo+no-ransac", 3, 7, 0.1 + 0.2);
  row.settings.options.rotations = RotationSource::averaging;
  row.settings.options.ransac = false;
  row.settings.tracking = Tracking::anchored;
  row.settings.options.inliers = Inliers::consistent;
  row.inliers = 118;
  row.iterations = 9;
  const Row back = row_from_json(nlohmann::ordered_json::parse(to_json(row).dump()));
  EXPECT_EQ(back.pne_deg, row.pne_deg);
  EXPECT_EQ(to_csv(std::vector{back}), to_csv(std::vector{row}));
  EXPECT_EQ(back.settings, row.settings);
  EXPECT_EQ(back.inliers, row.inliers);
}

TEST(Row, QuotesReasonsAndLeavesUnknownValuesEmpty) {
  const std::string csv = to_csv(std::vector{made_row("gpo", 3, 7, {})});
  EXPECT_THAT(csv.substr(csv.find('\n') + 1), StartsWith("made,gpo,3,7,gpo_joint,automatic,"));
  EXPECT_THAT(csv, HasSubstr("failed,\"no parallax, \"\"none\"\"\",,,"));
}

Row desk_row(const std::string& configuration, int frames) {
  const Settings settings{.start = 7, .frames = frames};
  Row row = refused_row("desk", apply(parse_configuration(configuration), settings), "");
  row.status = "ok";
  row.pne_deg = 0.1 * frames;
  row.ate_m = 1.0 / 3;
  row.iterations = 5;
  row.termination = "convergence";
  return row;
}

class ResultsFile : public ::testing::Test {
 protected:
  std::filesystem::path write(const std::string& text) {
    return folder_.write("results.csv", text);
  }
  std::string refusal(const std::string& text) {
    return test::error_of([&] { read_results(write(text)); });
  }
  test::TestFolder folder_;
};

TEST_F(ResultsFile, ReadsBackWrittenRows) {
  std::vector<Row> rows = {desk_row("gpo", 10), desk_row("gpo+no-ransac", 20), desk_row("ba", 10)};
  rows[1].status = "failed";
  rows[1].reason = "too little parallax, \"0.1\" of\n1 deg";
  rows[1].ate_m.reset();
  const auto file = write(to_csv(rows));
  EXPECT_TRUE(is_results(file));
  const std::vector<Row> read = read_results(file);
  ASSERT_EQ(read.size(), rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) EXPECT_EQ(to_json(read[i]), to_json(rows[i])) << i;
}

TEST_F(ResultsFile, ErrorsNameFileAndLine) {
  const std::string good = to_csv(std::vector<Row>{desk_row("gpo", 10), desk_row("ba", 10)});
  const auto broken = [&](const std::string& old, const std::string& by) {
    std::string text = good;
    text.replace(text.rfind(old), old.size(), by);
    return refusal(text);
  };
  EXPECT_THAT(broken(",ok,", ",perhaps,"), HasSubstr("results.csv:3: status: found 'perhaps'"));
  EXPECT_THAT(broken(",7,", ",seven,"), HasSubstr("results.csv:3: start: 'seven'"));
  EXPECT_THAT(broken("desk,ba", "desk,baa"), HasSubstr("results.csv:3: methods"));
  EXPECT_THAT(broken(",7,", ","), HasSubstr("results.csv:3: found"));
  EXPECT_THAT(refusal("recording,configuration,frames\n"), HasSubstr("results.csv:1: no column"));
  EXPECT_THAT(refusal(good.substr(0, good.find('\n') + 1)), HasSubstr("no rows"));
  EXPECT_THAT(refusal(good + "\"desk"), HasSubstr("results.csv:4: found a quote"));
}

TEST_F(ResultsFile, CountsLineBreaksInCells) {
  std::vector<Row> rows = {desk_row("gpo", 10), desk_row("ba", 10)};
  rows[0].reason = "a\nb";
  std::string text = to_csv(rows);
  text.replace(text.rfind(",ok,"), 4, ",no,");
  EXPECT_THAT(refusal(text), HasSubstr("results.csv:4: status"));
}

TEST_F(ResultsFile, IgnoresUnknownAndMissingColumns) {
  const auto file = write(
      "recording,configuration,start,frames,status,color,pne_deg\r\n"
      "desk,gpo,0,10,ok,red,0.5\r\n");
  const std::vector<Row> rows = read_results(file);
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_EQ(rows[0].pne_deg, 0.5);
  EXPECT_EQ(rows[0].ate_m, std::nullopt);
}

TEST_F(ResultsFile, RejectsOtherTables) {
  EXPECT_FALSE(is_results(write("#timestamp [ns],w_RS_S_x\n1,2\n")));
  EXPECT_FALSE(is_results(folder_.path()));
  EXPECT_FALSE(is_results(folder_.path() / "none.csv"));
}

}  // namespace
}  // namespace gpo
