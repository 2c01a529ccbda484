// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/synthesis/synthesize.h"

#include <filesystem>
#include <span>
#include <vector>

namespace gpo {

/// Where the recording of a recipe is kept: cache/STEM-HASH/STEM, so that it is called after its
/// recipe, and an edited recipe has another place. Throws InputError where there is no such file.
std::filesystem::path synthesized_folder(const std::filesystem::path& recipe,
                                         const std::filesystem::path& cache);

/// The folders of the recipes' recordings, in their order; makes those that are not there yet, some
/// at a time. Where another process makes one of them, waits for it. `progress` counts the frames
/// of all that are being made; it is never called by two threads at a time, and stops everything
/// where it throws. Throws InputError; what is not finished is never left behind.
std::vector<std::filesystem::path> synthesized_recordings(
    std::span<const std::filesystem::path> recipes,
    const std::filesystem::path& cache,
    int threads,
    const SynthesisProgress& progress = {});

}  // namespace gpo
