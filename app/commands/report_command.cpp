// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "app/commands/commands.h"
#include "engine/base/error.h"
#include "engine/experiment/experiment.h"
#include "engine/inspection/inspector.h"
#include "ui/views/report/report.h"

#include <algorithm>

namespace gpo {
namespace {

struct ReportArguments {
  InspectArguments inspect;
  std::vector<fs::path> further;
  std::optional<std::string> methods;
  fs::path output;
};

std::vector<Configuration> reported_configurations(const ReportRequest& request) {
  if (request.methods) return parse_configurations(*request.methods, request.table);
  return {configuration_of(request.window)};
}

/// Inspects with every configuration; the first one is the section's own.
std::vector<Compared> inspect_all(Inspector& inspector,
                                  const std::vector<Configuration>& configurations,
                                  const Settings& base,
                                  const std::stop_token& stop) {
  std::vector<Compared> all;
  for (const Configuration& one : configurations) {
    const Settings settings = apply(one, base);
    all.push_back({one, settings, inspector.inspect(settings, stop)});
    if (!all.back().inspection) throw Stopped{};
  }
  return all;
}

std::vector<Figure> report_figures(const ReportRecording& opened,
                                   const Inspection& inspection,
                                   const ReportRequest& request,
                                   const std::stop_token& stop) {
  std::vector<Figure> figures{growth_figure(inspection)};
  const int frames = inspection.window->frame_count();
  if (frames < kFewestFramesForCurves) return figures;
  const ViewRequest curves{
      .view = "curves",
      .frame = {},
      .size = {},
      .methods = request.methods.value_or(key_of(configuration_of(inspection.settings))),
      .lengths = {},
      .window = inspection.settings,
      .table = request.table};
  DrawnView drawn;
  figures.push_back(curves_over_length(opened.recording, curves, drawn, stop));
  return figures;
}

ReportSection section_of(const ReportRecording& opened,
                         const ReportRequest& request,
                         const std::stop_token& stop) {
  const auto configurations = reported_configurations(request);
  const Settings base = with_window_within(
      base_of(configurations, request.window), request.given, opened.recording->frame_count());
  Inspector inspector(opened.recording);
  std::vector<Compared> all = inspect_all(inspector, configurations, base, stop);
  const auto inspection = all.front().inspection;
  ReportSection section = drawn_section(inspection);
  if (request.methods) section.methods = std::move(all);
  section.figures = report_figures(opened, *inspection, request, stop);
  section.found =
      to_text(found_in(opened.recording)) + to_text(describe_topics(opened.path, opened.topics));
  section.command = report_command(opened.path,
                                   opening_options(*opened.recording, opened.tracks, opened.topics),
                                   base,
                                   request.methods ? configurations : std::vector<Configuration>{});
  return section;
}

void check(const ReportArguments& arguments) {
  if (arguments.output.extension() != ".html")
    throw InputError(fmt::format("--output: '{}', expected a file name that ends in .html",
                                 arguments.output.string()));
  std::vector<NamedFile> inputs{{"--tracks", arguments.inspect.tracks},
                                {"recording", arguments.inspect.recording}};
  for (const fs::path& one : arguments.further) inputs.push_back({"recording", one});
  check_outputs({{"--output", arguments.output}}, inputs);
  if (arguments.inspect.tracks && !arguments.further.empty())
    throw InputError("--tracks: belongs to one recording; report one recording, not several");
}

int write_report(const ReportArguments& arguments, const MethodTable& methods) {
  check(arguments);
  ReportRequest request{.recordings = {},
                        .methods = arguments.methods,
                        .window = arguments.inspect.settings,
                        .given = arguments.inspect.given,
                        .table = methods};
  InspectArguments one = arguments.inspect;
  std::vector<fs::path> paths{one.recording};
  paths.insert(paths.end(), arguments.further.begin(), arguments.further.end());
  for (const fs::path& path : paths) {
    one.recording = path;
    request.recordings.push_back(
        {.path = path, .recording = open(one), .topics = one.topics, .tracks = one.tracks});
    check_not_overwritten(*request.recordings.back().recording, {{"--output", arguments.output}});
  }
  const WrittenReport report = make_report(request, current_stop());
  const auto configurations = reported_configurations(request);
  report_unused(arguments.inspect.given,
                report.inspections,
                request.methods ? configurations : std::vector<Configuration>{});
  write_output(arguments.output, report.page);
  fmt::print("{}: {}, {:.1f} MB\n",
             arguments.output.string(),
             counted(paths.size(), "recording"),
             1e-6 * static_cast<double>(report.page.size()));
  for (const auto& inspection : report.inspections)
    if (!inspection->initialization->ok)
      fmt::print(stderr,
                 "{}: initialization failed: {}\n",
                 inspection->recording->name,
                 inspection->initialization->reason);
  return report.ok ? kDone : kFailed;
}

}  // namespace

WrittenReport make_report(const ReportRequest& request, const std::stop_token& stop) {
  if (request.recordings.empty()) throw InputError("report: no recording is given");
  Report report{.sections = {}, .program = program_identity()};
  WrittenReport written;
  for (const ReportRecording& opened : request.recordings) {
    report.sections.push_back(section_of(opened, request, stop));
    const ReportSection& section = report.sections.back();
    written.inspections.push_back(section.inspection);
    written.ok |= section.inspection->initialization->ok ||
                  std::ranges::any_of(section.methods, [](const Compared& one) {
                    return one.inspection->initialization->ok;
                  });
  }
  written.page = report_page(report);
  return written;
}

RunCommand add_report(CLI::App& app) {
  const auto to = std::make_shared<ReportArguments>();
  CLI::App& command = *app.add_subcommand(
      "report", "Writes one HTML file to send: verdict, images, a scene to turn, tables");
  add_tracks_and_recording(command, to->inspect)->required();
  command.add_option("more", to->further, "Further recordings, compared in one table");
  command.add_option("--output", to->output, "HTML file to write, at most 5 MB")->required();
  command.add_option("--methods",
                     to->methods,
                     "Comma-separated methods to compare, each with changed settings: " +
                         configuration_syntax() + "; the first is shown");
  return [to](OwnMethods& own, Interrupt& /*interrupt*/) {
    find_method(to->inspect, own.table);
    return write_report(*to, own.table);
  };
}

}  // namespace gpo
