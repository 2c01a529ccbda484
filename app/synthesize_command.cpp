// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "app/commands.h"
#include "engine/synthesis/recipe.h"
#include "engine/synthesis/synthesize.h"

#include <cstdio>

#include <fmt/format.h>
#include <unistd.h>

namespace gpo {

int synthesize_command(const std::filesystem::path& recipe, const std::filesystem::path& output) {
  const Recipe what = read_recipe(recipe);
  // Progress is for people who watch, not for logs.
  const bool watched = isatty(fileno(stderr)) != 0;
  synthesize(what, output, [&](int done, int of) {
    if (watched) fmt::print(stderr, "\rframe {}/{}{}", done, of, done == of ? "\n" : "");
  });
  fmt::print("{}: {} frames, {}x{}\n",
             output.string(),
             what.frame_count,
             what.camera.width,
             what.camera.height);
  return kDone;
}

}  // namespace gpo
