// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/session/session_file.h"

#include "tests/engine/test_folder.h"
#include "tests/ui/window_test.h"

#include <cstdlib>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace gpo {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre, testing::HasSubstr;

std::shared_ptr<const Recording> recording_at(const fs::path& path) {
  auto recording = std::make_shared<Recording>();
  recording->path = path;
  recording->name = path.filename();
  for (int i = 0; i < 60; ++i) recording->timestamps_ns.push_back(i * 33'000'000);
  return recording;
}

class SessionFile : public testing::Test {
 protected:
  SessionFile() {
    fs::create_directories(folder_ / "desk");
    setenv("XDG_STATE_HOME", (folder_ / "state").c_str(), 1);
    apply_recording(state_, recording_at(folder_ / "desk"));
  }
  fs::path write(const std::string& text) const { return owner_.write("a.json", text); }
  std::string refusal(const std::string& text) const {
    return test::error_of([&] { read_session(write(text)); });
  }

  const test::TestFolder owner_;
  const fs::path folder_ = owner_.path();
  WorkbenchState state_;
};

TEST_F(SessionFile, KeepsTheUsersOwnMethods) {
  state_.methods.add(Method{.key = "mine", .title = "mine", .command = "mine=cat"});
  state_.document.settings.options.method = state_.methods.find("mine");
  state_.document.compared = parse_configurations("mine+no-ransac,gpo", state_.methods);
  const std::string text = session_text(state_);
  EXPECT_NE(text.find("mine=cat"), std::string::npos);
  const auto read = read_session(write(text), state_.methods).state;
  EXPECT_EQ(read->document.settings, state_.document.settings);
  EXPECT_EQ(read->document.compared, state_.document.compared);
  EXPECT_THAT(refusal(text), HasSubstr("unknown value 'mine'"));
}

TEST_F(SessionFile, RestoresEverythingChosen) {
  test::run_lines(state_,
                  "method pba; set ransac_threshold_px 3.5; set exclude 3,17; set-scale 0.75 10 20 "
                  "30.5 40; set-origin 1 2 3 4; world_up gravity; frame 12; speed 2;"
                  "bookmark \"the cube leans\"; loop on; theme light; tails off; view normals;"
                  "view curves; compare gpo,ba+no-ransac; zoom 3");
  state_.view.orbit = OrbitCamera{.yaw_deg = 33};
  state_.document.cube_ray = Eigen::Vector3d(0.1, 0.2, 1);
  state_.document.other_cube_rays[2] = Eigen::Vector3d(-0.1, 0.2, 1);
  state_.selection = selected(std::vector<std::int64_t>{5, 2});
  const std::string text = session_text(state_);
  const SavedSession session = read_session(write(text));
  EXPECT_EQ(session.recording, folder_ / "desk");
  WorkbenchState other;
  other.files.waiting_session = session;
  apply_recording(other, state_.document.recording);
  EXPECT_EQ(session_text(other), text);
  EXPECT_EQ(other.document.settings, state_.document.settings);
  EXPECT_EQ(other.selection.focus, 2);
  EXPECT_THAT(other.document.bookmarks, ElementsAre(Bookmark{12, "the cube leans"}));
}

TEST_F(SessionFile, IsSavedTwoSecondsAfterAChangeOnly) {
  SessionSaver saver;
  const auto saved_frame = [] { return read_session(last_session_file()).state->view.frame; };
  saver.advance(state_, 60);
  EXPECT_FALSE(fs::exists(last_session_file())) << "nothing has changed";
  state_.view.frame = 12;
  saver.note_change();
  saver.advance(state_, 1);
  EXPECT_FALSE(fs::exists(last_session_file()));
  EXPECT_NEAR(saver.seconds_left().value(), 1, 1e-9) << "the window must wake up";
  saver.note_change();  // later changes do not delay it
  saver.advance(state_, 1.1);
  EXPECT_EQ(saved_frame(), 12);
  EXPECT_FALSE(saver.seconds_left());
  state_.view.frame = 13;
  saver.note_change();
  saver.advance(state_, 3);
  EXPECT_EQ(saved_frame(), 13);
}

/// Written by an early version of the program.
constexpr const char* kOldSession = R"({
  "kind": "gpo-inspector session",
  "version": 1,
  "recording": "/nowhere/desk",
  "settings": {"start": "3", "frames": "20", "method": "pba", "ransac_threshold_px": "3.5"},
  "frame": 12,
  "speed": 2.0,
  "loop": true,
  "theme": "light",
  "view": {"tracks": true, "tails": false, "residuals": true, "cube": false,
           "wireframe": true, "tower": true, "truth": true, "gravity": true, "undistorted": true,
           "legend": false, "scan": false, "uncertainty": 10, "exaggeration": 20, "point_size_px": 8},
  "panes": {"side": "normals", "compare": true, "drawer": "timing"},
  "division": {"column_px": 320.0, "settings_px": 200.0, "picture_share": 0.5, "drawer_share": 0.25,
               "column": false, "timeline": true},
  "text_zoom": 1.5,
  "compared": ["ba", "gpo+no-ransac"],
  "hidden_curves": ["pba"],
  "compare_zoom": {"factor": 2.0, "center": [0.25, 0.75]},
  "metric": true,
  "cube_side": 0.5,
  "cube_ray": [0.125, 0.25, 1.0],
  "model": "robot",
  "picture_zoom": {"factor": 4.0, "center": [0.5, 0.25]},
  "normals_zoom": {"factor": 2.0, "center": [0.25, -0.125]},
  "viewpoint": "side",
  "coloring": "depth",
  "orbit": {"target": [0.0, 0.5, 1.0], "up": [0.0, -1.0, 0.0], "front": [0.0, 0.0, 1.0],
            "yaw_deg": 33.0, "pitch_deg": 10.0, "distance": 2.5, "view_angle_deg": 30.0},
  "selection": {"tracks": [2, 5], "focus": 2},
  "bookmarks": [{"frame": 12, "note": "the cube leans"}]
})";

