// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/internal/background_job.h"
#include "ui/workbench/browsing.h"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace gpo {

/// What is in a folder, as far as it is known.
struct FolderList {
  std::vector<FolderEntry> entries;  ///< folders first, each by name
  std::string error;                 ///< why there are none, one line
  bool reading = false;              ///< entries are still to come, or what they are
};

/// Lists folders in the background: a slow disk stops no window. May be called from any thread.
class FolderLister {
 public:
  /// `changed` is called on the lister's thread when more is known.
  explicit FolderLister(std::function<void()> changed = {});

  /// What is known of it; the folder before is forgotten.
  FolderList list(const std::filesystem::path& folder);
  /// To be read anew when it is listed next.
  void forget();

 private:
  BackgroundJob::Job next();
  void read(const std::filesystem::path& folder, const std::stop_token& stop);

  std::filesystem::path folder_;  ///< that is wanted
  bool wanted_ = false;           ///< and has not been begun
  FolderList list_;
  BackgroundJob job_;
};

}  // namespace gpo
