// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/joint/self_product.h"

#include "engine/base/processor.h"

#include <algorithm>
#include <cstring>

namespace gpo::joint {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using FourDoubles = double __attribute__((vector_size(32)));
constexpr Index kTile = 4;  // columns at a time; the rows of a panel are in two registers

[[gnu::always_inline]] inline void subtract(const Panels& H, MatrixXd& A) {
  const Index n = A.rows();
  const Index columns = H.cols() / panel_count(n);
  for (Index first = 0; first < n; first += kPanel) {
    for (Index column = 0; column < std::min(first + kPanel, n); column += kTile) {
      FourDoubles upper[kTile] = {}, lower[kTile] = {};
      const double* rows = H.data() + first * columns;
      const double* others = H.data() + place_in_panel(column, columns);
      for (Index k = 0; k < columns; ++k, rows += kPanel, others += kPanel) {
        FourDoubles a, b;
        std::memcpy(&a, rows, sizeof(a));
        std::memcpy(&b, rows + 4, sizeof(b));
#pragma GCC unroll 4
        for (Index c = 0; c < kTile; ++c) {
          upper[c] += a * others[c];
          lower[c] += b * others[c];
        }
      }
      for (Index c = 0; c < std::min(kTile, n - column); ++c)
        for (Index r = 0; r < std::min(kPanel, n - first); ++r)
          A(first + r, column + c) -= r < 4 ? upper[c][r] : lower[c][r - 4];
    }
  }
}

GPO_AVX2_FMA void subtract_avx2_fma(const Panels& H, MatrixXd& A) { subtract(H, A); }

}  // namespace

void subtract_self_product(const Panels& H, MatrixXd& A) {
  if (has_avx2_fma())
    subtract_avx2_fma(H, A);
  else
    subtract(H, A);
}

}  // namespace gpo::joint
