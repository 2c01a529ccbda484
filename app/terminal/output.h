// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>

namespace gpo {

/// A file by the option that names it.
struct NamedFile {
  const char* option;
  std::optional<std::filesystem::path> path;
};

/// What `--json -` and the like mean.
bool is_standard_output(const std::filesystem::path& file);

/// Refuses, before any work is done, outputs that cannot be written, two that are the same file,
/// and one that is also read. Folders need not exist yet. Throws InputError.
void check_outputs(std::span<const NamedFile> written, std::span<const NamedFile> read = {});

/// Writes to a file, whose folder is made where it is missing, or to standard output. Throws
/// InputError.
void write_output(const std::filesystem::path& file, const std::string& content);

}  // namespace gpo
