// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "app/terminal/quiet_libraries.h"

#include <cstdio>
#include <iostream>
#include <streambuf>
#include <string>

#include <opencv2/core/ocl.hpp>
#include <opencv2/core/utils/logger.hpp>

extern "C" {
#include <libavutil/log.h>
}

namespace gpo {
namespace {

/// Passes what is written to std::cerr on to standard error, without the lines in which OpenCV's
/// imread and imdecode print what a decoder threw: they do so at every log level and whoever
/// handles errors. Threads may write at the same time.
class WithoutImageErrors : public std::streambuf {
  int_type overflow(int_type c) override {
    thread_local std::string line;
    thread_local bool of_error = false;  // the line before was of such an error
    if (c == traits_type::eof()) return 0;
    line += traits_type::to_char_type(c);
    if (c != '\n') return c;
    // Details follow in lines that begin with '>', and an empty line ends the error.
    const bool begins = line.starts_with("imread") || line.starts_with("imdecode");
    const bool goes_on = of_error && (line.starts_with('>') || line == "\n");
    of_error = begins || (goes_on && line != "\n");
    if (!begins && !goes_on) std::fputs(line.c_str(), stderr);
    line.clear();
    return c;
  }
};

}  // namespace

void quiet_libraries() {
  cv::ocl::setUseOpenCL(false);  // the engine does not use it; only its drivers would be loaded
  cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
  av_log_set_level(AV_LOG_QUIET);  // what it says of broken videos becomes an InputError
  static auto* const filter = new WithoutImageErrors;  // std::cerr is flushed after main
  std::cerr.rdbuf(filter);
}

}  // namespace gpo
