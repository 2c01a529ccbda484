// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "app/commands/commands.h"
#include "app/terminal/interrupt.h"
#include "app/terminal/progress_bar.h"
#include "engine/synthesis/recipe.h"
#include "engine/synthesis/synthesize.h"

#include <fmt/format.h>

namespace gpo {

int synthesize_command(const std::filesystem::path& recipe, const std::filesystem::path& output) {
  const Recipe what = read_recipe(recipe);
  {
    const Interrupt interrupt;
    ProgressBar bar("synthesizing " + output.string());
    synthesize(what, output, [&](int done, int of) {
      bar.show(done, of);
      interrupt.check("nothing is left of " + output.string());
    });
  }
  fmt::print("{}: {} frames, {}x{}\n",
             output.string(),
             what.frame_count,
             what.camera.width,
             what.camera.height);
  return kDone;
}

}  // namespace gpo
