// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>

namespace gpo {

/// How corners are followed: from each frame to the next, as the paper does, or held to their own
/// first look, so that they do not drift (method.md, "Tracks drift, and on a plane they need not").
enum class Tracking { frame_to_frame, anchored };

/// Keys on the command line and in files, in the order of the enumeration.
std::span<const char* const> tracking_keys();
const char* to_string(Tracking tracking);
/// Throws InputError that names the known ones.
Tracking tracking_of(const std::string& key);

}  // namespace gpo
