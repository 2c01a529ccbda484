// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// The part of the Python module that draws: it alone loads the libraries of the window.
#include "app/commands/commands.h"
#include "app/python/bindings.h"
#include "engine/experiment/runner.h"
#include "ui/workbench/actions/actions.h"

namespace gpo {
namespace {

OpenRecording open_in_python(const RecordingOrPath& recording) {
  if (const auto* open = std::get_if<OpenRecording>(&recording)) return *open;
  const py::object open = py::module_::import("gpo").attr("open");
  return open(std::get<std::filesystem::path>(recording)).cast<OpenRecording>();
}

py::array snapshot(const RecordingOrPath& recording,
                   const std::string& view,
                   std::optional<int> frame,
                   std::optional<std::pair<int, int>> size,
                   const std::optional<std::string>& methods,
                   const py::kwargs& given) {
  const Request wanted = request_of(given);
  const SharedRecording shared = open_in_python(recording).shared;
  const ViewRequest request{
      .view = view,
      .frame = frame,
      .size =
          size ? std::optional(image_size(fmt::format("{}x{}", size->first, size->second), "size"))
               : std::nullopt,
      .methods = methods,
      .lengths = {},
      .window = wanted.settings_for(*shared),
      .table = wanted.own.table};
  return view_image(interruptible([shared, request](const std::stop_token& stop) {
    return draw_view(shared, request, stop).image;
  }));
}

ReportRecording report_recording(const RecordingOrPath& recording) {
  const OpenRecording open = open_in_python(recording);
  ReportRecording made{.path = open.shared->path, .recording = open.shared};
  for (const auto& [role, name] : open.topics) made.topics[choice<TopicRole>(role)] = name;
  return made;
}

bool report(const std::variant<RecordingOrPath, std::vector<RecordingOrPath>>& recordings,
            const std::filesystem::path& output,
            const py::object& methods,
            const py::kwargs& given) {
  Request wanted = request_of(given);
  ReportRequest request{.recordings = {}, .methods = {}, .window = wanted.settings};
  request.given = wanted.given;
  if (!methods.is_none()) request.methods = methods_text(methods, wanted.own.table);
  request.table = wanted.own.table;
  if (const auto* one = std::get_if<RecordingOrPath>(&recordings))
    request.recordings.push_back(report_recording(*one));
  else
    for (const RecordingOrPath& each : std::get<std::vector<RecordingOrPath>>(recordings))
      request.recordings.push_back(report_recording(each));
  return interruptible([request, output](const std::stop_token& stop) {
    const WrittenReport written = make_report(request, stop);
    write_output(output, written.page);
    return written.ok;
  });
}

void write_finished(const std::filesystem::path& folder) {
  OwnMethods own({});
  own.add_shards({folder});
  interruptible([folder, table = own.table](const std::stop_token&) {
    write_evaluation(folder, read_experiment(folder, table), std::nullopt);
    return true;
  });
}

}  // namespace
}  // namespace gpo

PYBIND11_MODULE(_views, module) {
  pybind11::module_::import("gpo._recordings");  // the class Recording
  module.def("snapshot",
             &gpo::snapshot,
             pybind11::arg("recording"),
             pybind11::arg("view") = "image",
             pybind11::arg("frame") = pybind11::none(),
             pybind11::arg("size") = pybind11::none(),
             pybind11::arg("methods") = pybind11::none(),
             "Draws one view without a display, like `gpo-inspector snapshot`. Returns (H, W, 3) "
             "uint8, BGR. view: image, scene, normals, compare, curves or window.");
  module.def(
      "report",
      &gpo::report,
      pybind11::arg("recordings"),
      pybind11::arg("output"),
      pybind11::arg("methods") = pybind11::none(),
      "Writes an HTML report of one or more recordings, like `gpo-inspector report`. Returns "
      "whether at least one initialization succeeded.");
  module.def("_write_evaluation", &gpo::write_finished);
}
