// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/app/program.h"

#include <algorithm>
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace gpo::test {

namespace fs = std::filesystem;

std::string read_file(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream content;
  content << stream.rdbuf();
  return content.str();
}

void write_file(const fs::path& file, const std::string& content) {
  fs::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary) << content;
}

fs::path fresh_folder() {
  const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
  std::string name = std::string(info->test_suite_name()) + "." + info->name();
  std::ranges::replace(name, '/', '_');
  fs::path folder = fs::path(GPO_TEST_OUTPUT_DIR) / name;
  fs::remove_all(folder);
  fs::create_directories(folder);
  return folder;
}

Outcome shell(const std::string& command) {
  const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
  const fs::path log =
      fs::path(GPO_TEST_OUTPUT_DIR) / (std::string(info->test_suite_name()) + "-" + info->name());
  fs::create_directories(log.parent_path());
  const std::string out = log.string() + ".out";
  const std::string err = log.string() + ".err";
  const std::string line = "cd '" GPO_SOURCE_DIR "' && unset DISPLAY WAYLAND_DISPLAY && { " +
                           command + " ; } > '" + out + "' 2> '" + err + "' < /dev/null";
  const pid_t child = fork();
  if (child == 0) {
    execl("/bin/sh", "sh", "-c", line.c_str(), nullptr);
    _exit(127);
  }
  int status = 0;
  rusage used{};
  wait4(child, &status, 0, &used);
  return {
      WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_file(out), read_file(err), used.ru_maxrss};
}

Outcome program(const std::string& arguments) { return shell("'" GPO_PROGRAM "' " + arguments); }

std::ostream& operator<<(std::ostream& stream, const BadInput& bad) {
  return stream << bad.arguments;
}

void expect_refused(const Outcome& outcome, const BadInput& bad, const fs::path& folder) {
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, ::testing::HasSubstr(bad.message));
  EXPECT_EQ(std::ranges::count(outcome.err, '\n'), 1) << outcome.err;
  EXPECT_TRUE(fs::is_empty(folder));
}

fs::path desk() { return fs::path(GPO_SOURCE_DIR) / "sequences/desk"; }

}  // namespace gpo::test
