// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "app/commands/commands.h"
#include "app/python/bindings.h"
#include "engine/base/error.h"
#include "engine/experiment/row.h"
#include "engine/experiment/runner.h"
#include "engine/files/text_file.h"
#include "engine/inspection/inspector.h"
#include "engine/inspection/report/report.h"

#include <limits>
#include <thread>

#include <pybind11/eigen.h>
#include <pybind11/stl.h>
#include <unistd.h>

namespace gpo {
namespace {

namespace fs = std::filesystem;

struct Result : Solved {
  explicit Result(std::shared_ptr<const Inspection> inspection)
      : Solved{{inspection, &*inspection->initialization},
               inspection->window,
               {inspection->tracks, &inspection->tracks->ids},
               {inspection, inspection->inertial ? &*inspection->inertial : nullptr}},
        shared(std::move(inspection)) {}
  std::shared_ptr<const Inspection> shared;
};

Result run(const RecordingOrPath& recording, const py::kwargs& given) {
  const SharedRecording open = opened(recording);
  const Settings settings = settings_of(given);
  return Result(interruptible(
      [&](const std::stop_token& stop) { return Inspector(open).inspect(settings, stop); }));
}

py::object json_of(const Result& result) {
  return py::module_::import("json").attr("loads")(json_text(to_json(*result.shared), 0));
}

py::object metrics_of(const Result& result) {
  return result.shared->evaluation ? py::object(json_of(result)["metrics"]) : py::none();
}

/// Returns (timestamp_ns, ids, pixels) of each frame, the input of `initialize`.
py::list frames_of(const Result& result) {
  py::list frames;
  const auto& tracks = result.shared->tracks;
  for (int i = 0; tracks && i < tracks->frame_count(); ++i) {
    std::vector<int> seen;
    std::vector<std::int64_t> ids;
    for (int j = 0; j < tracks->track_count(); ++j) {
      if (!tracks->seen(i, j)) continue;
      seen.push_back(j);
      ids.push_back(tracks->ids[j]);
    }
    const Eigen::MatrixX2d pixels = tracks->raw_px[i](Eigen::all, seen).transpose();
    frames.append(py::make_tuple(result.shared->recording->timestamps_ns[tracks->start + i],
                                 py::array_t<std::int64_t>(std::ssize(ids), ids.data()),
                                 pixels));
  }
  return frames;
}

template <class T>
constexpr bool kIsNumber =
    std::is_same_v<T, std::optional<int>> || std::is_same_v<T, std::optional<double>>;

/// Returns a structured array of rows: numbers as float64 (NaN if unknown), other columns as text.
py::object table_of(const std::vector<Row>& rows) {
  py::list types;
  visit_row(rows.front(), [&]<class T>(const char* name, const T&) {
    types.append(py::make_tuple(name, kIsNumber<T> ? "f8" : "O"));
  });
  py::list lines;
  for (const Row& row : rows) {
    py::list line;
    visit_row(row, [&]<class T>(const char*, const T& value) {
      if constexpr (kIsNumber<T>)
        line.append(value ? static_cast<double>(*value) : std::numeric_limits<double>::quiet_NaN());
      else if constexpr (IsSettingColumn<T>)
        line.append(setting_cell(value.settings, value.setting));
      else
        line.append(value);
    });
    lines.append(py::tuple(line));
  }
  return py::module_::import("numpy").attr("array")(lines, py::arg("dtype") = types);
}

struct Scratch {
  fs::path folder;
  Scratch() : folder(fs::temp_directory_path() / "gpo-XXXXXX") {
    std::string name = folder.string();
    if (mkdtemp(name.data()) == nullptr) throw InputError(name + ": cannot be created");
    folder = name;
  }
  ~Scratch() {
    std::error_code none;
    fs::remove_all(folder, none);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
};

py::object evaluated(const std::vector<RecordingOrPath>& recordings,
                     const std::string& methods,
                     const std::string& lengths,
                     const std::string& starts,
                     std::uint64_t seed,
                     int jobs) {
  std::vector<SharedRecording> all;
  all.reserve(recordings.size());
  for (const RecordingOrPath& recording : recordings) all.push_back(opened(recording));
  if (all.empty()) throw InputError("evaluate: needs at least one recording");
  const Experiment experiment = plan_experiment(all,
                                                {.configurations = parse_configurations(methods),
                                                 .lengths = parse_ranges(lengths, "lengths"),
                                                 .starts = parse_ranges(starts, "starts"),
                                                 .seed = seed});
  const Scratch scratch;
  const auto rows = interruptible([&](const std::stop_token& stop) {
    RunOptions options;
    options.jobs = jobs > 0 ? jobs : static_cast<int>(std::thread::hardware_concurrency());
    options.stop = stop;
    return run_experiment(experiment, all, scratch.folder, options)
               ? collect_rows(experiment, std::span(&scratch.folder, 1))
               : std::vector<Row>{};
  });
  return table_of(rows);
}

py::array snapshot(const RecordingOrPath& recording,
                   const std::string& view,
                   std::optional<int> frame,
                   std::optional<std::pair<int, int>> size,
                   const std::optional<std::string>& methods,
                   const py::kwargs& given) {
  const ViewRequest request{
      .view = view,
      .frame = frame,
      .size = size ? std::optional(cv::Size(size->first, size->second)) : std::nullopt,
      .methods = methods,
      .lengths = {},
      .window = settings_of(given)};
  const SharedRecording open = opened(recording);
  return view_image(interruptible(
      [&](const std::stop_token& stop) { return draw_view(open, request, stop).image; }));
}

}  // namespace

void bind_results(py::module_& module) {
  py::class_<Result, Solved>(
      module, "Result", "One initialization of a recording's window, with its input.")
      .def_property_readonly(
          "method", [](const Result& r) { return r.shared->settings.options.method.key(); })
      .def_property_readonly("frames",
                             &frames_of,
                             "[(timestamp_ns, ids (n,), raw pixels (n, 2))], the input of "
                             "`initialize`")
      .def_property_readonly(
          "metrics", &metrics_of, "None without ground truth, else as in the JSON")
      .def_property_readonly("json", &json_of, "output of `run --json` as a dict")
      .def("__str__", [](const Result& r) { return to_text(*r.shared); })
      .def("__repr__", [](const Result& r) {
        return fmt::format("<gpo.Result {} on {}: {}>",
                           r.shared->settings.options.method.key(),
                           r.shared->recording->name,
                           r.initialization->ok ? "ok" : r.initialization->reason);
      });
  module.def("run",
             &run,
             py::arg("recording"),
             "Initializes once, like `gpo-inspector run`. Settings are those of the command line "
             "with _: start, frames, method, rotations, planes, preset, ... Raises InputError. If "
             "the window cannot be initialized, the Result is not ok and has the reason.");
  module.def(
      "evaluate",
      &evaluated,
      py::arg("recordings"),
      py::arg("methods") = "all",
      py::arg("lengths") = "10:60:10",
      py::arg("starts") = "0:end:10",
      py::arg("seed") = 1,
      py::arg("jobs") = 0,
      "Compares methods on many windows, like `gpo-inspector evaluate`. Returns a structured "
      "array with the columns of results.csv; numbers are float64, NaN if unknown. jobs=0: "
      "one per processor.");
  module.def("snapshot",
             &snapshot,
             py::arg("recording"),
             py::arg("view") = "image",
             py::arg("frame") = py::none(),
             py::arg("size") = py::none(),
             py::arg("methods") = py::none(),
             "Draws one view without a display, like `gpo-inspector snapshot`. Returns (H, W, 3) "
             "uint8, BGR. view: image, scene, normals, compare, curves or window.");
}

}  // namespace gpo
