// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/common/window_checks.h"

#include "engine/methods/methods.h"
#include "tests/engine/simulated_window.h"
#include "tests/engine/test_folder.h"

#include <functional>
#include <limits>
#include <utility>

#include <gmock/gmock.h>

namespace gpo::test {
namespace {

TEST(WindowChecks, RefuseListsOfDifferentSizesByEveryMethod) {
  using Change = std::function<void(Window&)>;
  const Window good = simulate({.frames = 5, .points = 20}).window;
  for (const auto& [change, expected] : std::initializer_list<std::pair<Change, const char*>>{
           {[](Window& w) { w.points_px.clear(); }, "window: no frames"},
           {[](Window& w) { w.points_px[2].resize(2, 19); },
            "window: 19 tracks in a frame, expected 20"},
           {[](Window& w) { w.inlier.pop_back(); }, "window: 4 frames of inliers, expected 5"},
           {[](Window& w) { w.inlier[1].pop_back(); },
            "window: 19 inlier marks in a frame, expected 20"},
           {[](Window& w) { w.H_i1.clear(); }, "window: 0 homographies, expected 5"},
           {[](Window& w) { w.R_wc.pop_back(); }, "window: 4 rotations, expected 5"},
           {[](Window& w) { w.leader = 3; }, "window: leader 3 is no plane"},
           {[](Window& w) { w.K(0, 0) = std::numeric_limits<double>::quiet_NaN(); },
            "window: K is not finite, or a focal length is not above 0"},
       }) {
    Window window = good;
    change(window);
    for (const Method& method : methods())
      EXPECT_EQ(error_of([&] { method.initialize(window, {}, {}); }), expected) << method.key;
  }
}

TEST(WindowChecks, CountOnlyTracksThatWereNotLeftOut) {
  Window window = simulate({.frames = 5, .points = 30}).window;
  window.inliers = Inliers::planes;
  window.planes.clear();
  const auto leave_out = [&](int count) {
    for (Eigen::Matrix2Xd& points : window.points_px)
      points.leftCols(count).setConstant(std::numeric_limits<double>::quiet_NaN());
    return reason_not_to_try(window).value_or("");
  };
  EXPECT_THAT(leave_out(10), testing::HasSubstr("no plane: no set of the 20 tracks agrees"));
  EXPECT_THAT(leave_out(30), testing::HasSubstr("the first of the window, has 0, at least 8"));
}

}  // namespace
}  // namespace gpo::test
