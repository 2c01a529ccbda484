// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// Initializers of the user as keywords: callables, commands and results of other programs.
#include "app/python/bindings.h"

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

}  // namespace gpo
