// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/experiment/recording_tables.h"

#include "engine/base/error.h"
#include "engine/files/csv_table.h"
#include "engine/inspection/inspector.h"
#include "engine/methods/recording_method.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gpo {
namespace {

RecordingLine line_of(const std::string& recording,
                      std::span<const Row> rows,
                      const std::vector<std::string>& methods) {
  const int frames = rows.front().settings.frames;
  RecordingLine line{.recording = recording, .solved = {}};
  const std::vector<Cell> cells = summarize(rows);
  const std::vector<Cell> common = summarize(on_common_windows(rows));
  for (const std::string& method : methods) {
    const Cell cell = cell_or_empty(cells, method, frames);
    line.windows = std::max(line.windows, cell.windows);
    line.solved.push_back(cell.ok);
    line.common_cells.push_back(cell_or_empty(common, method, frames));
    line.common = std::max(line.common, line.common_cells.back().windows);
  }
  return line;
}

std::vector<NumberColumn> columns_with_values(const std::vector<RecordingLine>& lines) {
  std::vector<Cell> cells;
  for (const RecordingLine& line : lines)
    cells.insert(cells.end(), line.common_cells.begin(), line.common_cells.end());
  std::vector<NumberColumn> columns = error_columns(cells);
  std::erase_if(columns, [&](const NumberColumn& column) {
    return !has_values(cells, column.columns.front());
  });
  if (columns.empty()) columns.push_back({.title = "RMS [px]", .columns = {"rms_px"}, .digits = 3});
  return columns;
}

std::string name_of(const RecordingLine& line) { return line.all ? "all" : line.recording; }

std::vector<RecordingTable> tables_of(std::span<const Row> rows, const std::set<int>& lengths) {
  std::vector<RecordingTable> tables;
  for (const int frames : lengths) tables.push_back(recording_table(rows, frames));
  return tables;
}

/// Returns the indices of the methods with the lowest printed median; empty for a single method.
std::vector<std::size_t> best_of(const RecordingLine& line, const NumberColumn& column) {
  std::vector<std::size_t> best;
  std::optional<std::string> least_text;
  double least = 0;
  int known = 0;
  for (const Cell& cell : line.common_cells) {
    const auto& median = distribution_of(cell, column.columns.front()).median;
    if (!median) continue;
    if (known++ == 0 || *median < least) {
      least = *median;
      least_text = formatted(least, column);
    }
  }
  for (std::size_t i = 0; known > 1 && i < line.common_cells.size(); ++i) {
    const auto& median = distribution_of(line.common_cells[i], column.columns.front()).median;
    if (median && formatted(*median, column) == least_text) best.push_back(i);
  }
  return best;
}

std::string latex_cell(const Distribution& d, const NumberColumn& column, bool bold) {
  if (!d.median) return "--";
  const std::string median = formatted(*d.median, column);
  return fmt::format("{} {{\\scriptsize [{}, {}]}}",
                     bold ? "\\textbf{" + median + "}" : median,
                     formatted(*d.lower, column),
                     formatted(*d.upper, column));
}

std::string latex_block(const RecordingTable& table, const NumberColumn& column) {
  std::string text = fmt::format("    \\multicolumn{{{}}}{{l}}{{\\emph{{{}}}}} \\\\\n",
                                 table.methods.size() + 2,
                                 latex_text(column.title));
  for (const RecordingLine& line : table.lines) {
    const auto best = best_of(line, column);
    text += fmt::format("    {} & {}/{}", latex_text(name_of(line)), line.common, line.windows);
    for (std::size_t i = 0; i < table.methods.size(); ++i) {
      const bool bold = std::ranges::find(best, i) != best.end();
      text +=
          " & " +
          latex_cell(distribution_of(line.common_cells[i], column.columns.front()), column, bold);
    }
    text += " \\\\\n";
  }
  return text + "    \\midrule\n";
}

std::string latex_float(const RecordingTable& table) {
  std::vector<std::string> titles;
  for (const std::string& title : table.titles) titles.push_back(latex_text(title));
  std::string text = fmt::format(
      "\\begin{{table*}}\n"
      "  \\centering\\footnotesize\\setlength{{\\tabcolsep}}{{3pt}}\n"
      "  \\caption{{Median and quartiles of the errors over the windows of {0} frames that all "
      "methods solved.}}\n"
      "  \\label{{tab:errors-{0}}}\n"
      "  \\begin{{tabular}}{{lr{1}}}\n"
      "    \\toprule\n"
      "    Recording & Windows & {2} \\\\\n"
      "    \\midrule\n",
      table.frames,
      std::string(table.methods.size(), 'r'),
      fmt::join(titles, " & "));
  for (const NumberColumn& column : table.errors) text += latex_block(table, column);
  text += fmt::format("    \\multicolumn{{{}}}{{l}}{{\\emph{{Solved windows}}}} \\\\\n",
                      table.methods.size() + 2);
  for (const RecordingLine& line : table.lines)
    text += fmt::format("    {} & {} & {} \\\\\n",
                        latex_text(name_of(line)),
                        line.windows,
                        fmt::join(line.solved, " & "));
  return text + "    \\bottomrule\n  \\end{tabular}\n\\end{table*}\n";
}

std::string csv_number(const std::optional<double>& value, const NumberColumn& column) {
  return value ? fmt::format("{:.6g}", column.factor * *value) : "";
}

std::string milliseconds_text(const std::optional<double>& seconds) {
  return seconds ? fmt::format("{:.2f}", 1e3 * *seconds) : "";
}

}  // namespace

