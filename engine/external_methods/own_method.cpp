// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/external_methods/own_method.h"

#include "engine/base/choice.h"
#include "engine/base/error.h"
#include "engine/base/stop.h"
#include "engine/files/refuse.h"
#include "engine/files/text_file.h"
#include "engine/process/child_process.h"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <mutex>
#include <sstream>
#include <system_error>

#include <nlohmann/json.hpp>
#include <zlib.h>

namespace gpo {
namespace {

constexpr std::array<std::uint32_t, 6> kOwnColors{
    0x9B30FF, 0xFF4FA3, 0x7FBF00, 0x00B5AD, 0xB22222, 0x5C4BD6};

std::vector<std::string> texts_in(const nlohmann::ordered_json& json,
                                  const fs::path& file,
                                  const char* key) {
  if (!json.contains(key)) return {};
  std::vector<std::string> texts;
  const auto& list = json.at(key);
  const auto fail = [&] { refuse(file, "{}: expected a list of strings, NAME=...", key); };
  if (!list.is_array()) fail();
  for (const auto& one : list) {
    if (!one.is_string()) fail();
    texts.push_back(one.get<std::string>());
  }
  return texts;
}

using Clock = std::chrono::steady_clock;

constexpr std::size_t kMaxLine = 300;

struct Worker {
  explicit Worker(const std::string& command) : process(command) {}
  ChildProcess process;
  int questions = 0;
};

class Program {
 public:
  Program(NamedText command, CommandOptions options)
      : command_(std::move(command)), options_(std::move(options)) {}

  Initialization initialize(const Window& window, const Sources& sources, const Watch& watch) {
    if (options_.allowed && !*options_.allowed)
      return failed(command_.name +
                    ": not started: only a session names the command; --allow-commands starts it");
    try {
      return ask(window, sources, watch);
    } catch (const std::exception& error) {
      return failed(fmt::format("{}: {}", command_.name, message_of(error)));
    }
  }

 private:
  std::unique_ptr<Worker> take() {
    while (true) {
      std::unique_ptr<Worker> worker;
      {
        const std::lock_guard lock(mutex_);
        if (idle_.empty()) break;
        worker = std::move(idle_.back());
        idle_.pop_back();
      }
      if (worker->process.is_in_step()) return worker;
    }
    return std::make_unique<Worker>(command_.text);
  }

  void give_back(std::unique_ptr<Worker> worker) {
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(worker));
  }

  ProcessReply send(Worker& worker, nlohmann::ordered_json& question, const Watch& watch) const {
    question["id"] = ++worker.questions;
    ProcessReply reply =
        worker.process.ask(json_text(question, -1), {.time = options_.time_limit}, watch.stop);
    log(reply.error_output);
    return reply;
  }

  void log(const std::string& lines) const {
    if (!options_.on_line) return;
    constexpr int kMaxLines = 20;
    int count = 0;
    for (const std::string& line : split(lines, '\n'))
      if (count <= kMaxLines)
        options_.on_line(command_.name, count++ < kMaxLines ? legible(line, kMaxLine) : "...");
  }

  std::string failure_of(Worker& worker, const ProcessReply& reply) const {
    const int number = worker.questions;
    constexpr std::size_t kMiB = std::size_t{1} << 20;
    if (reply.reply == Reply::late)
      return fmt::format("no answer {} within {:g} s{}",
                         number,
                         std::chrono::duration<double>(options_.time_limit).count(),
                         reply.answer.empty() ? "" : ", only its beginning");
    if (reply.reply == Reply::too_long)
      return fmt::format(
          "answer {} is longer than {} MiB", number, ReplyLimits{}.answer_bytes / kMiB);
    const std::string_view errors = trimmed(reply.error_output);
    const std::string last = legible(errors.substr(errors.rfind('\n') + 1), kMaxLine);
    return fmt::format("{} {} answer {}{}{}",
                       worker.process.end(),
                       reply.answer.empty() ? "before" : "in the middle of",
                       number,
                       last.empty() ? "" : ": ",
                       last);
  }

