// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/ui/gl_test.h"
#include "tests/ui/made_inspection.h"
#include "ui/workbench/actions/actions.h"
#include "ui/workbench/session/session_file.h"
#include "ui/workbench_window.h"

#include <algorithm>

#include <gmock/gmock.h>

namespace gpo {
namespace {

/// What is open in a window, and how it is looked at.
struct Patch {
  cv::Size size;
  float scale;
};

class EveryPane : public DrawingTest, public testing::WithParamInterface<Patch> {};

cv::Mat drawn(OffscreenContext& context, Gui& gui, Views& views, const WorkbenchState& state) {
  const JobStatus idle;
  const SurveyStatus none;
  const cv::Size size(context.width(), context.height());
  context.bind();
  for (int i = 0; i < 3; ++i)
    draw_workbench({state, idle, none, false, gui.scale()}, size, gui, views);
  return context.read_bgr();
}

TEST_P(EveryPane, IsDrawnAndOtherThanTheOthers) {
  const auto [size, scale] = GetParam();
  OffscreenContext context(size.width, size.height);
  Gui gui(scale);
  Views views;
  for (const MadeOptions& options :
       {MadeOptions{.normal_sigma_deg = 0.3}, MadeOptions{.ok = false}}) {
    const auto inspection = std::make_shared<const Inspection>(made_inspection(options));
    WorkbenchState state;
    state.document.settings = inspection->settings;
    apply_recording(state, inspection->recording);
    state.results.inspection = inspection;
    run_line(state, "select track " + std::to_string(inspection->tracks->ids[3]));
    std::vector<cv::Mat> images = {drawn(context, gui, views, state)};
    for (const Action& action : actions()) {
      if (!action.name.starts_with("view ") || !action.complete()) continue;
      if (action.name == "view scene" || action.name == "view no-drawer") continue;
      WorkbenchState other = state;
      run_line(other, action.name);
      images.push_back(drawn(context, gui, views, other));
      const auto same = [&](const cv::Mat& one) { return same_bytes(one, images.back()); };
      EXPECT_EQ(std::ranges::count_if(images, same), 1) << action.name;
    }
    for (const char* line : {"help", "palette", "theme light"}) {
      WorkbenchState other = state;
      run_line(other, line);
      EXPECT_FALSE(same_bytes(drawn(context, gui, views, other), images.front())) << line;
    }
    // The dark theme again: the very bytes as before.
    EXPECT_TRUE(same_bytes(drawn(context, gui, views, state), images.front()));
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes,
                         EveryPane,
                         testing::Values(Patch{{1024, 640}, 1},
                                         Patch{{1280, 720}, 1},
                                         Patch{{2560, 1440}, 2},
                                         Patch{{3840, 2160}, 2}),
                         [](const auto& info) {
                           return std::to_string(info.param.size.width) + "at" +
                                  std::to_string(static_cast<int>(info.param.scale));
                         });

}  // namespace
}  // namespace gpo
