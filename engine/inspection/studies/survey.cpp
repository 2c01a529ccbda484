// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inspection/studies/survey.h"

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

const Surveyed* find_surveyed(const SurveyResults* results, const Settings& settings) {
  if (results == nullptr) return nullptr;
  const auto found = std::ranges::find(*results, settings, &Surveyed::settings);
  return found == results->end() ? nullptr : &*found;
}

Survey::Survey(std::function<void()> changed, Study study)
    : changed_(std::move(changed)),
      make_study_(std::move(study)),
      thread_([this](const std::stop_token& stop) { run(stop); }) {}

Survey::~Survey() {
  want({});
  study(nullptr);
  thread_.request_stop();
  thread_.join();
}

void Survey::open(std::shared_ptr<const Recording> recording) {
  const std::lock_guard lock(mutex_);
  if (recording == recording_) return;
  running_.request_stop();
  recording_ = std::move(recording);
  wanted_.clear();
  to_study_.reset();
  study_.reset();
  results_ = std::make_shared<const SurveyResults>();
  wake_.notify_one();
}

void Survey::want(std::vector<Settings> settings) {
  const std::lock_guard lock(mutex_);
  if (settings == wanted_) return;
  wanted_ = std::move(settings);
  if (active_ && std::ranges::find(wanted_, running_settings_) == wanted_.end())
    running_.request_stop();
  wake_.notify_one();
}

void Survey::add(const std::shared_ptr<const Inspection>& inspection) {
  const std::lock_guard lock(mutex_);
  if (inspection->recording != recording_) return;
  if (find_surveyed(results_.get(), inspection->settings) != nullptr) return;
  store({inspection->settings, inspection, ""});
}

void Survey::study(std::shared_ptr<const Inspection> inspection) {
  const std::lock_guard lock(mutex_);
  if (inspection &&
      (inspection->recording != recording_ || (study_ && study_->window == inspection->window)))
    inspection.reset();
  if (inspection && to_study_ && to_study_->window == inspection->window) return;
  if (studying_) running_.request_stop();
  to_study_ = std::move(inspection);
  wake_.notify_one();
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

const Settings* Survey::next() const {
  if (!recording_) return nullptr;
  const auto found = std::ranges::find_if(wanted_, [&](const Settings& settings) {
    return find_surveyed(results_.get(), settings) == nullptr;
  });
  return found == wanted_.end() ? nullptr : &*found;
}

SurveyStatus Survey::status() const {
  const std::lock_guard lock(mutex_);
  SurveyStatus status;
  status.of = static_cast<int>(wanted_.size());
  status.done = static_cast<int>(std::ranges::count_if(wanted_, [&](const Settings& settings) {
    return find_surveyed(results_.get(), settings) != nullptr;
  }));
  if (to_study_) {
    ++status.of;
    status.stage = "normals of the window";
  } else if (const Settings* settings = next())
    status.stage = fmt::format("{}, {} frames", settings->options.method.key(), settings->frames);
  return status;
}

std::shared_ptr<const SurveyResults> Survey::results() const {
  const std::lock_guard lock(mutex_);
  return results_;
}

std::shared_ptr<const NormalStudy> Survey::latest_study() const {
  const std::lock_guard lock(mutex_);
  return study_;
}

void Survey::finish_study(const std::stop_token& request,
                          std::shared_ptr<const NormalStudy> study) {
  const std::lock_guard lock(mutex_);
  studying_ = false;
  if (request.stop_requested()) return;
  study_ = std::move(study);
  to_study_.reset();
}

void Survey::run(const std::stop_token& stop) {
  std::shared_ptr<const Recording> inspected;
  std::unique_ptr<Inspector> inspector;  // keeps the tracks from one setting to the next
  while (true) {
    std::stop_token request;
    std::shared_ptr<const Inspection> studied;  // null: one of the list is inspected
    {
      std::unique_lock lock(mutex_);
      if (!wake_.wait(lock, stop, [this] { return to_study_ || next() != nullptr; })) return;
      running_ = std::stop_source();
      request = running_.get_token();
      studied = to_study_;
      studying_ = studied != nullptr;
      active_ = !studying_;
      if (active_) running_settings_ = *next();
      if (inspected != recording_) {
        inspected = recording_;
        inspector = std::make_unique<Inspector>(inspected);
      }
    }
    if (studied) {
      finish_study(request, study_of(make_study_, *studied, request));
      if (changed_) changed_();
      continue;
    }
    Surveyed result = inspect(*inspector, running_settings_, request);
    {
      const std::lock_guard lock(mutex_);
      active_ = false;
      if (!request.stop_requested()) store(std::move(result));
    }
    if (changed_) changed_();
  }
}

}  // namespace gpo
