// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

// The alignment of Eigen's objects depends on the compiler's flags (-march=native, -mavx,
// -fsanitize=address). The library and its callers exchange such objects, so both must use the same
// one. The CMake and pkg-config packages define these macros.
static_assert(EIGEN_MAX_STATIC_ALIGN_BYTES == 16 && EIGEN_MAX_ALIGN_BYTES <= 16 &&
                  EIGEN_MALLOC_ALREADY_ALIGNED == 1,
              "Eigen's alignment differs from that of the gpo library. Compile all sources of your "
              "program that use Eigen with -DEIGEN_MAX_ALIGN_BYTES=16 "
              "-DEIGEN_MAX_STATIC_ALIGN_BYTES=16 -DEIGEN_MALLOC_ALREADY_ALIGNED=1.");
static_assert(
    !Eigen::Matrix3d::IsRowMajor && sizeof(Eigen::Index) == 8,
    "The gpo library needs Eigen's column-major matrices and 64-bit indices. Compile without "
    "EIGEN_DEFAULT_TO_ROW_MAJOR and EIGEN_DEFAULT_DENSE_INDEX_TYPE.");
