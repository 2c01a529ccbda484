// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/work/export_writer.h"

#include "engine/base/error.h"

#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gpo {

ExportWriter::ExportWriter(std::function<void()> changed)
    : job_([this] { return next(); }, std::move(changed)) {}

void ExportWriter::add(PendingExport pending) {
  const auto lock = job_.lock();
  pending_.push_back(std::move(pending));
  job_.wake();
}

std::vector<WrittenExport> ExportWriter::take() {
  const auto lock = job_.lock();
  return std::exchange(written_, {});
}

bool ExportWriter::busy() const {
  const auto lock = job_.lock();
  return job_.busy() || !pending_.empty() || !written_.empty();
}

void ExportWriter::cancel() {
  const auto lock = job_.lock();
  pending_.clear();
  job_.cancel();
}

BackgroundJob::Job ExportWriter::next() {
  if (pending_.empty()) return nullptr;
  PendingExport pending = std::move(pending_.front());
  pending_.pop_front();
  return [this, pending = std::move(pending)](const std::stop_token& stop) {
    WrittenExport written{pending.request.path};
    try {
      written.notes = write_export(*pending.inspection, pending.choices, pending.request);
    } catch (const InputError& error) {
      written.error = error.what();
    }
    job_.publish(stop, [&] { written_.push_back(std::move(written)); });
  };
}

void synchronize(WorkbenchState& state, ExportWriter& writer) {
  const bool writes = writer.busy() || !state.requests.exports.empty();
  if (writes && std::exchange(state.requests.cancel, false)) {
    state.requests.exports.clear();
    writer.cancel();
    say(state, "Export canceled. The incomplete file was deleted");
  }
  for (PendingExport& pending : std::exchange(state.requests.exports, {})) {
    say(state, fmt::format("writing {}", pending.request.path.string()));
    writer.add(std::move(pending));
  }
  for (const WrittenExport& written : writer.take()) {
    const std::string path = written.path.string();
    if (written.error.empty())
      say(state, fmt::format("saved {}: {}", path, fmt::join(written.notes, ". ")));
    else
      say(state, written.error, Severity::error);
  }
}

void request_export(WorkbenchState& state, const ExportFormat& format, const fs::path& path) {
  if (!state.results.inspection) throw InputError("no result to export yet");
  const ExportRequest request{&format, path};
  check_export(request);
  state.requests.exports.push_back(
      {state.results.inspection,
       {.metric = state.document.metric, .cube_side = state.document.cube_side},
       request});
}

}  // namespace gpo
