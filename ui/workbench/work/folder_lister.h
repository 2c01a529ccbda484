// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/internal/background_job.h"

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace gpo {

/// Something in a folder.
struct FolderEntry {
  std::string name;
  bool folder = false;
  bool known = false;     ///< `what` is told already
  std::string what = {};  ///< "EuRoC · 60 frames · 2.0 s", "session"; empty: nothing to open
  bool operator==(const FolderEntry&) const = default;
};

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

/// What is typed into the field: a folder, and the beginning or a part of a name in it. "~" is the
/// home folder; what does not begin at the root begins in the working folder; after "//" it begins
/// at the root anew.
struct TypedPath {
  std::filesystem::path folder;
  std::string name;

  std::filesystem::path whole() const { return folder / name; }
};
TypedPath typed_path(const std::string& text);

/// Those whose name has the typed one in it, whatever its case: that begin with it first. Hidden
/// ones only where the typed name begins with a dot.
std::vector<FolderEntry> matching(std::span<const FolderEntry> entries, const std::string& name);

/// The text with its name as long as all entries that begin with it agree, a lone folder entered.
std::string completed(const std::string& text, std::span<const FolderEntry> entries);

}  // namespace gpo
