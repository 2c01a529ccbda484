// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/common/window_checks.h"
#include "engine/methods/initializers.h"
#include "engine/methods/plane/linear_solutions.h"
#include "engine/methods/plane/plane_result.h"

namespace gpo {

Initialization initialize_closed_form(const Window& window, const Watch& /*watch*/) {
  if (auto reason = reason_not_to_try(window)) return failed(*reason);
  auto motion = closed_form_motion(window);
  if (!motion) return failed("a frame has no homography");
  for (int i = 1; i < window.frame_count(); ++i)
    motion->tau[i] = translation_given_normal(window, i, motion->normal);
  return make_result(window, *motion, {});
}

}  // namespace gpo
