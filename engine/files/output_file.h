// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/files/paths.h"

#include <string>

#include <opencv2/core.hpp>

namespace gpo {

/// Throws InputError if the file is a folder, or its folder is missing or not writable.
void check_writable(const fs::path& file);

/// Returns whether both are one file, also through links; false for devices like /dev/null.
bool same_file(const fs::path& one, const fs::path& other);

void make_folder(const fs::path& folder);

/// A file that appears as a whole or not at all: written at `path` in the same folder, then renamed
/// by `finish`, or else removed by the destructor. Follows links.
class AtomicFile {
 public:
  explicit AtomicFile(const fs::path& file);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Has the extension of the file, which determines the format in some libraries.
  const fs::path& path() const { return path_; }
  void finish();

 private:
  fs::path file_, path_;
};

/// Removes the unfinished files and folders of this process, before it ends without destructors.
void remove_unfinished();

/// Writes the whole file or nothing, and to devices like /dev/stdout directly. Throws InputError.
void write_file(const fs::path& file, const std::string& content);

/// Writes a PNG: 1, 3 or 4 channels of 8 or 16 bits; blue first. Throws InputError.
void write_image(const fs::path& file, const cv::Mat& image);

/// Throws InputError if it is a file, or is not empty and lacks `ours`, the command's marker file.
void check_output_folder(const fs::path& folder, const std::string& ours = "");

/// A folder that appears as a whole or not at all: filled at `path`, then renamed by `finish`, or
/// else removed by the destructor.
class AtomicFolder {
 public:
  /// Throws InputError if it exists and is not an empty folder, or cannot be written.
  explicit AtomicFolder(const fs::path& folder);
  ~AtomicFolder();
  AtomicFolder(const AtomicFolder&) = delete;
  AtomicFolder& operator=(const AtomicFolder&) = delete;

  const fs::path& path() const { return path_; }
  void finish();

 private:
  fs::path folder_, path_;
};

}  // namespace gpo