TEST_F(SessionFile, SortsTheBookmarks) {
  std::string text = kOldSession;
  const std::string before = R"("bookmarks": [)";
  text.insert(text.find(before) + before.size(), R"({"frame": 20, "note": "late"}, )");
  state_.files.waiting_session = read_session(write(text));
  apply_recording(state_, state_.document.recording);
  EXPECT_THAT(state_.document.bookmarks,
              ElementsAre(Bookmark{12, "the cube leans"}, Bookmark{20, "late"}));
}

TEST_F(SessionFile, ReadsOldSessionsAndWritesThemUnchanged) {
  WorkbenchState other;
  other.files.waiting_session = read_session(write(kOldSession));
  apply_recording(other, state_.document.recording);
  auto before = nlohmann::ordered_json::parse(kOldSession);
  const auto after = nlohmann::ordered_json::parse(session_text(other));
  for (const auto& [key, value] : before.at("settings").items())
    EXPECT_EQ(after.at("settings").at(key), value) << key;
  for (const char* key : {"recording", "settings"}) before[key] = after.at(key);
  for (const auto& [key, value] : before.at("view").items())
    EXPECT_EQ(after.at("view").at(key), value) << key;
  before["view"] = after.at("view");
  before["cube_plane"] = 0;  // new
  before["other_cubes"] = nlohmann::ordered_json::array();
  EXPECT_EQ(after, before) << "also in the order of the keys";
  EXPECT_EQ(other.view.panes.drawer, find_pane("timing", drawers()));
  EXPECT_EQ(other.view.toggles.uncertainty, 10);
}

TEST_F(SessionFile, ReadsTheSingleCubeOfAnOldSessionOnAnotherPlane) {
  auto old = nlohmann::ordered_json::parse(kOldSession);
  old["cube_plane"] = 2;
  const auto read = read_session(write(old.dump())).state;
  EXPECT_FALSE(read->document.cube_ray);
  EXPECT_EQ(read->document.other_cube_rays.at(2), Eigen::Vector3d(0.125, 0.25, 1));
}

TEST_F(SessionFile, KeepsDefaultsOfMissingFields) {
  const auto state =
      read_session(write(R"({"kind": "gpo-inspector session", "version": 1, "speed": 2,
                             "orbit": null, "view": {"tails": false}, "panes": {},
                             "compared": [], "hidden_curves": [], "bookmarks": []})"))
          .state;
  const WorkbenchState fresh;
  EXPECT_EQ(state->document.compared, fresh.document.compared);
  EXPECT_EQ(state->view.speed, 2);
  EXPECT_FALSE(state->view.toggles.tails);
  EXPECT_EQ(state->view.toggles.cube, fresh.view.toggles.cube);
  EXPECT_EQ(state->view.panes, fresh.view.panes);
  EXPECT_EQ(state->document.settings, fresh.document.settings);
  EXPECT_FALSE(state->view.orbit);
}

TEST_F(SessionFile, FindsARecordingMovedTogetherWithIt) {
  const fs::path moved = owner_.write("elsewhere/s.json", session_text(state_));
  fs::rename(folder_ / "desk", folder_ / "elsewhere/desk");
  EXPECT_EQ(read_session(moved).recording, folder_ / "elsewhere/desk");
}

TEST_F(SessionFile, ReportsInvalidFields) {
  const std::string head = R"({"kind": "gpo-inspector session", "version": 1, )";
  for (const auto& [text, message] :
       {std::pair<std::string, const char*>{"nonsense", "a.json: not valid JSON"},
        {"[]", "a.json: expected an object"},
        {"{}", "kind: ''"},
        {head + R"("frame": "x"})", "frame: invalid value \"x\""},
        {head + R"("frame": -1})", "frame: invalid value -1"},
        {head + R"("settings": {"method": "nobody"}})", "nobody"},
        {head + R"("panes": {"side": "cellar"}})", "cellar"},
        {head + R"("orbit": {"distance": 0}})", "distance: invalid value 0"},
        {head + R"("compared": ["gpo+sideways"]})", "sideways"}})
    EXPECT_THAT(refusal(text), HasSubstr(message));
}

TEST_F(SessionFile, RecentFilesAreUniqueAndLatestFirst) {
  fs::create_directories(folder_ / "other");
  for (const char* name : {"desk", "other", "desk", "gone", "desk/", "./desk"})
    remember_file(folder_ / name);
  EXPECT_THAT(recent_files(), ElementsAre(folder_ / "desk", folder_ / "other"));
}

TEST_F(SessionFile, IsRecognizedByItsKind) {
  EXPECT_TRUE(is_session(write(session_text(state_))));
  EXPECT_FALSE(is_session(write("{}")));
  EXPECT_FALSE(is_session(folder_));
}

TEST(UserFolders, FollowXdgVariablesElseHome) {
  setenv("HOME", "/home/nobody", 1);
  setenv("XDG_CACHE_HOME", "/somewhere", 1);
  EXPECT_EQ(user_cache_folder(), "/somewhere/gpo-inspector");
  setenv("XDG_CACHE_HOME", "not/absolute", 1);
  EXPECT_EQ(user_cache_folder(), "/home/nobody/.cache/gpo-inspector");
  unsetenv("XDG_STATE_HOME");
  EXPECT_EQ(user_state_folder(), "/home/nobody/.local/state/gpo-inspector");
}

}  // namespace
}  // namespace gpo
