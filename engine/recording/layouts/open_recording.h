// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/recording/layouts/layouts.h"

#include <filesystem>
#include <memory>

namespace gpo {

/// Opens a folder or a file; finds out which layout it is. Pictures are not decoded yet, but each
/// is known to exist. Throws InputError.
std::shared_ptr<const Recording> open_recording(const std::filesystem::path& path,
                                                const OpenOptions& options = {});

}  // namespace gpo
