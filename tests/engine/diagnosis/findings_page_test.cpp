// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/diagnosis/diagnosis.h"
#include "engine/files/text_file.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

namespace gpo::test {
namespace {

TEST(FindingsPage, ListsEachCheck) {
  std::vector<std::string> rows, listed;
  for (const Check& check : checks())
    rows.push_back(fmt::format("| `{}` | {} | {} | {} |",
                               check.key,
                               check.title,
                               to_string(check.of),
                               check.may_be_ignored ? "yes" : "no"));
  for (const std::string& line :
       split(read_file(GPO_SOURCE_DIR "/engine/diagnosis/README.md"), '\n'))
    if (line.starts_with("| `")) listed.push_back(line);
  EXPECT_EQ(listed, rows);
}

}  // namespace
}  // namespace gpo::test
