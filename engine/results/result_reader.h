// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/results/result_method.h"

namespace gpo {

/// The files of a result for one recording. Both functions are thread-safe.
struct ResultReader {
  std::function<Initialization(const Window& window,
                               const Sources& sources,
                               const RecordingFacts& recording,
                               ImportedResult& imported)>
      initialize;
  std::function<std::optional<ImportedResult>(const RecordingFacts& recording)> describe;
};

/// Reads the files of a result without `{recording}`. Throws InputError.
ResultReader read_result(const ProgramResult& result, const ResultLog& log);

}  // namespace gpo
