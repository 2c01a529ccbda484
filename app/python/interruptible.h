// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <future>
#include <stop_token>

#include <pybind11/pybind11.h>

namespace gpo {

/// `work(stop_token)` on another thread, without the interpreter's lock; Ctrl-C stops it and is
/// raised as KeyboardInterrupt. What the work throws is thrown here.
template <class Work>
auto interruptible(Work work) {
  namespace py = pybind11;
  std::stop_source stop;
  auto result =
      std::async(std::launch::async, [&work, token = stop.get_token()] { return work(token); });
  for (bool done = false; !done;) {
    {
      const py::gil_scoped_release others_may_run;
      done = result.wait_for(std::chrono::milliseconds(20)) == std::future_status::ready;
    }
    if (done || PyErr_CheckSignals() == 0) continue;
    stop.request_stop();
    {
      const py::gil_scoped_release others_may_run;
      result.wait();
    }
    throw py::error_already_set();
  }
  return result.get();
}

}  // namespace gpo
