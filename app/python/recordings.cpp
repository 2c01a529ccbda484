// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// The part of the Python module that opens recordings.
#include "app/recordings/recordings.h"

#include "app/python/bindings.h"
#include "app/terminal/terminal.h"
#include "engine/base/error.h"
#include "engine/exports/exports.h"
#include "engine/files/budget.h"
#include "engine/files/text_file.h"
#include "engine/inspection/inspector.h"
#include "engine/inspection/report/report.h"

#include <limits>
#include <optional>

#include <fmt/format.h>

namespace gpo {
namespace {

using namespace py::literals;

struct Result : Solved {
  Result() = default;
  explicit Result(std::shared_ptr<const Inspection> inspection)
      : Solved{{},
               {inspection, &*inspection->initialization},
               inspection->window,
               {inspection->tracks, &inspection->tracks->ids},
               {inspection, inspection->inertial ? &*inspection->inertial : nullptr}},
        shared(std::move(inspection)) {}
  std::shared_ptr<const Inspection> shared;
};

Result run(const RecordingOrPath& recording, const py::kwargs& given) {
  const SharedRecording open = opened(recording);
  const Request request = request_of(given);
  Result result(
      interruptible([open, settings = request.settings_for(*open)](const std::stop_token& stop) {
        return Inspector(open).inspect(settings, stop);
      }));
  check_chosen(*result.shared);
  return result;
}

py::object python_json(const Inspection& inspection) {
  return py::module_::import("json").attr("loads")(json_text(to_json(inspection), 0));
}

/// Returns the output of `run --json` for tracks without a recording.
py::object json_of_tracks(const TrackedWindow& tracked) {
  const WindowResult& result = *tracked.shared;
  auto recording = std::make_shared<Recording>();
  recording->name = "tracks";
  recording->camera = tracked.camera;
  recording->camera_source =
      tracked.options.camera_is_guess ? CameraSource::guess : CameraSource::file;
  recording->timestamps_ns = result.window.timestamps_ns;
  auto tracks = std::make_shared<Tracks>();
  tracks->ids = result.ids;
  Inspection inspection;
  inspection.recording = std::move(recording);
  inspection.settings.frames = result.window.frame_count();
  inspection.settings.options = tracked.options;
  inspection.rotations_used = result.rotations;
  inspection.rotations_note = result.rotations_note;
  inspection.tracks = std::move(tracks);
  inspection.window = tracked.window;
  inspection.initialization = tracked.initialization;
  inspection.inertial = result.inertial;
  inspection.findings = result.findings;
  return python_json(inspection);
}

py::object json_of(const Result& result) { return python_json(*result.shared); }

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

py::array frame_image(const OpenRecording& open, int frame) {
  const SharedRecording& recording = open.shared;
  if (!recording->images) throw InputError(recording->name + " has no images");
  const int count = recording->frame_count();
  if (frame < 0 || frame >= count)
    throw py::index_error(
        fmt::format("frame {} of {}, which has {}", frame, recording->name, count));
  return view_image(
      interruptible([recording, frame](const auto&) { return recording->images->bgr(frame); }));
}

py::object gyroscope_arrays(const OpenRecording& open) {
  const SharedRecording& recording = open.shared;
  if (!recording->gyroscope) return py::none();
  const Gyroscope& gyro = *recording->gyroscope;
  const auto vectors = [&](const std::vector<Eigen::Vector3d>& all) -> py::object {
    if (all.empty()) return py::none();
    return view_vectors(all, recording);
  };
  const auto& body = recording->T_body_camera;
  return frozen(py::dict("timestamps_ns"_a = view_integers(gyro.timestamps_ns, recording),
                         "rates_rad_s"_a = vectors(gyro.rates_rad_s),
                         "accelerations_m_s2"_a = vectors(gyro.accelerations_m_s2),
                         "R_gyro_camera"_a = gyro.R_gyro_camera,
                         "time_offset_ns"_a = gyro.time_offset_ns,
                         "bias_rad_s"_a = gyro.bias_rad_s,
                         "bias_sigma_rad_s"_a = gyro.bias_sigma_rad_s,
                         "bias_known"_a = gyro.bias_known,
                         "noise_density"_a = gyro.noise_density,
                         "p_gyro_camera_m"_a = body ? std::optional(body->p_wc) : std::nullopt));
}

/// Returns None or the true poses, NaN for frames without a pose.
py::object truth_of(const OpenRecording& open) {
  const SharedRecording& recording = open.shared;
  if (!recording->truth) return py::none();
  auto poses = std::make_shared<std::vector<Pose>>();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const auto& pose : recording->truth->poses)
    poses->push_back(
        pose.value_or(Pose{Eigen::Matrix3d::Constant(nan), Eigen::Vector3d::Constant(nan)}));
  py::dict result;
  result["R_wc"] = view_members<Pose>(*poses, &Pose::R_wc, poses);
  result["p_wc"] = view_members<Pose>(*poses, &Pose::p_wc, poses);
  if (recording->plane) {
    result["normal"] = recording->plane->normal;
    result["distance"] = recording->plane->distance;
  }
  return frozen(result);
}

OpenRecording open_with_options(const std::filesystem::path& path,
                                const std::map<std::string, std::string>& topics,
                                const std::optional<double>& limits) {
  if (limits && !(*limits >= 1))
    throw InputError(fmt::format("limits: found {}, expected a number of at least 1", *limits));
  if (limits) set_limits(*limits);
  std::vector<std::string> texts;
  for (const auto& [role, name] : topics) texts.push_back(role + "=" + name);
  OpenOptions options;
  options.topics = parse_topic_choices(texts);
  return {
      interruptible([path, options](const std::stop_token&) { return open_given(path, options); }),
      topics,
      limits};
}

void bind_recording(py::module_& module) {
  using Open = OpenRecording;
  py::class_<Open> recording(module, "Recording", "A recorded sequence. Arrays are read-only.");
  recording.attr("__module__") = "gpo";
  recording.def_property_readonly("name", [](const Open& r) { return r.shared->name; })
      .def_property_readonly("layout", [](const Open& r) { return r.shared->layout; })
      .def_property_readonly("path", [](const Open& r) { return r.shared->path.string(); })
      .def_property_readonly("notes", [](const Open& r) { return r.shared->notes; })
      .def("__len__", [](const Open& r) { return r.shared->frame_count(); })
      .def_property_readonly(
          "timestamps_ns",
          [](const Open& r) { return view_integers(r.shared->timestamps_ns, r.shared); },
          "(N,) int64 [ns]")
      .def_property_readonly(
          "camera", [](const Open& r) { return r.shared->camera; }, "Camera with K and lens")
      .def_property_readonly(
          "camera_source",
          [](const Open& r) { return std::string(to_string(r.shared->camera_source)); },
          "file, self-calibrated or guess")
      .def("frame", &frame_image, py::arg("frame"), "(H, W, 3) uint8, BGR, read-only")
      .def_property_readonly("gyroscope",
                             &gyroscope_arrays,
                             "None, or {timestamps_ns (M,), rates_rad_s (M, 3), accelerations_m_s2 "
                             "(M, 3) or None, R_gyro_camera (3, 3), time_offset_ns, bias_rad_s "
                             "(3,), bias_sigma_rad_s, "
                             "bias_known, noise_density [rad/s/sqrt(Hz)], p_gyro_camera_m (3,) or "
                             "None}")
      .def_property_readonly(
          "truth",
          &truth_of,
          "None, or {R_wc (N, 3, 3), p_wc (N, 3) [m], normal (3,), distance [m]}; "
          "NaN where a frame has no pose")
      .def("__repr__",
           [](const Open& r) {
             const Recording& it = *r.shared;
             return fmt::format(
                 "<gpo.Recording {}: {}, {} frames>", it.name, it.layout, it.frame_count());
           })
      .def(py::pickle(
          [](const Open& r) {
            return std::tuple(
                std::filesystem::absolute(r.shared->path).string(), r.topics, r.limits);
          },
          [](const std::tuple<std::string,
                              std::map<std::string, std::string>,
                              std::optional<double>>& state) {
            return std::apply(open_with_options, state);
          }))
      .def("__copy__", [](const Open& r) { return r; })
      .def("__deepcopy__", [](const Open& r, const py::dict&) { return r; });
}

void bind_open(py::module_& module) {
  module.def(
      "open",
      &open_with_options,
      py::arg("path"),
      py::arg("topics") = std::map<std::string, std::string>(),
      py::arg("limits") = std::nullopt,
      "Opens any recording or recipe that the command line accepts. `topics` are those of a bag by "
      "role, like --topic: {'image': '/cam0/image_raw'}. `limits` multiplies "
      "the limits for the sizes of inputs from now on, in the whole process, like --limits; inf: "
      "no limits. Raises InputError.");
}

/// Returns the remarks on the written export.
ExportNotes export_result(const Result& result,
                          const std::string& format,
                          const std::filesystem::path& path,
                          bool metric,
                          double cube_side) {
  if (!result.shared)
    throw InputError(
        "export: this result is a copy or was restored, without its recording. Run again to "
        "export");
  check_within("cube_side", cube_side, 0, 1e6);
  const ExportRequest request{&export_format(format), path};
  check_export(request);
  return interruptible(
      [shared = result.shared, choices = ExportChoices{metric, cube_side}, request](
          const std::stop_token&) { return write_export(*shared, choices, request); });
}

std::vector<std::pair<std::string, std::string>> formats_with_help() {
  std::vector<std::pair<std::string, std::string>> rows;
  for (const ExportFormat& format : export_formats()) rows.emplace_back(format.key, format.help);
  return rows;
}

void bind_export(py::class_<Result, Solved>& result, py::module_& module) {
  result.def("export",
             &export_result,
             "format"_a,
             "path"_a,
             "metric"_a = false,
             "cube_side"_a = 0.0,
             "Writes the result for another program, like `run --export FORMAT=PATH`; see "
             "`export_formats`. `metric`: in meters by the accelerometer; cube_side [plane "
             "distances], 0: the default. Returns remarks, one line each. Raises InputError.");
  module.def(
      "export_formats", &formats_with_help, "[(format, help)], the formats of `Result.export`");
}

void bind_result(py::module_& module) {
  py::class_<Result, Solved> result(
      module, "Result", "One initialization of a recording's window, with its input.");
  const AddField add{result};
  add("method", [](const Result& r) { return r.shared->settings.options.method.key(); });
  add(
      "recording",
      [](const Result& r) { return r.shared->recording->name; },
      "the recording's name");
  add("frames",
      &frames_of,
      "[(timestamp_ns, ids (n,), raw pixels (n, 2))], the input of `initialize`");
  add("metrics", &metrics_of, "None without ground truth, else as in the JSON");
  add(
      "findings",
      [](const Result& result) { return json_of(result)["findings"].cast<py::list>(); },
      "what speaks against inputs and result, as in the JSON");
  add("json", &json_of, "output of `run --json` as a dict");
  add(
      "text", [](const Result& r) { return to_text(*r.shared); }, "the table that `run` prints");
  add_saving(result);
  bind_export(result, module);
  result.def("__str__", [](const py::object& self) { return self.attr("text"); })
      .def("__repr__", [](const py::object& self) {
        const bool ok = self.attr("ok").cast<bool>();
        return fmt::format("<gpo.Result {} on {}: {}>",
                           self.attr("method").cast<std::string>(),
                           self.attr("recording").cast<std::string>(),
                           ok ? "ok" : self.attr("reason").cast<std::string>());
      });
  module.def("run",
             &run,
             py::arg("recording"),
             "Initializes once, like `gpo-inspector run`. Settings are those of the command line "
             "with _: start, frames, method, rotations, planes, preset, ... `method` may be a "
             "callable, see `evaluate`; so may method_command, method_timeout, method_resample "
             "and result be given. Raises InputError. If the window cannot be initialized, the "
             "Result is not ok and has the reason.");
  module.def("_json_of_tracks", &json_of_tracks);
}

}  // namespace

SharedRecording opened(const RecordingOrPath& recording) {
  if (const auto* open = std::get_if<OpenRecording>(&recording)) return open->shared;
  return interruptible([path = std::get<std::filesystem::path>(recording)](const std::stop_token&) {
    return open_given(path);
  });
}

}  // namespace gpo

PYBIND11_MODULE(_recordings, module) {
  pybind11::module_::import("gpo._gpo");  // the base classes
  gpo::silence_libraries();
  gpo::bind_recording(module);
  gpo::bind_open(module);
  gpo::bind_result(module);
  gpo::bind_evaluate(module);
}
