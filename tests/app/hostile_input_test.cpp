// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// Broken files on the command line give one line with the reason, exit code 2, no output and take
// less than 1 GiB of memory. tests/fuzz tests the parsers with more input.
#include "app/terminal/terminal.h"
#include "engine/base/error.h"
#include "engine/recording/images/images.h"
#include "tests/app/program.h"
#include "tests/engine/recording/images/made_video.h"

#include <algorithm>
#include <iostream>

#include <gmock/gmock.h>
#include <unistd.h>

namespace gpo::test {
namespace {

using testing::HasSubstr;

constexpr long kMostKiB = 1 << 20;

const char* const kCamera = R"(resolution: [8, 6]
camera_model: pinhole
intrinsics: [6, 6, 4, 3]
distortion_model: none
distortion_coefficients: []
T_BS: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]
)";
const char* const kImageList = "#timestamp [ns],filename\n1000000000,0.pgm\n1050000000,1.pgm\n";
const char* const kGyroscope =
    "#timestamp [ns],wx,wy,wz\n990000000,0,0,0\n1000000000,0,0,0\n1060000000,0,0,0\n";
const char* const kTruth =
    "#timestamp [ns],px,py,pz,qw,qx,qy,qz\n990000000,0,0,1,1,0,0,0\n1060000000,0,0,1,1,0,0,0\n";

std::string image() { return "P5 8 6 255\n" + std::string(48, 'x'); }

/// A small valid recording in the EuRoC layout.
void write_recording(const fs::path& folder) {
  write_file(folder / "cam0/sensor.yaml", kCamera);
  write_file(folder / "cam0/data.csv", kImageList);
  write_file(folder / "cam0/data/0.pgm", image());
  write_file(folder / "cam0/data/1.pgm", image());
  write_file(folder / "imu0/data.csv", kGyroscope);
  write_file(folder / "state_groundtruth_estimate0/data.csv", kTruth);
  write_file(folder / "plane.yaml", "normal: [0, 0, 1]\ndistance: 0\n");
  write_file(folder / "board.yaml", "pattern: chessboard\ncolumns: 9\nrows: 6\nsquare: 0.025\n");
}

void expect_one_line(const Outcome& outcome, const std::string& message) {
  expect_refused(outcome, message);
  EXPECT_LT(outcome.err.size(), 2000U);
  const auto control = [](unsigned char c) { return c < 0x20 && c != '\n'; };
  EXPECT_TRUE(std::ranges::none_of(outcome.err, control)) << outcome.err.substr(0, 2000);
  EXPECT_LT(outcome.peak_kib, kMostKiB);
}

std::string camera_with(const std::string& from, const std::string& to) {
  return replaced(kCamera, {{from, to}});
}

std::string repeated(const std::string& text, int count) {
  std::string all;
  for (int i = 0; i < count; ++i) all += text;
  return all;
}

const std::string kZeros(4096, '\0');

struct Replaced {
  std::string file, content, message;
};

