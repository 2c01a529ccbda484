// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "app/commands/commands.h"
#include "app/recordings/recordings.h"
#include "engine/base/error.h"
#include "ui/context/offscreen_context.h"
#include "ui/workbench/actions/actions.h"
#include "ui/workbench/commands.h"
#include "ui/workbench_host.h"

#include <utility>

#include <fmt/format.h>

namespace gpo {
namespace {

/// What was said since line `from` of the log; an error ends the script.
void tell(const WorkbenchState& state, std::size_t from) {
  for (std::size_t i = from; i < state.messages.lines.size(); ++i) {
    if (state.messages.lines[i].severity == Severity::error)
      throw InputError(state.messages.lines[i].text);
    fmt::print("{}\n", state.messages.lines[i].text);
  }
}

/// Has been on standard error already.
void keep_in_log(WorkbenchState& state, MethodLog& log) {
  for (std::string& line : log.take())
    state.messages.lines.push_back({Severity::note, std::move(line)});
}

void run(WorkbenchHost& host, OffscreenContext& context, const std::string& line) {
  const std::size_t said = host.state.messages.lines.size();
  if (!line.empty()) run_line(host.state, line);
  host.settle();
  context.bind();
  for (const Command& command : host.draw()) apply(host.state, command);
  tell(host.state, said);
}

}  // namespace

int script_command(const std::filesystem::path& script,
                   const InspectArguments& arguments,
                   cv::Size size,
                   OwnMethods& own) {
  const std::vector<ScriptLine> lines = read_script(script);
  OffscreenContext context(size.width, size.height);
  Gui gui;
  WorkbenchHost host(gui,
                     opener_for_window(arguments.cache_mib, arguments.recording, arguments.topics),
                     example_recording());
  host.timings = false;
  host.size = size;
  host.state.document.settings = arguments.settings;
  host.state.methods = own.table;
  host.link.add_methods = [&own](const std::filesystem::path& session, WorkbenchState& state) {
    own.add_session(session);
    say_not_started(own);
    state.methods = own.table;
  };
  host.link.calibrates = arguments.calibrate == "auto";
  if (!arguments.recording.empty()) host.state.requests.open = arguments.recording;
  run(host, context, "");
  for (const ScriptLine& line : lines) {
    try {
      run(host, context, line.text);
      keep_in_log(host.state, *own.log);
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}:{}: {}", script.string(), line.number, error.what()));
    }
    if (host.state.requests.quit) break;
  }
  return kDone;
}

}  // namespace gpo
