// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/files/output_file.h"

#include "engine/files/image_codec.h"
#include "engine/files/refuse.h"
#include "engine/files/text_file.h"

#include <cerrno>
#include <fstream>
#include <mutex>
#include <random>
#include <set>
#include <system_error>

#include <unistd.h>

namespace gpo {
namespace {

[[noreturn]] void not_written(const fs::path& file, const std::error_code& why) {
  refuse(file, "cannot be written: {}", why.message());
}

std::error_code last_error() { return {errno, std::generic_category()}; }

fs::path followed(fs::path file) {
  constexpr int kMaxLinks = 40;
  std::error_code error;
  for (int i = 0; i < kMaxLinks && fs::is_symlink(fs::symlink_status(file, error)); ++i) {
    const fs::path next = fs::read_symlink(file, error);
    if (error) break;
    file = file.parent_path() / next;
  }
  return file;
}

bool is_stream(const fs::path& file) {
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}

/// The files and folders that this process is writing.
struct Unfinished {
  std::mutex mutex;
  std::set<fs::path> paths;

  void add(const fs::path& path) {
    const std::scoped_lock lock(mutex);
    paths.insert(path);
  }
  void drop(const fs::path& path) {
    const std::scoped_lock lock(mutex);
    paths.erase(path);
  }
};

Unfinished& unfinished() {
  static auto* const paths = new Unfinished;  // outlives all other objects
  return *paths;
}

/// Returns a part of a temporary name: several machines may write the same output at once.
std::string random_mark() { return fmt::format("{:08x}", std::random_device()()); }

void write_whole(const fs::path& path, const fs::path& name, const std::string& content) {
  errno = 0;
  std::ofstream stream(path, std::ios::binary);
  stream << content;
  stream.close();
  if (!stream) not_written(name, last_error());
}

}  // namespace

void check_writable(const fs::path& file) {
  std::error_code error;
  if (fs::status(file, error).type() == fs::file_type::none) not_written(file, error);
  const fs::path folder = folder_of(followed(file));
  if (!fs::is_directory(folder, error))
    refuse(file, "cannot be written, there is no folder {}", folder.string());
  if (fs::is_directory(file, error)) refuse(file, "is a folder, expected a file to write");
  const fs::path written = is_stream(file) ? file : folder;
  if (access(written.c_str(), W_OK) != 0) not_written(file, last_error());
}

bool same_file(const fs::path& one, const fs::path& other) {
  if (is_stream(one) || is_stream(other)) return false;
  std::error_code error;
  if (fs::equivalent(one, other, error)) return true;
  const auto place = [&](const fs::path& file) {
    const fs::path absolute = fs::absolute(followed(file), error);
    const fs::path whole = fs::weakly_canonical(absolute, error);
    return error ? absolute.lexically_normal() : whole;
  };
  return place(one) == place(other);
}

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) refuse(folder, "cannot be created: {}", error.message());
}

AtomicFile::AtomicFile(const fs::path& file) : file_(followed(file)) {
  check_writable(file);
  path_ = file_.parent_path() / fmt::format("{}.{}.partial{}",
                                            file_.filename().string(),
                                            random_mark(),
                                            file_.extension().string());
  unfinished().add(path_);
}

AtomicFile::~AtomicFile() {
  std::error_code none;
  if (path_.empty()) return;
  fs::remove(path_, none);
  unfinished().drop(path_);
}

void AtomicFile::finish() {
  std::error_code error;
  fs::rename(path_, file_, error);
  if (error) not_written(file_, error);
  unfinished().drop(path_);
  path_.clear();
}

void remove_unfinished() {
  const std::scoped_lock lock(unfinished().mutex);
  std::error_code ignored;
  for (const fs::path& path : unfinished().paths) fs::remove_all(path, ignored);
}

void write_file(const fs::path& file, const std::string& content) {
  if (is_stream(file)) return write_whole(file, file, content);
  AtomicFile unfinished(file);
  write_whole(unfinished.path(), file, content);
  unfinished.finish();
}

void write_image(const fs::path& file, const cv::Mat& image) {
  write_file(file, encode_png(image));
}

void check_output_folder(const fs::path& folder, const std::string& ours) {
  std::error_code error;
  if (!fs::exists(folder, error)) return;
  bool free = fs::is_directory(folder, error) && fs::is_empty(folder, error);
  // While that file is being written, its temporary name starts with its name.
  if (!ours.empty() && fs::is_directory(folder, error))
    for (const auto& entry : fs::directory_iterator(folder, error))
      free = free || entry.path().filename().string().starts_with(ours);
  if (free) return;
  refuse(folder,
         "is not empty; choose a new or empty folder{}",
         ours.empty() ? "" : ", or one with " + ours);
}

AtomicFolder::AtomicFolder(const fs::path& folder)
    : folder_(fs::absolute(folder / "").parent_path()),
      path_(fmt::format("{}.{}.unfinished", folder_.string(), random_mark())) {
  check_output_folder(folder);
  make_folder(path_);
  unfinished().add(path_);
}

AtomicFolder::~AtomicFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
  unfinished().drop(path_);
}

void AtomicFolder::finish() {
  std::error_code error;
  fs::remove(folder_, error);
  if (!error) fs::rename(path_, folder_, error);
  if (error) not_written(folder_, error);
}

}  // namespace gpo