  Initialization ask(const Window& window, const Sources& sources, const Watch& watch) {
    nlohmann::ordered_json question = {{"id", 0}};
    question.update(window_json(window, sources));
    const auto begin = Clock::now();
    std::unique_ptr<Worker> worker = take();
    ProcessReply reply = send(*worker, question, watch);
    // A program that answers once and ends is restarted for each window.
    if (reply.reply == Reply::ended && reply.answer.empty() && worker->questions > 1) {
      worker = std::make_unique<Worker>(command_.text);
      reply = send(*worker, question, watch);
    }
    if (reply.reply == Reply::stopped) return stopped_early();
    if (reply.reply != Reply::answered)
      return failed(fmt::format("{}: {}", command_.name, failure_of(*worker, reply)));
    const double elapsed_ms =
        std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
    const ExpectedAnswer expected{.id = worker->questions,
                                  .frames = window.frame_count(),
                                  .tracks = window.track_count(),
                                  .planes = static_cast<int>(window.planes.size())};
    Initialization result;
    try {
      const Answer answer = read_answer(reply.answer, expected);
      give_back(std::move(worker));
      result = initialization_of(window, answer);
      result.solver.milliseconds =
          std::clamp(answer.milliseconds.value_or(elapsed_ms), 0.0, elapsed_ms);
    } catch (const InputError& error) {
      // The process is not reused, because its next line may answer any question.
      return failed(fmt::format("{}: answer {}: {}", command_.name, expected.id, error.what()));
    }
    if (!result.ok) result.reason = fmt::format("{}: {}", command_.name, result.reason);
    return result;
  }

  const NamedText command_;
  const CommandOptions options_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<Worker>> idle_;
};

std::string identity_of(const std::string& command) {
  std::string identity = command;
  std::istringstream words(command);
  for (std::string word; words >> word;) {
    std::erase_if(word, [](char c) { return c == '"' || c == '\''; });
    const std::string sum = checksum_of(word);
    if (!sum.empty()) identity += " " + sum;
  }
  return identity;
}

using Ordered = nlohmann::ordered_json;

Ordered vector_json(const Eigen::VectorXd& vector) {
  if (!vector.allFinite()) return nullptr;
  return std::vector<double>(vector.begin(), vector.end());
}

Ordered matrix_json(const Eigen::Matrix3d& matrix) {
  if (!matrix.allFinite()) return nullptr;
  Ordered rows = Ordered::array();
  for (int i = 0; i < 3; ++i) rows.push_back(vector_json(matrix.row(i).transpose()));
  return rows;
}

Ordered list_json(const auto& values, auto json_of) {
  Ordered list = Ordered::array();
  for (const auto& value : values) list.push_back(json_of(value));
  return list;
}

Ordered plane_json(const WindowPlane& plane) {
  return {{"tracks", plane.tracks},
          {"picture_share", plane.image_share},
          {"homographies", list_json(plane.H_i1, matrix_json)}};
}

Ordered gyroscope_json(const Gyroscope& gyroscope, const Window& window) {
  const auto& times = gyroscope.timestamps_ns;
  const auto after =
      std::ranges::upper_bound(times, window.timestamps_ns.front() + gyroscope.time_offset_ns);
  const auto beyond =
      std::ranges::lower_bound(times, window.timestamps_ns.back() + gyroscope.time_offset_ns);
  const auto first = std::max<std::ptrdiff_t>(0, after - times.begin() - 1);
  const auto end = std::min(std::ssize(times), beyond - times.begin() + 1);
  Ordered json = {{"timestamps_ns", Ordered::array()}, {"rates_rad_s", Ordered::array()}};
  for (auto i = first; i < end; ++i) {
    json["timestamps_ns"].push_back(times[i]);
    json["rates_rad_s"].push_back(vector_json(gyroscope.rates_rad_s[i]));
  }
  json["R_gyro_camera"] = matrix_json(gyroscope.R_gyro_camera);
  json["time_offset_ns"] = gyroscope.time_offset_ns;
  json["bias_rad_s"] = vector_json(gyroscope.bias_rad_s);
  return json;
}

Ordered camera_json(const Camera& camera) {
  return {{"width", camera.width},
          {"height", camera.height},
          {"intrinsics", {camera.fx, camera.fy, camera.cx, camera.cy}},
          {"distortion", lens_model(camera.distortion).name},
          {"coefficients", camera.coefficients}};
}

void add_images(const Sources& sources, const Window& window, Ordered& json) {
  const auto name = [](const fs::path& file) {
    std::error_code none;
    return fs::absolute(file, none).string();
  };
  if (std::ssize(sources.images) == window.frame_count())
    json["pictures"] = list_json(sources.images, name);
  else if (sources.images.size() == 1)
    json["video"] = name(sources.images.front());
}

}  // namespace

