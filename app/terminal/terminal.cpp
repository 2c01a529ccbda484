// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "app/terminal/terminal.h"

#include "engine/base/error.h"
#include "engine/files/libav_functions.h"
#include "engine/files/output_file.h"
#include "engine/files/text_file.h"
#include "engine/recording/images/images.h"

#include <chrono>
#include <cstdio>
#include <iostream>
#include <span>
#include <streambuf>

#include <fmt/format.h>
#include <opencv2/core/ocl.hpp>
#include <opencv2/core/utils/logger.hpp>
#include <unistd.h>

namespace gpo {
namespace {

namespace fs = std::filesystem;

/// Like `check_writable`, also for a file whose folder does not exist yet.
void check_can_be_written(const fs::path& file) {
  fs::path folder = folder_of(fs::absolute(file));
  std::error_code error;
  if (fs::exists(folder, error)) return check_writable(file);
  while (!fs::exists(folder, error) && folder.has_relative_path()) folder = folder.parent_path();
  if (is_folder(folder) && access(folder.c_str(), W_OK) == 0) return;
  throw InputError(fmt::format(
      "{}: cannot be written, no folder can be created in {}", file.string(), folder.string()));
}

void check_differ(const NamedFile& output, const NamedFile& other, const char* problem) {
  if (!output.path || !other.path) return;
  const bool standard = is_standard_output(*output.path) || is_standard_output(*other.path);
  if (!(standard ? *output.path == *other.path : same_file(*output.path, *other.path))) return;
  throw InputError(fmt::format("{} and {}: found {} for both, {}",
                               output.option,
                               other.option,
                               output.path->string(),
                               problem));
}

/// Passes std::cerr on without the lines of OpenCV's image decoders. Thread-safe.
class WithoutImageErrors : public std::streambuf {
  int_type overflow(int_type c) override {
    thread_local std::string line;
    thread_local bool in_error = false;
    if (c == traits_type::eof()) return 0;
    line += traits_type::to_char_type(c);
    if (c != '\n') return c;
    // An error starts with the function's name and continues in lines with '>' until an empty one.
    const bool begins = line.starts_with("imread") || line.starts_with("imdecode");
    const bool goes_on = in_error && (line.starts_with('>') || line == "\n");
    in_error = begins || (goes_on && line != "\n");
    if (!begins && !goes_on) std::fputs(line.c_str(), stderr);
    line.clear();
    return c;
  }
};

sigset_t stopping_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  return signals;
}

}  // namespace

bool is_standard_output(const fs::path& file) { return file == "-"; }

void check_outputs(const std::vector<NamedFile>& outputs, const std::vector<NamedFile>& inputs) {
  for (const NamedFile& output : outputs) {
    if (!output.path) continue;
    if (output.path->empty())
      throw InputError(fmt::format("{}: '', expected the name of a file", output.option));
    for (const NamedFile& earlier : std::span(outputs.data(), &output))
      check_differ(output, earlier, "expected a file for each");
    for (const NamedFile& input : inputs)
      check_differ(output, input, "which would be overwritten; choose another file");
    if (!is_standard_output(*output.path)) check_can_be_written(*output.path);
  }
}

void write_output(const fs::path& file, const std::string& content) {
  if (is_standard_output(file)) return fmt::print("{}", content);
  make_folder(folder_of(fs::absolute(file)));
  write_file(file, content);
}

std::function<std::string(const std::string&)> number_within(double least, double most) {
  return [=](const std::string& text) {
    const auto value = parse_number(text);
    if (value && *value >= least && *value <= most) return std::string();
    return fmt::format("'{}', expected a number from {:g} to {:g}", text, least, most);
  };
}

void silence_libraries() {
  cv::ocl::setUseOpenCL(false);
  cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
  libav::before_loading([] {
    const libav::Function<decltype(av_log_set_level)> set_level("av_log_set_level");
    set_level(AV_LOG_QUIET);
  });
}

void quiet_libraries() {
  silence_libraries();
  static auto* const filter = new WithoutImageErrors;  // std::cerr is flushed after main
  std::cerr.rdbuf(filter);
}

void hold_signals() {
  const sigset_t signals = stopping_signals();
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
}

Interrupt::Interrupt() : signals_(stopping_signals()) {
  pthread_sigmask(SIG_BLOCK, &signals_, &mask_before_);
  waiter_ = std::jthread([this](const std::stop_token& end) { wait(end); });
}

void Interrupt::wait(const std::stop_token& end) {
  using Clock = std::chrono::steady_clock;
  constexpr timespec kPoll{0, 20'000'000};  // 20 ms
  constexpr std::chrono::milliseconds kGrace{800};
  constexpr int kInterrupted = 1;
  std::optional<Clock::time_point> deadline;
  while (!end.stop_requested()) {
    if (sigtimedwait(&signals_, nullptr, &kPoll) > 0) {
      if (source_.stop_requested()) deadline = Clock::now();
      if (lets_finish_ && !deadline)
        source_.request_stop();
      else
        end_soon(kInterrupted);
    }
    if (code_ == kRuns) continue;
    if (!deadline) deadline = Clock::now() + kGrace;
    if (Clock::now() < *deadline) continue;
    if (code_ == kInterrupted)
      std::fputs("gpo-inspector: stopped; unfinished files were removed\n", stderr);
    remove_unfinished();
    _exit(code_);
  }
}

void Interrupt::end_soon(int code) {
  int runs = kRuns;
  code_.compare_exchange_strong(runs, code);
  source_.request_stop();
}

Interrupt::~Interrupt() {
  waiter_.request_stop();
  waiter_.join();
  pthread_sigmask(SIG_SETMASK, &mask_before_, nullptr);
}

bool progress_is_watched() { return isatty(fileno(stderr)) != 0; }

ProgressBar::~ProgressBar() {
  if (begun_) std::fputc('\n', stderr);
}

void ProgressBar::operator()(int done, int of) {
  if (!progress_is_watched()) {
    if (report_timer_.due(ReportTimer::Clock::now()))
      fmt::print(stderr, "{}: {}/{} {}\n", title_, done, of, unit_);
    return;
  }
  constexpr int kLength = 20;
  const int filled = kLength * done / of;
  const std::string bar = std::string(filled, '#') + std::string(kLength - filled, '.');
  fmt::print(stderr, "\r{} [{}] {}/{} {}", title_, bar, done, of, unit_);
  std::fflush(stderr);
  begun_ = true;
}

}  // namespace gpo
