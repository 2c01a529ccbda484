// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/panels/facts/result_row.h"

#include <utility>

namespace gpo {

ResultRow dash(std::string label, std::string why) {
  return {std::move(label), "\u2013", "", std::move(why), Tone::dim};
}

}  // namespace gpo
