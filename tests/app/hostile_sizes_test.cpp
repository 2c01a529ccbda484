// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// Small files that ask for much: one line, exit code 2, at most 300 MiB and 2 s of processor time.
// With GPO_HOSTILE=1 (tests/nightly.sh hostile) each runs in a process with limits for its memory
// and time.
#include "tests/app/program.h"
#include "tests/engine/recording/images/made_video.h"

#include <cstdlib>
#include <cstring>
#include <ctime>
#include <functional>

#include <bzlib.h>
#include <gmock/gmock.h>
#include <lz4frame.h>
#include <sqlite3.h>
#include <zlib.h>
#include <zstd.h>

namespace gpo::test {
namespace {

using testing::HasSubstr;

constexpr long kMostHostileKiB = 300 << 10;
constexpr double kMostSeconds = 2;

std::string many(const std::string& text, std::size_t count) {
  std::string all;
  all.reserve(text.size() * count);
  for (std::size_t i = 0; i < count; ++i) all += text;
  return all;
}

/// Little-endian bytes of an unsigned number.
template <class T>
std::string le(T number) {
  std::string bytes(sizeof(T), '\0');
  std::memcpy(bytes.data(), &number, sizeof(T));
  return bytes;
}

std::string text32(const std::string& text) {
  return le(static_cast<std::uint32_t>(text.size())) + text;
}

std::string zstd(const std::string& bytes) {
  std::string out(ZSTD_compressBound(bytes.size()), '\0');
  out.resize(ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), 1));
  return out;
}

std::string lz4(const std::string& bytes) {
  std::string out(LZ4F_compressFrameBound(bytes.size(), nullptr), '\0');
  out.resize(LZ4F_compressFrame(out.data(), out.size(), bytes.data(), bytes.size(), nullptr));
  return out;
}

std::string bz2(std::string bytes) {
  std::string out(bytes.size() / 50 + 1000, '\0');
  auto size = static_cast<unsigned>(out.size());
  BZ2_bzBuffToBuffCompress(
      out.data(), &size, bytes.data(), static_cast<unsigned>(bytes.size()), 9, 0, 0);
  out.resize(size);
  return out;
}

// MCAP: records of a kind, a length and a content.
std::string mcap_record(char kind, const std::string& content) {
  return kind + le(std::uint64_t{content.size()}) + content;
}

std::string mcap_chunk(const std::string& compression,
                       const std::string& stored,
                       std::uint64_t size) {
  return mcap_record(6,
                     std::string(16, '\0') + le(size) + le(std::uint32_t{0}) + text32(compression) +
                         le(std::uint64_t{stored.size()}) + stored);
}

/// A file without an index, whose chunks each have a million empty messages.
std::string mcap_bomb(const std::string& compression, int chunks) {
  const std::string magic = "\x89MCAP0\r\n";
  const std::string schema = mcap_record(
      3, le(std::uint16_t{1}) + text32("sensor_msgs/msg/Image") + text32("") + text32(""));
  const std::string channel = mcap_record(
      4,
      le(std::uint16_t{1}) + le(std::uint16_t{1}) + text32("/image") + text32("cdr") + text32(""));
  const std::string messages =
      many(mcap_record(5, le(std::uint16_t{1}) + std::string(20, '\0')), 1'000'000);
  const std::string stored = compression == "zstd" ? zstd(messages) : lz4(messages);
  return magic + mcap_record(1, text32("") + text32("")) + schema + channel +
         many(mcap_chunk(compression, stored, messages.size()), chunks);
}

/// ROS 1: records of fields and data.
std::string ros1_record(const std::vector<std::string>& fields, const std::string& data) {
  std::string all;
  for (const std::string& field : fields) all += text32(field);
  return text32(all) + text32(data);
}

