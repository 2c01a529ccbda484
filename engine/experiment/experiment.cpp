// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/experiment/experiment.h"

#include "engine/base/error.h"
#include "engine/files/refuse.h"
#include "engine/files/text_file.h"
#include "engine/methods/recording_method.h"

#include <algorithm>
#include <climits>
#include <cstring>
#include <set>
#include <span>

#include <fmt/ranges.h>
#include <link.h>

namespace gpo {
namespace {

using nlohmann::ordered_json;

constexpr int kFormat = 2;  // version of an experiment's files

/// The part of a loaded program or library that contains `address`.
struct LoadedObject {
  std::uintptr_t address;
  std::string build_id = {};  ///< in hexadecimal digits
};

std::string build_id_in(const char* notes, std::size_t size) {
  const auto aligned = [](std::size_t length) { return (length + 3) & ~std::size_t{3}; };
  while (size >= sizeof(ElfW(Nhdr))) {
    ElfW(Nhdr) note;
    std::memcpy(&note, notes, sizeof note);
    const char* digest = notes + sizeof note + aligned(note.n_namesz);
    const std::size_t length = sizeof note + aligned(note.n_namesz) + aligned(note.n_descsz);
    if (length > size) break;
    if (note.n_type == NT_GNU_BUILD_ID) {
      const std::span<const unsigned char> bytes(reinterpret_cast<const unsigned char*>(digest),
                                                 note.n_descsz);
      return fmt::format("{:02x}", fmt::join(bytes, ""));
    }
    notes += length;
    size -= length;
  }
  return {};
}

int find_build_id(dl_phdr_info* info, std::size_t, void* data) {
  auto& object = *static_cast<LoadedObject*>(data);
  const std::span segments(info->dlpi_phdr, info->dlpi_phnum);
  const bool contains = std::ranges::any_of(segments, [&](const auto& segment) {
    const std::uintptr_t begin = info->dlpi_addr + segment.p_vaddr;
    return segment.p_type == PT_LOAD && object.address >= begin &&
           object.address < begin + segment.p_memsz;
  });
  if (!contains) return 0;
  for (const auto& segment : segments) {
    if (segment.p_type != PT_NOTE) continue;
    const auto* notes = reinterpret_cast<const char*>(info->dlpi_addr + segment.p_vaddr);
    if (object.build_id.empty()) object.build_id = build_id_in(notes, segment.p_memsz);
  }
  return 1;
}

std::vector<int> fitting(const std::vector<int>& lengths, int frames) {
  return {lengths.begin(), std::ranges::upper_bound(lengths, frames)};
}

ExperimentRecording plan_recording(const Recording& recording,
                                   const std::vector<int>& lengths,
                                   const std::vector<Range>& starts) {
  const int frames = recording.frame_count();
  const std::vector<int> fit = fitting(lengths, frames);
  ExperimentRecording planned{.name = recording.name,
                              .path = recording.path,
                              .frames = frames,
                              .content = content_of(recording)};
  if (fit.empty()) return planned;
  planned.starts = numbers_in(starts, frames - fit.back());
  std::erase_if(planned.starts, [&](int start) { return start + fit.front() > frames; });
  return planned;
}

void check_names(const std::vector<ExperimentRecording>& recordings) {
  for (auto it = recordings.begin(); it != recordings.end(); ++it) {
    const auto other =
        std::ranges::find(recordings.begin(), it, it->name, &ExperimentRecording::name);
    if (other == it) continue;
    throw InputError(fmt::format(
        "{} and {}: two recordings have the name '{}', but results are identified by name",
        other->path.string(),
        it->path.string(),
        it->name));
  }
}

std::optional<int> parse_count(std::string_view text, int least, int most) {
  const auto number = parse_integer(text);
  if (!number || *number < least || *number > most) return std::nullopt;
  return static_cast<int>(*number);
}

std::optional<Range> parse_range(const std::string& text) {
  const std::vector<std::string> parts = split(text, ':');
  const auto frames = [](const std::string& part) { return parse_count(part, 0, 1'000'000); };
  if (parts.empty() || parts.size() > 3 || text.ends_with(':')) return std::nullopt;
  const auto first = frames(parts[0]);
  const bool to_end = parts.size() > 1 && parts[1] == "end";
  const auto last = parts.size() > 1 ? frames(parts[1]) : first;
  const auto step = parts.size() > 2 ? frames(parts[2]) : 1;
  if (!first || !step || *step < 1) return std::nullopt;
  if (to_end) return Range{*first, std::nullopt, *step};
  if (!last || *last < *first) return std::nullopt;
  return Range{*first, last, *step};
}

/// Adds the identities of results with a file for each recording, as "METHOD/RECORDING".
void add_results(Experiment& experiment) {
  for (const Configuration& one : experiment.configurations) {
    const Method& row = one.method.row();
    const RecordingMethod* method = recording_method(row);
    if (method == nullptr || !method->identity_for) continue;
    bool found = false;
    for (const ExperimentRecording& recording : experiment.recordings) {
      const auto identity = method->identity_for(recording.name);
      found = found || identity;
      experiment.commands[row.key + "/" + recording.name] = identity.value_or("");
    }
    if (!found && !experiment.recordings.empty())
      refuse("--result " + row.result,
             "found no file for any recording, expected one with {} in place of {{recording}}",
             experiment.recordings.front().name);
  }
}

}  // namespace

std::string program_identity() {
  LoadedObject self{reinterpret_cast<std::uintptr_t>(&program_identity)};
  dl_iterate_phdr(find_build_id, &self);
  return self.build_id.empty() ? GPO_VERSION
                               : fmt::format("{} build {}", GPO_VERSION, self.build_id);
}

MethodTable methods_of(const Experiment& experiment) {
  MethodTable methods;
  for (const Configuration& one : experiment.configurations) methods.add(one.method);
  return methods;
}

std::string differ_text(const std::vector<std::string>& names) {
  return fmt::format("`{}` {}", fmt::join(names, "`, `"), names.size() == 1 ? "differs" : "differ");
}

Experiment plan_experiment(std::span<const std::shared_ptr<const Recording>> recordings,
                           const ExperimentRequest& request) {
  Experiment experiment;
  for (const Configuration& one : request.configurations)
    experiment.configurations.push_back(configuration_of(apply(one, {})));
  experiment.seed = request.seed;
  experiment.program = program_identity();
  for (const Configuration& one : experiment.configurations) {
    const std::string& identity = one.method.row().identity;
    if (!identity.empty()) experiment.commands[one.method.key()] = identity;
  }
  int max_frames = 0;
  for (const auto& recording : recordings)
    max_frames = std::max(max_frames, recording->frame_count());
  experiment.lengths = numbers_in(request.lengths, max_frames);
  if (experiment.lengths.empty() || experiment.lengths.front() < 2)
    refuse_setting("lengths", "a window has at least 2 frames");
  for (const auto& recording : recordings)
    experiment.recordings.push_back(plan_recording(*recording, experiment.lengths, request.starts));
  check_names(experiment.recordings);
  add_results(experiment);
  if (tasks_of(experiment).empty())
    refuse_setting("lengths",
                   "no window fits from these starts, {}",
                   max_frames == 0 ? "there is no recording"
                                   : "the longest recording has " + counted(max_frames, "frame"));
  return experiment;
}

std::vector<std::string> notes_of(const Experiment& experiment) {
  std::vector<std::string> notes;
  for (const ExperimentRecording& recording : experiment.recordings) {
    for (const auto& [method, identity] : experiment.commands)
      if (identity.empty() && method.ends_with("/" + recording.name))
        notes.push_back(fmt::format("{}: {} has no file for it, so its windows count as failed",
                                    recording.name,
                                    method.substr(0, method.find('/'))));
    const auto first_long = std::ranges::upper_bound(experiment.lengths, recording.frames);
    if (first_long == experiment.lengths.end()) continue;
    notes.push_back(fmt::format("{}: {}, too short for windows of {} frames",
                                recording.name,
                                counted(recording.frames, "frame"),
                                fmt::join(first_long, experiment.lengths.end(), ", ")));
  }
  return notes;
}

std::vector<ExperimentTask> tasks_of(const Experiment& experiment) {
  std::vector<ExperimentTask> tasks;
  for (std::size_t r = 0; r < experiment.recordings.size(); ++r) {
    const ExperimentRecording& recording = experiment.recordings[r];
    for (const int start : recording.starts)
      tasks.push_back({r, start, fitting(experiment.lengths, recording.frames - start)});
  }
  return tasks;
}

std::vector<ExperimentTask> windows_where(
    std::vector<ExperimentTask> tasks,
    const std::function<bool(const ExperimentTask& task, int frames)>& keep) {
  for (ExperimentTask& task : tasks)
    std::erase_if(task.lengths, [&](int frames) { return !keep(task, frames); });
  std::erase_if(tasks, [](const ExperimentTask& task) { return task.lengths.empty(); });
  return tasks;
}

Shard parse_shard(const std::string& text) {
  const std::string_view whole = text;
  const std::size_t slash = std::min(whole.find('/'), whole.size());
  const auto index = parse_count(whole.substr(0, slash), 1, INT_MAX);
  const auto count = parse_count(whole.substr(std::min(slash + 1, whole.size())), 1, INT_MAX);
  if (!index || !count || *index > *count)
    refuse_setting("shard", "'{}', expected K/N with K from 1 to N, e.g. 2/8", text);
  return {*index, *count};
}

std::vector<ExperimentTask> tasks_of(const Experiment& experiment, const Shard& shard) {
  const std::vector<ExperimentTask> tasks = tasks_of(experiment);
  const int windows = window_count(tasks);
  const int even = windows / shard.count, more = windows % shard.count, before = shard.index - 1;
  const int first = before * even + std::min(before, more);
  const int end = first + even + (before < more ? 1 : 0);
  int window = 0;
  return windows_where(tasks, [&](const ExperimentTask&, int) {
    const int here = window++;
    return here >= first && here < end;
  });
}

int window_count(std::span<const ExperimentTask> tasks) {
  std::size_t count = 0;
  for (const ExperimentTask& task : tasks) count += task.lengths.size();
  return static_cast<int>(count);
}

int timed_length(const std::vector<int>& lengths) {
  if (lengths.empty()) return 0;
  const auto above = std::ranges::upper_bound(lengths, kPaperFrames);
  return above == lengths.begin() ? *above : *std::prev(above);
}

ordered_json to_json(const Experiment& experiment) {
  ordered_json recordings = ordered_json::array();
  for (const ExperimentRecording& recording : experiment.recordings)
    recordings.push_back({{"name", recording.name},
                          {"path", recording.path.string()},
                          {"frames", recording.frames},
                          {"starts", recording.starts},
                          {"content", recording.content}});
  ordered_json configurations = ordered_json::array();
  for (const Configuration& configuration : experiment.configurations)
    configurations.push_back(key_of(configuration));
  ordered_json json = {{"format", kFormat},
                       {"program", experiment.program},
                       {"recordings", std::move(recordings)},
                       {"lengths", experiment.lengths},
                       {"configurations", std::move(configurations)},
                       {"seed", experiment.seed}};
  if (!experiment.commands.empty()) json["commands"] = experiment.commands;
  return json;
}

std::map<std::string, std::string> commands_in(const ordered_json& json) {
  if (!json.contains("commands")) return {};
  return json.at("commands").get<std::map<std::string, std::string>>();
}

Experiment experiment_from_json(const ordered_json& json, const MethodTable& methods) {
  if (json.at("format") != kFormat)
    refuse("key `format`",
           "found {} (another version of the program), expected {}",
           json.at("format").dump(),
           kFormat);
  Experiment experiment;
  for (const ordered_json& recording : json.at("recordings"))
    experiment.recordings.push_back({.name = recording.at("name").get<std::string>(),
                                     .path = recording.at("path").get<std::string>(),
                                     .frames = recording.at("frames").get<int>(),
                                     .starts = recording.at("starts").get<std::vector<int>>(),
                                     .content = recording.at("content").get<RecordingContent>()});
  experiment.lengths = json.at("lengths").get<std::vector<int>>();
  for (const ordered_json& key : json.at("configurations"))
    experiment.configurations.push_back(parse_configuration(key.get<std::string>(), methods));
  experiment.seed = json.at("seed").get<std::uint64_t>();
  experiment.program = json.at("program").get<std::string>();
  experiment.commands = commands_in(json);
  return experiment;
}

std::vector<Range> parse_ranges(const std::string& text, const std::string& name) {
  std::vector<Range> ranges;
  for (const std::string& part : split(text, ',')) {
    const auto range = parse_range(part);
    if (!range)
      refuse_setting(name, "'{}', expected FIRST:LAST:STEP in integers, e.g. 5:60:5", text);
    ranges.push_back(*range);
  }
  if (ranges.empty()) refuse_setting(name, "is empty, expected e.g. 5:60:5");
  return ranges;
}

std::vector<int> numbers_in(const std::vector<Range>& ranges, int end) {
  std::set<int> numbers;
  for (const Range& range : ranges) {
    const int last = range.last.value_or(end);
    for (std::int64_t n = range.first; n <= last; n += range.step)
      numbers.insert(static_cast<int>(n));
  }
  return {numbers.begin(), numbers.end()};
}

}  // namespace gpo
