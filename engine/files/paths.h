// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

namespace gpo {
namespace fs = std::filesystem;
}  // namespace gpo
