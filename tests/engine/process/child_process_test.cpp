// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/process/child_process.h"

#include <csignal>
#include <fstream>
#include <thread>

#include <gmock/gmock.h>

namespace gpo {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kEnough{20'000};

ProcessReply ask(ChildProcess& process,
                 const std::string& question = "question\n",
                 milliseconds time = kEnough) {
  return process.ask(question, {.time = time});
}

TEST(ChildProcess, AnswersLineByLine) {
  ChildProcess process("while read a; do echo \"<$a>\"; done");
  for (const std::string text : {"one", "two"}) {
    const ProcessReply reply = ask(process, text + "\n");
    EXPECT_EQ(reply.reply, Reply::answered);
    EXPECT_EQ(reply.answer, "<" + text + ">");
    EXPECT_TRUE(process.is_in_step());
  }
  EXPECT_EQ(process.end(), "closed its standard output") << "it was alive";
}

// Neither end may block: question and answer are larger than any pipe.
TEST(ChildProcess, TransfersMoreThanAPipeHolds) {
  ChildProcess process("cat");
  const std::string question = std::string(3'000'000, 'x') + "\n";
  const ProcessReply reply = ask(process, question);
  EXPECT_EQ(reply.reply, Reply::answered);
  EXPECT_EQ(reply.answer + "\n", question);
}

TEST(ChildProcess, ReportsHowItEnded) {
  for (const auto& [command, how] :
       {std::pair{"exit 3", "ended with exit code 3"},
        std::pair{"read a; printf half; kill -9 $$", "was killed by signal 9 (Killed)"},
        std::pair{"read a; printf half; sh -c 'kill -9 $$'; exit $?",
                  "was killed by signal 9 (Killed)"},
        std::pair{"exit 255", "ended with exit code 255"},
        std::pair{"exec >&-; sleep 60", "closed its standard output"}}) {
    ChildProcess process(command);
    const ProcessReply reply = ask(process);
    EXPECT_EQ(reply.reply, Reply::ended) << command;
    EXPECT_EQ(reply.answer, how == std::string("was killed by signal 9 (Killed)") ? "half" : "");
    EXPECT_FALSE(process.is_in_step()) << command;
    EXPECT_EQ(process.end(), how);
  }
}

TEST(ChildProcess, KillsLateProcessWithItsChildren) {
  pid_t grandchild = 0;
  {
    ChildProcess process("sleep 1000 & echo $!; wait");
    grandchild = std::stoi(ask(process, "").answer);
    ASSERT_EQ(kill(grandchild, 0), 0);
    EXPECT_EQ(ask(process, "question\n", milliseconds(100)).reply, Reply::late);
  }
  // Another process may have to reap it first.
  bool gone = false;
  for (int i = 0; i < 500 && !gone; ++i) {
    std::this_thread::sleep_for(milliseconds(10));
    std::ifstream file("/proc/" + std::to_string(grandchild) + "/stat");
    std::string pid, name, state;
    gone = !(file >> pid >> name >> state) || state == "Z";
  }
  EXPECT_TRUE(gone);
}

TEST(ChildProcess, LimitsEndlessAnswerAndStandardError) {
  ChildProcess process("yes | tr -d '\\n'");
  const ProcessReply reply = ask(process);
  EXPECT_EQ(reply.reply, Reply::too_long);
  EXPECT_LT(reply.answer.size(), ReplyLimits{}.answer_bytes + 100'000);
  ChildProcess complaining("read a; yes complaint | head -c 50000000 >&2; echo done");
  const ProcessReply complaint = ask(complaining);
  EXPECT_EQ(complaint.answer, "done");
  EXPECT_EQ(complaint.error_output.size(), ReplyLimits{}.error_bytes);
  EXPECT_THAT(complaint.error_output, testing::StartsWith("complaint\ncomplaint\n"));
}

TEST(ChildProcess, StopsOnRequest) {
  ChildProcess process("sleep 1000");
  std::stop_source stop;
  std::jthread stopper([&] {
    std::this_thread::sleep_for(milliseconds(50));
    stop.request_stop();
  });
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_EQ(process.ask("question\n", {.time = kEnough}, stop.get_token()).reply, Reply::stopped);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, kEnough / 2);
}

// A write to it raises SIGPIPE, which would end the test program.
TEST(ChildProcess, SurvivesClosedStandardInputAndIsOutOfStepAfterUnrequestedOutput) {
  ChildProcess process("exec <&-; sleep 0.2; echo answered anyway");
  const ProcessReply reply = ask(process, std::string(500'000, 'x') + "\n");
  EXPECT_EQ(reply.reply, Reply::answered);
  EXPECT_EQ(reply.answer, "answered anyway");
  EXPECT_FALSE(process.is_in_step()) << "the answer belongs to no question";
  ChildProcess twice("while read a; do echo first; echo second; done");
  EXPECT_EQ(ask(twice).answer, "first");
  std::this_thread::sleep_for(milliseconds(200));
  EXPECT_FALSE(twice.is_in_step());
}

}  // namespace
}  // namespace gpo
