// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/recording/layouts/open_recording.h"

#include <memory>

namespace gpo::test {

/// Returns sequences/desk, opened once.
inline std::shared_ptr<const Recording> desk() {
  static const auto recording = open_recording(GPO_SOURCE_DIR "/sequences/desk");
  return recording;
}

}  // namespace gpo::test
