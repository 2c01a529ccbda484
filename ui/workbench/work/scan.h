// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/internal/background_job.h"
#include "engine/inspection/studies/scan.h"
#include "ui/workbench/work/survey.h"

#include <functional>
#include <memory>
#include <optional>
#include <vector>

namespace gpo {

/// Scans in the background, on all cores but behind everybody else; keeps what it has found for
/// settings that come back. All functions may be called from any thread and return at once.
class Scan {
 public:
  /// `changed` is called on other threads after each start.
  explicit Scan(std::function<void()> changed = {});

  /// What is to be scanned, with whatever start; replaces what was wanted before. Null or nothing:
  /// nothing is. Another recording forgets all results.
  void want(std::shared_ptr<const Recording> recording, std::optional<Settings> settings);

  SurveyStatus status() const;
  std::shared_ptr<const StartScan> latest() const;  ///< of what is wanted; null: nothing is

 private:
  using Cached = std::vector<std::shared_ptr<const StartScan>>;

  BackgroundJob::Job next();
  void add(ScannedStart found);
  Cached::iterator find(const Settings& settings);

  std::shared_ptr<const Recording> recording_;
  std::optional<Settings> wanted_;
  std::shared_ptr<const StartScan> latest_;
  Cached kept_;  ///< the last wanted one last
  BackgroundJob job_;
};

}  // namespace gpo
