// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/calibration/plane/plane_views.h"
#include "engine/calibration/plane_views/plane_chain.h"
#include "engine/geometry/camera.h"

#include <vector>

namespace gpo {

struct LinkOptions {
  int most_images = 60;    ///< in which points are looked for, spread over a chain
  int most_references = 8;   ///< pictures whose points are looked for
  double least_area = 0.15;  ///< of a look, seen from elsewhere, of its own [-]
  double most_area = 6;      ///< the same
  double gate_px = 4;        ///< from the homography of the others; wide, as the lens is a guess
  AnchorOptions anchor = {};
};

/// The points of a chain's references, looked for in pictures all over the chain: by their own
/// looks, where the homography from their reference puts them, so that one plane with one set of
/// points is seen from everywhere. How far they go from frame to frame, the chain tells.
ObservedPlane linked_views(const ChainImages& images,
                           const PlaneChain& chain,
                           const Camera& camera,
                           const LinkOptions& options = {});

}  // namespace gpo
