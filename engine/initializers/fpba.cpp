// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/initializers/fpba.h"

#include "engine/initializers/common/refined_start.h"
#include "engine/initializers/dbscan.h"
#include "engine/initializers/pba.h"

namespace gpo {

Initialization initialize_fpba(const Window& window, const Watch& watch) {
  const Refinement refine = [](const Window& w, const Initialization& start, const Watch& s) {
    return refine_on_plane(w, start, PlaneNormal::held, s);
  };
  return refined_start(window, {"DBSCAN", initialize_dbscan}, refine, watch);
}

}  // namespace gpo
