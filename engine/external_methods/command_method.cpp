// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/external_methods/command_method.h"

#include "engine/base/choice.h"
#include "engine/base/error.h"
#include "engine/external_methods/answered.h"
#include "engine/external_methods/own_method.h"
#include "engine/files/json_text.h"
#include "engine/process/child_process.h"

#include <algorithm>
#include <array>
#include <mutex>
#include <sstream>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace gpo {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kLongestLine = 300;

/// The last line that is not empty.
std::string last_line(const std::string& text) {
  const std::size_t end = text.find_last_not_of(" \n\r\t");
  if (end == std::string::npos) return "";
  const std::size_t begin = text.rfind('\n', end);
  return legible(text.substr(begin == std::string::npos ? 0 : begin + 1, end - begin),
                 kLongestLine);
}

struct Worker {
  explicit Worker(const std::string& command) : process(command) {}
  ChildProcess process;
  int asked = 0;  ///< windows
};

/// A command and its processes.
class Program {
 public:
  Program(MethodCommand command, CommandOptions options)
      : command_(std::move(command)), options_(std::move(options)) {}

  Initialization initialize(const Window& window, const Sources& sources, const Watch& watch) {
    if (options_.allowed && !*options_.allowed)
      return failed(command_.name +
                    ": not started: the command is a session's; --allow-commands starts it");
    try {
      return answered(window, sources, watch);
    } catch (const std::exception& error) {
      return failed(fmt::format("{}: {}", command_.name, message_of(error)));
    }
  }

 private:
  Initialization answered(const Window& window, const Sources& sources, const Watch& watch);
  std::unique_ptr<Worker> take();
  void give_back(std::unique_ptr<Worker> worker);
  ProcessReply ask(Worker& worker, nlohmann::ordered_json& question, const Watch& watch) const;
  void tell(const std::string& said) const;
  std::string why_none(Worker& worker, const ProcessReply& reply) const;

  const MethodCommand command_;
  const CommandOptions options_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<Worker>> idle_;
};

/// One that waits for a window, else a new one.
std::unique_ptr<Worker> Program::take() {
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
  return std::make_unique<Worker>(command_.command);
}

void Program::give_back(std::unique_ptr<Worker> worker) {
  const std::lock_guard lock(mutex_);
  idle_.push_back(std::move(worker));
}

ProcessReply Program::ask(Worker& worker,
                          nlohmann::ordered_json& question,
                          const Watch& watch) const {
  question["id"] = ++worker.asked;
  ReplyLimits limits;
  limits.time = options_.time_limit;
  ProcessReply reply = worker.process.ask(json_text(question, -1), limits, watch.stop);
  tell(reply.said);
  return reply;
}

void Program::tell(const std::string& said) const {
  if (!options_.told) return;
  constexpr int kMostLines = 20;
  std::istringstream lines(said);
  int count = 0;
  for (std::string line; std::getline(lines, line) && count <= kMostLines; ++count)
    options_.told(command_.name, count < kMostLines ? legible(line, kLongestLine) : "...");
}

std::string Program::why_none(Worker& worker, const ProcessReply& reply) const {
  const int number = worker.asked;
  constexpr std::size_t kMiB = std::size_t{1} << 20;
  switch (reply.reply) {
    case Reply::late:
      return fmt::format("no answer {} within {:g} s{}",
                         number,
                         std::chrono::duration<double>(options_.time_limit).count(),
                         reply.answer.empty() ? "" : ", only the beginning of it");
    case Reply::too_long:
      return fmt::format(
          "answer {} is longer than {} MiB", number, ReplyLimits{}.answer_bytes / kMiB);
    default:
      break;
  }
  const std::string last = last_line(reply.said);
  return fmt::format("{} {} answer {}{}{}",
                     worker.process.end(),
                     reply.answer.empty() ? "before" : "in the middle of",
                     number,
                     last.empty() ? "" : ": ",
                     last);
}

Initialization Program::answered(const Window& window, const Sources& sources, const Watch& watch) {
  nlohmann::ordered_json question = {{"id", 0}};
  question.update(window_json(window, sources));
  const auto begin = Clock::now();
  std::unique_ptr<Worker> worker = take();
  ProcessReply reply = ask(*worker, question, watch);
  // Programs that answer once and end are started anew for each window.
  if (reply.reply == Reply::ended && reply.answer.empty() && worker->asked > 1) {
    worker = std::make_unique<Worker>(command_.command);
    reply = ask(*worker, question, watch);
  }
  if (reply.reply == Reply::stopped) return stopped_early();
  if (reply.reply != Reply::answered) {
    const std::string why = why_none(*worker, reply);
    return failed(fmt::format("{}: {}", command_.name, why));
  }
  const double elapsed_ms = std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
  const Asked asked{worker->asked,
                    window.frame_count(),
                    window.track_count(),
                    static_cast<int>(window.planes.size())};
  Initialization result;
  try {
    const Answer answer = read_answer(reply.answer, asked);
    give_back(std::move(worker));
    result = initialization_of(window, answer);
    result.solver.milliseconds =
        std::clamp(answer.milliseconds.value_or(elapsed_ms), 0.0, elapsed_ms);
  } catch (const InputError& error) {
    // What its next line would be an answer to is not known: it is not asked again.
    return failed(fmt::format("{}: answer {}: {}", command_.name, asked.id, error.what()));
  }
  if (!result.ok) result.reason = fmt::format("{}: {}", command_.name, result.reason);
  return result;
}

/// The command, and what is in those of its words that are files.
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

/// Null where it is not a number.
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

Ordered columns_json(const Eigen::Matrix2Xd& columns) {
  Ordered list = Ordered::array();
  for (const auto& column : columns.colwise()) list.push_back(vector_json(column));
  return list;
}

Ordered plane_json(const WindowPlane& plane) {
  return {{"tracks", plane.tracks},
          {"picture_share", plane.image_share},
          {"homographies", list_json(plane.H_i1, matrix_json)}};
}

/// The samples within the window, and one more to either side.
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
  constexpr std::array kModels{"none", "radial-tangential", "equidistant"};
  return {{"width", camera.width},
          {"height", camera.height},
          {"intrinsics", {camera.fx, camera.fy, camera.cx, camera.cy}},
          {"distortion", kModels[static_cast<std::size_t>(camera.distortion)]},
          {"coefficients", camera.coefficients}};
}

void add_images(const Sources& sources, const Window& window, Ordered& json) {
  const auto name = [](const std::filesystem::path& file) {
    std::error_code none;
    return std::filesystem::absolute(file, none).string();
  };
  if (std::ssize(sources.images) == window.frame_count())
    json["pictures"] = list_json(sources.images, name);
  else if (sources.images.size() == 1)
    json["video"] = name(sources.images.front());
}

}  // namespace

MethodCommand parse_method_command(const std::string& text) {
  auto [name, command] = parse_named(text, "--method-command", "NAME='COMMAND'");
  return {std::move(name), std::move(command)};
}

Method command_method(const MethodCommand& command, const CommandOptions& options, int number) {
  const auto program = std::make_shared<Program>(command, options);
  return own_method(
      command.name,
      number,
      [program](const Window& window, const Sources& sources, const Watch& watch) {
        return program->initialize(window, sources, watch);
      },
      identity_of(command.command));
}

Ordered window_json(const Window& window, const Sources& sources) {
  const auto same = [](const auto& value) { return Ordered(value); };
  Ordered json = {{"start", window.start},
                  {"K", matrix_json(window.K)},
                  {"timestamps_ns", window.timestamps_ns},
                  {"tracks", list_json(window.points_px, columns_json)},
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
