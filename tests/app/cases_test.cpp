// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// Files that people bring, with exact truth; see ../shared/data/cases/README.md.
#include "tests/app/program.h"

#include <gmock/gmock.h>

namespace gpo::test {
namespace {

using testing::HasSubstr;

struct Case {
  const char* name;
  const char* path;  ///< below data/cases
  int frames;        ///< number of frames in the recording
  double pne_deg, ate_m;
  const char* window = "--frames 20";
};

class FileOfPeople : public testing::TestWithParam<Case> {};

INSTANTIATE_TEST_SUITE_P(
    Cases,
    FileOfPeople,
    testing::Values(
        Case{"Av1Mp4", "phone-video-kinds/av1-mp4/video.mp4", 61, 0.03, 2e-4},
        Case{"Matroska", "phone-video-kinds/vp9-webm/recording.webm", 61, 0.03, 2e-4},
        Case{"M4v", "phone-video-kinds/h264-m4v/Frames.m4v", 61, 0.03, 2e-4},
        Case{"Phone3gp", "phone-video-kinds/h264-3gp/VID_0001.3gp", 61, 0.03, 2e-4},
        Case{"TransportStream", "phone-video-kinds/mpeg2-ts/video.ts", 61, 0.03, 2e-4},
        Case{"RotatedHlg", "phone-video-kinds/hevc10-hlg-rotated-mov/IMG_0001.MOV", 61, 0.03, 2e-4},
        Case{"SplitBag", "ros2-split-bag/rec", 45, 0.1, 1e-3},
        Case{"SplitBagByMetadata", "ros2-split-bag/rec/metadata.yaml", 45, 0.1, 1e-3},
        Case{"ZstdFile", "ros2-zstd/file-mode", 45, 0.1, 1e-3},
        Case{"ZstdFileAlone", "ros2-zstd/file-mode/rec_0.db3.zstd", 45, 0.1, 1e-3},
        Case{"ZstdMessages", "ros2-zstd/message-mode/rec_0.db3", 45, 0.1, 1e-3},
        Case{"TwoImuTopics", "realsense-two-imu-topics", 20, 0.1, 1e-3}),
    [](const auto& info) { return info.param.name; });

TEST_P(FileOfPeople, IsOpenedAndSolvedAsItsTruthSays) {
  const Case& tested = GetParam();
  const fs::path path = shared("cases") / tested.path;
  SKIP_WITHOUT(path);
  const Outcome info = succeeding("info {}", path);
  EXPECT_THAT(info.out, HasSubstr(fmt::format("{}, ", tested.frames)));
  const json result = run_json("{} {}", path, tested.window);
  EXPECT_LT(result["metrics"]["pne_deg"].get<double>(), tested.pne_deg);
  EXPECT_LT(result["metrics"]["ate_m"].get<double>(), tested.ate_m);
}

/// The cases that tests convert: a turned video, a guessed camera, sensors in two topics; all if
/// GPO_ALL_RECORDINGS is set, as in tests/nightly.sh.
std::vector<std::string> converted_cases() {
  std::vector<std::string> names = {"phone-video-kinds/hevc10-hlg-rotated-mov",
                                    "dataset-layouts/7scenes/seq-01",
                                    "realsense-two-imu-topics"};
  if (!all_recordings()) return names;
  for (const char* name : {"phone-video-kinds/av1-mp4",
                           "phone-video-kinds/vp9-webm",
                           "phone-video-kinds/h264-m4v",
                           "phone-video-kinds/h264-3gp",
                           "phone-video-kinds/mpeg2-ts",
                           "ros2-split-bag/rec",
                           "ros2-zstd/file-mode",
                           "ros2-zstd/message-mode",
                           "dataset-layouts/ios-logger",
                           "dataset-layouts/eth3d",
                           "dataset-layouts/replica",
                           "dataset-layouts/colmap",
                           "dataset-layouts/kitti/sequences/00",
                           "imu-gap-and-clock/gap-80ms",
                           "imu-gap-and-clock/late-30ms"})
    names.emplace_back(name);
  return names;
}

/// Compares plane, path, gravity and what is known of the camera.
void expect_same_window(const json& a, const json& b, const std::string& where) {
  for (const char* part : {"status", "plane", "metrics", "verdict", "uncertainty", "inertial"})
    expect_same_json(a.value(part, json()), b.value(part, json()), 1e-6, where);
  for (const char* part : {"source", "intrinsics"})
    expect_same_json(a.at("camera").at(part), b.at("camera").at(part), 1e-9, where);
}

/// A window that a guessed camera makes degenerate has a result, too.
json any_result(const fs::path& path) {
  return json::parse(program("run {} --frames 16 --json -", path).out);
}

TEST(FilesOfPeople, GiveTheSameResultAfterConversion) {
  for (const std::string& name : converted_cases()) {
    const fs::path path = shared("cases") / name, folder = fresh_folder();
    SKIP_WITHOUT(path);
    const json expected = any_result(path);
    for (const auto& [format, output] : {std::pair("euroc", "euroc"),
                                         std::pair("rosbag", "bag/a.bag"),
                                         std::pair("mcap", "mcap/a.mcap")}) {
      succeeding("convert {} --format {} --output {}", path, format, folder / output);
      expect_same_window(expected, any_result(folder / output), fmt::format("{} {}", name, output));
    }
  }
}

json finding(const json& result, const std::string& key) {
  for (const json& one : result["findings"])
    if (one["key"] == key) return one;
  return nullptr;
}

TEST(TruthOfPeople, IsNotUsedIfItsRotationsFitByAnotherConvention) {
  const fs::path source = shared("cases") / "truth-conventions";
  SKIP_WITHOUT(source);
  for (const auto& [name, convention] :
       {std::pair("opengl-axes", "its axes are x right, y up, z back (OpenGL)"),
        std::pair("quaternion-w-first", "its quaternions are read w first"),
        std::pair("world-to-camera", "its poses are inverted, from world to camera")}) {
    const fs::path folder = fresh_folder();
    fs::copy(source, folder, fs::copy_options::recursive);
    fs::copy(source / name / "groundtruth.txt", folder);
    for (const char* frames : {"10", "20"}) {
      const json found = run_json("{} --frames {}", folder, frames);
      const json note = finding(found, "truth-conventions");
      ASSERT_FALSE(note.is_null()) << name;
      EXPECT_THAT(note["sentence"].get<std::string>(), HasSubstr(convention));
      EXPECT_EQ(note["level"], "note");
      for (const char* metric : {"ate_m", "pne_deg", "pde_m", "path_error_m", "scale_ratio"})
        EXPECT_TRUE(found["metrics"][metric].is_null()) << metric;
    }
    const Outcome by_truth = program("run {} --frames 20 --rotations truth --json -", folder);
    EXPECT_EQ(by_truth.exit_code, 1);
    const json refused = json::parse(by_truth.out);
    EXPECT_EQ(finding(refused, "truth-conventions")["level"], "degenerate");
    EXPECT_THAT(refused["verdict"]["reason"].get<std::string>(), HasSubstr(convention));
    fs::remove(folder / "plane.yaml");
    EXPECT_FALSE(finding(run_json("{} --frames 20", folder), "truth-conventions").is_null());
  }
}

TEST(TruthOfPeople, ShowsErrorsThatContradictTheResult) {
  const fs::path folder = shared("cases") / "intrinsics-of-another-size";
  SKIP_WITHOUT(folder);
  const json result = run_json("{} --frames 20", folder);
  EXPECT_NEAR(result["metrics"]["pne_deg"].get<double>(), 13.8, 1);
  EXPECT_FALSE(finding(result, "truth-contradicts").is_null());
  EXPECT_TRUE(finding(result, "truth-conventions").is_null());
}

TEST(ResizedImages, AreSolvedByTheCommandOfTheFinding) {
  const fs::path path = shared("cases") / "intrinsics-of-another-size";
  SKIP_WITHOUT(path);
  const json wrong = run_json("{} --frames 20", path);
  EXPECT_EQ(wrong["verdict"]["readiness"], "weak");
  ASSERT_EQ(wrong["findings"][0]["key"], "implausible-intrinsics");
  EXPECT_EQ(wrong["findings"][0]["command"], "set intrinsics_scale 0.75");
  const json right = run_json("{} --frames 20 --intrinsics-scale 0.75", path);
  EXPECT_EQ(right["verdict"]["readiness"], "ready");
  EXPECT_LT(right["metrics"]["pne_deg"].get<double>(), 0.2);
  EXPECT_NEAR(right["camera"]["intrinsics"][2].get<double>(), 241.75, 1e-9);
}

}  // namespace
}  // namespace gpo::test
