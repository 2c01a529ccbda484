// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/app/program.h"

#include "app/commands/commands.h"
#include "engine/files/text_file.h"
#include "tests/engine/peak_memory.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <regex>

#include <gmock/gmock.h>
#include <opencv2/core/utility.hpp>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#include <wordexp.h>

namespace gpo::test {
namespace {

std::string name_of_test(const char* separator) {
  const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
  std::string name = std::string(info->test_suite_name()) + separator + info->name();
  std::ranges::replace(name, '/', '_');
  return name;
}

}  // namespace

std::string read_file(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::set<std::string> matches_in(const std::string& text, const char* pattern, int group) {
  const std::regex wanted(pattern);
  return {std::sregex_token_iterator(text.begin(), text.end(), wanted, group), {}};
}

void write_file(const fs::path& file, const std::string& content) {
  fs::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary) << content;
}

std::string replaced(std::string text,
                     const std::vector<std::pair<std::string, std::string>>& changes) {
  for (const auto& [from, to] : changes) text.replace(text.find(from), from.size(), to);
  return text;
}

fs::path fresh_folder() {
  fs::path folder = fs::path(GPO_TEST_OUTPUT_DIR) / name_of_test(".");
  fs::remove_all(folder);
  fs::create_directories(folder);
  return folder;
}

Outcome shell(const std::string& command) {
  fs::create_directories(GPO_TEST_OUTPUT_DIR);
  const std::string log = fs::path(GPO_TEST_OUTPUT_DIR) / name_of_test("-");
  const std::string out = log + ".out", err = log + ".err";
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

Outcome spawned(const std::string& arguments) { return shell("'" GPO_PROGRAM "' " + arguments); }

Outcome signaled(const char* signal, const std::string& condition, const std::string& arguments) {
  return shell("'" GPO_PROGRAM
               "' {} & pid=$!; for i in $(seq 4000); do {} && break; sleep 0.005; done; "
               "kill -{} $pid; wait $pid",
               arguments,
               condition,
               signal);
}

Outcome program(const std::string& arguments) {
  wordexp_t words{};
  const std::string line = "gpo-inspector " + arguments;
  if (wordexp(line.c_str(), &words, WRDE_NOCMD | WRDE_UNDEF) != 0) {
    ADD_FAILURE() << "needs a shell, use spawned(): " << arguments;
    return {-1, "", ""};
  }
  unsetenv("DISPLAY");
  unsetenv("WAYLAND_DISPLAY");
  fs::current_path(GPO_SOURCE_DIR);
  const PeakMemory memory;
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  const int exit_code =
      main_with_errors(static_cast<int>(words.we_wordc), words.we_wordv, all_commands());
  std::cout.flush();
  const long peak_kib = memory.kib();
  wordfree(&words);
  cv::setNumThreads(-1);  // `evaluate` limits OpenCV to one
  using testing::internal::GetCapturedStderr, testing::internal::GetCapturedStdout;
  return {exit_code, GetCapturedStdout(), GetCapturedStderr(), peak_kib};
}

Outcome succeeding(const std::string& arguments) {
  Outcome outcome = program(arguments);
  EXPECT_EQ(outcome.exit_code, 0) << arguments << "\n" << outcome.out << outcome.err;
  return outcome;
}

void expect_exit(int code, const Outcome& outcome, const std::string& message) {
  EXPECT_EQ(outcome.exit_code, code) << outcome.out << outcome.err;
  const std::string& error = outcome.err;
  EXPECT_THAT(code == 2 ? error : outcome.out + error, ::testing::HasSubstr(message));
}

json run_json(const std::string& arguments) {
  const Outcome outcome = succeeding("run " + arguments + " --json -");
  return json::accept(outcome.out) ? json::parse(outcome.out) : json();
}

void expect_same_json(const json& a, const json& b, double tolerance, const std::string& where) {
  if (a.is_number_float() && b.is_number()) {
    const double one = a.get<double>();
    EXPECT_NEAR(one, b.get<double>(), tolerance * (1 + std::abs(one))) << where;
    return;
  }
  ASSERT_EQ(a.is_structured(), b.is_structured()) << where;
  if (!a.is_structured()) {
    EXPECT_EQ(a, b) << where;
    return;
  }
  ASSERT_EQ(a.size(), b.size()) << where;
  for (const auto& [key, value] : a.items())
    expect_same_json(
        value, a.is_object() ? b.at(key) : b.at(std::stoul(key)), tolerance, where + "." + key);
}

void expect_refused(const Outcome& outcome, const std::string& message) {
  expect_exit(2, outcome, message);
  EXPECT_EQ(std::ranges::count(outcome.err, '\n'), 1) << outcome.err;
}

void expect_each_refused(const std::string& command, const std::vector<BadInput>& inputs) {
  const fs::path folder = fresh_folder();
  for (const auto& [arguments, message] : inputs) {
    SCOPED_TRACE(arguments);
    expect_refused(program(fmt::format(fmt::runtime(command + arguments), folder)), message);
    EXPECT_TRUE(fs::is_empty(folder));
  }
}

fs::path copy_of_desk(const fs::path& copy, std::initializer_list<const char*> without) {
  fs::create_directories(copy.parent_path());
  fs::copy(desk(), copy, fs::copy_options::recursive);
  for (const char* file : without) fs::remove_all(copy / file);
  return copy;
}

bool all_recordings() { return std::getenv("GPO_ALL_RECORDINGS") != nullptr; }

std::vector<std::string> rendered_recordings() {
  return split(all_recordings()
                   ? "sideways orbit approach diagonal up-down wander fast-arc low-parallax "
                     "rotation-dominant"
                   : "orbit wander rotation-dominant",
               ' ');
}

}  // namespace gpo::test
