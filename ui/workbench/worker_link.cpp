// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/worker_link.h"

#include <utility>

namespace gpo {
void synchronize(WorkbenchState& state,
                 WorkerLink& link,
                 Worker& worker,
                 const std::filesystem::path& example) {
  // The status first: one that says "idle" then never comes with a result that is not there yet.
  link.status = worker.status();
  const Published published = worker.latest();
  const bool opened = published.recording && published.recording != state.recording;
  if (opened) adopt(state, published.recording);
  link.inspection = published.inspection;

  const Wishes wishes = std::exchange(state.wishes, {});
  state.wishes.quit = wishes.quit;
  state.wishes.save_picture = wishes.save_picture;
  if (wishes.cancel && link.status.busy) {
    worker.cancel();
    state.message = "canceled; F5 computes again";
  }
  const bool compute =
      state.recording && (opened || wishes.compute || state.settings != link.requested);
  if (wishes.open_example) worker.open(example);
  if (wishes.open) worker.open(*wishes.open);
  if (compute) {
    worker.request(state.settings);
    link.requested = state.settings;
  }
  // Busy until the next call has seen what became of it.
  if (wishes.open_example || wishes.open || compute) link.status = {true, "", 0, 0, ""};
}

}  // namespace gpo
