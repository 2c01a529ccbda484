// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "app/commands/commands.h"
#include "app/recordings/recordings.h"
#include "app/terminal/output.h"
#include "engine/base/error.h"
#include "engine/calibration/gyroscope_report.h"
#include "engine/files/json_text.h"
#include "engine/inspection/report/recording_info.h"
#include "engine/inspection/studies/rotations_over_recording.h"

#include <array>
#include <cstdio>
#include <memory>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace gpo {

namespace {

/// What the word after `--json` may be: not, by mistake, a recording or anything else that is
/// there.
void check_json_file(const InfoArguments& arguments) {
  const auto& file = arguments.json;
  if (std::filesystem::exists(file) && file.extension() != ".json") {
    throw InputError(
        fmt::format("--json: {} is there already and is no .json file, expected a file to write",
                    file.string()));
  }
  check_outputs(std::array{NamedFile{"--json", file}},
                std::array{NamedFile{"recording", arguments.recording}});
}

/// What pictures and gyroscope say of each other, from a few windows.
std::string why_gyroscope_does_not_fit(const std::shared_ptr<const Recording>& recording,
                                       double rate_hz) {
  constexpr int kWindows = 12;
  constexpr int kLeastFrames = 20;
  if (!recording->gyroscope || recording->frame_count() < kLeastFrames) return "";
  if (!recording->images && recording->tracks.empty()) return "";
  const auto windows = rotations_over_recording(recording, kWindows);
  return why_it_does_not_fit(
      fit_gyroscope(windows, *recording->gyroscope), *recording->gyroscope, 1 / rate_hz);
}

/// Of a bag that is no recording its topics are told all the same, before the error is.
std::shared_ptr<const Recording> open_or_tell(const InfoArguments& arguments,
                                              const std::vector<TopicInfo>& topics) {
  try {
    return open_given(arguments.recording, {.tracks = {}, .topics = arguments.topics});
  } catch (const InputError&) {
    if (!arguments.wants_json) {
      fmt::print("{}", to_text(topics));
      std::fflush(stdout);
    }
    throw;
  }
}

}  // namespace

int info_command(const InfoArguments& arguments) {
  const bool to_file = !arguments.json.empty() && !is_standard_output(arguments.json);
  if (to_file) check_json_file(arguments);
  const auto topics = describe_topics(arguments.recording, arguments.topics);
  const std::shared_ptr<const Recording> recording = open_or_tell(arguments, topics);
  RecordingInfo info = describe(*recording);
  if (const auto why = why_gyroscope_does_not_fit(recording, info.rate_hz); !why.empty())
    info.notes.push_back(why);
  if (!arguments.wants_json) {
    fmt::print("{}{}", to_text(info), to_text(topics));
    return kDone;
  }
  nlohmann::json json = to_json(info);
  if (!topics.empty()) json["topics"] = to_json(topics);
  write_output(to_file ? arguments.json : "-", json_text(json, 2));
  return kDone;
}

}  // namespace gpo
