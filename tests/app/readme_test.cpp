// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/files/text_file.h"
#include "tests/app/program.h"

#include <cctype>
#include <iterator>
#include <sstream>

#include <gmock/gmock.h>

namespace gpo::test {
namespace {

std::vector<std::string> readme_commands() {
  std::vector<std::string> commands;
  bool in_block = false;
  for (const std::string& line : split(read_file(GPO_SOURCE_DIR "/README.md"), '\n')) {
    if (in_block && !line.starts_with("```")) commands.push_back(line);
    if (line.starts_with("```")) in_block = line == "```sh";
  }
  return commands;
}

/// A copy of the checkout made of symbolic links, without the user's out/.
fs::path linked_checkout() {
  const fs::path folder = fresh_folder();
  for (const auto& entry : fs::directory_iterator(GPO_SOURCE_DIR)) {
    if (entry.path().filename() != "out")
      fs::create_symlink(entry.path(), folder / entry.path().filename());
  }
  return folder;
}

Outcome shell_in(const fs::path& folder, const std::string& command) {
  return shell("cd '{}' && {}", folder, command);
}

/// Returns whether the line is the heading of an anchor: "## How fast" has the anchor how-fast.
bool is_heading(const std::string& line, const std::string& anchor) {
  if (!line.starts_with("#")) return false;
  std::string name;
  for (const char c : line.substr(line.find_first_not_of('#') + 1)) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0)
      name += static_cast<char>(std::tolower(c));
    if (c == ' ' && !name.empty()) name += '-';
  }
  return name == anchor;
}

TEST(Readme, AllLinksHaveATarget) {
  const fs::path top = GPO_SOURCE_DIR;
  std::vector<fs::path> pages = {"README.md"};
  for (const char* folder : {"app", "assets", "engine", "tests", "ui"})
    for (const auto& entry : fs::recursive_directory_iterator(top / folder))
      if (entry.path().extension() == ".md") pages.push_back(entry.path().lexically_relative(top));
  EXPECT_GE(pages.size(), 19U);
  for (const fs::path& page : pages)
    for (const std::string& link : matches_in(read_file(top / page), R"(\]\(([^)]+)\))", 1)) {
      const fs::path target = (top / page).parent_path() / link.substr(0, link.find('#'));
      EXPECT_TRUE(fs::exists(target)) << page << ": " << link;
      if (link.find('#') == std::string::npos) continue;
      std::istringstream lines(read_file(target));
      bool found = false;
      for (std::string line; std::getline(lines, line);)
        found = found || is_heading(line, link.substr(link.find('#') + 1));
      EXPECT_TRUE(found) << page << ": " << link;
    }
}

TEST(Readme, HasAtMost1500Words) {
  std::istringstream readme(read_file(GPO_SOURCE_DIR "/README.md"));
  const auto words = std::distance(std::istream_iterator<std::string>(readme), {});
  EXPECT_LE(words, 1500);
}

// In order, because some use the output of others. Skips ./test.sh, which runs this test.
TEST(Readme, EveryCommandWorks) {
  const fs::path checkout = linked_checkout();
  const fs::path out = checkout / "out";
  const auto commands = readme_commands();
  EXPECT_GE(commands.size(), 7U);
  for (const std::string& command : commands) {
    if (command == "./test.sh") continue;
    const Outcome outcome = shell_in(checkout, command);
    EXPECT_EQ(outcome.exit_code, 0) << command << "\n" << outcome.out << outcome.err;
  }
  for (const std::string& name :
       split("image.png scene.png window.png desk.json desk.txt desk.ply cube.png "
             "evaluation/results.csv evaluation/errors_by_recording.tex "
             "evaluation/figures/optimization.pdf",
             ' '))
    EXPECT_GT(fs::file_size(out / name), 0U) << name;
  // The recipe reproduces the bundled recording.
  for (const fs::path name :
       {"mav0/cam0/data.csv", "mav0/imu0/data.csv", "mav0/state_groundtruth_estimate0/data.csv"})
    EXPECT_EQ(read_file(out / "desk" / name), read_file(desk() / name)) << name;
}

TEST(Readme, RunScriptWithoutADisplayPrintsTheTable) {
  const Outcome outcome = shell_in(linked_checkout(), "./run.sh");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  for (const char* text : {"status      ok", "image.png, scene.png and window.png are in"})
    EXPECT_THAT(outcome.out, testing::HasSubstr(text));
}

TEST(RunScript, PassesExitCodesOn) {
  EXPECT_EQ(shell("./run.sh run no/such/recording").exit_code, 2);
}

/// Runs install_packages as a user without root and without the packages.
Outcome install_without_rights(const std::string& sudo) {
  const fs::path tools = fresh_folder();
  const auto tool = [&](const std::string& name, const std::string& body) {
    write_file(tools / name, "#!/bin/sh\n" + body + "\n");
    fs::permissions(tools / name, fs::perms::owner_all);
  };
  tool("dpkg-query", "exit 1");
  tool("id", "echo 1000");
  tool("apt-get", "echo \"$@\" >> " + (tools / "log").string());
  tool("sudo", sudo);
  const Outcome outcome =
      shell("PATH={}:$PATH bash -c 'source .ci/install.sh; install_packages one two'", tools);
  return {outcome.exit_code, read_file(tools / "log"), outcome.err};
}

TEST(Install, WithoutRootPrintsTheCommandAndExitsTwo) {
  const Outcome outcome = install_without_rights("exit 1");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_EQ(outcome.out, "");  // no attempt to install
  EXPECT_EQ(outcome.err,
            "missing packages; type: sudo apt-get install -y --no-install-recommends one two\n");
}

TEST(Install, WithSudoInstallsMissingPackages) {
  const Outcome outcome = install_without_rights(R"([ "$1" = -v ] || exec "$@")");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.out, "update\ninstall -y --no-install-recommends one two\n");
}

fs::path page(const std::string& name) {
  fs::path file = fresh_folder() / name;
  write_file(file, succeeding("pages {}", name).out);
  return file;
}

std::set<std::string> options_in(const std::string& text) {
  return matches_in(text, "--[a-z][a-z-]+");
}

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
  for (const char* command : {"view",
                              "info",
                              "run",
                              "snapshot",
                              "report",
                              "evaluate",
                              "calibrate",
                              "convert",
                              "record",
                              "synthesize"}) {
    const auto options = options_in(succeeding("{} --help", command).out);
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
