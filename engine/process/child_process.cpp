// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/process/child_process.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <system_error>
#include <thread>

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace gpo {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr milliseconds kPollTime{20};  // delay of a stop
constexpr milliseconds kGrace{500};    // for a process to end after it closed its output

void check(int error, const char* what) {
  if (error != 0) throw std::system_error(error, std::generic_category(), what);
}

struct Pipe {
  Pipe() {
    std::array<int, 2> ends{};
    check(pipe2(ends.data(), O_CLOEXEC) == 0 ? 0 : errno, "pipe");
    reads = Descriptor(ends[0]);
    writes = Descriptor(ends[1]);
  }
  Descriptor reads, writes;
};

/// The parameters of posix_spawn: three streams and no other descriptor, its own process group (so
/// that Ctrl-C does not reach it and its children can be killed), and default signal handlers.
class SpawnPlan {
 public:
  SpawnPlan(const Pipe& in, const Pipe& out, const Pipe& err) {
    check(posix_spawn_file_actions_init(&files_), "posix_spawn");
    check(posix_spawnattr_init(&attributes_), "posix_spawn");
    const std::array ends{in.reads.number(), out.writes.number(), err.writes.number()};
    for (int stream = 0; stream < 3; ++stream)
      check(posix_spawn_file_actions_adddup2(&files_, ends[stream], stream), "posix_spawn");
    check(posix_spawn_file_actions_addclosefrom_np(&files_, 3), "posix_spawn");
    sigset_t none, usual;
    sigemptyset(&none);
    sigemptyset(&usual);
    for (const int signal : {SIGPIPE, SIGINT, SIGTERM, SIGQUIT}) sigaddset(&usual, signal);
    posix_spawnattr_setsigmask(&attributes_, &none);
    posix_spawnattr_setsigdefault(&attributes_, &usual);
    posix_spawnattr_setpgroup(&attributes_, 0);
    posix_spawnattr_setflags(
        &attributes_, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  }
  ~SpawnPlan() {
    posix_spawn_file_actions_destroy(&files_);
    posix_spawnattr_destroy(&attributes_);
  }
  SpawnPlan(const SpawnPlan&) = delete;
  SpawnPlan& operator=(const SpawnPlan&) = delete;

  pid_t spawn(std::string command) const {
    std::string shell = "sh", option = "-c";
    const std::array arguments{shell.data(), option.data(), command.data(), (char*)nullptr};
    pid_t pid = -1;
    check(posix_spawn(&pid, "/bin/sh", &files_, &attributes_, arguments.data(), environ),
          "/bin/sh");
    return pid;
  }

 private:
  posix_spawn_file_actions_t files_;
  posix_spawnattr_t attributes_;
};

/// Like write(2), but a closed reader gives EPIPE without SIGPIPE for the whole program.
ssize_t write_quietly(int descriptor, std::string_view bytes) {
  sigset_t broken_pipe, before, pending;
  sigemptyset(&broken_pipe);
  sigaddset(&broken_pipe, SIGPIPE);
  sigpending(&pending);
  pthread_sigmask(SIG_BLOCK, &broken_pipe, &before);
  const ssize_t written = write(descriptor, bytes.data(), bytes.size());
  const int error = errno;
  if (written < 0 && error == EPIPE && sigismember(&pending, SIGPIPE) == 0) {
    const timespec at_once{};
    sigtimedwait(&broken_pipe, nullptr, &at_once);
  }
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  errno = error;
  return written;
}

bool is_try_again() { return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR; }

std::string ending_of(pid_t pid) {
  siginfo_t info{};
  if (waitid(P_PID, static_cast<id_t>(pid), &info, WEXITED | WNOHANG | WNOWAIT) != 0 ||
      info.si_pid == 0)
    return "";
  // A shell returns 128 + N if its child was killed by signal N.
  const bool from_shell = info.si_code == CLD_EXITED && info.si_status > 128;
  const int signal = from_shell ? info.si_status - 128 : info.si_status;
  const char* name = sigdescr_np(signal);
  if (info.si_code == CLD_EXITED && !(from_shell && name != nullptr))
    return fmt::format("ended with exit code {}", info.si_status);
  return fmt::format("was killed by signal {} ({})", signal, name == nullptr ? "?" : name);
}

}  // namespace

ChildProcess::ChildProcess(const std::string& command) {
  Pipe in, out, err;
  pid_ = SpawnPlan(in, out, err).spawn(command);
  in_ = std::move(in.writes);
  out_ = std::move(out.reads);
  err_ = std::move(err.reads);
  for (const Descriptor* ours : {&in_, &out_, &err_})
    fcntl(ours->number(), F_SETFL, fcntl(ours->number(), F_GETFL) | O_NONBLOCK);
}

ChildProcess::~ChildProcess() { end(); }

ProcessReply ChildProcess::ask(std::string_view question,
                               const ReplyLimits& limits,
                               const std::stop_token& stop) {
  ProcessReply reply;
  const auto ended = [&](Reply how) {
    in_step_ = in_step_ && how == Reply::answered && question.empty();
    read_errors(reply, limits.error_bytes);
    reply.reply = how;
    return std::move(reply);
  };
  const auto deadline = Clock::now() + limits.time;
  while (true) {
    if (stop.stop_requested()) return ended(Reply::stopped);
    const auto left = std::chrono::ceil<milliseconds>(deadline - Clock::now());
    if (left.count() <= 0) return ended(Reply::late);
    if (!out_.is_open()) return ended(Reply::ended);
    // poll ignores negative descriptors, i.e. closed ones and an input with no more to write.
    std::array<pollfd, 3> streams{pollfd{question.empty() ? -1 : in_.number(), POLLOUT, 0},
                                  pollfd{out_.number(), POLLIN, 0},
                                  pollfd{err_.number(), POLLIN, 0}};
    poll(streams.data(), streams.size(), static_cast<int>(std::min(left, kPollTime).count()));
    if (streams[2].revents != 0) read_errors(reply, limits.error_bytes);
    if (streams[0].revents != 0 && !write_some(question)) in_.close();
    if (streams[1].revents == 0) continue;
    if (read_answer(reply, limits)) return ended(Reply::answered);
    if (reply.answer.size() > limits.answer_bytes) return ended(Reply::too_long);
  }
}

bool ChildProcess::write_some(std::string_view& question) {
  const ssize_t written = write_quietly(in_.number(), question);
  if (written > 0) question.remove_prefix(static_cast<std::size_t>(written));
  return written >= 0 || is_try_again();
}

/// Returns whether the answer's line is complete. Closes the stream at its end.
bool ChildProcess::read_answer(ProcessReply& reply, const ReplyLimits& limits) {
  std::array<char, 65'536> buffer;
  while (reply.answer.size() <= limits.answer_bytes) {
    const ssize_t count = read(out_.number(), buffer.data(), buffer.size());
    if (count < 0 && is_try_again()) return false;
    if (count <= 0) {
      out_.close();
      return false;
    }
    const std::string_view bytes(buffer.data(), static_cast<std::size_t>(count));
    const std::size_t line_end = bytes.find('\n');
    reply.answer += bytes.substr(0, line_end);
    if (line_end == std::string_view::npos) continue;
    in_step_ = in_step_ && line_end + 1 == bytes.size();
    return reply.answer.size() <= limits.answer_bytes;
  }
  return false;
}

/// Reads the available output, with a limit because a process may write without end.
void ChildProcess::read_errors(ProcessReply& reply, std::size_t max_bytes) {
  constexpr int kMaxReads = 64;
  std::array<char, 16'384> buffer;
  for (int i = 0; i < kMaxReads && err_.is_open(); ++i) {
    const ssize_t count = read(err_.number(), buffer.data(), buffer.size());
    if (count < 0 && is_try_again()) return;
    if (count <= 0) return err_.close();
    const std::size_t room = max_bytes - std::min(max_bytes, reply.error_output.size());
    reply.error_output.append(buffer.data(), std::min(room, static_cast<std::size_t>(count)));
  }
}

bool ChildProcess::is_in_step() const {
  if (!in_step_ || !in_.is_open() || !out_.is_open()) return false;
  pollfd out{out_.number(), POLLIN, 0};
  return poll(&out, 1, 0) == 0;
}

std::string ChildProcess::end() {
  if (pid_ < 0) return "had ended";
  std::string how = ending_of(pid_);
  if (!out_.is_open()) {
    for (const auto until = Clock::now() + kGrace; how.empty() && Clock::now() < until;) {
      std::this_thread::sleep_for(milliseconds(2));
      how = ending_of(pid_);
    }
  }
  // The process is not reaped yet, so its number cannot belong to another one.
  kill(-pid_, SIGKILL);
  while (waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) {
  }
  pid_ = -1;
  return how.empty() ? "closed its standard output" : how;
}

}  // namespace gpo
