// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/recording/recording.h"

namespace gpo {

/// Numbered images of one camera and, in the same place, other sequences.
struct ImageSequence {
  std::vector<fs::path> files;    ///< in the order of their numbers; empty: none
  std::vector<FoundFile> others;  ///< the first image of each sequence that is not read
  std::vector<FoundFile>
      unreadable;  ///< names of images that are no files, see `unreadable_images`
};

/// Finds the color or gray images in a folder or in its usual subfolders. Never returns depth,
/// masks and the like, which their names tell.
ImageSequence find_image_sequence(const fs::path& folder);

/// Adds images that cannot be read to the recording's files, and one note that names them.
void report_unreadable(Recording& recording, const std::vector<FoundFile>& unreadable);

/// Times that all file names contain, and their unit for people.
struct TimesInNames {
  std::vector<std::int64_t> times_ns;  ///< strictly ascending
  const char* unit = "";
};

/// Recognizes seconds with decimals, milli-, micro- and nanoseconds, and SEC_NSEC; nullopt unless
/// the times of all names ascend at the rate of a camera. `files` is sorted by time.
std::optional<TimesInNames> times_in_names(std::vector<fs::path>& files);

}  // namespace gpo