RecordingTable recording_table(std::span<const Row> rows, int frames) {
  const std::vector<Row> own =
      rows_where(rows, [&](const Row& row) { return row.settings.frames == frames; });
  RecordingTable table{.frames = frames,
                       .methods = unique_of(rows, &Row::configuration),
                       .titles = {},
                       .errors = {}};
  MethodTable methods;
  for (const Row& row : rows) methods.add(row.settings.options.method);
  for (const std::string& method : table.methods)
    table.titles.push_back(title_of(parse_configuration(method, methods)));
  const std::vector<std::string> recordings = unique_of(own, &Row::recording);
  for (const std::string& recording : recordings)
    table.lines.push_back(
        line_of(recording,
                rows_where(own, [&](const Row& row) { return row.recording == recording; }),
                table.methods));
  if (recordings.size() > 1) {
    table.lines.push_back(line_of("*", own, table.methods));
    table.lines.back().all = true;
  }
  table.errors = columns_with_values(table.lines);
  return table;
}

std::string recordings_markdown(std::span<const Row> rows) {
  std::string text;
  const std::set<int> lengths = lengths_in(rows);
  const RecordingTable shown =
      recording_table(rows, timed_length({lengths.begin(), lengths.end()}));
  for (const NumberColumn& column : shown.errors) {
    Table table{.caption = fmt::format("{} with {} frames: median [quartiles] over the windows "
                                       "of each recording that all methods solved",
                                       column.title,
                                       shown.frames),
                .header = {"recording", "common windows"},
                .lines = {}};
    table.header.insert(table.header.end(), shown.methods.begin(), shown.methods.end());
    for (const RecordingLine& line : shown.lines) {
      std::vector<std::string> cells{name_of(line),
                                     fmt::format("{}/{}", line.common, line.windows)};
      for (const Cell& cell : line.common_cells) {
        const Distribution d = distribution_of(cell, column.columns.front());
        cells.push_back(d.median ? fmt::format("{} [{}, {}]",
                                               formatted(*d.median, column),
                                               formatted(*d.lower, column),
                                               formatted(*d.upper, column))
                                 : "-");
      }
      table.lines.push_back(std::move(cells));
    }
    text += "\n" + to_markdown(table);
  }
  return text;
}

