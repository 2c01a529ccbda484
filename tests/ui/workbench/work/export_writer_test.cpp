// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/exports/scene.h"
#include "engine/inspection/studies/studies.h"
#include "tests/engine/exports/exported_room.h"
#include "tests/engine/test_folder.h"
#include "tests/ui/window_test.h"
#include "ui/views/overlay/overlay.h"
#include "ui/workbench/work/writers.h"

#include <thread>

#include <fmt/format.h>
#include <gmock/gmock.h>

namespace gpo {
namespace {

using test::refusal, testing::HasSubstr;

struct ExportWriterTest : testing::Test {
  ExportWriterTest() {
    const Camera lens{320, 240, 250, 250, 159.5, 119.5, Distortion::none, {}};
    state.results.inspection = std::make_shared<const Inspection>(test::exported_room(lens));
    state.document.recording = state.results.inspection->recording;
  }
  void write_all() {
    do {
      synchronize(state, writer);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    } while (writer.busy());
  }

  const test::TestFolder folder;
  WorkbenchState state;
  ExportWriter writer;
};

TEST_F(ExportWriterTest, WritesWhatTheWindowShowsOneAfterTheOther) {
  state.document.cube_side = 0.4;
  const fs::path scene = folder.path() / "a.glb", model = folder.path() / "model";
  run_line(state, "export gltf " + scene.string());
  run_line(state, "export colmap " + model.string());
  run_line(state, "export foxglove " + (folder.path() / "a.mcap").string());
  EXPECT_FALSE(fs::exists(scene)) << "the window does not wait";
  write_all();
  EXPECT_TRUE(fs::exists(scene) && fs::exists(model / "images.bin"));
  EXPECT_TRUE(fs::exists(folder.path() / "a.mcap"));
  std::string log;
  for (const LogLine& line : state.messages.lines) log += line.text + "\n";
  EXPECT_THAT(log, HasSubstr("saved " + scene.string() + ": 4 cameras, 2 planes,"));
  EXPECT_THAT(log, HasSubstr("left out: 1 track without a point"));
  const ExportScene exported = export_scene(*state.results.inspection, {.cube_side = 0.4});
  EXPECT_NEAR(exported.cubes[0].side, 0.4, 1e-12);
}

TEST_F(ExportWriterTest, RefusesUnknownFormatsAndFullFolders) {
  EXPECT_THAT(refusal(state, "export obj a.obj"),
              HasSubstr("found 'obj', expected one of colmap, gltf, ply, foxglove, tum"));
  const fs::path kept = folder.write("full/kept.txt", "kept");
  EXPECT_THAT(refusal(state, "export colmap " + kept.parent_path().string()), HasSubstr("full"));
  EXPECT_THAT(refusal(state, "export ply /nowhere/a.ply"), HasSubstr("/nowhere"));
  EXPECT_TRUE(state.requests.exports.empty());
  state.results.inspection = nullptr;
  EXPECT_THAT(refusal(state, "export ply a.ply"), HasSubstr("no result to export yet"));
}

TEST_F(ExportWriterTest, ReportsWhyAnExportFailed) {
  Inspection failure = *state.results.inspection;
  failure.initialization = std::make_shared<const Initialization>(failed("no parallax"));
  state.results.inspection = std::make_shared<const Inspection>(std::move(failure));
  run_line(state, "export tum " + (folder.path() / "a.txt").string());
  write_all();
  EXPECT_EQ(state.messages.severity, Severity::error);
  EXPECT_THAT(state.messages.text, HasSubstr("the initialization failed (no parallax)"));
  EXPECT_FALSE(fs::exists(folder.path() / "a.txt"));
}

TEST_F(ExportWriterTest, CancelDropsAllThatIsNotFinished) {
  for (int i = 0; i < 20; ++i)
    run_line(state, fmt::format("export gltf {}/{}.glb", folder.path().string(), i));
  synchronize(state, writer);
  state.requests.cancel = true;
  synchronize(state, writer);
  write_all();
  EXPECT_FALSE(fs::exists(folder.path() / "19.glb"));
  EXPECT_FALSE(state.requests.cancel);
}

TEST(ExportColors, AreThoseOfTheWindow) {
  EXPECT_EQ(plane_color(0), color_of(Role::inlier));
  EXPECT_EQ(kOutlierRgb, color_of(Role::outlier));
}

}  // namespace
}  // namespace gpo
