// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "app/terminal/output.h"

#include "engine/base/error.h"
#include "engine/files/folder.h"
#include "engine/files/output_file.h"

#include <fmt/format.h>
#include <unistd.h>

namespace gpo {
namespace {

namespace fs = std::filesystem;

/// The same as `check_writable`, but of a folder that is yet to be made.
void check_can_be_written(const fs::path& file) {
  fs::path folder = folder_of(fs::absolute(file));
  std::error_code error;
  if (fs::exists(folder, error)) return check_writable(file);
  while (!fs::exists(folder, error) && folder.has_relative_path()) folder = folder.parent_path();
  if (is_folder(folder) && access(folder.c_str(), W_OK) == 0) return;
  throw InputError(fmt::format(
      "{}: cannot be written, no folder can be made in {}", file.string(), folder.string()));
}

/// Two of standard output are the same, too.
bool same_place(const fs::path& one, const fs::path& other) {
  if (is_standard_output(one) || is_standard_output(other)) return one == other;
  return same_file(one, other);
}

void check_differ(const NamedFile& written, const NamedFile& other, const char* what_happens) {
  if (!written.path || !other.path || !same_place(*written.path, *other.path)) return;
  throw InputError(fmt::format("{} and {}: found {} for both, {}",
                               written.option,
                               other.option,
                               written.path->string(),
                               what_happens));
}

}  // namespace

bool is_standard_output(const fs::path& file) { return file == "-"; }

void check_outputs(std::span<const NamedFile> written, std::span<const NamedFile> read) {
  for (std::size_t i = 0; i < written.size(); ++i) {
    if (!written[i].path) continue;
    for (std::size_t k = 0; k < i; ++k)
      check_differ(written[i], written[k], "expected a file for each");
    for (const NamedFile& input : read)
      check_differ(written[i], input, "which would be written over; expected another file");
    if (!is_standard_output(*written[i].path)) check_can_be_written(*written[i].path);
  }
}

void write_output(const fs::path& file, const std::string& content) {
  if (is_standard_output(file)) return fmt::print("{}", content);
  make_folder(folder_of(fs::absolute(file)));
  write_file(file, content);
}

}  // namespace gpo
