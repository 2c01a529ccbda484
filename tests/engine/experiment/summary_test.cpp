// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/experiment/summary.h"

#include "engine/inspection/inspector.h"
#include "engine/inspection/report/report.h"
#include "tests/engine/desk.h"
#include "tests/engine/experiment/made_rows.h"
#include "tests/engine/test_folder.h"

#include <set>
#include <sstream>

#include <gmock/gmock.h>

namespace gpo::test {
namespace {

using testing::ElementsAre, testing::HasSubstr, testing::StartsWith;

std::vector<std::string> column_names() {
  std::vector<std::string> names;
  std::istringstream header(to_csv(std::span<const Row>()));
  for (std::string name; std::getline(header, name, ',');)
    names.push_back(name.substr(0, name.find('\n')));
  return names;
}

TEST(Row, HasAllNumbersOfTheReportAndTimesLast) {
  const auto inspection = Inspector(desk()).inspect({.frames = 6});
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
  const Row row = make_row(*Inspector(desk()).inspect(settings));
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
          {"shutter", "known"},
          {"time_offset", "true"}});
}

TEST(Row, SurvivesJsonExactlyAndQuotesReasonsInCsv) {
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
    return error_of([&] { read_results(write(text)); });
  }
  TestFolder folder_;
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

TEST_F(ResultsFile, ErrorsNameFileAndLineAndCountLineBreaksInCells) {
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
  std::vector<Row> rows = {desk_row("gpo", 10), desk_row("ba", 10)};
  rows[0].reason = "a\nb";
  std::string text = to_csv(rows);
  text.replace(text.rfind(",ok,"), 4, ",no,");
  EXPECT_THAT(refusal(text), HasSubstr("results.csv:4: status"));
}

TEST_F(ResultsFile, IgnoresUnknownAndMissingColumnsAndRejectsOtherTables) {
  const auto file = write(
      "recording,configuration,start,frames,status,color,pne_deg\r\n"
      "desk,gpo,0,10,ok,red,0.5\r\n");
  const std::vector<Row> rows = read_results(file);
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_EQ(rows[0].pne_deg, 0.5);
  EXPECT_EQ(rows[0].ate_m, std::nullopt);
  EXPECT_FALSE(is_results(write("#timestamp [ns],w_RS_S_x\n1,2\n")));
  EXPECT_FALSE(is_results(folder_.path()));
  EXPECT_FALSE(is_results(folder_.path() / "none.csv"));
}

TEST(Distribution, IsMedianAndQuartiles) {
  const Distribution five = distribution({5, 1, 4, 2, 3});
  EXPECT_EQ(five.count, 5);
  EXPECT_EQ(five.lower, 2);
  EXPECT_EQ(five.median, 3);
  EXPECT_EQ(five.upper, 4);
  const Distribution four = distribution({1, 2, 3, 10});
  EXPECT_DOUBLE_EQ(*four.lower, 1.75);
  EXPECT_DOUBLE_EQ(*four.median, 2.5);
  EXPECT_DOUBLE_EQ(*four.upper, 4.75);
  EXPECT_EQ(distribution({7}).upper, 7);
  EXPECT_FALSE(distribution({}).median);
}

/// Returns three windows of 10 frames and one of 20. Without RANSAC one of each length fails.
std::vector<Row> made_rows() {
  return {made_row("gpo", 0, 10, 1.0),
          made_row("gpo+no-ransac", 0, 10, 3.0),
          made_row("gpo", 0, 20, 0.5),
          made_row("gpo+no-ransac", 0, 20, {}),
          made_row("gpo", 1, 10, 100.0),
          made_row("gpo+no-ransac", 1, 10, {}),
          made_row("gpo", 2, 10, 2.0),
          made_row("gpo+no-ransac", 2, 10, 5.0)};
}

