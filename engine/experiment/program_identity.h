// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace gpo {

/// Returns version and build id of this program: programs of one version may differ.
std::string program_identity();

}  // namespace gpo
