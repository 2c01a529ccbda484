// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/experiment/experiment.h"
#include "tests/engine/test_folder.h"

#include <gmock/gmock.h>

namespace gpo {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::vector<int> numbers(const std::string& text, int end = 47) {
  return numbers_in(parse_ranges(text, "starts"), end);
}

TEST(Ranges, IncludeBothEnds) {
  EXPECT_THAT(numbers("5:20:5"), ElementsAre(5, 10, 15, 20));
  EXPECT_THAT(numbers("5:19:5"), ElementsAre(5, 10, 15));
  EXPECT_THAT(numbers("3:5"), ElementsAre(3, 4, 5));
  EXPECT_THAT(numbers("7"), ElementsAre(7));
  EXPECT_THAT(numbers("30,10:20:10,20"), ElementsAre(10, 20, 30));
}

TEST(Ranges, EndIsKnownOnceThereIsARecording) {
  EXPECT_THAT(numbers("0:end:20"), ElementsAre(0, 20, 40));
  EXPECT_THAT(numbers("0:end:20", 40), ElementsAre(0, 20, 40));
  EXPECT_THAT(numbers("5:end:5", 4), ElementsAre());
}

TEST(Ranges, NameTheOptionAndWhatWasFound) {
  for (const char* text : {"a",
                           "5:x:5",
                           "5:60:0",
                           "5:60:-5",
                           "60:5:5",
                           "1:2:3:4",
                           "5:",
                           "-1:3",
                           "1.5",
                           "5,,6",
                           "end",
                           "1:9999999"}) {
    const std::string error = test::error_of([&] { parse_ranges(text, "lengths"); });
    EXPECT_THAT(error, HasSubstr(std::string("lengths: '") + text + "'")) << text;
  }
  EXPECT_THAT(test::error_of([] { parse_ranges("", "lengths"); }), HasSubstr("lengths"));
}

}  // namespace
}  // namespace gpo
