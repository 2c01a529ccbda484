// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/session/recent_files.h"

#include <cstdlib>

#include <gtest/gtest.h>

namespace gpo {
namespace {

TEST(UserFolders, FollowTheirVariablesAndElseTheHome) {
  setenv("HOME", "/home/nobody", 1);
  setenv("XDG_CACHE_HOME", "/somewhere", 1);
  EXPECT_EQ(user_cache_folder(), "/somewhere/gpo-inspector");
  setenv("XDG_CACHE_HOME", "not/absolute", 1);
  EXPECT_EQ(user_cache_folder(), "/home/nobody/.cache/gpo-inspector");
  unsetenv("XDG_STATE_HOME");
  EXPECT_EQ(user_state_folder(), "/home/nobody/.local/state/gpo-inspector");
}

}  // namespace
}  // namespace gpo
