// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace gpo {

/// What running times were measured on, as the system calls it: "AMD EPYC 7B13".
std::string processor_name();

}  // namespace gpo
