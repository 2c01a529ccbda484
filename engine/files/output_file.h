// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include <opencv2/core.hpp>

namespace gpo {

/// Refuses, before any work is done, a file whose folder does not exist or cannot be written to, or
/// that is a folder. Throws InputError.
void check_writable(const std::filesystem::path& file);

/// Whether what is written to one file would be written over the other: the same place, however it
/// is spelled, also through links. Never true of what is no regular file, like /dev/null.
bool same_file(const std::filesystem::path& one, const std::filesystem::path& other);

/// Makes a folder and those above it where they are missing. Throws InputError.
void make_folder(const std::filesystem::path& folder);

/// A file that appears whole or not at all: written under another name beside it, by whatever
/// writes to `path`, then renamed by `finish`. What is not finished is removed. Of a link, what it
/// leads to is written.
class AtomicFile {
 public:
  /// Throws InputError where it cannot be written.
  explicit AtomicFile(const std::filesystem::path& file);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Ends as the file does, for libraries that tell formats by endings.
  const std::filesystem::path& path() const { return path_; }
  /// Throws InputError.
  void finish();

 private:
  std::filesystem::path file_, path_;
};

/// Writes the whole file or none of it; what is no regular file, like /dev/stdout, directly. Throws
/// InputError.
void write_file(const std::filesystem::path& file, const std::string& content);

/// The same for a picture, as PNG.
void write_image(const std::filesystem::path& file, const cv::Mat& image);

/// The one rule of all output folders: refuses what is no folder, and a folder that is not empty,
/// but for one that holds `ours`, the file by which a command knows a folder of its own. Throws
/// InputError.
void check_output_folder(const std::filesystem::path& folder, const std::string& ours = "");

/// A folder that appears whole or not at all: filled under another name beside it, then renamed by
/// `finish`. What is not finished is removed.
class AtomicFolder {
 public:
  /// Throws InputError where there is something already that is no empty folder, or where nothing
  /// can be written.
  explicit AtomicFolder(const std::filesystem::path& folder);
  ~AtomicFolder();
  AtomicFolder(const AtomicFolder&) = delete;
  AtomicFolder& operator=(const AtomicFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  /// Throws InputError.
  void finish();

 private:
  std::filesystem::path folder_, path_;
};

}  // namespace gpo
