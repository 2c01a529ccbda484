// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// The Python module `gpo`: the same engine and views as the program's.
#include "app/python/bindings.h"
#include "engine/base/error.h"
#include "engine/inspection/settings/setting_values.h"

#include <exception>

#include <fmt/format.h>
#include <opencv2/core/ocl.hpp>
#include <opencv2/core/utils/logger.hpp>

extern "C" {
#include <libavutil/log.h>
}

namespace gpo {
namespace {

namespace py = pybind11;

std::string setting_text_of(const std::string& name, const py::handle& value) {
  if (py::isinstance<py::bool_>(value)) return value.cast<bool>() ? "on" : "off";
  if (!py::isinstance<py::str>(value) && py::isinstance<py::sequence>(value)) {
    std::string list;
    for (const py::handle one : value)
      list += (list.empty() ? "" : ",") + setting_text_of(name, one);
    return list;
  }
  return py::str(value);
}

}  // namespace

Settings settings_of(const py::kwargs& given) {
  Settings settings;
  if (given.contains("preset"))
    settings =
        with_preset(std::move(settings), choice<Preset>(std::string(py::str(given["preset"]))));
  for (const auto& [key, value] : given) {
    const std::string name = py::str(key);
    if (name == "preset" || value.is_none()) continue;
    settings = with_setting(std::move(settings), name, setting_text_of(name, value));
  }
  return settings;
}

}  // namespace gpo

PYBIND11_MODULE(_gpo, module) {
  namespace py = pybind11;
  // As the program does: what libraries would say is an exception of ours.
  cv::ocl::setUseOpenCL(false);
  cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
  av_log_set_level(AV_LOG_QUIET);
  py::register_exception<gpo::InputError>(module, "InputError", PyExc_ValueError);
  module.attr("__version__") = GPO_VERSION;
  gpo::bind_solved(module);
  gpo::bind_recording(module);
  gpo::bind_initialize(module);
  gpo::bind_results(module);
}
