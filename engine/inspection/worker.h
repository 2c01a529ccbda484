// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/inspection.h"
#include "engine/inspection/window/progress.h"

#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>

namespace gpo {

/// What the worker is doing, for people.
struct WorkerStatus {
  bool busy = false;
  std::string stage;  ///< "tracking", empty when idle and where what ran was canceled
  int done = 0;
  int of = 0;         ///< 0: unknown
  std::string error;  ///< why the last request failed, one line; empty where it did not
};

/// What the worker has published; immutable values. `generation` grows with each publication.
struct Published {
  std::shared_ptr<const Recording> recording;    ///< null until one is open
  std::shared_ptr<const Inspection> inspection;  ///< of `recording`; null until one is finished
  std::uint64_t generation = 0;
};

/// One thread that opens recordings and computes inspections, so that the screen never waits. The
/// newest request wins: it stops the running one. All functions may be called from any thread and
/// return at once.
class Worker {
 public:
  using Inspect = std::function<std::shared_ptr<const Inspection>(
      const Settings&, std::stop_token, const Progress&)>;
  struct Opened;
  /// The same recording with a camera that was found in its pictures; without a recording where it
  /// was stopped. Throws InputError with the reason where there is none to be found.
  using Calibrate = std::function<Opened(const std::stop_token&, const Progress&)>;
  struct Opened {
    std::shared_ptr<const Recording> recording;
    Inspect inspect;
    Calibrate calibrate = {};  ///< null: nobody can
  };
  /// Runs on the worker; may throw, as it may where it was stopped: what it returns is then
  /// dropped.
  using Open =
      std::function<Opened(const std::filesystem::path&, const std::stop_token&, const Progress&)>;

  /// `changed` is called on the worker's thread after each change of status or publication.
  explicit Worker(Open open = open_with_inspector, std::function<void()> changed = {});
  ~Worker();
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  /// Opens a recording and publishes it; the last one stays where it cannot be opened.
  void open(const std::filesystem::path& path);
  /// Publishes the open recording with a camera that is found in its pictures. Ignored where nobody
  /// can find one.
  void calibrate();
  /// Inspects the open recording. Ignored while there is none, and forgotten where a recording that
  /// is being opened takes its place.
  void request(const Settings& settings);
  /// Stops what runs and forgets what waits.
  void cancel();

  WorkerStatus status() const;
  Published latest() const;

  /// `open_recording` and an Inspector for it.
  static Opened open_with_inspector(const std::filesystem::path& path,
                                    const std::stop_token& stop = {},
                                    const Progress& progress = {});
  static Opened with_inspector(std::shared_ptr<const Recording> recording);

 private:
  void run(const std::stop_token& stop);
  void do_open(const std::filesystem::path& path, const std::stop_token& stop);
  void do_calibrate(const std::stop_token& stop);
  void do_inspect(const Settings& settings, const std::stop_token& stop);
  void publish(Opened opened, const std::stop_token& stop);
  void report(const std::string& stage, int done, int of, const std::stop_token& stop);
  void finish(const std::string& error, const std::stop_token& stop);

  Open open_;
  std::function<void()> changed_;
  mutable std::mutex mutex_;
  std::condition_variable_any wake_;
  std::optional<std::filesystem::path> next_path_;
  bool next_calibration_ = false;
  std::optional<Settings> next_settings_;
  std::stop_source running_;
  bool active_ = false;   ///< the thread is at work on a request
  bool opening_ = false;  ///< ... or will be, and that request publishes another recording
  WorkerStatus status_;   ///< `busy` aside
  Published published_;
  Inspect inspect_;      ///< of the open recording; touched by the worker's thread alone
  Calibrate calibrate_;  ///< likewise
  std::jthread thread_;  ///< last: it starts when all the others exist
};

}  // namespace gpo
