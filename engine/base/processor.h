// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace gpo {

/// Returns whether this processor supports AVX2 and FMA.
bool has_avx2_fma();

}  // namespace gpo
