// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "app/python/bindings.h"

#include "engine/base/error.h"

#include <fmt/format.h>

namespace gpo {
namespace {

/// Adds a method named like the callable. Returns its name.
std::string add_callable(const py::object& callable, MethodTable& table) {
  Method method = callable_method(callable, static_cast<int>(table.own().size()));
  const std::string name = method.key;
  table.add(std::move(method));
  return name;
}

/// Returns a keyword's texts: one, a list, or a dict of names and texts. Removes it.
std::vector<std::string> take_texts(py::kwargs& given, const char* key) {
  if (!given.contains(key)) return {};
  const py::object value = given.attr("pop")(key);
  if (value.is_none()) return {};
  if (py::isinstance<py::str>(value)) return {value.cast<std::string>()};
  std::vector<std::string> texts;
  if (py::isinstance<py::dict>(value)) {
    for (const auto& [name, text] : py::dict(value))
      texts.push_back(fmt::format("{}={}", std::string(py::str(name)), std::string(py::str(text))));
  } else {
    for (const py::handle text : value) texts.push_back(py::str(text));
  }
  return texts;
}

}  // namespace

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

void check_within(const char* name, double value, double least, double most) {
  if (!(value >= least && value <= most))
    throw InputError(fmt::format("{}: {}, expected {} to {}", name, value, least, most));
}

OwnMethods take_methods(py::kwargs& given) {
  MethodArguments arguments;
  arguments.specs = {take_texts(given, "method_command"), take_texts(given, "result")};
  if (given.contains("method_timeout")) {
    arguments.timeout_s = given.attr("pop")("method_timeout").cast<double>();
    check_within("method_timeout", arguments.timeout_s, 0.01, 1e5);
  }
  if (given.contains("method_resample"))
    arguments.resample = given.attr("pop")("method_resample").cast<bool>();
  return OwnMethods(arguments);
}

std::string methods_text(const py::object& methods, MethodTable& table) {
  if (py::isinstance<py::str>(methods)) return methods.cast<std::string>();
  if (PyCallable_Check(methods.ptr()) != 0) return add_callable(methods, table);
  std::string list;
  for (const py::handle one : methods)
    list +=
        (list.empty() ? "" : ",") + methods_text(py::reinterpret_borrow<py::object>(one), table);
  return list;
}

Request request_of(py::kwargs given) {
  Request request{take_methods(given), {}, {}};
  for (const auto& [key, value] : given) request.given.push_back(py::cast<std::string>(key));
  if (given.contains("method") && !given["method"].is_none())
    given["method"] = methods_text(given["method"], request.own.table);
  request.settings = settings_of(given, request.own.table);
  return request;
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
