// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/fpba.h"

#include "engine/methods/common/refined_start.h"
#include "engine/methods/dbscan.h"
#include "engine/methods/pba.h"

namespace gpo {

Initialization initialize_fpba(const Window& window, const Watch& watch) {
  const Refinement refine = [](const Window& w, const Initialization& start, const Watch& s) {
    return refine_on_plane(w, start, PlaneNormal::held, s);
  };
  return refined_start(window, {"DBSCAN", initialize_dbscan}, refine, watch);
}

}  // namespace gpo
