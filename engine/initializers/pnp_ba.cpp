// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/initializers/pnp_ba.h"

#include "engine/initializers/ba.h"
#include "engine/initializers/common/refined_start.h"
#include "engine/initializers/pnp.h"

namespace gpo {

Initialization initialize_pnp_ba(const Window& window, const Watch& watch) {
  return refined_start(window, {"PnP", initialize_pnp}, refine_bundle, watch);
}

}  // namespace gpo