TEST(Summary, ExcludesFailuresFromMediansAndComparesOnWindowsThatAllSolved) {
  const std::vector<Cell> cells = summarize(made_rows());
  ASSERT_EQ(cells.size(), 4U);
  EXPECT_EQ(cells[0].configuration, "gpo");
  EXPECT_EQ(cells[0].frames, 10);
  EXPECT_EQ(cells[0].windows, 3);
  EXPECT_EQ(cells[0].values.at("pne_deg").median, 2);
  EXPECT_EQ(cells[2].configuration, "gpo+no-ransac");
  EXPECT_EQ(cells[2].windows, 3);
  EXPECT_EQ(cells[2].ok, 2);
  EXPECT_EQ(cells[2].values.at("pne_deg").median, 4);
  EXPECT_EQ(cells[3].ok, 0);
  EXPECT_FALSE(cells[3].values.at("pne_deg").median);
  EXPECT_EQ(cells[0].values.at("pde_m").count, 0);  // unknown everywhere
  const std::vector<Cell> common = summarize(on_common_windows(made_rows()));
  ASSERT_EQ(common.size(), 3U);
  EXPECT_EQ(common[0].windows, 2);  // without the one of 100 deg, which the other failed
  EXPECT_EQ(common[0].values.at("pne_deg").median, 1.5);
  EXPECT_EQ(common[1].frames, 20);  // the other solved none of this length and is ignored
  EXPECT_EQ(common[1].windows, 1);
  EXPECT_EQ(common[2].values.at("pne_deg").median, 4);
  std::vector<Row> repeated = made_rows();
  repeated.push_back(repeated[4]);  // solves the window again that the other failed
  EXPECT_EQ(summarize(on_common_windows(repeated))[0].windows, 2);
}

Experiment made_experiment() {
  return {
      .recordings = {{.name = "made", .path = "somewhere/made", .frames = 22, .starts = {0, 1, 2}}},
      .lengths = {10, 20},
      .configurations = parse_configurations("gpo,gpo+no-ransac")};
}

TEST(Summary, JsonHasAllWindowsEachRecordingAndEachFigure) {
  const nlohmann::ordered_json json = to_json(made_experiment(), made_rows());
  EXPECT_EQ(json["experiment"]["lengths"].size(), 2U);
  EXPECT_EQ(json["all_windows"][2]["failed"], 1);
  EXPECT_EQ(json["all_windows"][0]["pne_deg"]["median"], 2);
  EXPECT_TRUE(json["all_windows"][0]["pde_m"]["median"].is_null());
  EXPECT_EQ(json["by_recording"][0]["recording"], "made");
  EXPECT_EQ(json["by_recording"][0]["cells"], json["all_windows"]);
  EXPECT_EQ(json["windows_that_all_solved"][0]["figure"], "gpo_ransac");
  EXPECT_EQ(json["windows_that_all_solved"][0]["cells"][0]["pne_deg"]["median"], 1.5);
}

std::string names(const std::string& configurations) {
  std::string names;
  for (const FigurePlan& plan : figure_plans(parse_configurations(configurations)))
    names += (names.empty() ? "" : ",") + plan.name;
  return names;
}

TEST(Figures, HaveTitlesThatFitAtLeastTwoConfigurations) {
  for (const auto& [configurations, expected] :
       {std::pair("gpo,gpo+no-ransac", "gpo_ransac"),
        std::pair("gpo,gpo+truth,gpo+averaging,gpo+no-ransac", "gpo_ransac,rotation_sources"),
        std::pair("gpo+five-point,gpo+direct", "rotation_sources"),
        std::pair("gpo", "configurations"),
        std::pair("gpo,gpo+truth,gpo+no-ransac+truth", "rotation_sources,configurations"),
        // These pairs do not differ in RANSAC alone, and their rotations are the same.
        std::pair("gpo,gpo+anchored", "configurations"),
        std::pair("gpo,gpo+consistent,gpo+anchored", "configurations"),
        std::pair("gpo,gpo+no-ransac+anchored", "configurations"),
        std::pair("ba,ba+anchored", "configurations"),
        // "GPO and ..." needs GPO.
        std::pair("pnp,dbscan", "configurations"),
        std::pair("gpo+anchored,pba,fpba", "configurations"),
        std::pair("gpo,pnp,dbscan", "aggregation")})
    EXPECT_EQ(names(configurations), expected) << configurations;
  const auto plans = figure_plans(parse_configurations("gpo,gpo+no-ransac,gpo+anchored"));
  ASSERT_EQ(plans[0].name, "gpo_ransac");
  EXPECT_EQ(plans[0].configurations.size(), 2U);
}

