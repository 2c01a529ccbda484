// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "app/terminal/quiet_libraries.h"

#include <iostream>

#include <opencv2/core/ocl.hpp>
#include <opencv2/core/utils/logger.hpp>

extern "C" {
#include <libavutil/log.h>
}

namespace gpo {

void quiet_libraries() {
  cv::ocl::setUseOpenCL(false);  // the engine does not use it; only its drivers would be loaded
  cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
  av_log_set_level(AV_LOG_QUIET);  // what it says of broken videos becomes an InputError
  // imread and imdecode print to std::cerr what a decoder threw, whatever the level of the log is
  // and whoever handles errors. We use stderr itself.
  std::cerr.setstate(std::ios::failbit);
}

}  // namespace gpo
