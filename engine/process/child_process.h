// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstddef>
#include <stop_token>
#include <string>
#include <string_view>
#include <utility>

#include <sys/types.h>
#include <unistd.h>

namespace gpo {

/// A file descriptor that is closed at the end.
class Descriptor {
 public:
  Descriptor() = default;
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() { close(); }
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }

  int number() const { return number_; }  ///< -1: closed
  bool is_open() const { return number_ >= 0; }
  void close() {
    if (is_open()) ::close(std::exchange(number_, -1));
  }

 private:
  int number_ = -1;
};

/// How a question to a process ended.
enum class Reply {
  answered,  ///< with a line
  ended,     ///< it closed its standard output first
  late,      ///< the time limit passed
  too_long,  ///< the line does not end within its limit
  stopped    ///< whoever asked does not want to know any more
};

struct ReplyLimits {
  std::chrono::milliseconds time{30'000};
  std::size_t answer_bytes = std::size_t{8} << 20;
  std::size_t said_bytes = std::size_t{16} << 10;  ///< of standard error; what is beyond is dropped
};

struct ProcessReply {
  Reply reply = Reply::ended;
  std::string answer;  ///< without the line end; of `ended`: what came of it
  std::string said;    ///< on standard error meanwhile
};

/// A command of the shell, in a process group of its own, which is asked by a line on its standard
/// input and answers by one on its standard output. Whatever it does, memory is bounded by the
/// limits. Not to be asked by two threads at once; several in parallel do not disturb each other.
class ChildProcess {
 public:
  /// Throws std::system_error where the system refuses.
  explicit ChildProcess(const std::string& command);
  /// Kills the group.
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// `question` with its line end. After any reply but `answered` it is of no more use.
  ProcessReply ask(std::string_view question,
                   const ReplyLimits& limits,
                   const std::stop_token& stop = {});

  /// Whether it lives and has said nothing that it was not asked for: else the next line that it
  /// writes might be the answer to an earlier question.
  bool is_in_step() const;

  /// Kills the group; how the process had ended before, for people: "ended with exit code 1", "was
  /// killed by signal 9 (Killed)", "closed its standard output" where it lives.
  std::string end();

 private:
  bool write_some(std::string_view& question);
  bool read_answer(ProcessReply& reply, const ReplyLimits& limits);
  void read_said(ProcessReply& reply, std::size_t most_bytes);

  pid_t pid_ = -1;             ///< and the group's; -1: ended, and nothing is left of it
  Descriptor in_, out_, err_;  ///< its standard streams, our ends
  bool in_step_ = true;
};

}  // namespace gpo
