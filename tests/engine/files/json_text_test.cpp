// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/files/json_text.h"

#include "tests/engine/test_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace gpo {
namespace {

using nlohmann::ordered_json;
using test::TestFolder;
using ::testing::HasSubstr;

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

}  // namespace
}  // namespace gpo
