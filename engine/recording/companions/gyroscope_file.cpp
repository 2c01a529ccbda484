// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/companions/gyroscope_file.h"

#include "engine/files/text_file.h"

#include <numbers>

namespace gpo {
namespace {

double rad_s_per_unit(const CsvTable& table) {
  if (table.header.empty()) return 1;
  const std::string name = lower_case(table.header[1]);
  const bool degrees =
      name.find("deg") != std::string::npos || name.find("dps") != std::string::npos;
  return degrees ? std::numbers::pi / 180 : 1;
}

/// Columns 4 to 6 where the header, if there is one, calls them a...
bool has_accelerations(const CsvTable& table) {
  return table.columns >= 7 && (table.header.empty() || lower_case(table.header[4])[0] == 'a');
}

}  // namespace

Gyroscope read_gyroscope(const std::filesystem::path& file, TimeUnit unit) {
  const CsvTable table = read_csv(file, {"timestamp", "wx", "wy", "wz"}, CsvColumns::at_least);
  Gyroscope gyroscope;
  gyroscope.file = file;
  gyroscope.timestamps_ns = csv_time_stamps(table, unit);
  gyroscope.lines.reserve(table.rows.size());
  gyroscope.rates_rad_s.reserve(table.rows.size());
  const double scale = rad_s_per_unit(table);
  const bool accelerations = has_accelerations(table);
  const auto vector = [&](const CsvRow& row, int column) {
    return Eigen::Vector3d(csv_number(table, row, column),
                           csv_number(table, row, column + 1),
                           csv_number(table, row, column + 2));
  };
  for (const auto& row : table.rows) {
    gyroscope.lines.push_back(row.line);
    gyroscope.rates_rad_s.emplace_back(scale * vector(row, 1));
    if (accelerations) gyroscope.accelerations_m_s2.push_back(vector(row, 4));
  }
  return gyroscope;
}

}  // namespace gpo
