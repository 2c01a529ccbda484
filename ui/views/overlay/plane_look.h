// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/inspection.h"
#include "ui/views/overlay/overlay.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace gpo {

/// The leading plane's is that of an inlier; the others have theirs in the order of their support.
std::uint32_t plane_color(const Window& window, int plane);

/// Numbers of the window's planes that do not lead.
std::vector<int> other_planes(const Window& window);

/// Number of the plane that the track lies on in the frame; nothing: on none.
std::optional<int> plane_of_track(const Window& window, int frame, int column);

struct TrackLook {
  Sign sign;
  std::uint32_t rgb;
};
/// A circle in the color of its plane, or an outlier's cross.
TrackLook track_look(const Window& window, int frame, int column);

/// What the setting `plane` must be for the plane of the track of this id to lead; nothing where it
/// lies on none, or on the one that leads.
std::optional<int> to_lead(const Inspection& inspection, std::int64_t id);

}  // namespace gpo