TEST(Figures, GiveAMethodTheSameMarkerEverywhere) {
  const auto marker = [](const Figure& figure, const std::string& name) {
    return std::ranges::find(figure.charts[1].curves, name, &Curve::name)->marker;
  };
  const std::vector<Row> rows{made_row("gpo", 0, 10, 1.0),
                              made_row("ba", 0, 10, 1.0),
                              made_row("pba", 0, 10, 1.0),
                              made_row("gpo+no-ransac", 0, 10, 1.0)};
  const Figure some = figure_over_length(rows, {"", "", parse_configurations("pba,ba")});
  const Figure others =
      figure_over_length(rows, {"", "", parse_configurations("gpo+no-ransac,gpo,ba")});
  EXPECT_EQ(marker(some, "BA"), marker(others, "BA"));
  EXPECT_NE(marker(some, "BA"), marker(some, "PBA"));
  EXPECT_EQ(marker(others, "GPO"), marker(others, "GPO without RANSAC"));
}

TEST(Figures, ShowMediansQuartilesTheBoundAndUnsolvedConfigurations) {
  const std::vector<Figure> all = figures(made_rows(), made_experiment().configurations);
  ASSERT_EQ(all.size(), 1U);
  EXPECT_THAT(all[0].title, HasSubstr("1 to 2 per length"));
  EXPECT_THAT(all[0].note, HasSubstr("the inliers of GPO"));
  EXPECT_THAT(all[0].note, HasSubstr("a curve may be below this one"));
  ASSERT_EQ(all[0].charts.size(), 3U);
  const Chart& ate = all[0].charts[0];
  EXPECT_EQ(ate.y_label, "ATE [mm]");
  ASSERT_EQ(ate.curves.size(), 2U);
  EXPECT_EQ(ate.curves[0].name, "GPO");
  EXPECT_DOUBLE_EQ(ate.curves[0].y[0], 15);
  const Chart& pne = all[0].charts[1];
  EXPECT_TRUE(pne.logarithmic);
  ASSERT_EQ(pne.curves.size(), 3U);
  EXPECT_THAT(pne.curves[0].counts, ElementsAre(2, 1));
  EXPECT_THAT(pne.curves[0].x, ElementsAre(10, 20));
  EXPECT_THAT(pne.curves[0].y, ElementsAre(1.5, 0.5));
  EXPECT_THAT(pne.curves[0].lower, ElementsAre(1.25, 0.5));
  EXPECT_THAT(pne.curves[0].upper, ElementsAre(1.75, 0.5));
  EXPECT_EQ(pne.curves[1].name, "GPO without RANSAC");
  EXPECT_THAT(pne.curves[1].x, ElementsAre(10));
  EXPECT_EQ(pne.curves[2].name, "bound for GPO's tracks");
  EXPECT_TRUE(pne.curves[2].counts.empty());
  EXPECT_TRUE(pne.curves[2].dotted);
  EXPECT_DOUBLE_EQ(pne.curves[2].y[0], 0.15);
  EXPECT_TRUE(pne.curves[2].lower.empty());
  const std::vector<Row> rows{made_row("gpo", 0, 10, 1.0), made_row("gpo+no-ransac", 0, 10, {})};
  const Figure figure = figures(rows, made_experiment().configurations).front();
  EXPECT_EQ(figure.charts[0].curves.size(), 1U);
  EXPECT_TRUE(figure.charts[2].curves.empty()) << "no window has a PDE";
  EXPECT_THAT(figure.title, HasSubstr("none solved by GPO without RANSAC"));
}

