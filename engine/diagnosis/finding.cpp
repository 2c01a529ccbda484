// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/diagnosis/finding.h"

#include <algorithm>

namespace gpo {

std::string text_of(const Finding& finding) {
  return finding.sentence + (finding.advice.empty() ? "" : ": " + finding.advice);
}

Level heaviest(std::span<const Finding> findings) {
  Level level = Level::note;
  for (const Finding& finding : findings) level = std::max(level, finding.level);
  return level;
}

const Finding* find_finding(std::span<const Finding> findings, std::string_view key) {
  const auto found = std::ranges::find(findings, key, &Finding::key);
  return found == findings.end() ? nullptr : &*found;
}

}  // namespace gpo
