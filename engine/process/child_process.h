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

/// A file descriptor that closes itself.
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

/// The outcome of a question to a process.
enum class Reply {
  answered,
  ended,     ///< the process closed its standard output first
  late,      ///< the time limit passed
  too_long,  ///< the line exceeds its limit
  stopped    ///< by the caller's stop token
};

struct ReplyLimits {
  std::chrono::milliseconds time{30'000};
  std::size_t answer_bytes = std::size_t{8} << 20;
  std::size_t error_bytes = std::size_t{16} << 10;  ///< from standard error; the rest is dropped
};

struct ProcessReply {
  Reply reply = Reply::ended;
  std::string answer;        ///< without the line break; incomplete unless answered
  std::string error_output;  ///< standard error meanwhile
};

/// A shell command in its own process group that reads a line on standard input and answers with a
/// line on standard output. The limits bound the memory in any case. Not thread-safe, but several
/// processes may run in parallel.
class ChildProcess {
 public:
  /// Throws std::system_error if the system refuses.
  explicit ChildProcess(const std::string& command);
  /// Kills the group.
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// `question` includes its line break. After any reply but `answered`, the process is useless.
  ProcessReply ask(std::string_view question,
                   const ReplyLimits& limits,
                   const std::stop_token& stop = {});

  /// Returns whether it is alive and has written no unrequested output; its next line might
  /// otherwise answer an earlier question.
  bool is_in_step() const;

  /// Kills the group. Returns how the process ended before: "ended with exit code 1", "was killed
  /// by signal 9 (Killed)", or "closed its standard output" if it was alive.
  std::string end();

 private:
  bool write_some(std::string_view& question);
  bool read_answer(ProcessReply& reply, const ReplyLimits& limits);
  void read_errors(ProcessReply& reply, std::size_t max_bytes);

  pid_t pid_ = -1;             ///< also of the group; -1: ended and reaped
  Descriptor in_, out_, err_;  ///< our ends of its standard streams
  bool in_step_ = true;
};

}  // namespace gpo
