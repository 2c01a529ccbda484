// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// Python callables as methods. Alone, so that `initialize` links no readers of recordings.
#include "app/python/bindings.h"
#include "engine/base/error.h"
#include "engine/external_methods/own_method.h"
#include "engine/files/text_file.h"

#include <algorithm>
#include <chrono>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace gpo {
namespace {

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

}  // namespace gpo
