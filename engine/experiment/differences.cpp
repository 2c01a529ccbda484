// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/experiment/experiment.h"

#include <algorithm>
#include <functional>

#include <fmt/format.h>

namespace gpo {
namespace {

using Identities = std::map<std::string, std::string>;

/// Returns whether a method of both has different identities.
bool has_other(const Identities& one, const Identities& other) {
  return std::ranges::any_of(one, [&](const auto& entry) {
    const auto same = other.find(entry.first);
    return same != other.end() && same->second != entry.second;
  });
}

/// Returns whether the list lacks an element of another one.
template <class List, class Projection = std::identity>
bool lacks(const List& list, const List& other, Projection projection = {}) {
  return std::ranges::any_of(other, [&](const auto& one) {
    return std::ranges::find(list, std::invoke(projection, one), projection) == list.end();
  });
}

}  // namespace

std::map<std::string, std::string> identities_on(const Experiment& experiment,
                                                 const ExperimentRecording& recording) {
  Identities identities;
  const std::string end = "/" + recording.name;
  for (const auto& [key, identity] : experiment.commands) {
    if (key.ends_with(end)) {
      identities[key.substr(0, key.find('/'))] += " " + identity;  // after that of the method
    } else if (key.find('/') == std::string::npos) {
      identities[key] = identity;
    }
  }
  return identities;
}

ExperimentDifferences differences(const Experiment& a, const Experiment& b, bool may_add) {
  const auto differ = [&]<class Projection = std::identity>(
      const auto& one, const auto& other, Projection projection = {}) {
    return may_add ? lacks(other, one, projection)
                   : !std::ranges::equal(one, other, {}, projection, projection);
  };
  ExperimentDifferences found;
  constexpr auto kName = &ExperimentRecording::name;
  if (differ(a.configurations, b.configurations)) found.plan.emplace_back("methods");
  if (differ(a.lengths, b.lengths)) found.plan.emplace_back("lengths");
  if (a.seed != b.seed) found.plan.emplace_back("seed");
  if (a.program != b.program) found.content.emplace_back("build of the program");
  if (may_add ? has_other(a.commands, b.commands) : a.commands != b.commands)
    found.content.emplace_back("command or files of a method");
  if (differ(a.recordings, b.recordings, kName)) {
    found.plan.emplace_back("recordings");
    if (!may_add) return found;
  }
  bool other_starts = false;
  for (const ExperimentRecording& one : a.recordings) {
    const auto other = std::ranges::find(b.recordings, one.name, kName);
    if (other == b.recordings.end()) continue;
    const auto parts = differing_parts(one.content, other->content);
    for (const std::string& part : parts)
      found.content.push_back(fmt::format("{} of {}", part, one.name));
    // `end` depends on lengths and frames: if these differ, so do the starts.
    other_starts = other_starts || (parts.empty() && differ(one.starts, other->starts));
  }
  if (other_starts && a.lengths == b.lengths) found.plan.emplace_back("starts");
  return found;
}

}  // namespace gpo
