// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/experiment/processor.h"

#include "engine/files/text_file.h"

#include <fstream>

#include <sys/utsname.h>

namespace gpo {

std::string processor_name() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    const std::size_t colon = line.find(':');
    if (colon == std::string::npos || !line.starts_with("model name")) continue;
    return std::string(trimmed(std::string_view(line).substr(colon + 1)));
  }
  utsname system{};  // not all kinds of processors have a model's name
  return uname(&system) == 0 ? system.machine : "unknown";
}

}  // namespace gpo
