// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/inspection.h"
#include "engine/inspection/studies/normal_study.h"

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

namespace gpo {

/// One of many settings, and what came of it.
struct Surveyed {
  Settings settings;
  std::shared_ptr<const Inspection> inspection;  ///< null: it could not be computed
  std::string error;                             ///< why not, one line
};

/// Immutable; what was computed later stands later.
using SurveyResults = std::vector<Surveyed>;

/// Null where these settings are not among them.
const Surveyed* find_surveyed(const SurveyResults* results, const Settings& settings);

struct SurveyStatus {
  int done = 0;       ///< of what is wanted
  int of = 0;         ///< wanted
  std::string stage;  ///< "gpo, 25 frames"; empty: all is done

  bool busy() const { return done < of; }
  bool operator==(const SurveyStatus&) const = default;
};

/// Many inspections of one recording, computed one after another by a thread of its own beside the
/// worker's: other methods, other lengths, and studies of a window. What was computed once is kept.
/// All functions may be called from any thread and return at once.
class Survey {
 public:
  /// Makes a study of a window, on the survey's thread; null where it was stopped. May throw.
  using Study =
      std::function<std::shared_ptr<const NormalStudy>(const Inspection&, const std::stop_token&)>;

  /// `changed` is called on the survey's thread after each result.
  explicit Survey(std::function<void()> changed = {}, Study study = study_normals);
  ~Survey();
  Survey(const Survey&) = delete;
  Survey& operator=(const Survey&) = delete;

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
  void run(const std::stop_token& stop);
  void store(Surveyed result);
  const Settings* next() const;  ///< the first wanted without a result; null: none
  void finish_study(const std::stop_token& request, std::shared_ptr<const NormalStudy> study);

  std::function<void()> changed_;
  Study make_study_;
  mutable std::mutex mutex_;
  std::condition_variable_any wake_;
  std::shared_ptr<const Recording> recording_;
  std::vector<Settings> wanted_;
  std::shared_ptr<const SurveyResults> results_ = std::make_shared<const SurveyResults>();
  Settings running_settings_;
  bool active_ = false;                         ///< `running_settings_` are being computed
  std::shared_ptr<const Inspection> to_study_;  ///< null: nothing, or it is done
  std::shared_ptr<const NormalStudy> study_;
  bool studying_ = false;  ///< `to_study_` is being studied
  std::stop_source running_;
  std::jthread thread_;  ///< last: it starts when all the others exist
};

}  // namespace gpo
