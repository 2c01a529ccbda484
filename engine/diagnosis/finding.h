// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/choice.h"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace gpo {

/// Effect of a finding on the verdict: a note leaves it.
enum class Level { note, weak, degenerate, no_plane };

template <>
struct ChoiceKeys<Level> : NamedKeys<"level", "note", "weak", "degenerate", "no plane"> {};

/// Evidence for a fault of the inputs, or against an answer.
struct Finding {
  std::string key = {};  ///< that of its check; stable, for JSON, scripts and tests
  Level level = Level::note;
  std::string sentence = {};              ///< the observation, with numbers and units
  std::string advice = {};                ///< one sentence; empty if nothing helps
  std::string command = {};               ///< a script line that does it; empty if there is none
  std::vector<std::int64_t> tracks = {};  ///< ids of the evidence to select and draw
  std::vector<int> frames = {};           ///< counted in the recording
  std::string view = {};                  ///< the pane that shows it best; empty: none
  bool ignored = false;                   ///< by `ignore_findings`; its level is `note`

  bool operator==(const Finding&) const = default;
};

/// Returns sentence and advice for people: "SENTENCE: ADVICE".
std::string text_of(const Finding& finding);

/// Returns the heaviest level; note if there are no findings.
Level heaviest(std::span<const Finding> findings);

/// Returns the finding with this key; null if there is none.
const Finding* find_finding(std::span<const Finding> findings, std::string_view key);

}  // namespace gpo
