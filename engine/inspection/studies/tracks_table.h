// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/inspection.h"

#include <string>

namespace gpo {

/// Every track of a window in every frame that sees it, as a table that `read_tracks` reads back:
/// `frame,track,x,y` in raw pixels, the number of its plane (empty: none), inlier or outlier, the
/// residual [raw px] against the result (empty: none) and why it is no inlier, or is lost.
std::string tracks_csv(const Inspection& inspection);

}  // namespace gpo
