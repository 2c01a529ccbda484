// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// A library must not change the process that loads it: the engine may not set global state of other
// libraries, look for the user's folders or depend on the environment.
#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>

namespace gpo {
namespace {

namespace fs = std::filesystem;

/// UMat would use OpenCL if it is enabled, with different results.
constexpr std::array kNotInTheEngine = {"av_log_set_level",
                                        "av_log_set_callback",
                                        "setUseOpenCL",
                                        "setNumThreads",
                                        "setUseOptimized",
                                        "redirectError",
                                        "UMat",
                                        "getenv",
                                        "setenv",
                                        "setlocale",
                                        "std::signal",
                                        "sigaction",
                                        "theRNG",
                                        "srand("};

TEST(Engine, DoesNotChangeTheProcess) {
  int sources = 0;
  for (const auto& entry : fs::recursive_directory_iterator(GPO_SOURCE_DIR "/engine")) {
    const std::string ending = entry.path().extension().string();
    if (ending != ".cpp" && ending != ".h") continue;
    ++sources;
    std::ifstream stream(entry.path());
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    for (const char* name : kNotInTheEngine)
      EXPECT_EQ(text.find(name), std::string::npos) << entry.path() << ": " << name;
  }
  EXPECT_GT(sources, 100);
}

}  // namespace
}  // namespace gpo
