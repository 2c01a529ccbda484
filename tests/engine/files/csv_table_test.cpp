// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/files/csv_table.h"

#include "engine/files/text_file.h"
#include "tests/engine/test_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace gpo {
namespace {

using test::error_of;
using test::TestFolder;
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::StartsWith;

const std::vector<std::string> kGyro = {"timestamp", "wx", "wy", "wz"};

std::vector<std::int64_t> times_of(const TestFolder& folder,
                                   const std::string& content,
                                   TimeUnit unit = TimeUnit::by_frame_rate) {
  return csv_time_stamps(
      read_csv(folder.write("t.txt", content), {"timestamp"}, CsvColumns::exactly), unit);
}

TEST(ParseDecimal, IsExactToTheNanosecond) {
  EXPECT_EQ(parse_decimal("1403636579.763555584", 9), 1403636579763555584);
  EXPECT_EQ(parse_decimal("1403636579763555584", 0), 1403636579763555584);
  EXPECT_EQ(parse_decimal("1.403636579763555584e+18", 0), 1403636579763555584);
  EXPECT_EQ(parse_decimal("-0.0000000015", 9), -2);
  EXPECT_EQ(parse_decimal("+.5", 9), 500000000);
  EXPECT_EQ(parse_decimal("0", 9), 0);
  EXPECT_EQ(parse_decimal("0e0", 9), 0);
  EXPECT_EQ(parse_decimal("1e-30", 9), 0);
  EXPECT_EQ(parse_decimal("007", 0), 7);
}

TEST(ParseDecimal, RejectsOtherText) {
  for (const char* text :
       {"", ".", "-", "nan", "inf", "1.2.3", "12a", "1e", "1e99", "9e18", "0x1"}) {
    EXPECT_EQ(parse_decimal(text, 9), std::nullopt) << text;
  }
}

TEST(ParseNumber, RejectsInfinityAndOtherText) {
  EXPECT_EQ(parse_number("+1.5e-3"), 1.5e-3);
  for (const char* text : {"", "nan", "inf", "-inf", "1e999", "1,5", "1.5 ", "+-1"}) {
    EXPECT_EQ(parse_number(text), std::nullopt) << text;
  }
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

TEST(CsvTable, ReadsTheUnitOfTimeFromTheHeader) {
  const TestFolder folder;
  for (const char* name : {"timestamp [ns]", "timestamp_ns", "#timestamp(ns)", "# t [ns]"}) {
    EXPECT_THAT(times_of(folder, std::string(name) + "\n5\n7\n"), ElementsAre(5, 7)) << name;
  }
  for (const char* name : {"timestamp [s]", "timestamp_s", "# time_s"}) {
    EXPECT_THAT(times_of(folder, std::string(name) + "\n0.5\n7\n"),
                ElementsAre(500000000, 7000000000))
        << name;
  }
  for (const char* name : {"timestamp [ms]", "time_ms", "# Time[millisec]"}) {
    EXPECT_THAT(times_of(folder, std::string(name) + "\n0.5\n7\n"), ElementsAre(500000, 7000000))
        << name;
  }
  EXPECT_THAT(times_of(folder, "t_us\n1\n2\n"), ElementsAre(1000, 2000));
}

TEST(CsvTable, DerivesTheUnitOfTimeFromTheRate) {
  const TestFolder folder;
  EXPECT_THAT(times_of(folder, "1403636579763555584\n1403636579763555585\n"),
              ElementsAre(1403636579763555584, 1403636579763555585));
  EXPECT_THAT(times_of(folder, "timestamp\n1\n2\n"), ElementsAre(1000000000, 2000000000));
  EXPECT_THAT(times_of(folder, "# my camera\n1403636579.5\n"), ElementsAre(1403636579500000000));
  EXPECT_THAT(times_of(folder, "0\n33333333\n", TimeUnit::nanoseconds), ElementsAre(0, 33333333));
  // A phone 28 minutes after its start, 30 Hz, in every unit.
  EXPECT_THAT(times_of(folder, "1700.1\n1700.133\n"), ElementsAre(1700100000000, 1700133000000));
  EXPECT_THAT(times_of(folder, "1700100\n1700133\n"), ElementsAre(1700100000000, 1700133000000));
  EXPECT_THAT(times_of(folder, "1700100000\n1700133000\n"),
              ElementsAre(1700100000000, 1700133000000));
  EXPECT_THAT(times_of(folder, "1700100000000\n1700133000000\n"),
              ElementsAre(1700100000000, 1700133000000));
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

TEST(CsvTable, ReportsTheLineOfANonAscendingTime) {
  const TestFolder folder;
  EXPECT_THAT(error_of([&] { times_of(folder, "timestamp_s\n1\n3\n2\n"); }),
              EndsWith("t.txt:4: found time stamp 2, earlier than the one before it, expected "
                       "ascending time stamps"));
  EXPECT_THAT(error_of([&] { times_of(folder, "1\n1\n"); }),
              HasSubstr("t.txt:2: found time stamp 1, equal to"));
  EXPECT_THAT(error_of([&] { times_of(folder, "1\nx\n"); }),
              EndsWith("t.txt:2: found \"x\", expected a time stamp"));
}

struct BadTable {
  const char* content;
  const char* message;
};
class CsvTableErrors : public testing::TestWithParam<BadTable> {};

TEST_P(CsvTableErrors, NameFileAndLine) {
  const TestFolder folder;
  const auto file = folder.write("gyro.csv", GetParam().content);
  const auto read = [&] {
    const CsvTable table = read_csv(file, kGyro, CsvColumns::exactly);
    csv_time_stamps(table, TimeUnit::by_sample_rate);
    for (const auto& row : table.rows) {
      for (int i = 1; i < 4; ++i) csv_number(table, row, i);
    }
  };
  EXPECT_EQ(error_of(read), file.string() + GetParam().message);
}

INSTANTIATE_TEST_SUITE_P(
    All,
    CsvTableErrors,
    testing::Values(
        BadTable{"", ": found no rows, expected timestamp,wx,wy,wz"},
        BadTable{"timestamp,wx,wy,wz\n", ": found no rows, expected timestamp,wx,wy,wz"},
        BadTable{"timestamp,wx,wy,wz\n1,2,3\n",
                 ":2: found 3 columns, expected 4 (timestamp,wx,wy,wz)"},
        BadTable{"1,2,3,4\n2,2,3,4,5\n", ":2: found 5 columns, expected 4 (timestamp,wx,wy,wz)"},
        BadTable{"1,2,3,4\n2,2,3",
                 ":2: found 3 columns (the file seems truncated), expected 4 (timestamp,wx,wy,wz)"},
        BadTable{"timestamp,wx,wz,wy\n1,2,3,4\n",
                 ":1: found column 3 named \"wz\", expected \"wy\" (columns timestamp,wx,wy,wz)"},
        BadTable{"#timestamp,ax,ay,az\n1,2,3,4\n",
                 ":1: found column 2 named \"ax\", expected \"wx\" (columns timestamp,wx,wy,wz)"},
        BadTable{"timestamp,wx,wy,wz,t\n1,2,3,4\n",
                 ":1: found 5 names of columns, expected 4 as in the rows"},
        BadTable{"1,2,3,4\n2,nan,3,4\n", ":2: found \"nan\", expected a finite number"},
        BadTable{"1,2,3,4\n2,3,-inf,4\n", ":2: found \"-inf\", expected a finite number"},
        BadTable{"1,2,3,4\n2,3,,4\n", ":2: found \"\", expected a finite number"},
        BadTable{"1,2,3,4\nnan,3,3,4\n", ":2: found \"nan\", expected a time stamp"}));

TEST(CsvTable, ReportsMissingFile) {
  EXPECT_THAT(error_of([] { read_csv("nowhere/gyro.csv", kGyro, CsvColumns::exactly); }),
              StartsWith("nowhere/gyro.csv: no such file"));
}

}  // namespace
}  // namespace gpo
