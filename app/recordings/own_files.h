// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

namespace gpo {

/// The bundled recording: in the source tree, or beside the program as it was installed
/// (share/gpo-inspector).
std::filesystem::path example_recording();

/// Where recordings of recipes are kept: in the build tree, or in the user's cache where the
/// program was installed.
std::filesystem::path made_recordings_folder();

}  // namespace gpo
