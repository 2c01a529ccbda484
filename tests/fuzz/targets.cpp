// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/fuzz/targets.h"

#include <iostream>

extern "C" {
#include <libavutil/log.h>
}

namespace gpo::fuzz {

void quiet_libraries() {
  av_log_set_level(AV_LOG_QUIET);
  std::cerr.setstate(std::ios::failbit);  // OpenCV prints each failure there
}

}  // namespace gpo::fuzz
