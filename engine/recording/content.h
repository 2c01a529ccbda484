// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/recording/recording.h"

#include <map>
#include <string>
#include <vector>

namespace gpo {

/// A recording's parts by name ("fx", "truth", "pictures"), each as a text that identifies its
/// content independently of the recording's path: numbers as they are, long data as SHA-256.
/// Missing parts have no entry.
using RecordingContent = std::map<std::string, std::string>;

/// Identifies images by file names and sizes, and rendered images by their recipe. Throws
/// InputError if an image file is missing.
RecordingContent content_of(const Recording& recording);

std::string text_of(const Board& board);

/// Returns the names of the parts that differ or exist in one recording only.
std::vector<std::string> differing_parts(const RecordingContent& a, const RecordingContent& b);

}  // namespace gpo
