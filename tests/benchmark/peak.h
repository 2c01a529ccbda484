// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace gpo::bench {

/// Floating-point operations that the kernel of known rotations spends on an observation in a pass,
/// a fused multiply-add being two: counted in the loop that GCC makes of plane_kernel.cpp.
inline constexpr double kPassOperations = 100;

/// Floating-point operations of one call of `peak_operations`.
inline constexpr double kPeakOperations = 10000.0 * 10 * 4 * 2;

/// Independent fused multiply-adds in registers alone: what this processor can do with the vectors
/// that the kernel uses. Returns their sum.
double peak_operations();

}  // namespace gpo::bench
