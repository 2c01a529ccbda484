// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

// The compiler's flags (-march=native, -mavx, -fsanitize=address) change how Eigen aligns and frees
// its objects. The library and its callers exchange such objects, so both must do it in the same
// way. The CMake and pkg-config packages add these options.
static_assert(
    EIGEN_MAX_STATIC_ALIGN_BYTES == 16 && EIGEN_DEFAULT_ALIGN_BYTES <= 16 &&
        EIGEN_MALLOC_ALREADY_ALIGNED == 1 &&
        sizeof(Eigen::internal::packet_traits<double>::type) <= 16,
    "Eigen's alignment differs from that of the gpo library. Compile all sources of your "
    "program that exchange Eigen's objects with -U__AVX__ -U__AVX2__ -U__AVX512F__ -U__FMA__ "
    "-DEIGEN_MALLOC_ALREADY_ALIGNED=1.");
static_assert(
    !Eigen::Matrix3d::IsRowMajor && sizeof(Eigen::Index) == 8,
    "The gpo library needs Eigen's column-major matrices and 64-bit indices. Compile without "
    "EIGEN_DEFAULT_TO_ROW_MAJOR and EIGEN_DEFAULT_DENSE_INDEX_TYPE.");