NamedText parse_named(const std::string& text, const char* option, const char* expected) {
  const std::size_t equals = text.find('=');
  const std::string name = text.substr(0, equals);
  constexpr std::size_t kMaxLength = 40;
  const bool fits =
      !name.empty() && name.size() <= kMaxLength && std::ranges::all_of(name, [](unsigned char c) {
        return std::isalnum(c) != 0 || c == '_' || c == '-';
      });
  const bool has_text =
      equals != std::string::npos && text.find_first_not_of(" \t", equals + 1) != std::string::npos;
  if (!fits || !has_text || name == "all")
    refuse(option, "'{}', expected {}, the name of letters, digits, _ and -", text, expected);
  return {name, text.substr(equals + 1)};
}

Method own_method(const std::string& name,
                  int number,
                  decltype(Method::initialize_from) initialize_from,
                  std::string identity) {
  Method method{};
  method.key = method.title = name;
  method.rgb = kOwnColors[static_cast<std::size_t>(number) % kOwnColors.size()];
  method.family = MethodFamily::optimization;
  method.needs_plane = false;
  method.inliers = Inliers::planes;
  method.rotations = RotationModel::free;
  method.initialize_from = std::move(initialize_from);
  method.initialize = [from = method.initialize_from](const Window& window,
                                                      const MethodOptions& /*options*/,
                                                      const Watch& watch) {
    return from(window, {}, watch);
  };
  method.identity = std::move(identity);
  method.number = number;
  return method;
}

std::string checksum_of(const fs::path& path) {
  std::error_code none;
  if (!fs::is_regular_file(path, none)) return "";
  std::ifstream file(path, std::ios::binary);
  std::array<char, 65'536> buffer{};
  uLong sum = crc32(0, nullptr, 0);
  while (file.read(buffer.data(), buffer.size()) || file.gcount() > 0) {
    check_stop();
    sum =
        crc32(sum, reinterpret_cast<const Bytef*>(buffer.data()), static_cast<uInt>(file.gcount()));
  }
  return fmt::format("{:08x}", sum);
}

MethodSpecs specs_in(const MethodTable& methods) {
  MethodSpecs specs;
  for (const auto& method : methods.own()) {
    if (!method->command.empty()) specs.commands.push_back(method->command);
    if (!method->result.empty()) specs.results.push_back(method->result);
  }
  return specs;
}

std::string with_whole_paths(const std::string& result) {
  const std::size_t equals = result.find('=');
  std::string whole = result.substr(0, equals);
  char before = '=';
  for (const std::string& part : split(result.substr(equals + 1), ',')) {
    std::error_code none;
    const bool file = !part.empty() && !part.starts_with("frame=") &&
                      !part.starts_with("offset=") && !part.starts_with("scale=");
    whole += std::exchange(before, ',') + (file ? fs::absolute(part, none).string() : part);
  }
  return whole;
}

MethodSpecs methods_in_session(const fs::path& file) {
  const auto json = read_json(file);
  if (!json.is_object()) return {};
  return {texts_in(json, file, "method_commands"), texts_in(json, file, "results")};
}

NamedText parse_method_command(const std::string& text) {
  return parse_named(text, "--method-command", "NAME='COMMAND'");
}

Method command_method(const NamedText& command, const CommandOptions& options, int number) {
  const auto program = std::make_shared<Program>(command, options);
  Method method = own_method(
      command.name,
      number,
      [program](const Window& window, const Sources& sources, const Watch& watch) {
        return program->initialize(window, sources, watch);
      },
      identity_of(command.text));
  method.resampled = options.resampled;
  return method;
}

Ordered window_json(const Window& window, const Sources& sources) {
  const auto same = [](const auto& value) { return Ordered(value); };
  const auto columns = [](const auto& points) { return list_json(points.colwise(), vector_json); };
  Ordered json = {{"start", window.start},
                  {"K", matrix_json(window.K)},
                  {"timestamps_ns", window.timestamps_ns},
                  {"tracks", list_json(window.points_px, columns)},
                  {"inliers", list_json(window.inlier, same)},
                  {"all_tracks", window.all_tracks},
                  {"homographies", list_json(window.H_i1, matrix_json)},
                  {"planes", list_json(window.planes, plane_json)},
                  {"leading_plane", window.leader},
                  {"rotations", list_json(window.R_wc, matrix_json)},
                  {"rotations_are", to_string(window.rotations)}};
  if (sources.gyroscope != nullptr) json["gyroscope"] = gyroscope_json(*sources.gyroscope, window);
  if (sources.camera != nullptr) json["camera"] = camera_json(*sources.camera);
  add_images(sources, window, json);
  return json;
}

}  // namespace gpo
