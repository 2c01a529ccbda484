// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/recording/bags/containers/bag.h"

#include <memory>
#include <string_view>

namespace gpo {

class FileBytes;

inline constexpr std::string_view kMcapMagic = "\x89MCAP0\r\n";

/// The index of an MCAP file: the one in its summary, or, where there is none or it is of no use,
/// what going through the whole file finds, up to where it is cut or broken. Throws InputError.
Bag open_mcap(const std::shared_ptr<const FileBytes>& file);

}  // namespace gpo
