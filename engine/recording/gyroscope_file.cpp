// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/gyroscope_file.h"

namespace gpo {

Gyroscope read_gyroscope(const std::filesystem::path& file, TimeUnit unit) {
  const CsvTable table = read_csv(file, {"timestamp", "wx", "wy", "wz"}, CsvColumns::at_least);
  Gyroscope gyroscope;
  gyroscope.file = file;
  gyroscope.timestamps_ns = csv_time_stamps(table, unit);
  gyroscope.lines.reserve(table.rows.size());
  gyroscope.rates_rad_s.reserve(table.rows.size());
  for (const auto& row : table.rows) {
    gyroscope.lines.push_back(row.line);
    gyroscope.rates_rad_s.emplace_back(
        csv_number(table, row, 1), csv_number(table, row, 2), csv_number(table, row, 3));
  }
  return gyroscope;
}

}  // namespace gpo
