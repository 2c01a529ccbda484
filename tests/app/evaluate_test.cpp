// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/files/text_file.h"
#include "tests/app/program.h"

#include <sstream>

#include <gmock/gmock.h>

namespace gpo::test {
namespace {

using testing::AllOf, testing::HasSubstr;

const std::string kFewWindows = " --methods gpo,gpo+no-ransac --lengths 5:10:5 --starts 0:40:10 ";

std::string evaluate(const std::string& arguments, const fs::path& output) {
  return fmt::format("evaluate {} {} --output {}", kDesk, arguments, output);
}

/// results.csv without its last eight columns (times, machine). Only the last cell may be quoted.
std::string results_without_times(const fs::path& folder) {
  std::istringstream csv(read_file(folder / "results.csv"));
  std::string kept;
  for (std::string line; std::getline(csv, line);) {
    if (line.ends_with('"')) line.resize(line.rfind(",\"") + 1);
    for (int column = 0; column < 8; ++column) line.resize(line.rfind(','));
    kept += line + "\n";
  }
  return kept;
}

std::string summary_without_times(const fs::path& folder) {
  const auto keep = [](int, json::parse_event_t event, json& parsed) {
    if (event != json::parse_event_t::key) return true;
    const auto key = parsed.get<std::string>();
    return !key.ends_with("_ms") && key != "timing";
  };
  return json::parse(read_file(folder / "summary.json"), keep).dump();
}

void expect_same_results(const fs::path& a, const fs::path& b) {
  EXPECT_EQ(results_without_times(a), results_without_times(b));
  EXPECT_EQ(summary_without_times(a), summary_without_times(b));
  EXPECT_EQ(read_file(a / "experiment.json"), read_file(b / "experiment.json"));
}

fs::path one_run(const fs::path& test_folder) {
  fs::path folder = test_folder / "one-run";
  succeeding(evaluate(kFewWindows + "--jobs 1", folder));
  return folder;
}

TEST(Evaluate, WritesAFolderOfResults) {
  const fs::path folder = fresh_folder() / "made" / "on-demand";
  const Outcome outcome = succeeding(
      evaluate("--methods gpo,gpo+no-ransac --lengths 6,9 --starts 0 --figure-width 85mm", folder));
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("gpo+no-ransac"), HasSubstr(folder.string())));
  EXPECT_THAT(outcome.err, HasSubstr("evaluating 2/2 windows"));
  const std::string csv = read_file(folder / "results.csv");
  EXPECT_EQ(std::ranges::count(csv, '\n'), 5);
  EXPECT_THAT(csv, testing::StartsWith("recording,configuration,start,frames,method,rotations,"));
  EXPECT_THAT(csv,
              HasSubstr("\ndesk,gpo+no-ransac,0,6,gpo,gyro-calibrated,anchored,false,2,per-frame,1,"
                        "1,schur,,,,,,typical,after,0.3,ok,,"))
      << "gpo uses only the solver";
  EXPECT_EQ(read_json(folder / "summary.json")["all_windows"].size(), 4U);
  for (const auto& [file, text] :
       {std::pair{"running_time.md", "with 9 frames (no windows of 30)"},
        {"running_time.md", "one window at a time, one thread"},
        {"running_time.csv", "\nGPO,1/1,"},
        {"errors.csv", "\ngpo+no-ransac,6,1,1,"},
        {"errors.csv", ",scale error [%],gravity error [deg],common,common PNE [deg],"},
        {"figures/gpo_ransac.png", "PNG"},
        {"figures/gpo_ransac_meters.png", "PNG"},
        {"figures/gpo_ransac.svg", "<svg"},
        {"figures/gpo_ransac.svg", "width=\"240.94"},  // 85 mm
        {"figures/gpo_ransac.pdf", "%PDF-"},
        {"figures/gpo_ransac.pdf", "/MediaBox [ 0 0 240.94"}})
    EXPECT_THAT(read_file(folder / file), HasSubstr(text)) << file;
}

TEST(Evaluate, ResumedAfterAKillGivesTheSameResults) {
  const fs::path folder = fresh_folder() / "killed";
  const std::string line = evaluate(kFewWindows + "--jobs 1", folder);
  const Outcome killed =
      signaled("9", fmt::format("[ -n \"$(ls {} 2>/dev/null)\" ]", folder / "windows"), line);
  EXPECT_EQ(killed.exit_code, 137);
  EXPECT_FALSE(fs::exists(folder / "results.csv"));
  EXPECT_FALSE(fs::is_empty(folder / "windows"));
  const Outcome resumed = spawned(line);  // another build would begin anew
  EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
  EXPECT_EQ(resumed.err.find("evaluating 0/"), std::string::npos) << resumed.err;
  const fs::path undisturbed = folder.parent_path() / "undisturbed";
  EXPECT_EQ(spawned(evaluate(kFewWindows + "--jobs 1", undisturbed)).exit_code, 0);
  expect_same_results(folder, undisturbed);
}

