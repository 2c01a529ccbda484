// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// Manual page and shell completions.
#include "tests/app/program.h"

#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>

namespace gpo::test {
namespace {

fs::path page(const std::string& name) {
  fs::path file = fresh_folder() / name;
  write_file(file, succeeding("pages {}", name).out);
  return file;
}

std::set<std::string> options_in(const std::string& text) {
  return matches_in(text, "--[a-z][a-z-]+");
}

/// Completions that bash offers for the last word.
std::set<std::string> offered_by_bash(const std::string& words) {
  const fs::path script = page("bash");
  const Outcome outcome = shell(
      "bash -c 'source {}; COMP_WORDS=({}); COMP_CWORD=$((${{#COMP_WORDS[@]}} - 1)); "
      "_gpo_inspector; printf \"%s\\n\" \"${{COMPREPLY[@]}}\"'",
      script,
      words);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  return matches_in(outcome.out, "[^\n]+");
}

TEST(Pages, ManualNamesEveryOptionOfEveryCommand) {
  const fs::path file = page("man");
  const Outcome rendered = shell("groff -man -Tutf8 -ww {} | col -bx", file);
  EXPECT_EQ(rendered.err, "");
  const auto documented = options_in(rendered.out);
  for (const char* command :
       {"view", "info", "run", "snapshot", "evaluate", "calibrate", "convert", "synthesize"}) {
    const auto options = options_in(program("{} --help", command).out);
    EXPECT_THAT(options, testing::SizeIs(testing::Ge(2))) << command;
    for (const std::string& option : options)
      EXPECT_THAT(documented, testing::Contains(option)) << command;
  }
}

TEST(Pages, BashCompletesCommandsOptionsKeysAndFiles) {
  using testing::Contains, testing::ElementsAre;
  EXPECT_THAT(offered_by_bash("gpo-inspector sn"), ElementsAre("snapshot"));
  EXPECT_THAT(offered_by_bash("gpo-inspector run --method"),
              ElementsAre("--method", "--method-command", "--method-resample", "--method-timeout"));
  EXPECT_THAT(offered_by_bash("gpo-inspector run --method pn"), ElementsAre("pnp", "pnp_ba"));
  EXPECT_THAT(offered_by_bash("gpo-inspector snapshot desk --view sc"), ElementsAre("scene"));
  EXPECT_THAT(offered_by_bash("gpo-inspector run sequences/des"), Contains("sequences/desk.yaml"));
}

TEST(Pages, ZshReadsItsCompletion) {
  if (shell("zsh --version").exit_code != 0) GTEST_SKIP() << "there is no zsh";
  const Outcome outcome = shell("zsh -n {}", page("zsh"));
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
}

}  // namespace
}  // namespace gpo::test