std::string recordings_latex(std::span<const Row> rows) {
  std::string text =
      "% Needs \\usepackage{booktabs}. A Windows column of 8/12: all methods solved 8 of 12 "
      "windows.\n";
  for (const RecordingTable& table : tables_of(rows, lengths_to_show(lengths_in(rows))))
    text += latex_float(table);
  return text;
}

std::string recordings_csv(std::span<const Row> rows) {
  const std::vector<RecordingTable> tables = tables_of(rows, lengths_in(rows));
  std::vector<NumberColumn> columns;
  for (const RecordingTable& table : tables)
    for (const NumberColumn& column : table.errors)
      if (std::ranges::find(columns, std::string(column.title), [](const NumberColumn& one) {
            return std::string(one.title);
          }) == columns.end())
        columns.push_back(column);
  std::string text = "recording,frames,method,windows,solved,common";
  for (const NumberColumn& column : columns)
    for (const char* part : {"median", "lower quartile", "upper quartile"})
      text += fmt::format(",{} {}", column.title, part);
  text += "\n";
  for (const RecordingTable& table : tables)
    for (const RecordingLine& line : table.lines)
      for (std::size_t i = 0; i < table.methods.size(); ++i) {
        text += fmt::format("{},{},{},{},{},{}",
                            csv_quoted(line.recording),
                            table.frames,
                            table.methods[i],
                            line.windows,
                            line.solved[i],
                            line.solved[i] > 0 ? line.common : 0);
        for (const NumberColumn& column : columns) {
          const Distribution d = distribution_of(line.common_cells[i], column.columns.front());
          for (const auto* value : {&d.median, &d.lower, &d.upper})
            text += "," + csv_number(*value, column);
        }
        text += "\n";
      }
  return text;
}

std::string latex_text(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '\\') {
      escaped += "\\textbackslash{}";
    } else if (c == '~') {
      escaped += "\\textasciitilde{}";
    } else if (c == '^') {
      escaped += "\\textasciicircum{}";
    } else {
      if (std::string_view("&%$#_{}").find(c) != std::string_view::npos) escaped += '\\';
      escaped += c;
    }
  }
  return escaped;
}

std::vector<Figure> recording_figures(std::span<const Row> rows,
                                      const std::vector<Configuration>& configurations) {
  std::vector<Figure> all;
  for (const std::string& recording : unique_of(rows, &Row::recording)) {
    const auto own = rows_where(rows, [&](const Row& row) { return row.recording == recording; });
    for (Figure& figure : figures(own, configurations)) {
      figure.name = recording + "_" + figure.name;
      figure.title = recording + ": " + figure.title;
      all.push_back(std::move(figure));
    }
  }
  return all;
}

Table time_offset_table(const Experiment& experiment,
                        std::span<const std::shared_ptr<const Recording>> recordings) {
  Table table{
      .caption = "Time offsets of results: recording minus result, estimated from rotations",
      .header = {"recording", "method", "offset [ms]", "sigma [ms]", "applied [ms]", "by"},
      .lines = {}};
  for (const auto& recording : recordings) {
    std::optional<RecordingFacts> facts;
    for (const Configuration& one : experiment.configurations) {
      const RecordingMethod* method = recording_method(one.method.row());
      if (method == nullptr) continue;
      if (!facts) facts = facts_for_results(*recording);
      try {
        const auto imported = method->describe(*facts);
        if (!imported) continue;
        table.lines.push_back({csv_quoted(recording->name),
                               key_of(one),
                               milliseconds_text(imported->time_offset_s),
                               milliseconds_text(imported->time_offset_sigma_s),
                               milliseconds_text(imported->applied_time_offset_s),
                               imported->clock});
      } catch (const InputError&) {  // its windows fail with this reason
      }
    }
  }
  return table;
}

}  // namespace gpo
