// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/experiment/error_columns.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace gpo {
std::string significant(double value) {
  const double size = std::abs(value);
  const int before = size > 0 ? static_cast<int>(std::floor(std::log10(size))) : 0;
  return fmt::format("{:.{}f}", value, std::clamp(2 - before, 0, 9));
}

std::string formatted(double value, const NumberColumn& column) {
  return column.digits == kSignificant
             ? significant(column.factor * value)
             : fmt::format("{:.{}f}", column.factor * value, column.digits);
}

std::vector<NumberColumn> error_columns(const std::function<bool(const char* column)>& has_values) {
  std::vector<NumberColumn> columns{{.title = "PNE [deg]", .columns = {"pne_deg"}, .digits = 3},
                                    {.title = "ATE [mm]", .columns = {"ate_m"}, .factor = 1e3},
                                    {.title = "PDE [mm]", .columns = {"pde_m"}, .factor = 1e3}};
  const bool gravity = has_values("gravity_error_deg");
  if (gravity || has_values("scale_error_percent"))
    columns.push_back({.title = "scale error [%]", .columns = {"scale_error_percent"}});
  if (gravity)
    columns.push_back({.title = "gravity error [deg]", .columns = {"gravity_error_deg"}});
  return columns;
}

std::set<int> lengths_in(std::span<const Row> rows) {
  std::set<int> lengths;
  for (const Row& row : rows) lengths.insert(row.settings.frames);
  return lengths;
}

std::set<int> lengths_to_show(const std::set<int>& all) {
  constexpr std::array kPreferred{10, 30, 60};
  if (std::ranges::includes(all, kPreferred)) return {kPreferred.begin(), kPreferred.end()};
  const std::vector<int> lengths(all.begin(), all.end());
  return {lengths.front(), lengths[lengths.size() / 2], lengths.back()};
}

}  // namespace gpo
