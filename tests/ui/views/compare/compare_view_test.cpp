// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/compare/compare_view.h"

#include "tests/ui/gl_test.h"
#include "tests/ui/made_inspection.h"
#include "ui/context/gui.h"
#include "ui/context/theme.h"
#include "ui/views/snapshot.h"

#include <set>
#include <utility>

#include <gtest/gtest.h>
#include <imgui.h>

namespace gpo {
namespace {

class CompareView : public DrawingTest {};

constexpr int kFrame = 24;
using Inspections = std::vector<std::shared_ptr<const Inspection>>;

std::shared_ptr<const Inspection> made(const MadeOptions& options,
                                       const InitializeOptions& other = {}) {
  auto inspection = std::make_shared<Inspection>(made_inspection(options));
  inspection->settings.options.ransac = other.ransac;
  inspection->settings.options.rotations = other.rotations;
  if (inspection->evaluation) {
    inspection->evaluation->pne_deg = options.estimate_error;
    inspection->evaluation->ate_m = 0.0042;
    inspection->evaluation->pde_m = 0.0021;
    inspection->evaluation->pne_bound_deg = 0.021;
  }
  return inspection;
}

/// Returns a true estimate, one wrong by 3 degrees, and a failed one.
Inspections three() {
  return {made({}),
          made({.estimate_error = 3}, {.ransac = false}),
          made({.ok = false}, {.rotations = RotationSource::averaging})};
}

/// Returns the part of an image of `three()` with one of them.
cv::Mat column(const cv::Mat& image, int index) {
  const int width = image.cols / 3;
  return image.colRange(index * width, (index + 1) * width);
}

/// Returns the numbers of columns and rows.
std::pair<int, int> grid_of(const Eigen::Vector2d& size, int count, double aspect) {
  std::set<double> xs, ys;
  for (const ColumnPlace& place : compare_places({{0, 0}, size}, count, aspect, true)) {
    xs.insert(place.image.min.x());
    ys.insert(place.image.min.y());
  }
  return {static_cast<int>(xs.size()), static_cast<int>(ys.size())};
}

TEST_F(CompareView, ArrangesColumnsForTheLargestImages) {
  const OffscreenContext context(64, 64);
  Gui gui;  // its font determines sizes
  gui.begin_frame(64, 64);
  EXPECT_EQ(grid_of({1600, 1000}, 4, 16.0 / 9), std::pair(2, 2));
  EXPECT_EQ(grid_of({1900, 450}, 4, 16.0 / 9), std::pair(4, 1));
  EXPECT_EQ(grid_of({500, 1000}, 2, 4.0 / 3), std::pair(1, 2));
  EXPECT_EQ(grid_of({1600, 1000}, 1, 4.0 / 3), std::pair(1, 1));
  EXPECT_EQ(grid_of({1600, 1000}, 5, 4.0 / 3), std::pair(3, 2));
  ImGui::EndFrame();
}

TEST_F(CompareView, ColumnsHaveTheirColorAndTheirCubeOrReason) {
  const Inspections inspections = three();
  const cv::Mat image = snapshot_compare(inspections, kFrame);
  keep("compare", image);
  ASSERT_EQ(image.size(), default_compare_size(inspections));
  for (int i = 0; i < 3; ++i) {
    const Configuration configuration = configuration_of(inspections[i]->settings);
    const cv::Mat heading = column(image, i).rowRange(38, 92);
    EXPECT_GT(count_pixels(heading, color_of(configuration)), 150) << "column " << i;
    const bool ok = inspections[i]->initialization->ok;
    const cv::Mat shown = column(image, i).rowRange(92, image.rows - 58);
    EXPECT_EQ(count_pixels(shown, color_of(Role::cube_base)) > 200, ok) << "column " << i;
    EXPECT_EQ(count_pixels(shown, color_of(Role::warning)) > 50, !ok) << "column " << i;
  }
  // All columns show the same part of the image: here a part of the floor without a cube.
  const cv::Rect corner(20, 100, 60, 60);
  for (int i = 1; i < 3; ++i)
    EXPECT_TRUE(same_bytes(image(corner), image(corner + cv::Point(i * 492, 0)))) << i;
}

TEST_F(CompareView, AMovedCubeChangesOnlyItsColumn) {
  Inspections inspections = three();
  const cv::Mat before = snapshot_compare(inspections, kFrame);
  auto moved = std::make_shared<Inspection>(*inspections[0]);
  // Within the true cube, so that all columns still show the same part of the image.
  moved->cube->axes *= 0.8;
  moved->cube->origin += 0.01 * moved->cube->axes.col(0);
  inspections[0] = moved;
  const cv::Mat after = snapshot_compare(inspections, kFrame);
  EXPECT_FALSE(same_bytes(column(before, 0), column(after, 0)));
  EXPECT_TRUE(same_bytes(column(before, 1), column(after, 1)));
  EXPECT_TRUE(same_bytes(column(before, 2), column(after, 2)));
}

TEST_F(CompareView, WrapsMoreThanFourColumnsIntoRows) {
  Inspections seven;
  for (int i = 0; i < 7; ++i) seven.push_back(made({.estimate_error = 0.4 * i}));
  const cv::Size size = default_compare_size(seven);
  EXPECT_EQ(size.width, 4 * 492 + 12);
  EXPECT_EQ(size.height, default_compare_size({seven.data(), 4}).height * 2 - 38);
  const cv::Mat image = snapshot_compare(seven, kFrame);
  keep("compare_seven", image);
  // The eighth place is empty.
  EXPECT_EQ(count_pixels(image(cv::Rect(3 * 492 + 12, size.height / 2 + 20, 490, 400)),
                         color_of(Role::panel)),
            490 * 400);
}

TEST_F(CompareView, ArrangesNineColumnsInThreeRows) {
  Inspections nine;
  for (int i = 0; i < 9; ++i)
    nine.push_back(made({.ok = i != 8, .estimate_error = 0.4 * i, .normal_sigma_deg = 0.3}));
  EXPECT_EQ(default_compare_size(nine).width, 3 * 492 + 12);
  const cv::Mat image = snapshot_compare(nine, kFrame);
  keep("compare_nine", image);
  const cv::Mat first = image(cv::Rect(12, 38, 480, 54));
  const cv::Mat last = image(cv::Rect(12 + 2 * 492, 38 + 2 * (image.rows - 38) / 3, 480, 54));
  EXPECT_GT(count_pixels(first, color_of(Role::good)), 30);  // ready
  EXPECT_GT(count_pixels(last, color_of(Role::bad)), 8);     // degenerate
}

TEST_F(CompareView, DrawsIncompleteResultsWithoutMessages) {
  const Inspections blind{made({.images = false, .truth = false})};
  const Inspections failed{made({.ok = false, .truth = false})};
  keep("compare_blind", snapshot_compare(blind, kFrame));
  keep("compare_outside", snapshot_compare(three(), 38));
  keep("compare_failed", snapshot_compare(failed, kFrame));
  keep("compare_small", snapshot_compare(three(), kFrame, cv::Size(900, 330)));
}

}  // namespace
}  // namespace gpo
