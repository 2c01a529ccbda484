// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/experiment/recording_tables.h"

#include "tests/engine/experiment/made_rows.h"

#include <gmock/gmock.h>

namespace gpo::test {
namespace {

using testing::ElementsAre, testing::HasSubstr, testing::Not;

Row row_in(const std::string& recording,
           const std::string& configuration,
           int start,
           std::optional<double> pne_deg) {
  Row row = made_row(configuration, start, 10, pne_deg);
  row.recording = recording;
  row.settings.options.method = "gpo";
  return row;
}

/// Two recordings: in `a_1` both methods solve windows 0 and 1 of 3; in `b` one of them none.
std::vector<Row> rows_of_two_recordings() {
  return {row_in("a_1", "gpo", 0, 1.0),
          row_in("a_1", "gpo", 1, 2.0),
          row_in("a_1", "gpo", 2, 50.0),
          row_in("a_1", "gpo+no-ransac", 0, 4.0),
          row_in("a_1", "gpo+no-ransac", 1, 6.0),
          row_in("a_1", "gpo+no-ransac", 2, {}),
          row_in("b", "gpo", 0, 3.0),
          row_in("b", "gpo+no-ransac", 0, {})};
}

TEST(RecordingTable, HasALinePerRecordingOverCommonWindowsAndOneOfAll) {
  const RecordingTable table = recording_table(rows_of_two_recordings(), 10);
  EXPECT_THAT(table.methods, ElementsAre("gpo", "gpo+no-ransac"));
  ASSERT_EQ(table.lines.size(), 3U);
  const RecordingLine& a = table.lines[0];
  EXPECT_EQ(a.recording, "a_1");
  EXPECT_EQ(a.windows, 3);
  EXPECT_EQ(a.common, 2);
  EXPECT_THAT(a.solved, ElementsAre(3, 2));
  EXPECT_EQ(a.common_cells[0].values.at("pne_deg").median, 1.5);
  EXPECT_EQ(a.common_cells[1].values.at("pne_deg").median, 5);
  const RecordingLine& b = table.lines[1];
  EXPECT_EQ(b.common, 1) << "the method that solved no window of b does not count";
  EXPECT_EQ(b.common_cells[1].windows, 0);
  EXPECT_TRUE(table.lines[2].all);
  EXPECT_EQ(table.lines[2].common, 2);
  EXPECT_EQ(table.lines[2].windows, 4);
  EXPECT_EQ(table.errors.size(), 2U) << "no window has a PDE";
  const auto rows = rows_of_two_recordings();
  EXPECT_EQ(recording_table(std::span(rows).subspan(6), 10).lines.size(), 1U);
}

TEST(RecordingTable, IsMarkdownWithMediansAndQuartiles) {
  const std::string text = recordings_markdown(rows_of_two_recordings());
  EXPECT_THAT(text, HasSubstr("PNE [deg] with 10 frames: median [quartiles]"));
  EXPECT_THAT(text, HasSubstr("| recording | common windows | gpo | gpo+no-ransac |"));
  EXPECT_THAT(text, HasSubstr("| a_1 | 2/3 | 1.500 [1.250, 1.750] | 5.000 [4.500, 5.500] |"));
  EXPECT_THAT(text, HasSubstr("| b | 1/1 | 3.000 [3.000, 3.000] | - |"));
  EXPECT_THAT(text, HasSubstr("| all | 2/4 |"));
  EXPECT_THAT(text, HasSubstr("| a_1 | 2/3 | 15.0 [12.5, 17.5] |"));  // ATE in mm
}

TEST(RecordingTable, IsLatexWithEscapedNamesAndTheLowestMedianBold) {
  const std::string text = recordings_latex(rows_of_two_recordings());
  for (const char* part :
       {"\\begin{tabular}{lrrr}",
        "    Recording & Windows & GPO & GPO without RANSAC \\\\\n",
        "    \\multicolumn{4}{l}{\\emph{PNE [deg]}} \\\\\n",
        "    a\\_1 & 2/3 & \\textbf{1.500} {\\scriptsize [1.250, 1.750]} & 5.000 ",
        "    b & 1/1 & 3.000 {\\scriptsize [3.000, 3.000]} & -- \\\\\n",
        "    a\\_1 & 3 & 3 & 2 \\\\\n",
        "\\label{tab:errors-10}"})
    EXPECT_THAT(text, HasSubstr(part));
  const auto count = [&](const std::string& word) {
    int found = 0;
    for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1))
      ++found;
    return found;
  };
  EXPECT_EQ(count("{"), count("}"));
  EXPECT_EQ(count("\\toprule"), 1);
  EXPECT_EQ(count("\\bottomrule"), 1);
  EXPECT_EQ(count("\\begin{"), count("\\end{"));
  EXPECT_EQ(latex_text("50 % of a&b_c^2 {x} #1 ~\\$"),
            "50 \\% of a\\&b\\_c\\textasciicircum{}2 \\{x\\} \\#1 "
            "\\textasciitilde{}\\textbackslash{}\\$");
}

TEST(RecordingTable, IsCsvOfAllLengthsWithNumbersOnly) {
  std::vector<Row> rows = rows_of_two_recordings();
  rows.push_back(rows[0]);
  rows.back().settings.frames = 20;
  const std::string csv = recordings_csv(rows);
  EXPECT_THAT(csv,
              testing::StartsWith("recording,frames,method,windows,solved,common,PNE [deg] median,"
                                  "PNE [deg] lower quartile,PNE [deg] upper quartile,"));
  EXPECT_THAT(csv, HasSubstr("\na_1,10,gpo,3,3,2,1.5,1.25,1.75,15,12.5,17.5\n"));
  EXPECT_THAT(csv, HasSubstr("\nb,10,gpo+no-ransac,1,0,0,,,,,,\n"));
  EXPECT_THAT(csv, HasSubstr("\n*,10,gpo,4,4,2,1.5,"));
  EXPECT_THAT(csv, HasSubstr("\na_1,20,gpo,1,1,1,1,1,1,10,10,10\n"));
}

TEST(RecordingTable, HasResidualsWithoutGroundTruth) {
  std::vector<Row> rows = rows_of_two_recordings();
  for (Row& row : rows) {
    row.pne_deg = row.pne_bound_deg = row.ate_m = std::nullopt;
    row.rms_px = 0.25;
  }
  EXPECT_THAT(recordings_latex(rows), HasSubstr("\\emph{RMS [px]}"));
  EXPECT_THAT(recordings_latex(rows), Not(HasSubstr("PNE")));
  const auto all = figures(rows, parse_configurations("gpo,gpo+no-ransac"));
  ASSERT_EQ(all[0].charts.size(), 1U);
  EXPECT_EQ(all[0].charts[0].y_label, "RMS [px]");
}

TEST(RecordingFigures, AreNamedAfterTheRecordingAndShowItsWindowsOnly) {
  const auto all =
      recording_figures(rows_of_two_recordings(), parse_configurations("gpo,gpo+no-ransac"));
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all[0].name, "a_1_gpo_ransac");
  EXPECT_EQ(all[1].name, "b_gpo_ransac");
  EXPECT_THAT(all[0].title, testing::StartsWith("a_1: GPO with and without RANSAC"));
  EXPECT_THAT(all[0].charts[1].curves[0].y, ElementsAre(1.5));
  EXPECT_THAT(all[1].charts[1].curves[0].y, ElementsAre(3.0));
}

}  // namespace
}  // namespace gpo::test
