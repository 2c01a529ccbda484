// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// Small files that ask for much: one line, exit code 2, at most 300 MiB and 2 s of processor time.
// With GPO_HOSTILE=1 (tests/nightly.sh hostile) each runs in a process with limits for its memory
// and time.
#include "tests/app/hostile_files.h"
#include "tests/app/program.h"
#include "tests/engine/peak_memory.h"
#include "tests/engine/recording/images/made_video.h"
#include "tests/engine/test_folder.h"
#include "ui/views/model/solid_model.h"

#include <cstdlib>
#include <ctime>
#include <functional>
#include <utility>

#include <gmock/gmock.h>

namespace gpo::test {
namespace {

using testing::HasSubstr;

/// Limits of a run; a script's include its recording and window.
struct RunBounds {
  long kib;
  double seconds;  ///< processor time
};

constexpr RunBounds kFileBounds{300 << 10, 2};
constexpr RunBounds kScriptBounds{700 << 10, 20};

/// Writes an MP4 of 4 frames and replaces `bytes` at `offset` from a box's name.
void write_changed_video(const fs::path& file,
                         const std::string& box,
                         std::size_t offset,
                         const std::string& bytes) {
  make_video(file, std::vector<cv::Mat>(4, cv::Mat(48, 64, CV_8UC3, cv::Scalar::all(99))));
  std::string video = read_file(file);
  const std::size_t place = video.find(box);
  ASSERT_NE(place, std::string::npos);
  video.replace(place + offset, bytes.size(), bytes);
  write_file(file, video);
}

/// Writes an AVI of 4 uncompressed frames that declares another size.
void write_uncompressed_video(const fs::path& file, std::uint32_t side) {
  make_video(file,
             std::vector<cv::Mat>(4, cv::Mat(48, 64, CV_8UC3, cv::Scalar::all(99))),
             {.codec = "rawvideo"});
  std::string video = read_file(file);
  video.replace(video.find("strf") + 12, 8, le(side) + le(side));
  write_file(file, video);
}

std::string laughs() {
  std::string yaml = "a0: &a0 [x, x, x, x, x, x, x, x, x, x]\n";
  for (int i = 1; i < 12; ++i)
    yaml += fmt::format("a{0}: &a{0} [{1}]\n", i, fmt::format("*a{0}, *a{0}, *a{0}, *a{0}", i - 1));
  return yaml;
}

std::string recipe_with(const std::string& boxes) {
  const std::string desk = read_file(GPO_SOURCE_DIR "/sequences/desk.yaml");
  const std::size_t begin = desk.find("  boxes:"), end = desk.find("picture:");
  return desk.substr(0, begin) + "  boxes: [" + boxes + "]\n" + desk.substr(end);
}

/// Writes a small recording in the EuRoC layout with one other file.
void write_euroc(const fs::path& folder, const std::string& name, const std::string& content) {
  write_file(folder / "cam0/data.csv", "1000000000,0.pgm\n1050000000,0.pgm\n");
  write_file(folder / "cam0/sensor.yaml",
             "resolution: [8, 6]\ncamera_model: pinhole\nintrinsics: [6, 6, 4, 3]\n"
             "distortion_model: none\ndistortion_coefficients: []\n"
             "T_BS: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]\n");
  write_file(folder / "cam0/data/0.pgm", "P5 8 6 255\n" + std::string(48, 'x'));
  write_file(folder / name, content);
}

std::string session_with(const std::string& fields) {
  return R"({"kind": "gpo-inspector session", "version": 1, "recording": "", )" + fields + "}";
}

struct Hostile {
  const char* name;
  std::string arguments;  ///< for the program; {} is the folder
  std::string message;    ///< empty: the program may also succeed
  std::function<void(const fs::path& folder)> write;
};

std::function<void(const fs::path&)> hostile_file(const char* name,
                                                  const std::function<std::string()>& content) {
  return [=](const fs::path& folder) { write_file(folder / name, content()); };
}

std::function<void(const fs::path&)> hostile_euroc(const char* name,
                                                   const std::function<std::string()>& content) {
  return [=](const fs::path& folder) { write_euroc(folder, name, content()); };
}

const std::string kBox = "{kind: carton, center: [0, 0], size: [3, 3, 3], angle: 0}";
const char* const kLimited = "--limits allows more";

std::vector<Hostile> hostile_bags() {
  return {
      {"mcap zstd",
       "info {}/a.mcap",
       kLimited,
       hostile_file("a.mcap", [] { return mcap_bomb("zstd", 20); })},
      {"mcap lz4",
       "info {}/a.mcap",
       kLimited,
       hostile_file("a.mcap", [] { return mcap_bomb("lz4", 20); })},
      {"ros 1 bz2", "info {}/a.bag", kLimited, hostile_file("a.bag", [] { return ros1_bomb(12); })},
      {"endless db3", "info {}/a.db3", "has no table `messages`", [](const fs::path& folder) {
         write_endless_database(folder / "a.db3");
       }}};
}

std::vector<Hostile> hostile_texts() {
  return {{"recipe, one box",
           "info {}/a.yaml",
           kLimited,
           hostile_file("a.yaml", [] { return recipe_with(kBox); })},
          {"recipe, 200 boxes",
           "info {}/a.yaml",
           kLimited,
           hostile_file("a.yaml", [] { return recipe_with(kBox + many(", " + kBox, 199)); })},
          {"yaml of aliases", "info {}", kLimited, hostile_euroc("cam0/sensor.yaml", laughs)},
          {"deep yaml",
           "info {}",
           "expected YAML",
           hostile_euroc("cam0/sensor.yaml", [] { return many("- ", 100'000); })},
          {"deep recipe",
           "info {}/a.yaml",
           "expected YAML",
           hostile_file("a.yaml", [] { return many("{a: ", 100'000); })},
          {"deep json",
           "view --session {}/a.json",
           "not valid JSON",
           hostile_file("a.json", [] { return many("{\"a\":", 100'000); })},
          {"csv line of 100 MB",
           "info {}",
           "imu0/data.csv",
           hostile_euroc("imu0/data.csv", [] { return std::string(100'000'000, '1'); })},
          {"board of 2500 million",
           "info {}",
           "board.yaml:2",
           hostile_euroc(
               "board.yaml",
               [] { return "pattern: aprilgrid\ntagCols: 50000\ntagRows: 50000\ntagSize: 1\n"; })},
          {"experiment",
           "evaluate --merge {}/a --output {}/b",
           "experiment.json",
           hostile_file("a/experiment.json", [] { return many("[", 100'000); })}};
}

std::vector<Hostile> hostile_pictures() {
  const auto picture = [](const char* name, std::string (*content)()) {
    return Hostile{
        name, "info {}", "an image of 60000x60000", hostile_euroc("cam0/data/0.pgm", content)};
  };
  return {picture("png", huge_png),
          picture("jpeg", huge_jpeg),
          picture("tiff", huge_tiff),
          picture("webp", huge_webp),
          {"video of 60000 px",
           "info {}/a.mp4",
           "",
           [](const fs::path& folder) {
             write_changed_video(folder / "a.mp4", "mp4v", 28, big_endian({60'000, 60'000}, 2));
           }},
          {"uncompressed video of 12000 px",
           "info {}/a.avi",
           "",
           [](const fs::path& folder) { write_uncompressed_video(folder / "a.avi", 12'000); }},
          {"video of 100 million frames",
           "info {}/a.mp4",
           "",
           [](const fs::path& folder) {
             write_changed_video(folder / "a.mp4", "stsz", 8, big_endian({1, 100'000'000}, 4));
           }},
          {"video of 4 billion samples", "info {}/a.mp4", "", [](const fs::path& folder) {
             write_changed_video(folder / "a.mp4", "stts", 12, big_endian({4'000'000'000, 1}, 4));
           }}};
}

std::string ply_text(const std::string& format, const std::string& counts) {
  return "ply\nformat " + format + " 1.0\n" + counts + "end_header\n" + std::string(100, '\x7F');
}

const std::string kVertices =
    "element vertex 2000000000\nproperty float x\nproperty float y\nproperty float z\n";

std::vector<Hostile> hostile_results() {
  const std::string run = "run sequences/desk --frames 5 --method r --result r=";
  const std::string session = "view --session {}/a.json";
  return {{"trajectory of points",
           run + "{}/a.txt,{}/a.ply",
           "a.ply:",
           [](const fs::path& folder) {
             write_file(folder / "a.txt", "1 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 1\n");
             write_file(folder / "a.ply", ply_text("ascii", kVertices));
           }},
          {"colmap images",
           run + "{}/images.bin",
           "images.bin",
           hostile_file("images.bin",
                        [] { return le(std::uint64_t{1} << 60) + std::string(100, '\1'); })},
          {"results",
           "snapshot sequences/desk --script {}/script",
           "results.csv",
           [](const fs::path& folder) {
             write_file(folder / "results.csv",
                        "recording,configuration\n" + many("a,b\n", 100'000));
             write_file(folder / "script", fmt::format("open {}/results.csv\n", folder));
           }},
          {"session of tracks", session, "a.json", hostile_file("a.json", [] {
             return session_with("\"frame\": 2000000000, \"selection\": {\"tracks\": [1" +
                                 many(",1", 1'000'000) + "]}");
           })}};
}

struct HostileModel {
  const char* name;
  const char* message;
  std::function<std::string()> content;
};

std::vector<HostileModel> hostile_models() {
  return {
      {"a.ply", kLimited, [] { return ply_text("binary_little_endian", kVertices); }},
      {"b.ply",
       "counts of type int",
       [] {
         return ply_text(
             "binary_little_endian",
             "element vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement "
             "face 1\nproperty list int int vertex_indices\n");
       }},
      {"a.glb",
       kLimited,
       [] {
         const std::string json =
             R"({"asset":{"version":"2.0"},"accessors":[{"componentType":5126,"count":2000000000,"type":"VEC3"}]})";
         return "glTF" + le(std::uint32_t{2}) + le(static_cast<std::uint32_t>(20 + json.size())) +
                le(static_cast<std::uint32_t>(json.size())) + "JSON" + json;
       }},
      {"a.gltf",
       kLimited,
       [] {
         return R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":20000000000,"uri":"a.bin"}]})";
       }},
      {"a.obj", "a.obj: found more than 64 MiB", [] { return std::string(100'000'000, ' '); }}};
}

/// Runs the program in a process of its own with 4 GB of addresses and 20 s of processor time.
Outcome limited(const std::string& arguments) {
  return shell("ulimit -v 4000000; ulimit -t 20; timeout 20 '" GPO_PROGRAM "' " + arguments);
}

/// Returns the outcome and its processor time [s] of the first of three runs within a bound, or of
/// the last one: other programs on the same processor lengthen it by up to a half.
std::pair<Outcome, double> timed(const std::function<Outcome()>& run, double bound) {
  for (int attempt = 1;; ++attempt) {
    const std::clock_t begin = std::clock();
    Outcome outcome = run();
    const double seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    if (seconds < bound || attempt == 3) return {std::move(outcome), seconds};
  }
}

void expect_bounded(const std::vector<Hostile>& inputs, RunBounds bounds) {
  bounds.seconds *= GPO_SLOWDOWN;  // sanitizers are slower
  const bool own_process = std::getenv("GPO_HOSTILE") != nullptr;
  for (const auto& [name, arguments, message, write] : inputs) {
    SCOPED_TRACE(name);
    const fs::path folder = fresh_folder();
    write(folder);
    std::string line = arguments;
    for (std::size_t at = 0; (at = line.find("{}")) != std::string::npos;)
      line.replace(at, 2, folder.string());
    const auto run = [&] { return own_process ? limited(line) : program(line); };
    const auto [outcome, seconds] = timed(run, bounds.seconds);
    if (!message.empty() || outcome.exit_code != 0) expect_refused(outcome, message);
    EXPECT_LT(outcome.peak_kib, bounds.kib);
    EXPECT_LT(seconds, bounds.seconds);
    fs::remove_all(folder);
  }
}

TEST(HostileSizes, BagsThatExpandAreRefused) { expect_bounded(hostile_bags(), kFileBounds); }
TEST(HostileSizes, TextsThatExpandAreRefused) { expect_bounded(hostile_texts(), kFileBounds); }
TEST(HostileSizes, ImagesOfImplausibleSizeAreRefused) {
  expect_bounded(hostile_pictures(), kFileBounds);
}
TEST(HostileSizes, ResultsOfImplausibleSizeAreRefused) {
  expect_bounded(hostile_results(), kScriptBounds);
}
TEST(HostileSizes, ModelsOfImplausibleSizeAreRefused) {
  for (const auto& [name, message, content] : hostile_models()) {
    SCOPED_TRACE(name);
    const fs::path file = fresh_folder() / name;
    write_file(file, content());
    const PeakMemory memory;
    EXPECT_THAT(error_of([&] { read_solid_model(file); }), HasSubstr(message));
    EXPECT_LT(memory.kib(), kFileBounds.kib);
    fs::remove(file);
  }
}

TEST(HostileSizes, LimitsOptionRaisesTheLimits) {
  const fs::path folder = fresh_folder();
  write_euroc(folder, "cam0/data/0.pgm", huge_png());
  expect_refused(program("info {} --limits 10", folder), "at most 640 million pixels");
  expect_refused(program("info {} --limits 0", folder),
                 "--limits: found '0', expected a number of at least 1, or none");
  write_euroc(folder, "cam0/sensor.yaml", laughs());
  expect_refused(program("info {}", folder), "at most 100000; --limits allows more");
}

}  // namespace
}  // namespace gpo::test
