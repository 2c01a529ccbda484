// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/internal/background_job.h"
#include "engine/inspection/inspection.h"
#include "engine/inspection/studies/normal_study.h"

#include <functional>
#include <memory>
#include <stop_token>
#include <string>
#include <vector>

namespace gpo {

class Inspector;

struct SurveyStatus {
  int done = 0;       ///< of what is wanted
  int of = 0;         ///< wanted
  std::string stage;  ///< "gpo, 25 frames"; empty: all is done

  bool busy() const { return done < of; }
  bool operator==(const SurveyStatus&) const = default;
};

/// Many inspections of one recording, computed one after another in the background beside the
/// worker's: other methods, other lengths, and studies of a window. What was computed once is kept.
/// All functions may be called from any thread and return at once.
class Survey {
 public:
  /// Makes a study of a window, on the survey's thread; null where it was stopped. May throw.
  using Study =
      std::function<std::shared_ptr<const NormalStudy>(const Inspection&, const std::stop_token&)>;

  /// `changed` is called on the survey's thread after each result.
  explicit Survey(std::function<void()> changed = {}, Study study = study_normals);

  /// Another recording, or none (null); forgets all results.
  void open(std::shared_ptr<const Recording> recording);
  /// What is to be computed, in this order; replaces what was wanted before and stops what is no
  /// longer wanted.
  void want(std::vector<Settings> settings);
  /// Somebody else's result.
  void add(const std::shared_ptr<const Inspection>& inspection);

  /// The window whose normals are to be studied, before all that is wanted; null: none. One
  /// that was studied last, or could not be, is not studied again.
  void study(std::shared_ptr<const Inspection> inspection);

  SurveyStatus status() const;
  std::shared_ptr<const SurveyResults> results() const;     ///< never null
  std::shared_ptr<const NormalStudy> latest_study() const;  ///< null: none yet; see its `error`

 private:
  BackgroundJob::Job next();
  void do_study(const Inspection& inspection, const std::stop_token& stop);
  void do_inspect(Inspector& inspector, const Settings& settings, const std::stop_token& stop);
  void store(Surveyed result);
  const Settings* next_wanted() const;  ///< the first wanted without a result; null: none

  Study make_study_;
  std::shared_ptr<const Recording> recording_;
  std::shared_ptr<Inspector> inspector_;  ///< keeps the recording's tracks for the next settings
  std::vector<Settings> wanted_;
  std::shared_ptr<const SurveyResults> results_ = std::make_shared<const SurveyResults>();
  std::shared_ptr<const Inspection> to_study_;  ///< null: nothing, or it is done
  std::shared_ptr<const NormalStudy> study_;
  bool studying_ = false;      ///< the job that was taken last studies `to_study_`
  Settings running_settings_;  ///< else it computes these
  BackgroundJob job_;
};

}  // namespace gpo
