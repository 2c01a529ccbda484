// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/files/text_file.h"

#include "engine/files/byte_cursor.h"
#include "engine/files/csv_table.h"
#include "engine/files/yaml_entry.h"
#include "tests/engine/test_folder.h"

#include <tuple>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>
#include <sys/stat.h>

namespace gpo::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;
using testing::ElementsAre, testing::EndsWith, testing::HasSubstr;

const std::vector<std::string> kGyro = {"timestamp", "wx", "wy", "wz"};

std::vector<std::int64_t> times_of(const TestFolder& folder,
                                   const std::string& content,
                                   TimeUnit unit = TimeUnit::by_frame_rate) {
  return csv_time_stamps(
      read_csv(folder.write("t.txt", content), {"timestamp"}, CsvColumns::exactly), unit);
}

TEST(ParseDecimal, IsExactToTheNanosecondAndRejectsOtherTextAndHugeNumbers) {
  EXPECT_EQ(parse_decimal("1403636579.763555584", 9), 1403636579763555584);
  EXPECT_EQ(parse_decimal("1403636579763555584", 0), 1403636579763555584);
  EXPECT_EQ(parse_decimal("1.403636579763555584e+18", 0), 1403636579763555584);
  EXPECT_EQ(parse_decimal("-0.0000000015", 9), -2);
  EXPECT_EQ(parse_decimal("+.5", 9), 500000000);
  EXPECT_EQ(parse_decimal("0", 9), 0);
  EXPECT_EQ(parse_decimal("0e0", 9), 0);
  EXPECT_EQ(parse_decimal("1e-30", 9), 0);
  EXPECT_EQ(parse_decimal("007", 0), 7);
  for (const char* text : {"", ".", "-", "nan", "inf", "1.2.3", "12a", "1e", "1e99", "9e18", "0x1"})
    EXPECT_EQ(parse_decimal(text, 9), std::nullopt) << text;
  EXPECT_TRUE(parse_decimal("4611686018427387902", 0));
  EXPECT_FALSE(parse_decimal("4611686018427387903", 0));
  EXPECT_FALSE(parse_decimal("-4611686018427387903", 0));
}

TEST(ParseNumber, RejectsInfinityAndOtherText) {
  EXPECT_EQ(parse_number("+1.5e-3"), 1.5e-3);
  for (const char* text : {"", "nan", "inf", "-inf", "1e999", "1,5", "1.5 ", "+-1"})
    EXPECT_EQ(parse_number(text), std::nullopt) << text;
}

TEST(CsvTable, ReadsEurocHeaderCommentsAndLineBreaks) {
  const TestFolder folder;
  const auto file = folder.write("imu.csv",
                                 "\xEF\xBB\xBF# made by hand\r\n"
                                 "#timestamp [ns],w_RS_S_x [rad s^-1],w_RS_S_y [rad s^-1],"
                                 "w_RS_S_z [rad s^-1],a_RS_S_x [m s^-2]\r\n"
                                 "1, 0.5 ,-2e-1,+3,9\r\n\r\n# a pause\r\n2,1,2,3,9");
  const CsvTable table = read_csv(file, kGyro, CsvColumns::at_least);
  ASSERT_EQ(table.rows.size(), 2U);
  EXPECT_EQ(table.header[1], "w_RS_S_x [rad s^-1]");
  EXPECT_EQ(table.rows[0].line, 3);
  EXPECT_EQ(table.rows[1].line, 6);
  EXPECT_DOUBLE_EQ(csv_number(table, table.rows[0], 1), 0.5);
  EXPECT_DOUBLE_EQ(csv_number(table, table.rows[0], 3), 3);
}

