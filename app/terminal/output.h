// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>

namespace gpo {

/// A file and the option that names it.
struct NamedFile {
  const char* option;
  std::optional<std::filesystem::path> path;
};

/// Returns whether the file is "-".
bool is_standard_output(const std::filesystem::path& file);

/// Checks, before any work, that each output can be written, that no two are the same file, and
/// that none is also an input. Folders need not exist yet. Throws InputError.
void check_outputs(std::span<const NamedFile> outputs, std::span<const NamedFile> inputs = {});

/// Writes to a file, whose folder is created if missing, or to standard output. Throws InputError.
void write_output(const std::filesystem::path& file, const std::string& content);

/// Turns off the log output of OpenCV and libav, and OpenCL, which the engine does not use.
void silence_libraries();
/// Also drops the messages of failed image decoders, which OpenCV prints to std::cerr at every log
/// level. Replaces the buffer of std::cerr: call it once, and only in a program of our own.
void quiet_libraries();

}  // namespace gpo
