// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/experiment/results_file.h"

#include "engine/base/error.h"
#include "engine/experiment/configuration.h"
#include "tests/engine/test_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace gpo {
namespace {

using test::TestFolder;
using testing::HasSubstr;

Row row(const std::string& configuration, int frames) {
  Settings settings;
  settings.frames = frames;
  settings.start = 7;
  Row row = refused_row("desk", apply(parse_configuration(configuration), settings), "");
  row.status = "ok";
  row.pne_deg = 0.1 * frames;
  row.ate_m = 1.0 / 3;
  row.iterations = 5;
  row.termination = "convergence";
  return row;
}

class ResultsFile : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& text) {
    return folder_.write("results.csv", text);
  }
  std::string refusal(const std::string& text) {
    try {
      read_results(write(text));
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
  TestFolder folder_;
};

TEST_F(ResultsFile, ReadsBackWhatWasWritten) {
  std::vector<Row> rows = {row("gpo", 10), row("gpo+no-ransac", 20), row("ba", 10)};
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
  const std::string good = to_csv(std::vector<Row>{row("gpo", 10), row("ba", 10)});
  const auto broken = [&](const std::string& what, const std::string& by) {
    std::string text = good;
    text.replace(text.rfind(what), what.size(), by);
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

TEST_F(ResultsFile, ALineIsCountedWhereTextHasLinesEnds) {
  std::vector<Row> rows = {row("gpo", 10), row("ba", 10)};
  rows[0].reason = "a\nb";
  std::string text = to_csv(rows);
  text.replace(text.rfind(",ok,"), 4, ",no,");
  EXPECT_THAT(refusal(text), HasSubstr("results.csv:4: status"));
}

TEST_F(ResultsFile, OtherColumnsAndMissingOnesDoNotMatter) {
  const auto file = write(
      "recording,configuration,start,frames,status,color,pne_deg\r\n"
      "desk,gpo,0,10,ok,red,0.5\r\n");
  const std::vector<Row> rows = read_results(file);
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_EQ(rows[0].pne_deg, 0.5);
  EXPECT_EQ(rows[0].ate_m, std::nullopt);
}

TEST_F(ResultsFile, OtherTablesAreNotResults) {
  EXPECT_FALSE(is_results(write("#timestamp [ns],w_RS_S_x\n1,2\n")));
  EXPECT_FALSE(is_results(folder_.path()));
  EXPECT_FALSE(is_results(folder_.path() / "none.csv"));
}

}  // namespace
}  // namespace gpo
