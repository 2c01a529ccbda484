// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/recording/bags/containers/bag.h"
#include "engine/recording/bags/messages.h"
#include "engine/recording/bags/topic_roles.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace gpo {

/// What a recording is made of, as the bag has it: by the time stamps in the messages' headers,
/// strictly ascending. Where a header has none it is the time at which it was recorded.
struct BagContents {
  std::vector<std::int64_t> picture_times_ns;
  std::vector<BagMessage> pictures;  ///< as many
  std::string camera_frame;          ///< where the first picture was taken: its `frame_id`
  std::optional<CameraInfoMessage> camera_info;  ///< the first
  std::vector<ImuMessage> imu;
  std::vector<PoseMessage> truth;
  std::vector<PoseMessage> transforms;  ///< of /tf_static
  std::vector<std::string> notes;       ///< what was left out
};

/// Goes through the messages of the topics that have a role, in the order of the file; of pictures
/// it reads the first bytes. Throws InputError where a message is cut or not of its type.
BagContents read_contents(const Bag& bag, const TopicRoles& roles);

}  // namespace gpo
