// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// The Python module `gpo`: the engine and views of the program.
#include "app/python/bindings.h"
#include "app/terminal/output.h"
#include "engine/base/error.h"
#include "engine/inspection/settings/setting_values.h"

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
  gpo::silence_libraries();
  py::register_exception<gpo::InputError>(module, "InputError", PyExc_ValueError);
  module.attr("__version__") = GPO_VERSION;
  gpo::bind_solved(module);
  gpo::bind_recording(module);
  gpo::bind_initialize(module);
  gpo::bind_results(module);
}
