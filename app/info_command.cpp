// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "app/commands.h"
#include "app/output.h"
#include "app/recordings.h"
#include "engine/base/error.h"
#include "engine/files/json_text.h"
#include "engine/inspection/report/recording_info.h"
#include "engine/inspection/report/topic_info.h"

#include <array>
#include <cstdio>
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

/// Of a bag that is no recording its topics are told all the same, before the error is.
RecordingInfo describe_given(const InfoArguments& arguments, const std::vector<TopicInfo>& topics) {
  try {
    return describe(*open_given(arguments.recording, {.tracks = {}, .topics = arguments.topics}));
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
  const RecordingInfo info = describe_given(arguments, topics);
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
