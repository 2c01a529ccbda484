// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/recording/bags/topic_roles.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace gpo {

/// A topic of a bag and its role, as `info` lists them.
struct TopicInfo {
  BagTopic topic;
  std::optional<TopicRole> role;
};

/// Returns the topics of the bag at a path; empty if there is none or it cannot be read. Roles are
/// missing if the bag has no camera.
std::vector<TopicInfo> describe_topics(const std::filesystem::path& path,
                                       const TopicChoices& choices);

nlohmann::json to_json(const std::vector<TopicInfo>& topics);
/// Returns rows of the table of a recording, each line ended.
std::string to_text(const std::vector<TopicInfo>& topics);

}  // namespace gpo
