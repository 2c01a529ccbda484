// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/benchmark/peak.h"

#include "engine/base/processor.h"

namespace gpo::bench {
namespace {

using Vector = double __attribute__((vector_size(32)));
constexpr int kChains = 10;  // two units of four cycles' latency need eight
constexpr int kSteps = static_cast<int>(kPeakOperations) / (kChains * 8);

[[gnu::always_inline]] inline double multiply_add() {
  Vector sum[kChains] = {};
  const volatile double half = 0.5;  // not known to the compiler
  const Vector factor = {half, half, half, half};
  for (int step = 0; step < kSteps; ++step) {
    for (Vector& chain : sum) chain = chain * factor + factor;
  }
  for (int k = 1; k < kChains; ++k) sum[0] += sum[k];
  return sum[0][0] + sum[0][1] + sum[0][2] + sum[0][3];
}

[[gnu::target("avx2,fma")]] double multiply_add_avx2_fma() { return multiply_add(); }

}  // namespace

double peak_operations() { return has_avx2_fma() ? multiply_add_avx2_fma() : multiply_add(); }

}  // namespace gpo::bench