TEST(Evaluate, InterruptionLeavesNoResults) {
  const fs::path folder = fresh_folder() / "interrupted";
  expect_exit(1,
              signaled("INT",
                       fmt::format("[ -d {} ]", folder / "windows"),
                       evaluate(kFewWindows + "--jobs 1", folder)),
              "stopped; ");
  EXPECT_FALSE(fs::exists(folder / "results.csv"));
}

TEST(Evaluate, ShardsMergeToTheResultsOfOneRun) {
  const fs::path folder = fresh_folder();
  const auto shard = [&](const char* which, const char* to) {
    return program(evaluate(kFewWindows + "--shard " + which, folder / to));
  };
  const Outcome first = shard("1/3", "a");
  EXPECT_EQ(first.exit_code, 0) << first.err;
  EXPECT_THAT(first.out, HasSubstr("evaluate --merge"));
  EXPECT_FALSE(fs::exists(folder / "a" / "results.csv"));
  EXPECT_EQ(shard("3/3", "a").exit_code, 0);
  const std::string merge = fmt::format("evaluate --merge {0}/a {0}/b --output {0}/all", folder);
  EXPECT_EQ(program(merge).exit_code, 2);
  EXPECT_EQ(shard("2/3", "b").exit_code, 0);
  succeeding(merge);
  expect_same_results(folder / "all", one_run(folder));
}

/// Writes the true cameras of the desk as a TUM trajectory whose clock is early.
void write_trajectory(const fs::path& file, double early_s) {
  succeeding("run {} --frames 60 --true-trajectory {}", kDesk, file);
  std::istringstream rows(read_file(file));
  std::string text;
  for (std::string row; std::getline(rows, row);) {
    const std::size_t blank = row.find(' ');
    if (row.starts_with('#')) continue;
    const double time_s = std::stod(row.substr(0, blank));
    text += fmt::format("{:.9f}{}\n", time_s - early_s, row.substr(blank));
  }
  write_file(file, text);
}

TEST(Evaluate, WritesTablesAndFiguresForPrintWithAResultOfEachRecording) {
  const fs::path folder = fresh_folder();
  const fs::path other = copy_of_desk(folder / "room_2");
  write_trajectory(folder / "desk.txt", 0);
  write_trajectory(folder / "room_2.txt", 0);
  const auto line = [&](const char* lengths) {
    return fmt::format(
        "evaluate {0} {1} --methods gpo,gpo_joint,pba,slam --result "
        "'slam={2}/{{recording}}.txt,scale=metric' --lengths {3} --starts 0,20 --figure-width 85mm "
        "--bare-figures --output {2}/out",
        kDesk,
        other.string(),
        folder.string(),
        lengths);
  };
  succeeding(line("10"));
  EXPECT_THAT(succeeding(line("10,20")).err, HasSubstr("has 16 of 32 results; the others are"));
  const std::string latex = read_file(folder / "out/errors_by_recording.tex");
  for (const char* text : {"\\toprule", "desk & 2/2", "room\\_2 & 2/2", "all & 4/4", "& slam \\\\"})
    EXPECT_THAT(latex, HasSubstr(text));
  EXPECT_THAT(read_file(folder / "out/errors_by_recording.csv"),
              HasSubstr("\nroom_2,20,slam,2,2,2,"));
  const std::string errors = read_file(folder / "out/errors.md");
  EXPECT_THAT(errors, HasSubstr("that all methods solved (`common`)"));
  EXPECT_THAT(errors, HasSubstr("| desk | 2/2 |"));
  for (const char* file : {"figures/optimization.pdf",
                           "figures/by_recording/desk_optimization.pdf",
                           "figures/by_recording/room_2_optimization.pdf"})
    EXPECT_THAT(read_file(folder / "out" / file), testing::StartsWith("%PDF-")) << file;
  EXPECT_THAT(read_file(folder / "out/figures/optimization.svg"), HasSubstr("<title></title>"));
  // The poses are exact and in meters.
  const std::string results = read_file(folder / "out/results.csv");
  std::istringstream rows(results);
  std::string header;
  std::getline(rows, header);
  const auto names = split(header, ',');
  const auto column = std::ranges::find(names, "scale_error_percent") - names.begin();
  int checked = 0;
  for (std::string row; std::getline(rows, row);) {
    if (row.find(",slam,") == std::string::npos) continue;
    EXPECT_LT(std::abs(std::stod(split(row, ',')[column])), 0.01) << row;
    ++checked;
  }
  EXPECT_EQ(checked, 8);
}

