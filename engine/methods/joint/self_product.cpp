// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/joint/self_product.h"

#include "engine/base/processor.h"

#include <algorithm>
#include <cstring>
#include <vector>

namespace gpo::joint {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using FourDoubles = double __attribute__((vector_size(32)));
constexpr Index kPanel = 2 * 4;  // rows at a time, in two registers
constexpr Index kTile = 4;       // columns at a time

/// Returns the panels of rows one after the other, the last one padded by zeros.
std::vector<double> packed(const MatrixXd& H) {
  const Index panels = (H.rows() + kPanel - 1) / kPanel;
  std::vector<double> all(panels * kPanel * H.cols());
  for (Index p = 0; p < panels; ++p) {
    const Index rows = std::min(kPanel, H.rows() - p * kPanel);
    for (Index k = 0; k < H.cols(); ++k)
      std::copy_n(&H(p * kPanel, k), rows, &all[(p * H.cols() + k) * kPanel]);
  }
  return all;
}

GPO_AVX2_FMA void subtract_avx2_fma(const MatrixXd& H, MatrixXd& A) {
  const std::vector<double> all = packed(H);
  const Index n = H.rows();
  for (Index first = 0; first < n; first += kPanel) {
    for (Index column = 0; column < std::min(first + kPanel, n); column += kTile) {
      FourDoubles upper[kTile] = {}, lower[kTile] = {};
      const double* rows = &all[first * H.cols()];
      const double* others = &all[column / kPanel * kPanel * H.cols() + column % kPanel];
      for (Index k = 0; k < H.cols(); ++k, rows += kPanel, others += kPanel) {
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

}  // namespace

void subtract_self_product(const MatrixXd& H, MatrixXd& A) {
  if (has_avx2_fma())
    subtract_avx2_fma(H, A);
  else
    A.selfadjointView<Eigen::Lower>().rankUpdate(H, -1);
}

}  // namespace gpo::joint
