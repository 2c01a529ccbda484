// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/internal/background_job.h"
#include "engine/inspection/inspection.h"
#include "engine/inspection/window/window_inputs.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>

namespace gpo {

/// What the worker has published; immutable values. `generation` grows with each publication.
struct Published {
  std::shared_ptr<const Recording> recording;    ///< null until one is open
  std::shared_ptr<const Inspection> inspection;  ///< of `recording`; null until one is finished
  std::uint64_t generation = 0;
};

/// Opens recordings and computes inspections in the background. The newest request wins: it stops
/// the running one. All functions may be called from any thread and return at once.
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

  JobStatus status() const;
  Published latest() const;

  /// `open_recording` and an Inspector for it.
  static Opened open_with_inspector(const std::filesystem::path& path,
                                    const std::stop_token& stop = {},
                                    const Progress& progress = {});
  static Opened with_inspector(std::shared_ptr<const Recording> recording);

 private:
  /// Makes another recording.
  using Opening = std::function<Opened(const std::stop_token&)>;

  BackgroundJob::Job next();
  void open_by(Opening opening);
  void do_open(const Opening& opening, const std::stop_token& stop);
  void do_inspect(const Settings& settings, const std::stop_token& stop);
  Progress progress(const std::stop_token& stop, const std::string& prefix = "");

  Open open_;
  Opening next_opening_;  ///< null: none waits
  std::optional<Settings> next_settings_;
  bool opening_ = false;  ///< one waits or runs
  Published published_;
  Inspect inspect_;      ///< of the open recording
  Calibrate calibrate_;  ///< likewise
  BackgroundJob job_;
};

}  // namespace gpo
