// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "app/commands/commands.h"
#include "engine/base/error.h"
#include "engine/experiment/recording_tables.h"
#include "engine/experiment/runner.h"
#include "engine/files/csv_table.h"
#include "engine/files/output_file.h"
#include "engine/files/text_file.h"
#include "ui/views/charts/charts.h"

#include <algorithm>
#include <chrono>
#include <cstdio>

#include <opencv2/core/utility.hpp>

namespace gpo {
namespace {

using Clock = ReportTimer::Clock;
using Recordings = std::vector<std::shared_ptr<const Recording>>;

struct EvaluateArguments {
  std::vector<fs::path> recordings, merge;
  TopicChoices topics;
  std::string methods = "all", lengths = "5:60:5", starts = "0:end:10";
  int jobs = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  int timing_jobs = 1;
  std::size_t cache_mib = FrameCache::kDefaultByteLimit >> 20;
  std::uint64_t seed = 1;
  std::optional<std::string> shard, figure_width;
  bool bare_figures = false;
  fs::path output;
};

Recordings open_all(const EvaluateArguments& arguments) {
  resolve_recordings(arguments.recordings);  // all recipes at once
  // Recordings that no job works on cache no frames.
  const auto jobs = static_cast<std::size_t>(std::max(arguments.jobs, arguments.timing_jobs));
  const std::size_t cache_bytes =
      (arguments.cache_mib << 20) / std::clamp<std::size_t>(jobs, 1, arguments.recordings.size());
  Recordings recordings;
  for (const fs::path& path : arguments.recordings) {
    recordings.push_back(
        open_given(path,
                   {.tracks = {}, .cache_bytes = cache_bytes, .topics = arguments.topics},
                   false,
                   kAllFrames));
    for (const std::string& note : recordings.back()->notes)
      fmt::print(stderr, "{}: {}\n", recordings.back()->name, note);
  }
  return recordings;
}

/// Prints "evaluating 132/432 windows, 3:10 left", in one line on a terminal, else every 10 s.
class ProgressLine {
 public:
  void operator()(const ExperimentProgress& progress) {
    const auto now = Clock::now();
    const bool last = progress.done == progress.of;
    const bool first = std::exchange(first_, false);
    if (!terminal_ && !first && !last && !report_timer_.due(now)) return;
    const std::string rest = last ? "" : left(progress.share, now - begin_);
    const char *start = terminal_ ? "\r" : "", *end = terminal_ && !last ? "    " : "\n";
    const auto [done, of] = std::pair(progress.done, progress.of);
    fmt::print(stderr, "{}evaluating {}/{} windows{}{}", start, done, of, rest, end);
  }

 private:
  static std::string left(double share, Clock::duration spent) {
    if (share <= 0) return "";
    const double seconds = std::chrono::duration<double>(spent).count() * (1 - share) / share;
    const std::int64_t whole = std::lround(seconds);
    return fmt::format(", {}:{:02} left", whole / 60, whole % 60);
  }

