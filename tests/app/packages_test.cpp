// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// Unpacks the Debian packages of this build and uses them. tests/packages.sh installs them.
#include "engine/version.h"
#include "tests/app/program.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

namespace gpo::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

fs::path folder() { return fs::path(GPO_TEST_OUTPUT_DIR) / "packages"; }
fs::path root() { return folder() / "root"; }

fs::path deb(const std::string& name) {
  const std::string architecture = shell("dpkg --print-architecture").out;
  return folder() / "debs" /
         fmt::format("{}_{}.{}.{}_{}.deb",
                     name,
                     GPO_VERSION_MAJOR,
                     GPO_VERSION_MINOR,
                     GPO_VERSION_PATCH,
                     architecture.substr(0, architecture.find('\n')));
}

std::string field(const std::string& name, const std::string& field) {
  return shell("dpkg-deb -f {} {}", deb(name), field).out;
}

void make_and_unpack() {
  fs::remove_all(folder());
  const Outcome made =
      shell("mkdir -p {0}/debs && cd {0}/debs && cpack --config {1}/CPackConfig.cmake -B .",
            folder(),
            GPO_BINARY_DIR);
  ASSERT_EQ(made.exit_code, 0) << made.out << made.err;
  for (const char* name : {"gpo-inspector", "libgpo-dev", "python3-gpo"}) {
    const Outcome unpacked = shell("dpkg-deb -x {} {}", deb(name), root());
    ASSERT_EQ(unpacked.exit_code, 0) << unpacked.err;
  }
}

void expect_program() {
  const Outcome drawn = shell(
      "{0}/usr/bin/gpo-inspector snapshot {0}/usr/share/gpo-inspector/sequences/desk --view image "
      "--frames 10 --output {1}/image.png",
      root(),
      folder());
  EXPECT_EQ(drawn.exit_code, 0) << drawn.err;
  EXPECT_TRUE(fs::exists(folder() / "image.png"));
  EXPECT_THAT(field("gpo-inspector", "Depends"),
              AllOf(HasSubstr("libvtk9"), HasSubstr("libopencv-core"), Not(HasSubstr("-dev"))));
}

void expect_desktop_files() {
  for (const char* file : {"applications/gpo-inspector.desktop",
                           "icons/hicolor/scalable/apps/gpo-inspector.svg",
                           "mime/packages/gpo-inspector.xml",
                           "man/man1/gpo-inspector.1.gz",
                           "bash-completion/completions/gpo-inspector",
                           "zsh/vendor-completions/_gpo-inspector"})
    EXPECT_TRUE(fs::exists(root() / "usr/share" / file)) << file;
}

void expect_library() {
  EXPECT_TRUE(fs::exists(root() / "usr/include/gpo/initialize.h"));
  EXPECT_TRUE(fs::exists(root() / "usr/share/doc/libgpo-dev/examples/tracks_to_pose.cpp"));
  const std::string depends = field("libgpo-dev", "Depends");
  for (const char* needed : {"libeigen3-dev", "libceres-dev", "libopencv-dev", "libopengv-dev"})
    EXPECT_THAT(depends, HasSubstr(needed));
}

void expect_python_module() {
  const fs::path module = root() / "usr/lib/python3/dist-packages";
  const Outcome imported = shell(
      "cd / && PYTHONPATH={} PYTHONDONTWRITEBYTECODE=1 /usr/bin/python3 -c 'import gpo; "
      "print(gpo.__file__, gpo.run(\"{}\", frames=10).ok)'",
      module,
      root() / "usr/share/gpo-inspector/sequences/desk");
  EXPECT_EQ(imported.out, fmt::format("{} True\n", module / "gpo/__init__.py")) << imported.err;
  EXPECT_THAT(field("python3-gpo", "Depends"),
              AllOf(HasSubstr("python3 (>= 3."), HasSubstr("python3 (<< 3.")));
}

TEST(Packages, WorkAfterUnpacking) {
  make_and_unpack();
  if (HasFatalFailure()) return;
  expect_program();
  expect_desktop_files();
  expect_library();
  expect_python_module();
  fs::remove_all(folder());
}

}  // namespace
}  // namespace gpo::test
