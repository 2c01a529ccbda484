// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include <opencv2/core.hpp>

namespace gpo {

/// Refuses, before any work is done, a file whose folder does not exist or that is a folder. Throws
/// InputError.
void check_writable(const std::filesystem::path& file);

/// Writes the whole file or none of it: beside it first, then renamed. Throws InputError.
void write_file(const std::filesystem::path& file, const std::string& content);

/// The same for a picture, as PNG.
void write_picture(const std::filesystem::path& file, const cv::Mat& picture);

}  // namespace gpo
