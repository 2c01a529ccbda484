// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// Every list that a file may leave empty is accepted or refused with one line.
#include "tests/app/program.h"

#include <regex>

#include <gmock/gmock.h>

namespace gpo::test {
namespace {

/// Returns one copy of the JSON for each list in it, with that list empty.
std::vector<json> each_list_empty(const json& whole) {
  std::vector<json> copies;
  const json flat = whole.flatten();
  std::set<json::json_pointer> lists;
  for (const auto& [path, value] : flat.items())
    for (json::json_pointer at(path); !at.empty(); at = at.parent_pointer())
      if (whole.at(at).is_array()) lists.insert(at);
  for (const json::json_pointer& list : lists) copies.emplace_back(whole)[list] = json::array();
  return copies;
}

/// Runs the program, and expects success or one line.
void expect_result_or_line(const std::string& arguments) {
  const Outcome outcome = program(arguments);
  if (outcome.exit_code != 0) expect_refused(outcome, ": ");
}

TEST(EmptyLists, InExperimentsAreRefusedOrAccepted) {
  const fs::path folder = fresh_folder();
  succeeding("evaluate {} --methods gpo --lengths 5 --starts 0 --output {}/whole", kDesk, folder);
  const std::vector<json> variants = each_list_empty(read_json(folder / "whole/experiment.json"));
  ASSERT_GE(variants.size(), 4U);
  for (const json& variant : variants) {
    SCOPED_TRACE(variant.dump());
    write_file(folder / "whole/experiment.json", variant.dump());
    expect_result_or_line(fmt::format("evaluate --merge {0}/whole --output {0}/merged", folder));
    fs::remove_all(folder / "merged");
  }
}

TEST(EmptyLists, InSessionsAreDrawnOrRefused) {
  const fs::path folder = fresh_folder();
  const auto run = [&](const std::string& script) {
    write_file(folder / "script", script);
    expect_result_or_line(fmt::format("snapshot {} --script {}/script", kDesk, folder));
  };
  run(fmt::format("frame 10\nsave-session {}/whole.json\n", folder));
  const json whole = read_json(folder / "whole.json");
  json all = whole;
  for (const char* key : {"compared", "hidden_curves", "bookmarks"}) all[key] = json::array();
  all["selection"]["tracks"] = json::array();
  write_file(folder / "all.json", all.dump());
  run(fmt::format("open {0}/all.json\nview compare\nscreenshot {0}/a.png window 640x480\n",
                  folder));
  EXPECT_TRUE(fs::exists(folder / "a.png"));
  for (const json& variant : each_list_empty(whole)) {
    SCOPED_TRACE(variant.dump());
    write_file(folder / "one.json", variant.dump());
    run(fmt::format("open {}/one.json\n", folder));
  }
}

TEST(EmptyLists, InRecipesAreRefusedOrAccepted) {
  const fs::path folder = fresh_folder();
  const std::string recipe = read_file(GPO_SOURCE_DIR "/sequences/desk.yaml");
  const std::regex list(R"(: \[[^\]]*\])");
  int lists = 0;
  for (std::sregex_iterator one(recipe.begin(), recipe.end(), list), end; one != end; ++one) {
    std::string text = recipe;
    text.replace(one->position(), one->length(), ": []");
    write_file(folder / "a.yaml", text);
    expect_refused(program("synthesize {0}/a.yaml --output {0}/made", folder), "a.yaml:");
    ++lists;
  }
  EXPECT_GT(lists, 20);
}

TEST(EmptyLists, InSmallFilesAreRefusedOrAccepted) {
  const fs::path folder = fresh_folder();
  write_file(folder / "r/0.pgm", "P5 64 48 255\n" + std::string(64 * 48, 'x'));
  const auto info = [&](const std::string& name, const std::string& content) {
    SCOPED_TRACE(name + ": " + content);
    write_file(folder / "r" / name, content);
    expect_result_or_line(fmt::format("info {}/r", folder));
    fs::remove(folder / "r" / name);
  };
  for (const char* content : {"resolution: []\nintrinsics: []\n",
                              "resolution: [64, 48]\nintrinsics: [60, 60, 32, 24]\n"
                              "camera_model: pinhole\ndistortion_model: radial-tangential\n"
                              "distortion_coefficients: []\nT_BS: []\n",
                              "cam0: {intrinsics: [], resolution: [], distortion_coeffs: []}\n",
                              "camera_matrix: {rows: 3, cols: 3, data: []}\n",
                              "[]"})
    info("camera.yaml", content);
  for (const char* name : {"plane.yaml", "board.yaml", "groundtruth.yaml"})
    for (const char* content : {"[]", "normal: []\ndistance: 0\n", "T_truth_camera: []\n", "{}"})
      info(name, content);
  for (const char* name : {"gyro.csv", "frame_timestamps.txt", "groundtruth.txt", "tracks.csv"})
    info(name, "# no rows\n");
  write_file(folder / "results.csv", "recording,configuration,start,frames,status\n");
  write_file(folder / "script", fmt::format("open {}/results.csv\n", folder));
  expect_refused(program("snapshot {} --script {}/script", kDesk, folder), "no rows of results");
  write_file(folder / "script", "");
  expect_result_or_line(fmt::format("snapshot {} --script {}/script", kDesk, folder));
}

}  // namespace
}  // namespace gpo::test