std::string ros1_bomb(int chunks) {
  const std::string connection =
      ros1_record({std::string("op=\x07"), "conn=" + le(std::uint32_t{0}), "topic=/image"},
                  text32("topic=/image") + text32("type=sensor_msgs/Image"));
  const std::string message = ros1_record(
      {std::string("op=\x02"), "conn=" + le(std::uint32_t{0}), "time=" + le(std::uint64_t{0})}, "");
  const std::string content = connection + many(message, 600'000);
  const std::string chunk = ros1_record({std::string("op=\x05"),
                                         "compression=bz2",
                                         "size=" + le(static_cast<std::uint32_t>(content.size()))},
                                        bz2(content));
  return "#ROSBAG V2.0\n" +
         ros1_record({std::string("op=\x03"),
                      "index_pos=" + le(std::uint64_t{0}),
                      "conn_count=" + le(std::uint32_t{0}),
                      "chunk_count=" + le(std::uint32_t{0})},
                     std::string(4000, ' ')) +
         many(chunk, chunks);
}

/// A database of ROS 2 whose messages are a view without end.
void write_endless_database(const fs::path& file) {
  sqlite3* database = nullptr;
  sqlite3_open(file.c_str(), &database);
  sqlite3_exec(database,
               "CREATE TABLE topics(id INTEGER, name TEXT, type TEXT, serialization_format TEXT);"
               "INSERT INTO topics VALUES(1, '/image', 'sensor_msgs/msg/Image', 'cdr');"
               "CREATE VIEW messages AS WITH RECURSIVE n(id) AS (SELECT 1 UNION ALL SELECT id + 1 "
               "FROM n) SELECT id, 1 AS topic_id, id AS timestamp, x'00' AS data FROM n;",
               nullptr,
               nullptr,
               nullptr);
  sqlite3_close(database);
}

std::string png_chunk(const std::string& kind, const std::string& data) {
  const std::string summed = kind + data;
  const auto sum =
      crc32(0, reinterpret_cast<const Bytef*>(summed.data()), static_cast<unsigned>(summed.size()));
  return big_endian({std::ssize(data)}, 4) + summed +
         big_endian({static_cast<std::int64_t>(sum)}, 4);
}

constexpr std::int64_t kSide = 60'000;

std::string huge_png() {
  return "\x89PNG\r\n\x1A\n" +
         png_chunk("IHDR", big_endian({kSide, kSide}, 4) + std::string("\x08\x00\x00\x00\x00", 5)) +
         png_chunk("IDAT", std::string(20, 'x')) + png_chunk("IEND", "");
}

std::string huge_jpeg() {
  return "\xFF\xD8\xFF\xC0" + big_endian({11}, 2) + "\x08" + big_endian({kSide, kSide}, 2) +
         std::string("\x01\x01\x11\x00", 4) + "\xFF\xD9" + std::string(20, ' ');
}

std::string huge_tiff() {
  const auto entry = [](std::uint16_t tag, std::uint32_t value) {
    return le(tag) + le(std::uint16_t{4}) + le(std::uint32_t{1}) + le(value);
  };
  return std::string("II*\0", 4) + le(std::uint32_t{8}) + le(std::uint16_t{2}) + entry(256, kSide) +
         entry(257, kSide) + std::string(20, '\0');
}

std::string huge_webp() {
  const std::string size = le(std::uint32_t{kSide - 1}).substr(0, 3);
  return "RIFF" + le(std::uint32_t{22}) + "WEBPVP8X" + le(std::uint32_t{10}) +
         std::string(4, '\0') + size + size;
}

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

std::string laughs() {
  std::string yaml = "a0: &a0 [x, x, x, x, x, x, x, x, x, x]\n";
  for (int i = 1; i < 12; ++i)
    yaml += fmt::format("a{0}: &a{0} [{1}]\n", i, fmt::format("*a{0}, *a{0}, *a{0}, *a{0}", i - 1));
  return yaml;
}

std::string recipe_with(const std::string& boxes) {
  return replaced(read_file(GPO_SOURCE_DIR "/sequences/desk.yaml"),
                  {{"  prints:\n", "  boxes: [" + boxes + "]\n  prints:\n"}});
}

/// Writes a small recording in the EuRoC layout with one other file.
void write_euroc(const fs::path& folder, const std::string& name, const std::string& content) {
  write_file(folder / "cam0/data.csv", "1000000000,0.pgm\n1050000000,0.pgm\n");
  write_file(folder / "cam0/data/0.pgm", "P5 8 6 255\n" + std::string(48, 'x'));
  write_file(folder / name, content);
}

std::string session_with(const std::string& fields) {
  return R"({"kind": "gpo-inspector session", "version": 1, "recording": "", )" + fields + "}";
}

struct Hostile {
  const char* name;
  std::string arguments;  ///< of the program; {} is the folder
  std::string message;
  std::function<void(const fs::path& folder)> write;
};

std::function<void(const fs::path&)> file(const char* name,
                                          const std::function<std::string()>& content) {
  return [=](const fs::path& folder) { write_file(folder / name, content()); };
}

std::function<void(const fs::path&)> euroc(const char* name,
                                           const std::function<std::string()>& content) {
  return [=](const fs::path& folder) { write_euroc(folder, name, content()); };
}

const std::string kBox = "{kind: carton, center: [0, 0], size: [3, 3, 3], angle: 0}";
const char* const kLimited = "--limits allows more";

std::vector<Hostile> hostile_bags() {
  return {{"mcap zstd",
           "info {}/a.mcap",
           "expands to more than",
           file("a.mcap", [] { return mcap_bomb("zstd", 20); })},
          {"mcap lz4",
           "info {}/a.mcap",
           "too many messages",
           file("a.mcap", [] { return mcap_bomb("lz4", 20); })},
          {"ros 1 bz2",
           "info {}/a.bag",
           "expands to more than",
           file("a.bag", [] { return ros1_bomb(12); })},
          {"endless db3", "info {}/a.db3", "has no table `messages`", [](const fs::path& folder) {
             write_endless_database(folder / "a.db3");
           }}};
}

std::vector<Hostile> hostile_texts() {
  return {
      {"recipe, one box",
       "info {}/a.yaml",
       kLimited,
       file("a.yaml", [] { return recipe_with(kBox); })},
      {"recipe, 200 boxes",
       "info {}/a.yaml",
       kLimited,
       file("a.yaml", [] { return recipe_with(kBox + many(", " + kBox, 199)); })},
      {"yaml of aliases", "info {}", kLimited, euroc("cam0/sensor.yaml", laughs)},
      {"deep yaml",
       "info {}",
       "expected YAML",
       euroc("cam0/sensor.yaml", [] { return many("- ", 100'000); })},
      {"deep recipe",
       "info {}/a.yaml",
       "expected YAML",
       file("a.yaml", [] { return many("{a: ", 100'000); })},
      {"deep json",
       "view --session {}/a.json",
       "not valid JSON",
       file("a.json", [] { return many("{\"a\":", 100'000); })},
      {"csv line of 100 MB",
       "info {}",
       "imu0/data.csv:1: found 1 column",
       euroc("imu0/data.csv", [] { return std::string(100'000'000, '1'); })},
      {"board of 2500 million",
       "info {}",
       "board.yaml:2",
       euroc("board.yaml",
             [] { return "pattern: aprilgrid\ntagCols: 50000\ntagRows: 50000\ntagSize: 1\n"; })},
      {"experiment",
       "evaluate {}/a --merge {}/a --output {}/b",
       "experiment.json",
       file("a/experiment.json", [] { return many("[", 100'000); })},
      {"results", "view {}/results.csv", "results.csv", file("results.csv", [] {
         return "recording,configuration\n" + many("a,b\n", 100'000);
       })}};
}

std::vector<Hostile> hostile_pictures() {
  const auto picture = [](const char* name, std::string (*content)()) {
    return Hostile{name, "info {}", "an image of 60000x60000", euroc("cam0/data/0.pgm", content)};
  };
  return {picture("png", huge_png),
          picture("jpeg", huge_jpeg),
          picture("tiff", huge_tiff),
          picture("webp", huge_webp),
          {"video of 60000 px",
           "info {}/a.mp4",
           "a.mp4",
           [](const fs::path& folder) {
             write_changed_video(folder / "a.mp4", "mp4v", 28, big_endian({kSide, kSide}, 2));
           }},
          {"video of 100 million frames",
           "info {}/a.mp4",
           "a.mp4",
           [](const fs::path& folder) {
             write_changed_video(folder / "a.mp4", "stsz", 8, big_endian({1, 100'000'000}, 4));
           }},
          {"video of 4 billion samples", "info {}/a.mp4", "a.mp4", [](const fs::path& folder) {
             write_changed_video(folder / "a.mp4", "stts", 12, big_endian({4'000'000'000, 1}, 4));
           }}};
}

std::vector<Hostile> hostile_results() {
  const std::string run = "run sequences/desk --frames 5 --method r --result r=";
  const std::string session =
      "snapshot sequences/desk --session {}/a.json --view image --output {}/a.png";
  const auto model =
      [](const char* name, const char* message, const std::function<std::string()>& content) {
        return Hostile{name,
                       fmt::format("snapshot sequences/desk --script {{}}/script --frames 5"),
                       message,
                       [=](const fs::path& folder) {
                         write_file(folder / name, content());
                         write_file(folder / "script", fmt::format("model {}\n", folder / name));
                       }};
      };
  const auto ply = [](const std::string& format, const std::string& counts) {
    return [=] {
      return "ply\nformat " + format + " 1.0\n" + counts + "end_header\n" +
             std::string(100, '\x7F');
    };
  };
  const std::string vertices =
      "element vertex 2000000000\nproperty float x\nproperty float y\nproperty float z\n";
  return {
      {"trajectory of points",
       run + "{}/a.txt,{}/a.ply",
       "a.ply:",
       [=](const fs::path& folder) {
         write_file(folder / "a.txt", "1 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 1\n");
         write_file(folder / "a.ply", ply("ascii", vertices)());
       }},
      {"colmap images",
       run + "{}/images.bin",
       "images.bin",
       file("images.bin", [] { return le(std::uint64_t{1} << 60) + std::string(100, '\1'); })},
      {"session of tracks",
       session,
       "a.json",
       file("a.json",
            [] {
              return session_with("\"frame\": 2000000000, \"selection\": {\"tracks\": [1" +
                                  many(",1", 1'000'000) + "]}");
            })},
      model("a.ply", kLimited, ply("binary_little_endian", vertices)),
      model("b.ply",
            "no triangles",
            ply("binary_little_endian",
                "element vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement "
                "face 1\nproperty list int int vertex_indices\n")),
      model(
          "a.glb",
          kLimited,
          [] {
            const std::string json =
                R"({"asset":{"version":"2.0"},"accessors":[{"componentType":5126,"count":2000000000,"type":"VEC3"}]})";
            return "glTF" + le(std::uint32_t{2}) +
                   le(static_cast<std::uint32_t>(20 + json.size())) +
                   le(static_cast<std::uint32_t>(json.size())) + "JSON" + json;
          }),
      model(
          "a.gltf",
          kLimited,
          [] {
            return R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":20000000000,"uri":"a.bin"}]})";
          }),
      model(
          "a.obj", "a.obj: found more than 64 MiB", [] { return std::string(100'000'000, ' '); })};
}

/// Runs the program in a process of its own, limited to 1 GB of addresses more than it needs at
/// start and 10 s of processor time.
Outcome limited(const std::string& arguments) {
  return shell("ulimit -v 2500000 -t 10; timeout 20 '" GPO_PROGRAM "' " + arguments);
}

void expect_bounded(const std::vector<Hostile>& inputs) {
  const bool own_process = std::getenv("GPO_HOSTILE") != nullptr;
  for (const auto& [name, arguments, message, write] : inputs) {
    SCOPED_TRACE(name);
    const fs::path folder = fresh_folder();
    write(folder);
    std::string line = arguments;
    for (std::size_t at = 0; (at = line.find("{}")) != std::string::npos;)
      line.replace(at, 2, folder.string());
    const std::clock_t begin = std::clock();
    const Outcome outcome = own_process ? limited(line) : program(line);
    const double seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    expect_refused(outcome, message);
    EXPECT_LT(outcome.peak_kib, kMostHostileKiB);
    EXPECT_LT(seconds, kMostSeconds);
    fs::remove_all(folder);
  }
}

TEST(HostileSizes, BagsThatExpandAreRefused) { expect_bounded(hostile_bags()); }
TEST(HostileSizes, TextsThatExpandAreRefused) { expect_bounded(hostile_texts()); }
TEST(HostileSizes, ImagesOfImplausibleSizeAreRefused) { expect_bounded(hostile_pictures()); }
TEST(HostileSizes, ResultsAndModelsOfImplausibleSizeAreRefused) {
  expect_bounded(hostile_results());
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
