// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "app/commands.h"
#include "app/recordings.h"
#include "engine/files/json_text.h"
#include "engine/inspection/recording_info.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace gpo {

int info_command(const std::filesystem::path& recording, bool json) {
  const auto opened = open_given(recording);
  const RecordingInfo info = describe(*opened);
  if (json) {
    fmt::print("{}", json_text(to_json(info), 2));
    return kDone;
  }
  fmt::print("{}", to_text(info));
  return kDone;
}

}  // namespace gpo
