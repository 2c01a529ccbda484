// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/files/yaml_entry.h"

#include "tests/engine/test_folder.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace gpo {
namespace {

using test::error_of;
using test::TestFolder;
using testing::AnyOf;
using testing::ElementsAre;
using testing::HasSubstr;

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
