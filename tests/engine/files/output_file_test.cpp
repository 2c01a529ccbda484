// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/files/output_file.h"

#include "tests/engine/test_folder.h"

#include <array>
#include <csignal>
#include <thread>

#include <gmock/gmock.h>
#include <linux/capability.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace gpo::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

std::ptrdiff_t count_in(const fs::path& folder) {
  return std::distance(fs::directory_iterator(folder), {});
}

/// While one exists, files end after some bytes, as on a full disk.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FullDisk() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

 private:
  rlimit before_{};
  void (*handler_)(int);
};

TEST(OutputFile, ReplacesTheFileButNotOnAFullDisk) {
  const TestFolder folder;
  const fs::path file = folder.write("a.txt", std::string("before"));
  write_file(file, "after");
  EXPECT_EQ(folder.read("a.txt"), "after");
  const std::string large(1 << 20, 'x');
  std::string message, message_of_new;
  {
    const FullDisk full(4096);
    message = error_of([&] { write_file(file, large); });
    message_of_new = error_of([&] { write_file(folder.path() / "new.txt", large); });
  }
  EXPECT_EQ(message, file.string() + ": cannot be written: File too large");
  EXPECT_THAT(message_of_new, HasSubstr("new.txt: cannot be written"));
  EXPECT_EQ(folder.read("a.txt"), "after");
  EXPECT_EQ(count_in(folder.path()), 1);
}

TEST(OutputFile, FollowsLinksExceptForALoopAndWritesDirectlyIntoPipes) {
  const TestFolder folder;
  fs::create_directories(folder.path() / "elsewhere");
  fs::create_symlink("elsewhere/a.txt", folder.path() / "link");
  write_file(folder.path() / "link", "content");
  EXPECT_TRUE(fs::is_symlink(folder.path() / "link"));
  EXPECT_EQ(folder.read("elsewhere/a.txt"), "content");
  EXPECT_EQ(count_in(folder.path() / "elsewhere"), 1);
  fs::create_symlink("loop", folder.path() / "loop");
  EXPECT_THAT(error_of([&] { write_file(folder.path() / "loop", "content"); }),
              HasSubstr("loop: cannot be written: Too many levels of symbolic links"));
  EXPECT_EQ(count_in(folder.path()), 3);
  const fs::path pipe = folder.path() / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  std::FILE* reader = popen(("cat '" + pipe.string() + "'").c_str(), "r");
  write_file(pipe, "content\n");
  std::array<char, 100> line{};
  EXPECT_STREQ(std::fgets(line.data(), line.size(), reader), "content\n");
  pclose(reader);
  EXPECT_TRUE(fs::is_fifo(pipe));
}

TEST(OutputFile, RejectsMissingFolders) {
  const TestFolder folder;
  EXPECT_THAT(error_of([&] { check_writable(folder.path() / "no/a.txt"); }),
              HasSubstr("a.txt: cannot be written, there is no folder "));
  EXPECT_THAT(error_of([&] { check_writable(folder.path()); }),
              HasSubstr(": is a folder, expected a file to write"));
  EXPECT_THAT(error_of([&] { make_folder("/proc/a/b"); }),
              HasSubstr("/proc/a/b: cannot be created"));
}

/// Drops the capabilities of this thread, so that root can no longer write everywhere.
void give_up_capabilities() {
  __user_cap_header_struct head{_LINUX_CAPABILITY_VERSION_3, 0};
  std::array<__user_cap_data_struct, _LINUX_CAPABILITY_U32S_3> none{};
  ASSERT_EQ(syscall(SYS_capset, &head, none.data()), 0);
}

TEST(OutputFile, RejectsFolderWithoutPermission) {
  const TestFolder folder;
  fs::permissions(folder.path(), fs::perms::owner_read | fs::perms::owner_exec);
  std::jthread([&] {
    give_up_capabilities();
    EXPECT_THAT(error_of([&] { check_writable(folder.path() / "a.txt"); }),
                HasSubstr("a.txt: cannot be written: Permission denied"));
  }).join();
  fs::permissions(folder.path(), fs::perms::owner_all);
}

TEST(AtomicFile, IsRemovedUnlessFinished) {
  const TestFolder folder;
  const fs::path file = folder.path() / "movie.mp4";
  {
    const AtomicFile unfinished(file);
    EXPECT_EQ(unfinished.path().extension(), ".mp4");
    std::ofstream(unfinished.path()) << "half";
  }
  EXPECT_EQ(count_in(folder.path()), 0);
}

TEST(AtomicFolder, KeepsFoldersThatOthersAreWriting) {
  const TestFolder folder;
  const fs::path output = folder.path() / "desk";
  fs::create_directory(folder.path() / "desk.unfinished");
  folder.write("desk.unfinished/notes.txt", "of the user");
  {
    AtomicFolder first(output);
    std::ofstream(first.path() / "a.txt") << "first";
    const AtomicFolder second(output);
    EXPECT_NE(first.path(), second.path());
    first.finish();
  }
  EXPECT_EQ(folder.read("desk/a.txt"), "first");
  EXPECT_EQ(folder.read("desk.unfinished/notes.txt"), "of the user");
  EXPECT_EQ(count_in(folder.path()), 2);
}

TEST(SameFile, RecognizesOtherPathsOfTheSameFile) {
  const TestFolder folder;
  const fs::path file = folder.path() / "a";  // does not exist yet
  fs::create_symlink("a", folder.path() / "link");
  for (const char* same : {"a", "./a", "b/../a", "link"}) {
    EXPECT_TRUE(same_file(file, folder.path() / same)) << same;
    EXPECT_TRUE(same_file(folder.path() / same, file)) << same;
  }
  EXPECT_TRUE(same_file(file, fs::relative(file)));
  EXPECT_FALSE(same_file(file, folder.path() / "b"));
  folder.write("a", "x");
  fs::create_hard_link(file, folder.path() / "hard");
  EXPECT_TRUE(same_file(file, folder.path() / "hard"));
  EXPECT_FALSE(same_file("/dev/null", "/dev/null"));
}

}  // namespace
}  // namespace gpo::test
