// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// The report is one file that holds the result, asks no server for anything, and turns in Chromium.
#include "tests/app/program.h"

#include <cmath>
#include <regex>

#include <gmock/gmock.h>

namespace gpo::test {
namespace {

using testing::AllOf, testing::Each, testing::ElementsAre, testing::HasSubstr, testing::IsEmpty,
    testing::Not, testing::StartsWith;

constexpr std::size_t kMostBytes = 5'000'000;

/// The results that a page holds, in the order of the page.
std::vector<json> results_in(const std::string& page) {
  const std::string begin = "class=\"result\"";
  std::vector<json> results;
  for (std::size_t at = page.find(begin); at != std::string::npos; at = page.find(begin, at)) {
    at = page.find('>', at) + 1;
    results.push_back(json::parse(page.substr(at, page.find("</script>", at) - at)));
  }
  return results;
}

/// Expects that elements and styles of the page refer to data in the page only.
void expect_self_contained(const std::string& page) {
  EXPECT_LT(page.size(), kMostBytes);
  const auto sources =
      matches_in(page, R"re(\s(?:src|href|action|data|srcset)="([^"]{0,12}))re", 1);
  EXPECT_THAT(sources, Not(IsEmpty()));
  EXPECT_THAT(sources, Each(testing::AnyOf(StartsWith("data:image/"), StartsWith("#recording-"))));
  EXPECT_THAT(page,
              AllOf(Not(HasSubstr("url(")), Not(HasSubstr("@import")), Not(HasSubstr("<link"))));
  EXPECT_THAT(page, HasSubstr("default-src 'none'; img-src data:;"));
}

std::string reported(const std::string& arguments, const fs::path& file) {
  const Outcome outcome = succeeding("report {} --output {}", arguments, file);
  EXPECT_THAT(outcome.out, HasSubstr(file.string() + ": "));
  return read_file(file);
}

TEST(Report, HoldsTheNumbersOfRunAndNoReferences) {
  const fs::path file = fresh_folder() / "new/desk.html";
  const std::string page = reported(kDesk + " --frames 12 --seed 7", file);
  expect_self_contained(page);
  json expected = run_json("{} --frames 12 --seed 7", kDesk);
  const auto results = results_in(page);
  ASSERT_EQ(results.size(), 1U);
  json found = results[0];
  for (json* one : {&expected, &found}) one->erase("timing_ms");
  expect_same_json(found, expected, 1e-12, "report");
  EXPECT_EQ(matches_in(page, "<figure data-frame=\"([0-9]+)\"", 1),
            (std::set<std::string>{"0", "2", "5", "8", "11"}));
  for (const char* text : {"class=\"verdict ",
                           "Normals",
                           "Curves",
                           "uncertainty (1 sigma)",
                           "resolution    640x480 px",
                           " --frames 12 --seed 7 --output report.html",
                           "<tr class=\"changed\"><th>"})
    EXPECT_THAT(page, HasSubstr(text));
  EXPECT_TRUE(std::regex_search(page, std::regex("gpo-inspector [0-9.]+ build [0-9a-f]+")));
}

TEST(Report, ComparesMethodsAndRecordings) {
  const fs::path folder = fresh_folder(), other = copy_of_desk(folder / "other");
  const std::string page = reported(
      fmt::format("{} {} --frames 12 --methods gpo,pnp_ba", kDesk, other), folder / "both.html");
  expect_self_contained(page);
  std::vector<std::string> methods;
  for (const json& result : results_in(page)) methods.push_back(result["method"]);
  EXPECT_THAT(methods, ElementsAre("gpo", "pnp_ba", "gpo", "pnp_ba"));
  const std::string top = page.substr(0, page.find("<section"));
  EXPECT_THAT(
      top,
      AllOf(HasSubstr("#recording-2"), HasSubstr("<th>desk</th>"), HasSubstr("<th>other</th>")));
}

TEST(Report, NamesTheCommandThatReproducesIt) {
  const fs::path folder = fresh_folder();
  std::string tracks = "frame,track,x,y\n";
  for (int frame = 0; frame < 8; ++frame)
    for (int k = 0; k < 30; ++k) tracks += fmt::format("{},{},{},{}\n", frame, k, 20 * k, 7 * k);
  write_file(folder / "tracks.csv", tracks);
  const std::string options = fmt::format(
      "--tracks {}/tracks.csv --frames 8 --method orb --result orb={}/tests/app/"
      "results/CameraTrajectory.txt",
      folder,
      GPO_SOURCE_DIR);
  program("report {} {} --output {}/a.html", kDesk, options, folder);
  const std::string page = read_file(folder / "a.html");
  EXPECT_THAT(page, HasSubstr(fmt::format("desk {} --output report.html", options)));
}

TEST(Report, EscapesTheNameOfARecording) {
  const fs::path folder = fresh_folder();
  const std::string name = "<img src=x onerror=alert(1)>&\"";
  copy_of_desk(folder / name);
  const Outcome outcome =
      program("report '{}' --frames 8 --output {}", folder / name, folder / "a.html");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const std::string page = read_file(folder / "a.html");
  EXPECT_THAT(page, Not(HasSubstr("<img src=x")));
  EXPECT_THAT(page, HasSubstr("&lt;img src=x onerror=alert(1)&gt;&amp;&quot;: initialization"));
  EXPECT_EQ(results_in(page)[0]["recording"], (folder / name).string());
}

TEST(Report, ExplainsAFailedInitialization) {
  const fs::path folder = fresh_folder();
  const Outcome outcome = program("report {} --frames 2 --output {}", kDesk, folder / "a.html");
  expect_exit(1, outcome, "desk: initialization failed: the camera moved by only ");
  const std::string page = read_file(folder / "a.html");
  expect_self_contained(page);
  EXPECT_THAT(page, HasSubstr("<div class=\"verdict failed\"><b>failed</b>"));
}

TEST(Report, RefusesBadArguments) {
  expect_each_refused("report ",
                      {{kDesk + " --output {}/a.txt", "expected a file name that ends in .html"},
                       {kDesk + " " + kDesk + " --tracks " + kDesk + "/x.csv --output {}/a.html",
                        "--tracks: belongs to one recording"},
                       {kDesk + " --methods nonsense --output {}/a.html", "nonsense"}});
}

TEST(Report, IsWrittenByAScriptOfTheWindow) {
  const fs::path folder = fresh_folder();
  write_file(folder / "script", fmt::format("frames 12\nreport {}\n", folder / "window.html"));
  const Outcome outcome = succeeding("snapshot {} --script {}", kDesk, folder / "script");
  EXPECT_THAT(outcome.out, HasSubstr("saved " + (folder / "window.html").string()));
  const std::string page = read_file(folder / "window.html");
  expect_self_contained(page);
  EXPECT_EQ(results_in(page)[0]["window"]["frames"], 12);
  const std::string command = reported(kDesk + " --frames 12 --methods gpo_joint,gpo,pnp_ba,ba,pba",
                                       folder / "command.html");
  for (const std::string& one : {page, command}) {
    EXPECT_EQ(results_in(one).size(), 5U);
    EXPECT_THAT(one, HasSubstr("<figure class=\"charts-3\"><img"));
    EXPECT_THAT(one, HasSubstr("desk: windows from frame 0 over their length"));
  }
  write_file(folder / "bad", "report a.png\n");
  expect_exit(2,
              program("snapshot {} --script {}", kDesk, folder / "bad"),
              "report: 'a.png', expected a file name that ends in .html");
}

/// Opens the report in Chromium without a network, drags the scene and turns the wheel.
json turned_in_chromium(const fs::path& page, const fs::path& folder) {
  const Outcome run =
      shell(DEBIANS_PYTHON "tests/app/report/turn_scene.py {} {}", page, folder / "chromium");
  EXPECT_EQ(run.exit_code, 0) << run.err;
  return run.exit_code == 0 ? json::parse(run.out) : json();
}

TEST(ReportInChromium, TurnsByTheMouseWithoutANetwork) {
  if (shell("command -v chromium").exit_code != 0)
    GTEST_SKIP() << "no chromium on this machine; Debian's package is chromium";
  const fs::path folder = fresh_folder(), file = folder / "desk.html";
  reported(kDesk + " --frames 12", file);
  const json seen = turned_in_chromium(file, folder);
  ASSERT_FALSE(seen.is_null());
  EXPECT_EQ(seen["requests"], json::array({"file://" + file.string()}));
  EXPECT_EQ(seen["faults"], json::array());
  const json &start = seen["start"], &turned = seen["turned"], &zoomed = seen["zoomed"];
  EXPECT_GT(start["drawn"], 500);
  const auto number = [](const json& of, const char* key) { return of[key].get<double>(); };
  // Half a turn for a drag over the height of the scene.
  const double degrees_per_px = 180 / number(start, "height");
  const json& drag = seen["drag_px"];
  EXPECT_NEAR(std::remainder(number(turned, "yaw") - number(start, "yaw"), 360),
              -degrees_per_px * drag[0].get<double>(),
              1e-6);
  EXPECT_NEAR(number(turned, "pitch") - number(start, "pitch"),
              degrees_per_px * drag[1].get<double>(),
              1e-6);
  EXPECT_EQ(turned["distance"], start["distance"]);
  EXPECT_NE(turned["pixels"], start["pixels"]);
  EXPECT_NEAR(number(zoomed, "distance"), number(turned, "distance") / 1.2, 1e-9);
  EXPECT_NE(zoomed["pixels"], turned["pixels"]);
}

}  // namespace
}  // namespace gpo::test
