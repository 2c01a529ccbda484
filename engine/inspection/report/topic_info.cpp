// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inspection/report/topic_info.h"

#include "engine/base/error.h"
#include "engine/recording/bags/containers/bag.h"
#include "engine/recording/layouts/open_recording.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace gpo {
namespace {

constexpr std::size_t kLongestName = 200;

std::vector<TopicInfo> topics_of(const Bag& bag) {
  std::vector<TopicInfo> topics;
  for (const BagTopic& topic : bag.topics) topics.push_back({topic, std::nullopt});
  return topics;
}

}  // namespace

std::vector<TopicInfo> describe_topics(const std::filesystem::path& path,
                                       const TopicChoices& choices) {
  std::vector<TopicInfo> topics;
  try {
    if (!find_bag(path)) return {};
    const Bag bag = open_bag(bag_at(path));
    topics = topics_of(bag);
    const TopicRoles roles = topic_roles(bag, choices);
    for (int i = 0; i < kTopicRoles; ++i)
      if (const auto topic = roles.topics[i]) topics[*topic].role = static_cast<TopicRole>(i);
  } catch (const InputError&) {
    // Opening the recording reports the error.
  }
  return topics;
}

nlohmann::json to_json(const std::vector<TopicInfo>& topics) {
  auto list = nlohmann::json::array();
  for (const auto& [topic, role] : topics) {
    nlohmann::json one = {{"name", topic.name}, {"type", topic.type}, {"messages", topic.messages}};
    if (role) one["role"] = to_string(*role);
    list.push_back(one);
  }
  return list;
}

std::string to_text(const std::vector<TopicInfo>& topics) {
  std::string text;
  for (const auto& [topic, role] : topics) {
    text += fmt::format("{:<14}{} ({}, {}){}\n",
                        text.empty() ? "topics" : "",
                        legible(topic.name, kLongestName),
                        legible(topic.type, kLongestName),
                        topic.messages,
                        role ? fmt::format(": {}", to_string(*role)) : "");
  }
  return text;
}

}  // namespace gpo