TEST(Evaluate, CountsRecordingsWithoutAResultAsFailedAndRefusesIfAllLackOne) {
  const fs::path folder = fresh_folder();
  const fs::path other = copy_of_desk(folder / "room");
  write_trajectory(folder / "desk.txt", 0);
  const auto line = [&](const std::string& pattern) {
    return fmt::format(
        "evaluate {} {} --methods gpo,slam --result 'slam={}' --lengths 10 --starts 0 --output {}",
        kDesk,
        other.string(),
        pattern,
        (folder / "out").string());
  };
  const std::string pattern = (folder / "{recording}.txt").string();
  EXPECT_THAT(succeeding(line(pattern)).err,
              HasSubstr("room: slam has no file for it, so its windows count as failed\n"));
  EXPECT_THAT(read_file(folder / "out/results.csv"), HasSubstr("room.txt: no such file"));
  EXPECT_THAT(read_file(folder / "out/errors.csv"), HasSubstr("\nslam,10,1,2,"));
  expect_exit(2,
              program(line((folder / "none-{recording}.txt").string())),
              "found no file for any recording, expected one with desk in place of {recording}");
  write_file(folder / "room.txt", "1 2 3\n");
  expect_exit(2, program(line(pattern)), "room.txt: found rows of 3 numbers");
}

TEST(Evaluate, EstimatesReportsAndCorrectsTheTimeOffsetOfAResult) {
  const fs::path folder = fresh_folder();
  write_trajectory(folder / "late.txt", 0.02);
  const auto evaluated = [&](const std::string& suffix) {
    const fs::path out = folder / ("out" + suffix);
    const Outcome outcome = succeeding(
        "evaluate {} --methods slam --result slam={}/late.txt{} --lengths 30 --starts 10 --output "
        "{}",
        kDesk,
        folder.string(),
        suffix,
        out.string());
    const auto cells = split(split(read_file(out / "errors.csv"), '\n')[1], ',');
    return std::tuple(std::stod(cells[4]), outcome.err, read_file(out / "time_offsets.csv"));
  };
  const auto [pne_deg, messages, offsets] = evaluated("");
  EXPECT_THAT(messages, HasSubstr("slam: time offset +20."));
  EXPECT_THAT(messages, HasSubstr("by the ground truth; it is not applied, add ,offset=auto"));
  EXPECT_THAT(offsets, HasSubstr("\ndesk,slam,20."));
  EXPECT_THAT(offsets, HasSubstr(",0.00,the ground truth\n"));
  const auto [corrected_deg, other_messages, applied] = evaluated(",offset=auto");
  EXPECT_THAT(other_messages, HasSubstr("by the ground truth; it is applied"));
  EXPECT_GT(pne_deg, 5 * corrected_deg);
  EXPECT_LT(corrected_deg, 0.2);
}

TEST(Evaluate, ReportsTooLongWindowsOnce) {
  const fs::path folder = fresh_folder() / "long";
  EXPECT_THAT(succeeding(evaluate("--methods gpo --lengths 5,70,80 --starts 0", folder)).err,
              HasSubstr("desk: 60 frames, too short for windows of 70, 80 frames\n"));
}

TEST(Evaluate, RefusesBadInputInOneLineAndLeavesNoFile) {
  expect_each_refused(
      "evaluate --output {}/results ",
      {{"", "evaluate: expected either recordings or --merge DIR..."},
       {"sequences/desk --merge somewhere", "expected either recordings or --merge"},
       {"sequences/desk sequences/desk", "two recordings have the name 'desk'"},
       {"no/such/folder", "no/such/folder"},
       {"sequences/desk --methods gpoo", "--methods: unknown method 'gpoo'"},
       {"sequences/desk --lengths 5:x", "--lengths: '5:x', expected FIRST:LAST:STEP"},
       {"sequences/desk --starts -1", "--starts"},
       {"sequences/desk --lengths 61", "no window fits"},
       {"sequences/desk --jobs 0", "--jobs"},
       {"sequences/desk --figure-width 85", "--figure-width: '85', expected 50mm to 400mm"},
       {"sequences/desk --figure-width 8mm", "--figure-width: '8mm'"},
       {"sequences/desk --timing-jobs 0", "--timing-jobs"},
       {"sequences/desk --cache 1", "--cache"},
       {"sequences/desk --shard 4/3", "--shard: '4/3', expected K/N"},
       {"--merge no/such/folder", "no/such/folder/experiment.json"}});
}

TEST(Evaluate, MemoryDoesNotGrowWithRecordings) {
  const fs::path folder = fresh_folder();
  std::string four;
  for (const char* name : {"a", "b", "c", "d"}) four += copy_of_desk(folder / name).string() + " ";
  const auto peak_mib = [&](const std::string& recordings, const char* output) {
    const Outcome outcome = spawned(
        fmt::format("evaluate {} --methods dbscan --lengths 60 --starts 0 --jobs 1 --output {}",
                    recordings,
                    folder / output));
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return static_cast<double>(outcome.peak_kib) / 1024;
  };
  const double one = peak_mib((folder / "a").string(), "one");
  // Each recording has 60 images of 0.9 MB.
  EXPECT_LT(peak_mib(four, "four"), one + 60);
}

}  // namespace
}  // namespace gpo::test
