// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/recording/recording.h"

#include <map>
#include <string>
#include <vector>

namespace gpo {

/// What a recording holds, wherever it lies: its parts by name ("fx", "truth", "pictures"), each as
/// a text that is the same where the part is. Numbers stand as they are, what is long as its
/// SHA-256. Parts that a recording does not have are not there.
using RecordingContent = std::map<std::string, std::string>;

/// Of pictures it looks at names and sizes, and of those that a recipe made at the recipe. Throws
/// InputError where a picture's file has gone.
RecordingContent content_of(const Recording& recording);

/// All that is known of a board, in a line.
std::string text_of(const Board& board);

/// The names of the parts that differ, or that only one has.
std::vector<std::string> differing_parts(const RecordingContent& a, const RecordingContent& b);

}  // namespace gpo