TEST(Tables, RunningTimesAreForThirtyFramesOrFewerAndDescribeTheirMeasurement) {
  const Table table = running_time_table(made_rows());
  EXPECT_THAT(table.caption, HasSubstr("with 20 frames (no windows of 30)"));
  ASSERT_EQ(table.lines.size(), 2U);
  EXPECT_THAT(table.lines[0], ElementsAre("GPO", "1/1", "1.50", "1.00", "5.00", "4.00", "1.80"));
  EXPECT_THAT(table.lines[1], ElementsAre("GPO without RANSAC", "0/1", "-", "-", "-", "-", "-"));
  EXPECT_THAT(to_markdown(table), HasSubstr("| GPO | 1/1 | 1.50 |"));
  EXPECT_THAT(to_csv(table), HasSubstr("\nGPO,1/1,1.50,"));
  const std::vector<Row> longer{made_row("gpo", 0, 40, 1), made_row("gpo", 0, 50, 1)};
  EXPECT_THAT(running_time_table(longer).caption, HasSubstr("with 40 frames"));
  std::vector<Row> rows{made_row("gpo", 0, 30, 1.0), made_row("gpo", 0, 60, 1.0)};
  EXPECT_THAT(running_time_table(rows).caption, HasSubstr("unknown number of windows"));
  rows[0].jobs = 1;
  rows[1].jobs = 8;  // windows of another length
  rows[0].processor = "a processor";
  EXPECT_THAT(running_time_table(rows).caption,
              HasSubstr("one window at a time, one thread, on a processor"));
  rows.push_back(made_row("gpo", 10, 30, 1.0));
  rows.back().jobs = 2;
  rows.back().processor = "another";
  EXPECT_THAT(running_time_table(rows).caption, HasSubstr("up to 2 windows at a time"));
  EXPECT_THAT(running_time_table(rows).caption, HasSubstr("on a processor and another"));
  EXPECT_THAT(running_time_table(rows).caption, ::testing::Not(HasSubstr("one thread")));
  const auto timing = to_json(made_experiment(), rows)["timing"];
  EXPECT_EQ(timing["jobs"].dump(), "[1,2,8]");
  EXPECT_EQ(timing["processors"].dump(), R"(["a processor","another"])");
}

TEST(Tables, OverviewShowsSolvedOfTriedWindowsAndLengthsWithThreeDigits) {
  const std::string text = to_text(overview_table(made_rows()));
  EXPECT_THAT(text,
              HasSubstr("gpo+no-ransac      10     2/3       2      4.000      40.0         -\n"));
  EXPECT_THAT(text, HasSubstr("gpo                10     3/3       2      1.500      15.0"))
      << "without the window of 100 deg, which the other method failed";
  const std::string csv = to_csv(overview_numbers(made_rows()));
  EXPECT_THAT(
      csv,
      HasSubstr("method,frames,solved,of,PNE [deg],ATE [mm],PDE [mm],common,common PNE [deg],"));
  EXPECT_THAT(csv, HasSubstr("\ngpo,10,3,3,2.000,20.0,,2,1.500,15.0,\n"));
  EXPECT_THAT(csv, HasSubstr("\ngpo+no-ransac,20,0,1,,,,0,,,\n"));
  const auto ate = [](double ate_m) {
    std::vector<Row> rows{made_row("gpo", 0, 10, 1.0)};
    rows[0].ate_m = ate_m;
    return overview_table(rows).lines[0][5];
  };
  EXPECT_EQ(ate(0.0000123456), "0.0123");
  EXPECT_EQ(ate(0.000654321), "0.654");
  EXPECT_EQ(ate(0.0123456), "12.3");
  EXPECT_EQ(ate(1.23456), "1235");
  EXPECT_EQ(ate(0), "0.00");
}

}  // namespace
}  // namespace gpo::test
