// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace gpo {

/// Keeps libraries from what they would do to the whole process, or print beside our own messages.
/// The program calls it once; the engine itself changes nothing of the kind.
void quiet_libraries();

}  // namespace gpo
