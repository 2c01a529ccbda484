// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "app/terminal/output.h"

#include "engine/base/error.h"
#include "engine/files/output_file.h"
#include "engine/files/text_file.h"

#include <cstdio>
#include <iostream>
#include <streambuf>

#include <fmt/format.h>
#include <opencv2/core/ocl.hpp>
#include <opencv2/core/utils/logger.hpp>
#include <unistd.h>

extern "C" {
#include <libavutil/log.h>
}

namespace gpo {
namespace {

namespace fs = std::filesystem;

/// Like `check_writable`, also for a file whose folder does not exist yet.
void check_can_be_written(const fs::path& file) {
  fs::path folder = folder_of(fs::absolute(file));
  std::error_code error;
  if (fs::exists(folder, error)) return check_writable(file);
  while (!fs::exists(folder, error) && folder.has_relative_path()) folder = folder.parent_path();
  if (is_folder(folder) && access(folder.c_str(), W_OK) == 0) return;
  throw InputError(fmt::format(
      "{}: cannot be written, no folder can be created in {}", file.string(), folder.string()));
}

void check_differ(const NamedFile& output, const NamedFile& other, const char* problem) {
  if (!output.path || !other.path) return;
  const bool standard = is_standard_output(*output.path) || is_standard_output(*other.path);
  if (!(standard ? *output.path == *other.path : same_file(*output.path, *other.path))) return;
  throw InputError(fmt::format("{} and {}: found {} for both, {}",
                               output.option,
                               other.option,
                               output.path->string(),
                               problem));
}

/// Passes std::cerr on to standard error without the lines of OpenCV's image decoders. Threads may
/// write at the same time.
class WithoutImageErrors : public std::streambuf {
  int_type overflow(int_type c) override {
    thread_local std::string line;
    thread_local bool in_error = false;
    if (c == traits_type::eof()) return 0;
    line += traits_type::to_char_type(c);
    if (c != '\n') return c;
    // An error starts with the function's name, goes on in lines with '>' and ends with an empty
    // one.
    const bool begins = line.starts_with("imread") || line.starts_with("imdecode");
    const bool goes_on = in_error && (line.starts_with('>') || line == "\n");
    in_error = begins || (goes_on && line != "\n");
    if (!begins && !goes_on) std::fputs(line.c_str(), stderr);
    line.clear();
    return c;
  }
};

}  // namespace

bool is_standard_output(const fs::path& file) { return file == "-"; }

void check_outputs(std::span<const NamedFile> outputs, std::span<const NamedFile> inputs) {
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    if (!outputs[i].path) continue;
    for (const NamedFile& earlier : outputs.first(i))
      check_differ(outputs[i], earlier, "expected a file for each");
    for (const NamedFile& input : inputs)
      check_differ(outputs[i], input, "which would be overwritten; choose another file");
    if (!is_standard_output(*outputs[i].path)) check_can_be_written(*outputs[i].path);
  }
}

void write_output(const fs::path& file, const std::string& content) {
  if (is_standard_output(file)) return fmt::print("{}", content);
  make_folder(folder_of(fs::absolute(file)));
  write_file(file, content);
}

void silence_libraries() {
  cv::ocl::setUseOpenCL(false);
  cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
  av_log_set_level(AV_LOG_QUIET);
}

void quiet_libraries() {
  silence_libraries();
  static auto* const filter = new WithoutImageErrors;  // std::cerr is flushed after main
  std::cerr.rdbuf(filter);
}

}  // namespace gpo
