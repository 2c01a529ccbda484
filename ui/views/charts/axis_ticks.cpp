// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/charts/axis_ticks.h"

#include <algorithm>
#include <array>
#include <cstdint>

#include <fmt/format.h>

namespace gpo {
namespace {

constexpr std::array kSteps = {1.0, 2.0, 5.0};
constexpr int kFewest = 3;  ///< ticks of a readable scale

/// Returns the `index`-th of ..., 0.5, 1, 2, 5, 10, ...; the 0th is 1.
double round_number(int index) {
  const int decade = static_cast<int>(std::floor(index / 3.0));
  // 5 * 10^-2 is not 0.05 to the last bit; 5 / 10^2 is.
  const double power = std::pow(10.0, std::abs(decade));
  const double step = kSteps[index - 3 * decade];
  return decade < 0 ? step / power : step * power;
}

/// Returns the index of the largest round number that is not above `value`.
int round_number_below(double value) {
  constexpr double kSlack = 1 + 1e-9;
  int index = 3 * static_cast<int>(std::floor(std::log10(value)));
  while (round_number(index) > value * kSlack) --index;
  while (round_number(index + 1) <= value * kSlack) ++index;
  return index;
}

void add_tick(AxisTicks& ticks, double value) {
  ticks.values.push_back(value);
  ticks.labels.push_back(fmt::format("{:.10g}", value + 0.0));  // not "-0"
}

}  // namespace

AxisTicks linear_ticks(double low, double high, int most) {
  if (low == high) {
    const double room = low == 0 ? 1 : std::abs(low) / 2;
    low -= room;
    high += room;
  }
  int index = round_number_below((high - low) / most);
  const auto count = [&] {
    return std::floor(high / round_number(index)) - std::ceil(low / round_number(index)) + 1;
  };
  while (count() > most) ++index;
  while (count() < kFewest) --index;
  const double step = round_number(index);
  AxisTicks ticks{low, high, {}, {}};
  const double slack = 1e-9 * (high - low) / step;
  const auto first = static_cast<std::int64_t>(std::ceil(low / step - slack));
  const auto last = static_cast<std::int64_t>(std::floor(high / step + slack));
  for (std::int64_t k = first; k <= last; ++k)
    add_tick(ticks, std::clamp(static_cast<double>(k) * step, low, high));
  return ticks;
}

AxisTicks logarithmic_ticks(double low, double high, int most) {
  const int first = round_number_below(low);
  int last = round_number_below(high);
  if (round_number(last) < high * (1 - 1e-9) || last == first) ++last;
  AxisTicks ticks{round_number(first), round_number(last), {}, {}};
  const auto count = [&](int every) {
    return static_cast<int>(std::floor(1.0 * last / every) - std::ceil(1.0 * first / every)) + 1;
  };
  int every = 1;
  for (const int candidate : {3, 6, 9, 15, 30})
    if ((last - first) / every + 1 > most && count(candidate) >= kFewest) every = candidate;
  if (count(every) < kFewest) {
    const AxisTicks between = linear_ticks(ticks.low, ticks.high, std::max(most, kFewest));
    ticks.values = between.values;
    ticks.labels = between.labels;
    return ticks;
  }
  for (int index = first; index <= last; ++index)
    if (index % every == 0) add_tick(ticks, round_number(index));
  return ticks;
}

}  // namespace gpo
