// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "app/commands.h"
#include "app/interrupt.h"
#include "app/recordings.h"
#include "engine/base/error.h"
#include "engine/experiment/experiment.h"
#include "engine/experiment/figures.h"
#include "engine/experiment/runner.h"
#include "engine/experiment/summary.h"
#include "engine/experiment/tables.h"
#include "engine/experiment/window_files.h"
#include "engine/files/json_text.h"
#include "engine/files/output_file.h"
#include "ui/views/charts/figure_view.h"

#include <chrono>
#include <cmath>
#include <cstdio>

#include <fmt/format.h>
#include <opencv2/core/utility.hpp>
#include <unistd.h>

namespace gpo {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
using Recordings = std::vector<std::shared_ptr<const Recording>>;

/// Many recordings are open at once; neighboring windows want the same pictures.
constexpr std::size_t kCacheBytes = std::size_t{96} << 20;

Recordings open_all(const std::vector<fs::path>& paths) {
  resolve_recordings(paths);  // all recipes at once
  Recordings recordings;
  for (const fs::path& path : paths) {
    recordings.push_back(open_given(path, {.tracks = {}, .cache_bytes = kCacheBytes}));
    const Recording& recording = *recordings.back();
    for (const std::string& note : recording.notes) {
      fmt::print(stderr, "{}: {}\n", recording.name, note);
    }
  }
  return recordings;
}

/// "evaluating 132/432 windows, 3:10 left", on a terminal in one line that changes, else now and
/// then.
class ProgressLine {
 public:
  void operator()(const ExperimentProgress& progress) {
    const auto now = Clock::now();
    const bool last = progress.done == progress.of;
    if (!terminal_ && !last && now - told_ < std::chrono::seconds(20)) return;
    told_ = now;
    fmt::print(stderr,
               "{}evaluating {}/{} windows{}{}",
               terminal_ ? "\r" : "",
               progress.done,
               progress.of,
               last ? "" : left(progress.share, now - begin_),
               terminal_ && !last ? "    " : "\n");
  }

 private:
  static std::string left(double share, Clock::duration spent) {
    if (share <= 0) return "";  // nothing to judge by yet
    const double seconds = std::chrono::duration<double>(spent).count() * (1 - share) / share;
    const std::int64_t whole = std::lround(seconds);
    return fmt::format(", {}:{:02} left", whole / 60, whole % 60);
  }

  const bool terminal_ = isatty(fileno(stderr)) != 0;
  const Clock::time_point begin_ = Clock::now();
  Clock::time_point told_ = {};
};

void write_figure(const fs::path& folder, const Figure& figure) {
  const cv::Size size = default_figure_size(figure);
  write_picture(folder / (figure.name + ".png"), draw_figure(figure, size));
  write_file(folder / (figure.name + ".svg"), figure_svg(figure, size));
}

/// Everything that is made of the finished windows.
void write_results(const fs::path& folder, const Experiment& experiment) {
  const std::vector<Row> rows = collect_rows(experiment, std::span(&folder, 1));
  const Table times = running_time_table(rows);
  const Table errors = overview_table(rows);
  write_file(folder / "results.csv", to_csv(rows));
  write_file(folder / "summary.json", json_text(to_json(experiment, rows), 1));
  write_file(folder / "errors.md", to_markdown(errors));
  write_file(folder / "errors.csv", to_csv(errors));
  write_file(folder / "running_time.md", to_markdown(times));
  write_file(folder / "running_time.csv", to_csv(times));
  fmt::print("{}", to_text(errors));
  make_folder(folder / "figures");
  for (const Figure& figure : figures(rows, experiment.configurations)) {
    write_figure(folder / "figures", figure);
  }
  fmt::print(
      "{}: {} windows x {} configurations in results.csv; summary.json, errors.md, "
      "running_time.md, "
      "figures\n",
      folder.string(),
      rows.size() / experiment.configurations.size(),
      experiment.configurations.size());
}

void check_usage(const EvaluateArguments& arguments) {
  if (arguments.recordings.empty() == arguments.merge.empty()) {
    throw InputError("evaluate: expected either recordings or --merge DIR...");
  }
  if (arguments.shard && !arguments.merge.empty()) {
    throw InputError("evaluate: expected either --shard or --merge");
  }
}

int run(const EvaluateArguments& arguments) {
  const ExperimentRequest request{parse_configurations(arguments.methods),
                                  parse_ranges(arguments.lengths, "--lengths"),
                                  parse_ranges(arguments.starts, "--starts"),
                                  arguments.seed};
  const Shard shard = arguments.shard ? parse_shard(*arguments.shard) : Shard{};
  cv::setNumThreads(1);  // the times are those of one thread, whatever the jobs
  const Recordings recordings = open_all(arguments.recordings);
  const Experiment experiment = plan_experiment(recordings, request);
  for (const std::string& note : notes_of(experiment)) fmt::print(stderr, "{}\n", note);
  const std::string output = arguments.output.string();
  ProgressLine line;
  const Interrupt interrupt;
  const RunOptions options{arguments.jobs, shard, interrupt.token(), std::ref(line)};
  if (!run_experiment(experiment, recordings, arguments.output, options)) {
    fmt::print(stderr, "\nstopped; the same command goes on from there ({})\n", output);
    return kFailed;
  }
  if (!arguments.shard) {
    write_results(arguments.output, experiment);
    return kDone;
  }
  fmt::print("{}: shard {} is finished; when all are: evaluate --merge {} ... --output DIR\n",
             output,
             *arguments.shard,
             output);
  return kDone;
}

}  // namespace

int evaluate_command(const EvaluateArguments& arguments) {
  check_usage(arguments);
  if (arguments.merge.empty()) return run(arguments);
  write_results(arguments.output, merge_experiments(arguments.merge, arguments.output));
  return kDone;
}

}  // namespace gpo
