// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/error.h"
#include "engine/base/report_timer.h"
#include "engine/files/text_file.h"

#include <filesystem>
#include <new>
#include <string>

#include <gtest/gtest.h>

namespace gpo {
namespace {

namespace fs = std::filesystem;

TEST(Legible, KeepsPrintableText) {
  EXPECT_EQ(legible("12.5 m/s, \u00e9 \u2013 \u65e5\u672c \U0001F600", 100),
            "12.5 m/s, \u00e9 \u2013 \u65e5\u672c \U0001F600");
}

TEST(Legible, EscapesControlsAndInvalidUtf8) {
  EXPECT_EQ(legible(std::string_view("a\nb\r\tc\0d\x1B[31m\x7F", 14), 100),
            "a\\nb\\r\\tc\\x00d\\x1B[31m\\x7F");
  EXPECT_EQ(legible("\xFF\xC0\x80\xED\xA0\x80", 100), "\\xFF\\xC0\\x80\\xED\\xA0\\x80");
  EXPECT_EQ(legible("\xC2\x9B", 100), "\\xC2\\x9B");  // a control of eight bits
  EXPECT_EQ(legible("\xE2\x82", 100), "\\xE2\\x82");  // truncated
  EXPECT_EQ(legible("\xF4\x90\x80\x80", 100), "\\xF4\\x90\\x80\\x80");
}

TEST(Legible, CutsBetweenCharacters) {
  EXPECT_EQ(legible("abcdef", 6), "abcdef");
  EXPECT_EQ(legible("abcdef", 5), "abcde...");
  EXPECT_EQ(legible("abc\u00e9", 4), "abc...");
  EXPECT_EQ(legible("abc\n", 4), "abc...");
}

TEST(InputErrors, AreOneShortLine) {
  const InputError error("a\nb" + std::string(1 << 20, 'x') + ", expected y");
  const std::string message = error.what();
  EXPECT_LE(message.size(), 1000U);
  EXPECT_TRUE(message.starts_with("a\\nbxxx")) << message;
  EXPECT_TRUE(message.ends_with("xxx, expected y")) << message;
  EXPECT_STREQ(InputError(error.what()).what(), error.what());  // idempotent
}

TEST(Messages, NameTheFileOfASystemError) {
  const fs::filesystem_error refused(
      "status", "/some/file", std::make_error_code(std::errc::too_many_symbolic_link_levels));
  EXPECT_EQ(message_of(refused), "/some/file: Too many levels of symbolic links");
  EXPECT_EQ(message_of(InputError("camera.yaml: is empty")), "camera.yaml: is empty");
  EXPECT_EQ(message_of(std::bad_alloc()), "not enough memory");
  EXPECT_EQ(message_of(std::logic_error("a\nbug")), "internal error, please report it: a\\nbug");
}

TEST(ReportTimer, IsDueEveryTenSeconds) {
  const ReportTimer::Clock::time_point begin{};
  ReportTimer timer(begin);
  for (const auto& [seconds, due] :
       {std::pair(0, false), {9, false}, {10, true}, {19, false}, {45, true}, {54, false}})
    EXPECT_EQ(timer.due(begin + std::chrono::seconds(seconds)), due) << seconds;
}

// A library must not change the process that loads it: the engine may not set global state of other
// libraries, look for the user's folders or depend on the environment.
/// UMat would use OpenCL if it is enabled, with different results.
constexpr const char* kNotInTheEngine =
    "av_log_set_level,av_log_set_callback,setUseOpenCL,setNumThreads,setUseOptimized,redirectError,"
    "UMat,getenv,setenv,setlocale,std::signal,sigaction,theRNG,srand(";

TEST(Engine, DoesNotChangeTheProcess) {
  int sources = 0;
  for (const auto& entry : fs::recursive_directory_iterator(GPO_SOURCE_DIR "/engine")) {
    const std::string ending = entry.path().extension().string();
    if (ending != ".cpp" && ending != ".h") continue;
    ++sources;
    const std::string text = read_file(entry.path());
    for (const std::string& name : split(kNotInTheEngine, ','))
      EXPECT_EQ(text.find(name), std::string::npos) << entry.path() << ": " << name;
  }
  EXPECT_GT(sources, 100);
}

}  // namespace
}  // namespace gpo