const std::vector<Replaced> kFiles = {
    {"cam0/sensor.yaml", "", "sensor.yaml: found no value, expected"},
    {"cam0/sensor.yaml", kZeros, "sensor.yaml:"},
    {"cam0/sensor.yaml", "\x1B[2J\xFF\xFE\x80", "sensor.yaml:"},
    {"cam0/sensor.yaml", repeated("[", 500'000), "expected YAML"},
    {"cam0/sensor.yaml", repeated("a: {", 100'000), "expected YAML"},
    {"cam0/sensor.yaml", repeated(" ", 2 << 20), "found more than 1 MiB"},
    {"cam0/sensor.yaml", "resolution: &a [*a, *a]", "lists or maps nested too deeply"},
    {"cam0/sensor.yaml", camera_with("[6, 6, 4, 3]", "[0, 6, 4, 3]"), "intrinsics"},
    {"cam0/sensor.yaml", camera_with("[6, 6, 4, 3]", "[.nan, 6, 4, 3]"), "intrinsics"},
    {"cam0/sensor.yaml", camera_with("[8, 6]", "[1e9, 1e9]"), "resolution"},
    {"cam0/sensor.yaml",
     camera_with("pinhole", repeated("x\\n", 300'000)),
     "key `camera_model`: found \"x"},
    {"board.yaml",
     "pattern: chessboard\ncolumns: 1000000000\nrows: 6\nsquare: 1\n",
     "board.yaml:2: key `columns`"},
    {"board.yaml",
     "pattern: aprilgrid\ntagCols: 1000000000\ntagRows: 6\ntagSize: 1\n",
     "board.yaml:2: key `tagCols`"},
    {"board.yaml", "pattern: apriltag\ntagSize: .inf\n", "board.yaml:2: key `tagSize`"},
    {"plane.yaml", "normal: [.inf, 0, 0]\ndistance: 0\n", "plane.yaml:1: key `normal`"},
    {"cam0/data.csv", "", "cam0/data.csv: found no rows"},
    {"cam0/data.csv", kZeros, "cam0/data.csv"},
    {"cam0/data.csv", "2,0.pgm\n1,1.pgm\n", "cam0/data.csv:2: found time stamp 1"},
    {"cam0/data.csv", "1,0.pgm\n1,1.pgm\n", "cam0/data.csv:2: found time stamp 1"},
    {"cam0/data.csv", "1,0.pgm\n2,nothing.pgm\n", "nothing.pgm"},
    {"imu0/data.csv", "1,nan,0,0\n2,inf,0,0\n", "imu0/data.csv:1: found no row of finite rates"},
    {"imu0/data.csv", "1,0,0,0\n2,none,0,0\n", "imu0/data.csv:2: found \"none\""},
    {"imu0/data.csv", "1,0,0,0\n2,0,0", "imu0/data.csv:2: found 3 columns"},
    {"imu0/data.csv", "1,0,0,0\n99999999999999999999,0,0,0\n", "imu0/data.csv:2"},
    {"state_groundtruth_estimate0/data.csv", "1,0,0,0,0,0,0,0\n", "data.csv:1"},
    {"cam0/data/0.pgm", "", "0.pgm: the image is truncated or broken"},
    {"cam0/data/0.pgm", "no picture at all", "cannot decode: not an image"},
    {"cam0/data/0.pgm", image().substr(0, 40), "the image is truncated or broken"},
    {"cam0/data/0.pgm", "P2 65535 65535 255\n0", "found an image of 65535x65535"},
    {"cam0/data/0.pgm", "P5 4 4 255\n" + kZeros, "expected the calibrated resolution"}};

TEST(HostileFile, IsRefusedWithOneLine) {
  for (const auto& [file, content, message] : kFiles) {
    SCOPED_TRACE(file + ": " + message);
    const fs::path folder = fresh_folder(), recording = folder / "recording";
    write_recording(recording);
    write_file(recording / file, content);
    expect_one_line(program("info {}", recording), message);
    expect_one_line(program("run {} --frames 2 --json {}/result.json", recording, folder), message);
    EXPECT_EQ(std::distance(fs::directory_iterator(folder), {}), 1);
  }
}

/// Logs of sensors next to a video; they are read before the video.
const std::vector<Replaced> kLogs = {
    {"data.gcsv", kZeros, "data.gcsv:1: found a different first line"},
    {"data.gcsv",
     "GYROFLOW IMU LOG\n" + repeated("x,y\n", 1'000'000),
     "data.gcsv:201: found no table"},
    {"data.gcsv",
     "GYROFLOW IMU LOG\ntscale,1e308\ngscale,1\nt,gx,gy,gz\n1e308,1,2,3\n",
     "data.gcsv:5: found an implausible time"},
    {"data.jsonl", repeated("[", 5'000'000), "data.jsonl:1: found a line of"},
    {"data.jsonl", repeated("{\"a\":", 5'000) + "\n", "data.jsonl:1: found a line that"},
    {"data.jsonl", std::string("\xFF\xFE\0\n", 4), "data.jsonl:1: found a line that"},
    {"Gyroscope.csv", "time\n1\n", "Gyroscope.csv: missing column"},
    {"Gyroscope.csv", kZeros, "Gyroscope.csv"},
    {"camera_matrix.csv", "1,0,1\n0,1e999,1\n0,0,1\n", "camera_matrix.csv:2: found \"1e999\""},
    {"camera_matrix.csv", "1,0,1\n0,-1,1\n0,0,1\n", "camera_matrix.csv:3"},
    {"camera_matrix.csv", "1,0,1\n0,1,1\n0,0,1\n", "data.mp4: cannot decode"}};

TEST(HostileLog, IsRefusedWithOneLine) {
  for (const auto& [file, content, message] : kLogs) {
    SCOPED_TRACE(file + ": " + message);
    const fs::path folder = fresh_folder();
    write_file(folder / "camera.yaml", kCamera);
    write_file(folder / "data.mp4", "no video");
    write_file(folder / "odometry.csv", "1,0,0,0,0,0,0,0,1\n");
    write_file(folder / file, content);
    expect_one_line(program("info {}", folder), message);
  }
}

TEST(HostileInput, AcceptsByteOrderMarksAndLineEndsOfEditors) {
  const fs::path folder = fresh_folder();
  write_recording(folder / "plain");
  const Outcome plain = succeeding("info {}", folder / "plain");
  write_recording(folder / "edited/plain");
  for (const char* name : {"cam0/sensor.yaml", "cam0/data.csv", "imu0/data.csv", "plane.yaml"}) {
    std::string text = "\xEF\xBB\xBF" + read_file(folder / "plain" / name);
    text.pop_back();  // end of the last line
    for (std::size_t i = 0; (i = text.find('\n', i)) != std::string::npos; i += 4)
      text.replace(i, 1, "  \r\n");
    write_file(folder / "edited/plain" / name, text);
  }
  const Outcome edited = succeeding("info {}", folder / "edited/plain");
  EXPECT_EQ(edited.out.substr(edited.out.find('\n')), plain.out.substr(plain.out.find('\n')));
}

TEST(HostileInput, InvalidPathsAreRefused) {
  const fs::path folder = fresh_folder();
  fs::create_symlink("loop", folder / "loop");
  expect_one_line(program("info {}", folder / "loop"), "Too many levels of symbolic links");
  expect_one_line(program("info {}", repeated("long", 1000)), "File name too long");
  expect_one_line(program("info 'no\nsuch\033[31m\377file'"), "no");
  expect_one_line(program("info ''"), "recording is required");
  expect_one_line(program("info /dev/zero"), "/dev/zero");
}

TEST(HostileInput, NamesThatAreNotUtf8AreWritten) {
  const fs::path recording = fresh_folder() / "caf\xE9";
  write_recording(recording);
  EXPECT_THAT(succeeding("info --json '{}'", recording).out, HasSubstr("caf\xEF\xBF\xBD"));
}

TEST(HostileInput, UnreadableFilesAreRefused) {
  const fs::path folder = fresh_folder();
  write_recording(folder / "recording");
  // Root may read everything unless these capabilities are dropped.
  const std::string as_user =
      geteuid() == 0 ? "setpriv --bounding-set -dac_override,-dac_read_search " : "";
  const std::string info = as_user + "'" GPO_PROGRAM "' info " + (folder / "recording").string();
  fs::permissions(folder / "recording/cam0/sensor.yaml", fs::perms::none);
  expect_one_line(shell(info), "sensor.yaml: found Permission denied");
  fs::permissions(folder / "recording", fs::perms::none);
  expect_one_line(shell(info), "Permission denied");
  fs::permissions(folder / "recording", fs::perms::owner_all);
}

TEST(HostileInput, BrokenVideosAreRefused) {
  const fs::path folder = fresh_folder(), video = folder / "a.mp4";
  write_file(folder / "camera.yaml", camera_with("[8, 6]", "[64, 48]"));
  std::vector<cv::Mat> images;
  for (int i = 0; i < 10; ++i) images.emplace_back(48, 64, CV_8UC3, cv::Scalar::all(20 * i));
  make_video(video, images);
  const std::string whole = read_file(video);
  succeeding("info {}", folder);
  for (const std::string& broken :
       {std::string(), whole.substr(0, whole.size() / 2), whole.substr(0, 40), kZeros}) {
    write_file(video, broken);
    expect_one_line(program("info {}", folder), "a.mp4");
  }
}

TEST(HostileInput, InvalidRecipesSessionsAndScriptsAreRefused) {
  const fs::path folder = fresh_folder();
  const auto file = [&](const std::string& name, const std::string& content) {
    write_file(folder / name, content);
    return (folder / name).string();
  };
  expect_one_line(program("info {}", file("r.yaml", "seed: &a [*a]")),
                  "lists or maps nested too deeply");
  expect_one_line(
      program("synthesize {} --output {}", file("r.yaml", "seed: 1e300\n"), folder / "made"),
      "r.yaml:1: key `seed`: found \"1e300\"");
  expect_one_line(program("view --session {}", file("s.json", repeated("[", 100'000))),
                  "s.json: not valid JSON, expected a session");
  expect_one_line(program("view --session {}", file("s.json", repeated(" ", 20 << 20))),
                  "found more than 16 MiB");
  expect_one_line(program("view --script {}", file("s.txt", repeated("x", 2 << 20))),
                  "found more than 1 MiB");
  file("done/experiment.json", repeated("[", 100'000));
  expect_one_line(
      program("evaluate {} --methods gpo --lengths 5 --starts 0 --output {}/done", kDesk, folder),
      "experiment.json: is not the definition of an experiment");
  EXPECT_FALSE(fs::exists(folder / "made"));
}

/// Runs the program with files limited to 4 KiB, as on a full disk.
Outcome on_full_disk(const std::string& arguments) {
  return shell("trap '' XFSZ && ulimit -f 8 && '" GPO_PROGRAM "' {}", arguments);
}

TEST(FullDisk, NoPartialFileIsLeft) {
  const fs::path folder = fresh_folder();
  const fs::path script = folder.string() + ".script";
  write_file(script, fmt::format("export-video {}/a.mp4\n", folder));
  for (const BadInput& bad :
       {BadInput{"run {1} --frames 10 --json {0}/r.json", "r.json: "},
        {"run {1} --frames 10 --points {0}/p.ply", "p.ply: "},
        {"snapshot {1} --frames 5 --view image --output {0}/a.png", "a.png: "},
        {"snapshot {1} --frames 5 --script {0}.script", "a.mp4: "},
        {"synthesize sequences/desk.yaml --output {0}/made", ""}}) {
    const std::string line = fmt::format(fmt::runtime(bad.arguments), folder, kDesk);
    SCOPED_TRACE(line);
    expect_one_line(on_full_disk(line), bad.message + "cannot be written: File too large");
    EXPECT_TRUE(fs::is_empty(folder));
  }
  fs::remove(script);
}

TEST(FullDisk, EvaluateNamesTheFile) {
  const fs::path folder = fresh_folder();
  const Outcome outcome =
      on_full_disk("evaluate sequences/desk --methods all --lengths 5 --starts 0 --output " +
                   folder.string() + "/e 2>&1 >/dev/null | tail -n 1 >&2; exit 2");
  EXPECT_THAT(outcome.err, HasSubstr("cannot be written: File too large"));
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    EXPECT_EQ(entry.path().string().find("partial"), std::string::npos) << entry.path();
}

TEST(FullDisk, StandardOutputIsChecked) {
  expect_one_line(spawned("info " + kDesk + " >/dev/full"),
                  "standard output: cannot be written: No space left on device");
}

TEST(QuietLibraries, SilencesOnlyImageDecoders) {
  quiet_libraries();
  const std::string letter = "P2\n2 1\n255\nx";  // among the gray values
  testing::internal::CaptureStderr();
  EXPECT_THROW(decode_image(letter, "letter"), InputError);
  std::cerr << "another library " << 1 << '\n';
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "another library 1\n");
}

}  // namespace
}  // namespace gpo::test
