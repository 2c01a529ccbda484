// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "app/python/bindings.h"

#include "engine/base/error.h"
#include "engine/external_methods/own_method.h"
#include "engine/files/text_file.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

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

using Callable = std::shared_ptr<py::object>;

/// Returns a reference that any thread may drop.
Callable shared_callable(const py::object& callable) {
  return {new py::object(callable), [](py::object* one) {
            if (!Py_IsInitialized()) return;
            const py::gil_scoped_acquire python;
            delete one;
          }};
}

/// Calls with the window as a dict. Returns the answer as JSON. Throws InputError if it raises.
std::string answer_of(const Callable& callable, const nlohmann::ordered_json& window) {
  const py::gil_scoped_acquire python;
  try {
    const py::module_ json = py::module_::import("json");
    const py::cpp_function lists([](const py::object& array) { return array.attr("tolist")(); });
    const py::object answer = (*callable)(json.attr("loads")(json_text(window, -1)));
    return py::str(json.attr("dumps")(answer, py::arg("default") = lists));
  } catch (py::error_already_set& error) {
    constexpr std::size_t kMaxLength = 300;
    const std::string text = py::str(error.value());
    const std::string type = py::str(error.type().attr("__name__"));
    throw InputError(fmt::format("{}: {}", type, legible(text, kMaxLength)));
  }
}

Initialization called(const Callable& callable,
                      const std::string& name,
                      const Window& window,
                      const Sources& sources) {
  const ExpectedAnswer expected{.frames = window.frame_count(),
                                .tracks = window.track_count(),
                                .planes = static_cast<int>(window.planes.size())};
  Initialization result;
  try {
    const auto begin = std::chrono::steady_clock::now();
    const std::string text = answer_of(callable, window_json(window, sources));
    const std::chrono::duration<double, std::milli> elapsed =
        std::chrono::steady_clock::now() - begin;
    const Answer answer = read_answer(text, expected);
    result = initialization_of(window, answer);
    result.solver.milliseconds =
        std::clamp(answer.milliseconds.value_or(elapsed.count()), 0.0, elapsed.count());
  } catch (const InputError& error) {
    return failed(fmt::format("{}: {}", name, error.what()));
  }
  if (!result.ok) result.reason = fmt::format("{}: {}", name, result.reason);
  return result;
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

Method callable_method(const py::object& callable, int number) {
  const py::str type = py::type::of(callable).attr("__name__");
  const std::string given = py::str(py::getattr(callable, "__name__", type));
  const std::string name = parse_named(given + "=python", "methods", "a callable with a name").name;
  // Its source may differ from that of an earlier run, so no window of it is reused.
  const auto now = std::chrono::system_clock::now().time_since_epoch().count();
  const auto initialize = [name, shared = shared_callable(callable)](
                              const Window& window, const Sources& sources, const Watch&) {
    return called(shared, name, window, sources);
  };
  return own_method(name, number, initialize, fmt::format("Python callable {}, {}", name, now));
}

void check_within(const char* name, double value, double least, double most) {
  if (!(value >= least && value <= most))
    throw InputError(fmt::format("{}: {}, expected {} to {}", name, value, least, most));
}

OwnMethods take_methods(py::kwargs& given) {
  MethodArguments arguments;
  arguments.specs = {take_texts(given, "method_command"), take_texts(given, "result")};
  const auto require_command = [&](const char* name) {
    if (arguments.specs.commands.empty())
      throw InputError(fmt::format("{}: applies to method_command, which is not given", name));
  };
  if (given.contains("method_timeout")) {
    arguments.timeout_s = given.attr("pop")("method_timeout").cast<double>();
    check_within("method_timeout", arguments.timeout_s, 0.01, 1e5);
    require_command("method_timeout");
  }
  if (given.contains("method_resample")) {
    arguments.resample = given.attr("pop")("method_resample").cast<bool>();
    if (arguments.resample) require_command("method_resample");
  }
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
