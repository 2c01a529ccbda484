// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// The part of the Python module that draws: it alone loads the libraries of the window.
#include "app/commands/commands.h"
#include "app/python/bindings.h"
#include "engine/experiment/runner.h"

namespace gpo {
namespace {

py::array snapshot(const RecordingOrPath& recording,
                   const std::string& view,
                   std::optional<int> frame,
                   std::optional<std::pair<int, int>> size,
                   const std::optional<std::string>& methods,
                   const py::kwargs& given) {
  const Request wanted = request_of(given);
  const py::object open = py::module_::import("gpo").attr("open");
  const auto* given_open = std::get_if<OpenRecording>(&recording);
  const SharedRecording shared =
      given_open != nullptr
          ? given_open->shared
          : open(std::get<std::filesystem::path>(recording)).cast<OpenRecording>().shared;
  const ViewRequest request{
      .view = view,
      .frame = frame,
      .size = size ? std::optional(cv::Size(size->first, size->second)) : std::nullopt,
      .methods = methods,
      .lengths = {},
      .window = wanted.settings_for(*shared),
      .table = wanted.own.table};
  return view_image(interruptible([shared, request](const std::stop_token& stop) {
    return draw_view(shared, request, stop).image;
  }));
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
  module.def("_write_evaluation", &gpo::write_finished);
}
