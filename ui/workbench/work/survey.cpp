// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/work/survey.h"

#include "engine/base/error.h"
#include "engine/inspection/inspector.h"

#include <algorithm>
#include <exception>
#include <utility>

#include <fmt/format.h>

namespace gpo {
namespace {

/// Results kept, those that are wanted among them: ten methods at some tens of lengths, each about
/// half a megabyte.
constexpr std::size_t kMostResults = 300;

Surveyed inspect(Inspector& inspector, const Settings& settings, const std::stop_token& stop) {
  try {
    return {settings, inspector.inspect(settings, stop), ""};
  } catch (const std::exception& error) {
    return {settings, nullptr, message_of(error)};
  }
}

/// Null where it was stopped; with its reason where it could not be made, so that nobody asks for
/// it again.
std::shared_ptr<const NormalStudy> study_of(const Survey::Study& study,
                                            const Inspection& inspection,
                                            const std::stop_token& stop) {
  try {
    return study(inspection, stop);
  } catch (const std::exception& error) {
    NormalStudy failed;
    failed.window = inspection.window;
    failed.error = message_of(error);
    return std::make_shared<const NormalStudy>(std::move(failed));
  }
}

}  // namespace

Survey::Survey(std::function<void()> changed, Study study)
    : make_study_(std::move(study)), job_([this] { return next(); }, std::move(changed)) {}

void Survey::open(std::shared_ptr<const Recording> recording) {
  const auto lock = job_.lock();
  if (recording == recording_) return;
  job_.cancel();
  recording_ = std::move(recording);
  inspector_.reset();
  wanted_.clear();
  to_study_.reset();
  study_.reset();
  results_ = std::make_shared<const SurveyResults>();
}

void Survey::want(std::vector<Settings> settings) {
  const auto lock = job_.lock();
  if (settings == wanted_) return;
  wanted_ = std::move(settings);
  const bool inspecting = job_.running() && !studying_;
  if (inspecting && std::ranges::find(wanted_, running_settings_) == wanted_.end()) job_.cancel();
  job_.wake();
}

void Survey::add(const std::shared_ptr<const Inspection>& inspection) {
  const auto lock = job_.lock();
  if (inspection->recording != recording_) return;
  if (find_surveyed(results_.get(), inspection->settings) != nullptr) return;
  store({inspection->settings, inspection, ""});
}

void Survey::study(std::shared_ptr<const Inspection> inspection) {
  const auto lock = job_.lock();
  if (inspection &&
      (inspection->recording != recording_ || (study_ && study_->window == inspection->window)))
    inspection.reset();
  if (!inspection && !to_study_) return;
  if (inspection && to_study_ && to_study_->window == inspection->window) return;
  if (studying_) job_.cancel();
  to_study_ = std::move(inspection);
  job_.wake();
}

void Survey::store(Surveyed result) {
  SurveyResults results = *results_;
  results.push_back(std::move(result));
  const auto dispensable = [&](const Surveyed& one) {
    return std::ranges::find(wanted_, one.settings) == wanted_.end();
  };
  if (results.size() > kMostResults) {
    const auto oldest = std::ranges::find_if(results, dispensable);
    if (oldest != results.end()) results.erase(oldest);
  }
  results_ = std::make_shared<const SurveyResults>(std::move(results));
}

const Settings* Survey::next_wanted() const {
  if (!recording_) return nullptr;
  const auto found = std::ranges::find_if(wanted_, [&](const Settings& settings) {
    return find_surveyed(results_.get(), settings) == nullptr;
  });
  return found == wanted_.end() ? nullptr : &*found;
}

SurveyStatus Survey::status() const {
  const auto lock = job_.lock();
  SurveyStatus status;
  status.of = static_cast<int>(wanted_.size());
  status.done = static_cast<int>(std::ranges::count_if(wanted_, [&](const Settings& settings) {
    return find_surveyed(results_.get(), settings) != nullptr;
  }));
  if (to_study_) {
    ++status.of;
    status.stage = "normals of the window";
  } else if (const Settings* settings = next_wanted())
    status.stage = fmt::format("{}, {} frames", settings->options.method.key(), settings->frames);
  return status;
}

std::shared_ptr<const SurveyResults> Survey::results() const {
  const auto lock = job_.lock();
  return results_;
}

std::shared_ptr<const NormalStudy> Survey::latest_study() const {
  const auto lock = job_.lock();
  return study_;
}

BackgroundJob::Job Survey::next() {
  studying_ = to_study_ != nullptr;
  if (studying_)
    return [this, inspection = to_study_](const std::stop_token& stop) {
      do_study(*inspection, stop);
    };
  const Settings* settings = next_wanted();
  if (settings == nullptr) return nullptr;
  running_settings_ = *settings;
  if (!inspector_) inspector_ = std::make_shared<Inspector>(recording_);
  return [this, inspector = inspector_, settings = *settings](const std::stop_token& stop) {
    do_inspect(*inspector, settings, stop);
  };
}

void Survey::do_study(const Inspection& inspection, const std::stop_token& stop) {
  auto study = study_of(make_study_, inspection, stop);
  job_.publish(stop, [&] {
    study_ = std::move(study);
    to_study_.reset();
  });
}

void Survey::do_inspect(Inspector& inspector,
                        const Settings& settings,
                        const std::stop_token& stop) {
  Surveyed result = inspect(inspector, settings, stop);
  job_.publish(stop, [&] { store(std::move(result)); });
}

}  // namespace gpo