  const bool terminal_ = progress_is_watched();
  const Clock::time_point begin_ = Clock::now();
  ReportTimer report_timer_{begin_};
  bool first_ = true;
};

/// Parses e.g. "85mm" [mm]. Throws InputError.
std::optional<double> parse_width(const std::optional<std::string>& text) {
  if (!text) return std::nullopt;
  constexpr double kMin_mm = 50, kMax_mm = 400;
  const bool has_unit = text->ends_with("mm");
  const auto width =
      has_unit ? parse_number(std::string_view(*text).substr(0, text->size() - 2)) : std::nullopt;
  if (width && *width >= kMin_mm && *width <= kMax_mm) return width;
  throw InputError(fmt::format(
      "--figure-width: '{}', expected {}mm to {}mm, e.g. 85mm", *text, kMin_mm, kMax_mm));
}

void write_figure(const fs::path& folder,
                  const Figure& figure,
                  const std::optional<double>& width_mm) {
  constexpr double kPrint_dpi = 300;
  const FigureSheet sheet = width_mm ? printed_sheet(figure, *width_mm)
                                     : screen_sheet(figure, default_figure_size(figure));
  const double px_per_unit = width_mm ? sheet.unit_mm / 25.4 * kPrint_dpi : 1;
  write_image(folder / (figure.name + ".png"), figure_image(figure, sheet, px_per_unit));
  write_file(folder / (figure.name + ".svg"), figure_svg(figure, sheet));
  write_file(folder / (figure.name + ".pdf"), figure_pdf(figure, sheet));
}

/// Returns the table of a finished run; empty if it has none.
std::string time_offsets_markdown(const fs::path& file) {
  if (!fs::exists(file)) return "";
  Table table{.caption =
                  "Time offsets of other programs' results, recording minus result, estimated "
                  "from rotations; those that are not applied affect the errors",
              .header = {},
              .lines = {}};
  read_quoted_csv(file, [&](int, const std::vector<std::string>& cells) {
    if (table.header.empty())
      table.header = cells;
    else if (cells.size() == table.header.size())
      table.lines.push_back(cells);
  });
  return "\n" + to_markdown(table);
}

void write_results(const EvaluateArguments& arguments, const Experiment& experiment) {
  const auto rows = write_evaluation(
      arguments.output, experiment, arguments.figure_width, arguments.bare_figures);
  fmt::print("{}", to_text(overview_table(rows)));
  fmt::print(
      "{}: {} x {} in results.csv; summary.json, errors.md, errors_by_recording.tex, "
      "running_time.md, figures\n",
      arguments.output.string(),
      counted(rows.size() / experiment.configurations.size(), "window"),
      counted(experiment.configurations.size(), "configuration"));
}

void check_usage(const EvaluateArguments& arguments) {
  if (arguments.recordings.empty() == arguments.merge.empty())
    throw InputError("evaluate: expected either recordings or --merge DIR...");
  if (arguments.shard && !arguments.merge.empty())
    throw InputError("evaluate: expected either --shard or --merge");
  parse_width(arguments.figure_width);
  check_experiment_folder(arguments.output);
}

int run(const EvaluateArguments& arguments, const MethodTable& methods) {
  const ExperimentRequest request{
      .configurations = parse_configurations(arguments.methods, methods),
      .lengths = parse_ranges(arguments.lengths, "lengths"),
      .starts = parse_ranges(arguments.starts, "starts"),
      .seed = arguments.seed};
  const Shard shard = arguments.shard ? parse_shard(*arguments.shard) : Shard{};
  cv::setNumThreads(1);  // reported running times are those of one thread
  const Recordings recordings = open_all(arguments);
  const Experiment experiment = plan_experiment(recordings, request);
  for (const std::string& note : notes_of(experiment)) fmt::print(stderr, "{}\n", note);
  const std::string output = arguments.output.string();
  ProgressLine line;
  const RunOptions options{
      .jobs = arguments.jobs,
      .timing_jobs = arguments.timing_jobs,
      .shard = shard,
      .stop = current_stop(),
      .progress = std::ref(line),
      .note = [](const std::string& note) { fmt::print(stderr, "{}\n", note); }};
  if (!run_experiment(experiment, recordings, arguments.output, options)) throw Stopped{};
  if (!arguments.shard) {
    write_results(arguments, experiment);
    return kDone;
  }
  fmt::print("{}: shard {} is finished. After all shards: evaluate --merge {} ... --output DIR\n",
             output,
             *arguments.shard,
             output);
  return kDone;
}

int evaluate(const EvaluateArguments& arguments, const MethodTable& methods) {
  check_usage(arguments);
  try {
    if (arguments.merge.empty()) return run(arguments, methods);
  } catch (const Stopped&) {
    fmt::print(stderr,
               "\nstopped; run the same command again to continue ({})\n",
               arguments.output.string());
    return kFailed;
  }
  write_results(arguments, merge_experiments(arguments.merge, arguments.output, methods));
  return kDone;
}

}  // namespace

std::vector<Row> write_evaluation(const fs::path& folder,
                                  const Experiment& experiment,
                                  const std::optional<std::string>& figure_width,
                                  bool bare_figures) {
  const std::optional<double> width_mm = parse_width(figure_width);
  std::vector<Row> rows = collect_rows(experiment, std::span(&folder, 1));
  if (rows.empty()) throw InputError(fmt::format("{}: no window was evaluated", folder.string()));
  const Table times = running_time_table(rows);
  write_file(folder / "results.csv", to_csv(rows));
  write_file(folder / "summary.json", json_text(to_json(experiment, rows), 1));
  write_file(folder / "errors.md",
             to_markdown(overview_table(rows)) + recordings_markdown(rows) +
                 time_offsets_markdown(folder / "time_offsets.csv"));
  write_file(folder / "errors.csv", to_csv(overview_numbers(rows)));
  write_file(folder / "errors_by_recording.csv", recordings_csv(rows));
  write_file(folder / "errors_by_recording.tex", recordings_latex(rows));
  write_file(folder / "running_time.md", to_markdown(times));
  write_file(folder / "running_time.csv", to_csv(times));
  const auto write_all = [&](const fs::path& to, std::vector<Figure> all) {
    make_folder(to);
    for (Figure& figure : all) {
      check_stop();
      if (bare_figures) figure.title = figure.note = "";
      write_figure(to, figure, width_mm);
    }
  };
  write_all(folder / "figures", figures(rows, experiment.configurations));
  if (experiment.recordings.size() > 1)
    write_all(folder / "figures" / "by_recording",
              recording_figures(rows, experiment.configurations));
  return rows;
}

RunCommand add_evaluate(CLI::App& app) {
  const auto to = std::make_shared<EvaluateArguments>();
  CLI::App& command = *app.add_subcommand(
      "evaluate",
      "Compares methods on many windows: results.csv, summary.json, figures and running times. "
      "After an interruption (exit code 1), the same command continues");
  command.add_option("recording", to->recordings, "Folders or files of recordings, or recipes");
  add_topics(command, to->topics);
  command
      .add_option(
          "--methods",
          to->methods,
          "Comma-separated methods, each with the settings that differ from its defaults: " +
              configuration_syntax() + "; all: every method and the paper's ablations")
      ->capture_default_str();
  command.add_option("--lengths", to->lengths, "Window lengths [frames], FROM:TO:STEP")
      ->capture_default_str();
  command
      .add_option("--starts",
                  to->starts,
                  "First frames of the windows; end: the last one that fits the longest window")
      ->capture_default_str();
  command.add_option("--seed", to->seed, "Seed of the random number generators")
      ->capture_default_str()
      ->check(CLI::Range(std::uint64_t{0}, std::uint64_t{1'000'000'000}));
  command.add_option("--jobs", to->jobs, "Number of starts to compute in parallel")
      ->capture_default_str()
      ->check(CLI::Range(1, 1024));
  command
      .add_option("--timing-jobs",
                  to->timing_jobs,
                  "The same for the windows that running_time.md measures, at the end")
      ->capture_default_str()
      ->check(CLI::Range(1, 1024));
  add_cache(command, to->cache_mib);
  command.add_option(
      "--shard",
      to->shard,
      "K/N: compute only the K-th of N shares of the windows; --merge then writes the "
      "results. Shards may run on different machines and share a folder");
  command.add_option("--merge",
                     to->merge,
                     "Folders of all shards, instead of recordings: writes the results of one run");
  command.add_option("--figure-width",
                     to->figure_width,
                     "Print width of the figures, e.g. 85mm or 175mm; text is at least 7 pt");
  command.add_flag("--bare-figures",
                   to->bare_figures,
                   "Leaves out the title and the note of the figures, for a caption in print");
  command.add_option("--output", to->output, "Folder to write")->required();
  return [to](OwnMethods& own, Interrupt& /*interrupt*/) {
    own.add_shards(to->merge);
    return evaluate(*to, own.table);
  };
}

}  // namespace gpo
