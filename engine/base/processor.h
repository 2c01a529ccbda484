// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace gpo {

/// Whether this processor runs what is compiled for AVX2 and FMA.
bool has_avx2_fma();

}  // namespace gpo
