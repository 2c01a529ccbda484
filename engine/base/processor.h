// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Attribute of functions that are compiled for AVX2 and FMA, and called only if `has_avx2_fma`.
#ifdef __x86_64__
#define GPO_AVX2_FMA [[gnu::target("avx2,fma")]]
#else
#define GPO_AVX2_FMA
#endif

namespace gpo {

inline bool has_avx2_fma() {
#ifdef __x86_64__
  return __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0;
#else
  return false;
#endif
}

}  // namespace gpo
