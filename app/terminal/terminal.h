// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/report_timer.h"
#include "engine/base/stop.h"

#include <atomic>
#include <csignal>
#include <filesystem>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace gpo {

struct NamedFile {
  const char* option;
  std::optional<std::filesystem::path> path;
};

/// Returns whether the file is "-".
bool is_standard_output(const std::filesystem::path& file);

/// Checks, before any work, that each output can be written, that no two are the same file, and
/// that none is also an input. Folders need not exist yet. Throws InputError.
void check_outputs(const std::vector<NamedFile>& outputs, const std::vector<NamedFile>& inputs);

/// Writes to a file, whose folder is created if missing, or to standard output. Throws InputError.
void write_output(const std::filesystem::path& file, const std::string& content);

/// Checks an option for a finite number within a range, ends included: CLI::Range accepts nan.
std::function<std::string(const std::string&)> number_within(double least, double most);

/// Turns off the log output of OpenCV and libav, and OpenCL, which the engine does not use.
void silence_libraries();
/// Also drops the messages of failed image decoders, which OpenCV prints to std::cerr at every log
/// level. Replaces the buffer of std::cerr: call it once, and only in a program of our own.
void quiet_libraries();

/// Holds SIGINT and SIGTERM back from now on; `Interrupt` takes them. One that comes after it,
/// while the program exits, has no effect: the work is done.
void hold_signals();

/// Makes SIGINT and SIGTERM stop the work of this thread (StopScope). If the program runs for
/// another 800 ms, for example in a system call on a slow disk, it removes unfinished files and
/// ends the program with exit code 1; a second signal does so at once. Create it before other
/// threads.
class Interrupt {
 public:
  Interrupt();
  ~Interrupt();

  /// From now on the first signal only stops the work, however long its end takes.
  void let_finish() { lets_finish_ = true; }
  /// Does the same with another exit code, without a message.
  void end_soon(int code);

 private:
  void wait(const std::stop_token& end);

  sigset_t signals_;
  sigset_t mask_before_{};
  std::stop_source source_;
  StopWatch watch_{.stop = source_.get_token()};
  StopScope scope_{&watch_};
  std::atomic<bool> lets_finish_ = false;
  std::atomic<int> code_ = kRuns;
  static constexpr int kRuns = -1;
  std::jthread waiter_;  ///< last: it starts when all the others exist
};

/// Calls `work`. If it is stopped, the message says what remains of it.
template <class Work>
auto saying(const std::string& remains, Work&& work) {
  try {
    return work();
  } catch (const Stopped&) {
    throw Stopped{remains};
  }
}

/// Returns whether standard error is a terminal.
bool progress_is_watched();

/// "TITLE [####....] DONE/OF UNIT" on standard error; without a terminal a line every 10 s.
class ProgressBar {
 public:
  explicit ProgressBar(std::string title, std::string unit = "frames")
      : title_(std::move(title)), unit_(std::move(unit)) {}
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void operator()(int done, int of);

 private:
  std::string title_;
  std::string unit_;
  ReportTimer report_timer_{ReportTimer::Clock::now()};
  bool begun_ = false;
};

}  // namespace gpo
