// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/look/method_help.h"

#include "engine/initializers/methods.h"

#include <set>

#include <gmock/gmock.h>

namespace gpo {
namespace {

TEST(MethodHelp, SaysOfEachMethodWhatItDoesAndAssumes) {
  std::set<std::string> all;
  for (const Method& method : methods()) {
    const std::string help = method_help(method.key);
    EXPECT_THAT(help, testing::HasSubstr("Assumes")) << method.key;
    EXPECT_TRUE(all.insert(help).second) << method.key;
  }
  EXPECT_THAT(method_help("mine"), testing::HasSubstr("Your own"));
}

}  // namespace
}  // namespace gpo
