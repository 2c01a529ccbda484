// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/recording/bags/containers/bag.h"

#include <string>
#include <string_view>

#include <opencv2/core.hpp>

namespace gpo {

/// The picture of a message of `topic`, which is of a type of pictures: blue, green, red, of 8 or
/// 16 bits each. Throws InputError that begins with `name`.
cv::Mat bag_image(std::string_view bytes, const BagTopic& topic, const std::string& name);

}  // namespace gpo