TEST(CsvTable, ReadsTheUnitOfTimeFromTheHeaderOrDerivesItFromTheRate) {
  const TestFolder folder;
  for (const auto& [names, rows, first_ns, second_ns] :
       {std::tuple("timestamp [ns]|timestamp_ns|#timestamp(ns)|# t [ns]", "5\n7\n", 5, 7),
        std::tuple("t_us", "1\n2\n", 1000, 2000),
        std::tuple("timestamp [ms]|time_ms|# Time[millisec]", "0.5\n2\n", 500'000, 2'000'000),
        std::tuple("timestamp [s]|timestamp_s|# time_s", "0.5\n2\n", 500'000'000, 2'000'000'000)})
    for (const std::string& name : split(names, '|'))
      EXPECT_THAT(times_of(folder, name + "\n" + rows), ElementsAre(first_ns, second_ns)) << name;
  EXPECT_THAT(times_of(folder, "1403636579763555584\n1403636579763555585\n"),
              ElementsAre(1403636579763555584, 1403636579763555585));
  EXPECT_THAT(times_of(folder, "timestamp\n1\n2\n"), ElementsAre(1000000000, 2000000000));
  EXPECT_THAT(times_of(folder, "# my camera\n1403636579.5\n"), ElementsAre(1403636579500000000));
  EXPECT_THAT(times_of(folder, "0\n33333333\n", TimeUnit::nanoseconds), ElementsAre(0, 33333333));
  // A phone 28 minutes after its start, 30 Hz, in every unit.
  for (const char* times : {"1700.1\n1700.133\n",
                            "1700100\n1700133\n",
                            "1700100000\n1700133000\n",
                            "1700100000000\n1700133000000\n"})
    EXPECT_THAT(times_of(folder, times), ElementsAre(1700100000000, 1700133000000)) << times;
  // A gyroscope of 1 kHz in milliseconds steps by one, and so does a camera of 1 Hz in seconds.
  EXPECT_THAT(times_of(folder, "1\n2\n", TimeUnit::by_sample_rate), ElementsAre(1000000, 2000000));
  EXPECT_THAT(times_of(folder, "0.005\n0.01\n", TimeUnit::by_sample_rate),
              ElementsAre(5000000, 10000000));
}

TEST(CsvTable, ReadsColumnsSeparatedByBlanks) {
  const TestFolder folder;
  const auto file = folder.write("rgb.txt",
                                 "# color images\n# file: 'desk.bag'\n# timestamp filename\n"
                                 "1305031102.175304 rgb/1.png  \n1305031102.211214\trgb/2.png");
  const CsvTable table = read_csv(file, {"timestamp", ""}, CsvColumns::exactly, Separator::blanks);
  ASSERT_EQ(table.rows.size(), 2U);
  EXPECT_EQ(csv_cell(table, table.rows[0], 1), "rgb/1.png");
  EXPECT_EQ(csv_cell(table, table.rows[1], 1), "rgb/2.png");
  EXPECT_THAT(csv_time_stamps(table, TimeUnit::seconds),
              ElementsAre(1305031102175304000, 1305031102211214000));
}

TEST(CsvTable, AcceptsManyNamesOfAngularRates) {
  const TestFolder folder;
  for (const char* x :
       {"wx", "gx[rad/s]", "gyro_x", "omega_x (rad/s)", "rotationRateX", "w_RS_S_x"}) {
    const std::string name = x;
    const auto axis = [&](char c) {
      std::string other = name;
      other[name.find_first_of("xX", 1)] = name.find('X') != std::string::npos ? char(c - 32) : c;
      return other;
    };
    const auto file = folder.write(
        "gyro.csv",
        "Timestamp[nanosec]," + name + "," + axis('y') + "," + axis('z') + "\n1,2,3,4\n");
    EXPECT_NO_THROW(read_csv(file, kGyro, CsvColumns::exactly)) << name;
  }
}

TEST(CsvTable, ErrorsNameFileAndLineAlsoOfANonAscendingTime) {
  const TestFolder folder;
  EXPECT_THAT(error_of([&] { times_of(folder, "timestamp_s\n1\n3\n2\n"); }),
              EndsWith("t.txt:4: found time stamp 2, earlier than the previous one, expected "
                       "ascending time stamps"));
  EXPECT_THAT(error_of([&] { times_of(folder, "1\n1\n"); }),
              HasSubstr("t.txt:2: found time stamp 1, equal to"));
  EXPECT_THAT(error_of([&] { times_of(folder, "1\nx\n"); }),
              EndsWith("t.txt:2: found \"x\", expected a time stamp"));
  const std::string kColumns = "(timestamp,wx,wy,wz)";
  const auto error = [&](const std::string& content) {
    const auto file = folder.write("gyro.csv", content);
    return error_of([&] {
      const CsvTable table = read_csv(file, kGyro, CsvColumns::exactly);
      csv_time_stamps(table, TimeUnit::by_sample_rate);
      for (const auto& row : table.rows)
        for (int i = 1; i < 4; ++i) csv_number(table, row, i);
    });
  };
  for (const auto& [content, message] : std::vector<std::pair<std::string, std::string>>{
           {"", ": found no rows, expected timestamp,wx,wy,wz"},
           {"timestamp,wx,wy,wz\n", ": found no rows, expected timestamp,wx,wy,wz"},
           {"timestamp,wx,wy,wz\n1,2,3\n", ":2: found 3 columns, expected 4 " + kColumns},
           {"1,2,3,4\n2,2,3,4,5\n", ":2: found 5 columns, expected 4 " + kColumns},
           {"1,2,3,4\n2,2,3",
            ":2: found 3 columns (the file seems truncated), expected 4 " + kColumns},
           {"timestamp;wx;wy;wz\n1;2;3;4\n",
            ":2: found 1 column, expected 4 separated by commas " + kColumns},
           {"1 2 3 4\n2 2 3 4\n", ":2: found 1 column, expected 4 separated by commas " + kColumns},
           {"timestamp,wx,wz,wy\n1,2,3,4\n",
            ":1: found column 3 named \"wz\", expected \"wy\" (columns timestamp,wx,wy,wz)"},
           {"#timestamp,ax,ay,az\n1,2,3,4\n",
            ":1: found column 2 named \"ax\", expected \"wx\" (columns timestamp,wx,wy,wz)"},
           {"timestamp,wx,wy,wz,t\n1,2,3,4\n",
            ":1: found 5 names of columns, expected 4 as in the rows"},
           {"1,2,3,4\n2,nan,3,4\n", ":2: found \"nan\", expected a finite number"},
           {"1,2,3,4\n2,3,-inf,4\n", ":2: found \"-inf\", expected a finite number"},
           {"1,2,3,4\n2,3,,4\n", ":2: found \"\", expected a finite number"},
           {"1,2,3,4\nnan,3,3,4\n", ":2: found \"nan\", expected a time stamp"}})
    EXPECT_EQ(error(content), (folder.path() / "gyro.csv").string() + message);
}

TEST(CsvTable, NamesTheBlanksThatSeparateColumns) {
  const TestFolder folder;
  const auto error = [&](const std::string& content) {
    const auto file = folder.write("truth.txt", content);
    return error_of([&] {
      csv_time_stamps(read_csv(file, {"timestamp", "tx"}, CsvColumns::exactly, Separator::blanks),
                      TimeUnit::seconds);
    });
  };
  for (const char* content : {"1,2\n2,2\n", "1;2\n2;2\n"})
    EXPECT_THAT(error(content),
                EndsWith("truth.txt:2: found 1 column, expected 2 separated by blanks "
                         "(timestamp,tx)"));
  EXPECT_THAT(error("1, 2\n2, 2\n"),
              EndsWith("truth.txt:1: found column 1 named \"1,\", expected \"timestamp\" (columns "
                       "timestamp,tx, separated by blanks)"));
  EXPECT_THAT(error("timestamp, tx\n2, 2\n"),
              EndsWith("truth.txt:2: found \"2,\", expected a time stamp, separated by blanks"));
  EXPECT_THAT(error("1\n"), EndsWith("found 1 column, expected 2 (timestamp,tx)"));
  EXPECT_THAT(error("1 2 3\n"), EndsWith("found 3 columns, expected 2 (timestamp,tx)"));
}

std::string error_at(const fs::path& file) {
  return error_of([&] { read_file(file); });
}

TEST(TextFile, ReadsRegularFilesUpToTheLimit) {
  const TestFolder folder;
  std::string content;
  for (int i = 0; i < 300'000; ++i) content += static_cast<char>(i % 251);
  EXPECT_EQ(read_file(folder.write("a", content)), content);
  EXPECT_EQ(read_file(folder.write("empty", std::string())), "");
  const fs::path file = folder.write("a", std::string((1 << 20) + 1, 'x'));
  EXPECT_EQ(read_file(file, (1 << 20) + 1).size(), (1U << 20) + 1);
  EXPECT_THAT(error_of([&] { read_file(file, limits().hand_bytes); }),
              EndsWith("a: found more than 1 MiB, expected a smaller file; --limits allows more"));
  EXPECT_THAT(error_at(folder.path() / "no"), EndsWith("no: no such file"));
  EXPECT_THAT(error_at(folder.path()), EndsWith(": found a folder, expected a file"));
  ASSERT_EQ(mkfifo((folder.path() / "pipe").c_str(), 0600), 0);
  EXPECT_THAT(error_at(folder.path() / "pipe"),
              EndsWith("pipe: found a pipe or device, expected a regular file"));
  EXPECT_THAT(error_at("/dev/zero"), EndsWith("found a pipe or device, expected a regular file"));
  fs::create_symlink("loop", folder.path() / "loop");
  EXPECT_THAT(error_at(folder.path() / "loop"),
              EndsWith("loop: found Too many levels of symbolic links, expected a file"));
}

TEST(ParseSize, AcceptsOnlyTwoIntegers) {
  EXPECT_EQ(parse_size("640x480"), std::pair(640, 480));
  EXPECT_EQ(parse_size("-1x0"), std::pair(-1, 0));
  // The last two are 640x480 in the lowest 32 bits.
  for (const std::string& text :
       split(",x,640,640x,x480,640x480x,640x480 ,640X480,6.4x4,4294967936x480,640x4294967776", ','))
    EXPECT_EQ(parse_size(text), std::nullopt) << text;
}

TEST(TextLines, SkipsTheByteOrderMark) {
  TextLines lines("\xEF\xBB\xBF a b\r\n\nlast");
  EXPECT_EQ(lines.next(), "a b");
  EXPECT_EQ(lines.next(), "");
  EXPECT_TRUE(lines.ended());
  EXPECT_EQ(lines.rest(), "last");
  EXPECT_EQ(lines.next(), "last");
  EXPECT_FALSE(lines.ended());
  EXPECT_EQ(lines.number(), 3);
  EXPECT_EQ(lines.next(), std::nullopt);
  EXPECT_EQ(lines.number(), 3);
}

TEST(TakeWord, RemovesBlanksAfterTheWord) {
  std::string_view rest = "one \t two";
  EXPECT_EQ(take_word(rest), "one");
  EXPECT_EQ(take_word(rest), "two");
  EXPECT_TRUE(rest.empty());
  EXPECT_EQ(take_word(rest), "");
}

TEST(ByteOrder, ReadsOnlyCompleteNumbers) {
  const std::string_view bytes("\x01\x02\xFF", 3);
  EXPECT_EQ(big_endian(bytes, 0, 2), 0x0102U);
  EXPECT_EQ(little_endian(bytes, 0, 2), 0x0201U);
  EXPECT_EQ(big_endian(bytes, 2, 1), 0xFFU);
  EXPECT_EQ(big_endian(bytes, 2, 2), 0U);
  EXPECT_EQ(big_endian(bytes, UINT64_MAX, 1), 0U);
}

TEST(JsonText, SurvivesReadingUnlessItIsTruncatedOrDeep) {
  const TestFolder folder;
  const ordered_json json = {{"b", {1, 2.5, nullptr}}, {"a", "\u00e9\n"}};
  EXPECT_EQ(read_json(folder.write("a.json", json_text(json, 2))), json);
  EXPECT_EQ(json_text(ordered_json("caf\xE9"), 0), "\"caf\xEF\xBF\xBD\"\n");
  for (const std::string& text : {std::string(),
                                  std::string("{\"a\": "),
                                  std::string(20, '['),
                                  std::string(20, '[') + std::string(20, ']'),
                                  std::string(1'000'000, '[')})
    EXPECT_TRUE(read_json(folder.write("a.json", text)).is_discarded()) << text.substr(0, 20);
  EXPECT_FALSE(read_json(folder.write("a.json", std::string("[[[]]]"))).is_discarded());
}

std::string error_in(const std::string& content) {
  const TestFolder folder;
  return error_of([&] { load_yaml(folder.write("a.yaml", content)); });
}

TEST(Yaml, ExpandsAliasesAndRejectsEndlessOnes) {
  const TestFolder folder;
  const auto root = load_yaml(folder.write("a.yaml", std::string("a: &a [1, 2]\nb: [*a, *a]\n")));
  EXPECT_THAT(numbers(at(root, "b", "")), ElementsAre(1, 2, 1, 2));
  EXPECT_THAT(error_in("a: &a [1, *a]\n"),
              HasSubstr("a.yaml:1: found lists or maps nested too deeply, expected at most 64"));
  std::string doubling = "a0: &a0 [1, 1]\n";
  for (int i = 1; i < 40; ++i) doubling += fmt::format("a{0}: &a{0} [*a{1}, *a{1}]\n", i, i - 1);
  EXPECT_THAT(error_in(doubling), HasSubstr("a.yaml:1: found too many values"));
}

TEST(Yaml, RejectsDeepHugeAndBinaryFiles) {
  EXPECT_THAT(error_in(fmt::format("a: {:[>65}{:]>65}", "", "")),
              HasSubstr("lists or maps nested too deeply"));
  EXPECT_THAT(error_in(std::string(100'000, '[')), HasSubstr("expected YAML"));
  EXPECT_THAT(error_in(std::string(2 << 20, ' ')), HasSubstr("found more than 1 MiB"));
  EXPECT_THAT(error_in(std::string("\x7F"
                                   "ELF\0\1\xFF",
                                   7)),
              testing::AnyOf(HasSubstr("expected YAML"), HasSubstr("no error")));
}

TEST(Yaml, QuotesFoundTextShortAndLegible) {
  const TestFolder folder;
  const auto file = folder.write("a.yaml", fmt::format("a: \"x\n{:y>100}\"\n", ""));
  const auto root = load_yaml(file);
  EXPECT_EQ(error_of([&] { number(at(root, "a", "")); }),
            file.string() + ":1: key `a`: found \"x " + std::string(38, 'y') +
                "...\", expected a finite number");
}

TEST(FilesInAFolder, OmitUnfinishedOnesOfAKilledProgram) {
  const TestFolder folder;
  const fs::path file = folder.path() / "desk.mcap";
  const AtomicFile unfinished(file);
  folder.write(unfinished.path().filename().string(), std::string("half"));
  EXPECT_THAT(files_in(folder.path()), testing::IsEmpty());
  folder.write("my.partial.mcap", std::string("whole"));
  EXPECT_THAT(files_in(folder.path()), ElementsAre(folder.path() / "my.partial.mcap"));
}

}  // namespace
}  // namespace gpo::test
