// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "app/python/bindings.h"

#include "engine/base/error.h"

#include <fmt/format.h>

namespace gpo {

py::object frozen(py::object value) {
  const auto freeze = [](const py::handle& one) {
    frozen(py::reinterpret_borrow<py::object>(one));
  };
  if (py::isinstance<py::dict>(value)) {
    for (const auto& [key, one] : py::dict(value)) freeze(one);
  } else if (py::isinstance<py::list>(value) || py::isinstance<py::tuple>(value)) {
    for (const py::handle one : value) freeze(one);
  } else if (py::isinstance<py::array>(value)) {
    value.attr("setflags")(py::arg("write") = false);
  }
  return value;
}

py::dict dict_of(const py::object& self) {
  py::dict fields;
  for (const py::handle name : self.attr("_fields")) fields[name] = self.attr(name);
  return fields;
}

std::string setting_text_of(py::object value) {
  const bool is_text = py::isinstance<py::str>(value);
  if (!is_text && py::hasattr(value, "dtype") && value.attr("ndim").cast<int>() == 0)
    value = value.attr("item")();  // NumPy's bool and numbers
  if (py::isinstance<py::bool_>(value)) return value.cast<bool>() ? "on" : "off";
  if (is_text || !py::isinstance<py::sequence>(value)) return py::str(value);
  std::string list;
  for (const py::handle one : value)
    list += (list.empty() ? "" : ",") + setting_text_of(py::reinterpret_borrow<py::object>(one));
  return list;
}

Settings settings_of(const py::kwargs& given, const MethodTable& methods) {
  Settings settings;
  if (given.contains("preset") && !given["preset"].is_none())
    settings =
        with_preset(std::move(settings), choice<Preset>(std::string(py::str(given["preset"]))));
  for (const auto& [key, value] : given) {
    const std::string name = py::str(key);
    if (name == "preset" || value.is_none()) continue;
    const std::string text = setting_text_of(py::reinterpret_borrow<py::object>(value));
    settings = with_setting(std::move(settings), name, text, methods);
  }
  return settings;
}

void abandon(std::shared_ptr<void> work) {
  static std::vector<std::shared_ptr<void>> all;
  if (all.empty())
    py::module_::import("atexit").attr("register")(py::cpp_function([] {
      const py::gil_scoped_release it_may_need_python;
      all.clear();
    }));
  all.push_back(std::move(work));
}

}  // namespace gpo
