// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/pnp_ba.h"

#include "engine/methods/ba.h"
#include "engine/methods/common/refined_start.h"
#include "engine/methods/pnp.h"

namespace gpo {

Initialization initialize_pnp_ba(const Window& window, const Watch& watch) {
  return refined_start(window, {"PnP", initialize_pnp}, refine_bundle, watch);
}

}  // namespace gpo
