// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/internal/background_job.h"
#include "engine/inspection/inspection.h"
#include "engine/inspection/studies/studies.h"

#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

namespace gpo {

class Inspector;

struct SurveyStatus {
  int done = 0;
  int of = 0;
  std::string stage;  ///< "gpo, 25 frames"; empty: finished

  bool busy() const { return done < of; }
  bool operator==(const SurveyStatus&) const = default;
};

/// Computes many inspections of one recording, one after another in the background next to the
/// worker: other methods, other lengths, and normal studies of a window. Results are cached. All
/// functions may be called from any thread and return at once.
class Survey {
 public:
  /// Makes the study of a window on the survey's thread; null if it was stopped. May throw.
  using Study =
      std::function<std::shared_ptr<const NormalStudy>(const Inspection&, const std::stop_token&)>;

  /// `changed` is called on the survey's thread after each result.
  explicit Survey(std::function<void()> changed = {}, Study study = study_normals);

  /// Changes the recording (null: none) and discards all results.
  void open(std::shared_ptr<const Recording> recording);
  /// Requests inspections in this order instead of those requested before. Stops a running one
  /// that is no longer requested.
  void want(std::vector<Settings> settings);
  /// Adds a result that was computed elsewhere.
  void add(const std::shared_ptr<const Inspection>& inspection);
  /// Requests a study of a window's normals, which precedes all inspections; null: none. The last
  /// window studied, successfully or not, is not studied again.
  void study(std::shared_ptr<const Inspection> inspection);

  SurveyStatus status() const;
  std::shared_ptr<const SurveyResults> results() const;     ///< never null
  std::shared_ptr<const NormalStudy> latest_study() const;  ///< null: none yet; see its `error`

 private:
  BackgroundJob::Job next();
  void store(Surveyed result);
  bool is_done(const Settings& settings) const;
  const Settings* next_wanted() const;  ///< the first requested without a result; null: none

  Study make_study_;
  std::shared_ptr<const Recording> recording_;
  std::shared_ptr<Inspector> inspector_;  ///< caches the tracks of the recording
  std::vector<Settings> wanted_;
  std::shared_ptr<const SurveyResults> results_ = std::make_shared<const SurveyResults>();
  std::shared_ptr<const Inspection> to_study_;  ///< null: none
  std::shared_ptr<const NormalStudy> study_;
  bool studying_ = false;      ///< the last job studies `to_study_`
  Settings running_settings_;  ///< otherwise it computes these
  BackgroundJob job_;
};

/// Scans recordings for start frames in the background, on all cores at low priority. Caches the
/// scans of earlier settings. All functions may be called from any thread and return at once.
class Scan {
 public:
  /// `changed` is called on other threads after each start.
  explicit Scan(std::function<void()> changed = {});

  /// Requests a scan instead of the one requested before; the start of `settings` is ignored. Null
  /// or nullopt: none. Another recording discards all results.
  void want(std::shared_ptr<const Recording> recording, std::optional<Settings> settings);

  SurveyStatus status() const;
  std::shared_ptr<const StartScan> latest() const;  ///< for the request; null: none

 private:
  BackgroundJob::Job next();

  std::shared_ptr<const Recording> recording_;
  std::optional<Settings> wanted_;
  std::shared_ptr<const StartScan> latest_;
  std::vector<std::shared_ptr<const StartScan>> cache_;  ///< the one requested last is the last one
  BackgroundJob job_;
};

}  // namespace gpo
