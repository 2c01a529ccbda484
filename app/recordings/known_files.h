// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

namespace gpo {

/// Refuses a file that belongs to a recording, or to this program, but is none: a board.yaml, a
/// calibration, a session, ... Throws InputError that says what it is and what is to be named
/// instead. Everything else passes, also what does not exist.
void refuse_known_file(const std::filesystem::path& path);

}  // namespace gpo
