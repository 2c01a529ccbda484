// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/recording/bags/messages.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace gpo {

/// A topic and what it is read as: what `info` lists of a bag.
struct TopicInfo {
  BagTopic topic;
  std::optional<TopicRole> role;
};

/// The topics of the bag at a path; empty where there is none, or where it cannot be read. Roles
/// are missing where the bag has no camera.
std::vector<TopicInfo> describe_topics(const std::filesystem::path& path,
                                       const TopicChoices& choices);

nlohmann::json to_json(const std::vector<TopicInfo>& topics);
/// Rows of the table of a recording, each line ended.
std::string to_text(const std::vector<TopicInfo>& topics);

}  // namespace gpo
