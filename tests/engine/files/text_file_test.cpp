// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/files/text_file.h"

#include "engine/files/byte_cursor.h"
#include "engine/files/json_text.h"
#include "engine/files/yaml_entry.h"
#include "tests/engine/test_folder.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/stat.h>

namespace gpo {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;
using test::error_of;
using test::TestFolder;
using testing::AnyOf;
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;

std::string error_at(const fs::path& file) {
  return error_of([&] { read_file(file); });
}

TEST(TextFile, ReadsAllBytes) {
  const TestFolder folder;
  std::string content;
  for (int i = 0; i < 300'000; ++i) content += static_cast<char>(i % 251);
  EXPECT_EQ(read_file(folder.write("a", content)), content);
  EXPECT_EQ(read_file(folder.write("empty", std::string())), "");
}

TEST(TextFile, RejectsFileAboveTheLimit) {
  const TestFolder folder;
  const fs::path file = folder.write("a", std::string((1 << 20) + 1, 'x'));
  EXPECT_EQ(read_file(file, (1 << 20) + 1).size(), (1U << 20) + 1);
  EXPECT_THAT(error_of([&] { read_file(file, kMaxBytesByHand); }),
              EndsWith("a: found more than 1 MiB, expected a smaller file"));
}

TEST(TextFile, RejectsFoldersPipesAndDevices) {
  const TestFolder folder;
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

TEST(TextFile, DifferencesOfDecimalsFitIntoAnInteger) {
  const auto most = parse_decimal("4611686018427387902", 0);
  ASSERT_TRUE(most);
  EXPECT_FALSE(parse_decimal("4611686018427387903", 0));
  EXPECT_FALSE(parse_decimal("-4611686018427387903", 0));
}

TEST(ParseSize, AcceptsOnlyTwoIntegers) {
  EXPECT_EQ(parse_size("640x480"), std::pair(640, 480));
  EXPECT_EQ(parse_size("-1x0"), std::pair(-1, 0));
  // The last two are 640x480 in the lowest 32 bits.
  for (const char* text : {"",
                           "x",
                           "640",
                           "640x",
                           "x480",
                           "640x480x",
                           "640x480 ",
                           "640X480",
                           "6.4x4",
                           "4294967936x480",
                           "640x4294967776"}) {
    EXPECT_EQ(parse_size(text), std::nullopt) << text;
  }
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

TEST(JsonText, SurvivesReading) {
  const TestFolder folder;
  const ordered_json json = {{"b", {1, 2.5, nullptr}}, {"a", "\u00e9\n"}};
  EXPECT_EQ(read_json(folder.write("a.json", json_text(json, 2))), json);
}

TEST(JsonText, WritesNamesThatAreNotUtf8) {
  EXPECT_EQ(json_text(ordered_json("caf\xE9"), 0), "\"caf\xEF\xBF\xBD\"\n");
}

TEST(JsonText, DiscardsTruncatedAndDeepJson) {
  const TestFolder folder;
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

TEST(Yaml, ExpandsAliases) {
  const TestFolder folder;
  const auto root = load_yaml(folder.write("a.yaml", std::string("a: &a [1, 2]\nb: [*a, *a]\n")));
  EXPECT_THAT(numbers(at(root, "b", "")), ElementsAre(1, 2, 1, 2));
}

TEST(Yaml, RejectsEndlessAliases) {
  EXPECT_THAT(error_in("a: &a [1, *a]\n"),
              HasSubstr("a.yaml:1: found lists or maps without end, expected at most 64"));
  std::string doubling = "a0: &a0 [1, 1]\n";
  for (int i = 1; i < 40; ++i) doubling += fmt::format("a{0}: &a{0} [*a{1}, *a{1}]\n", i, i - 1);
  EXPECT_THAT(error_in(doubling), HasSubstr("a.yaml:1: found too many values"));
}

TEST(Yaml, RejectsDeepHugeAndBinaryFiles) {
  EXPECT_THAT(error_in(fmt::format("a: {:[>65}{:]>65}", "", "")),
              HasSubstr("lists or maps without end"));
  EXPECT_THAT(error_in(std::string(100'000, '[')), HasSubstr("expected YAML"));
  EXPECT_THAT(error_in(std::string(2 << 20, ' ')), HasSubstr("found more than 1 MiB"));
  EXPECT_THAT(error_in(std::string("\x7F"
                                   "ELF\0\1\xFF",
                                   7)),
              AnyOf(HasSubstr("expected YAML"), HasSubstr("no error")));
}

TEST(Yaml, QuotesFoundTextShortAndLegible) {
  const TestFolder folder;
  const auto file = folder.write("a.yaml", fmt::format("a: \"x\n{:y>100}\"\n", ""));
  const auto root = load_yaml(file);
  EXPECT_EQ(error_of([&] { number(at(root, "a", "")); }),
            file.string() + ":1: key `a`: found \"x " + std::string(38, 'y') +
                "...\", expected a finite number");
}

}  // namespace
}  // namespace gpo
