// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inspection/studies/studies.h"
#include "tests/ui/window_test.h"
#include "ui/context/imgui_versions.h"
#include "ui/views/image/image_geometry.h"
#include "ui/views/scene/scene_view.h"

#include <cmath>

#include <Eigen/Geometry>
#include <gmock/gmock.h>

namespace gpo {
namespace {

using Eigen::Vector2d, testing::Contains, testing::ElementsAre;

class PanesTest : public test::WindowTest {
 protected:
  void open_pane(const Inspection& inspection, const std::string& pane) {
    open(inspection);
    run_line(state_, "view " + pane);
  }
  cv::Mat drawer_image() {
    draw_times(2);
    const Rectangle place = layout().drawer;
    const cv::Rect2f part(place.x, place.y, place.width, place.height);
    return context_.read_bgr()(cv::Rect(part.tl(), part.br())).clone();
  }
};

TEST_F(PanesTest, DrawAnyResultWithoutCommands) {
  for (const bool ok : {true, false}) {
    open(made_inspection({.ok = ok}));
    for (const Pane& pane : side_panes())
      for (const Pane& drawer : drawers()) {
        state_.view.panes.side = &pane;
        state_.view.panes.drawer = &drawer;
        draw();
        EXPECT_TRUE(draw().empty());
      }
    state_.results.inspection.reset();
    draw();
  }
}

TEST_F(PanesTest, DrawBothCubesOfAnAmbiguousWindow) {
  const Inspection refused = made_inspection({.refused = true});
  const auto drawn = [&](double first_rad, double second_rad) {
    auto failure = std::make_shared<Initialization>(*refused.initialization);
    failure->ambiguity.emplace();
    for (const double angle_rad : {first_rad, second_rad}) {
      RefusedSolution& one = failure->ambiguity->undecided.emplace_back(*failure->refused);
      one.plane.normal = so3_exp(angle_rad * Eigen::Vector3d::UnitX()) * one.plane.normal;
    }
    Inspection ambiguous = refused;
    ambiguous.initialization = failure;
    open(ambiguous);
    draw_times(3);
    const Rectangle place = layout().image;
    const cv::Rect2f part(place.x, place.y, place.width, place.height);
    return cv::Mat(context_.read_bgr()(cv::Rect(part.tl(), part.br())).clone());
  };
  const cv::Mat both = drawn(0, 0.4);
  keep("ambiguous", both);
  EXPECT_TRUE(same_bytes(both, drawn(0, 0.4)));
  EXPECT_FALSE(same_bytes(both, drawn(0.1, 0.4)));
  EXPECT_FALSE(same_bytes(both, drawn(0, 0.3)));
}

TEST_F(PanesTest, ClickInTheResidualsGoesToTheFrame) {
  open_pane(made_inspection({.estimate_error = 1}), "residuals");
  apply(state_, GoToFrame{34});
  draw();
  const Rectangle place = layout().drawer;
  const Commands commands = click(place.x + 0.7F * place.width, place.y + 0.5F * place.height);
  const int frame = test::first<GoToFrame>(commands).frame;
  EXPECT_TRUE(frame > 10 && frame < 30) << frame;
}

TEST_F(PanesTest, ComputesResidualsAndChartsOncePerInspection) {
  open_pane(made_inspection({.estimate_error = 1}), "residuals");
  draw();
  const std::size_t drawn = views_->charts.at("rms over frames").texture().revision();
  apply(state_, GoToFrame{20});
  draw();
  EXPECT_EQ(views_->charts.at("rms over frames").texture().revision(), drawn)
      << "only the cursor may be drawn again";
  EXPECT_EQ(views_->residuals.of, state_.results.inspection);
}

/// Returns a study with simple candidates and clusters, and a cost whose minimum is the estimate.
std::shared_ptr<const NormalStudy> made_study(const Inspection& inspection) {
  NormalStudy study;
  study.window = inspection.window;
  const int frames = inspection.window->frame_count();
  const Eigen::Vector3d normal = inspection.initialization->plane.normal;
  study.landscape.side = 16;
  study.landscape.observations.assign(frames, 100);
  study.landscape.cost_px2.assign(frames, std::vector<float>(256));
  for (int i = 0; i < frames; ++i)
    for (int k = 0; k < 256; ++k) {
      const Eigen::Vector2d disc = disc_of_cell(16, k / 16, k % 16);
      const double away = (disc - disc_from_normal(normal)).norm();
      study.landscape.cost_px2[i][k] =
          disc.norm() < 0.9 ? static_cast<float>((i + 1) * (1 + 400 * away * away)) : NAN;
    }
  study.candidates.resize(frames);
  for (int i = 1; i < frames; ++i)
    study.candidates[i] = {
        {i, {{}, {0.1, 0, 0}, normal}, 0.5, Rejection::none, "", 0, 100},
        {i, {{}, {0.1, 0, 0}, {0.6, 0, -0.8}}, 9, Rejection::behind_camera, "behind"}};
  study.clusters = {{normal, 1, frames - 1, 2}};
  return std::make_shared<const NormalStudy>(study);
}

TEST_F(PanesTest, ZoomsAndPansTheNormals) {
  const Inspection inspection = made_inspection({.estimate_error = 1});
  open_pane(inspection, "normals");
  state_.results.study = made_study(inspection);
  const Rectangle place = layout().side;
  const float x = place.x + 0.6F * place.width, y = place.y + 0.4F * place.height;
  EXPECT_TRUE(point_at(x, y).empty()) << "hovering must not change anything";
  const Commands zoomed = wheel(x, y, 2);
  ASSERT_EQ(zoomed.size(), 1U);
  apply(state_, zoomed[0]);
  EXPECT_NEAR(state_.view.normals_zoom.factor, 1.5625, 1e-9);
  press(true);
  ImGui::GetIO().MousePos = {x + 30, y};
  const Commands moved = draw();
  ImGui::GetIO().MouseDown[0] = false;
  ASSERT_EQ(moved.size(), 1U);
  const double before = state_.view.normals_zoom.center.x();
  apply(state_, moved[0]);
  EXPECT_LT(state_.view.normals_zoom.center.x(), before);
}

TEST_F(PanesTest, MapsTheNormalsOfTheFramesUpToTheCurrentOne) {
  const Inspection inspection = made_inspection({.estimate_error = 1});
  open_pane(inspection, "normals");
  state_.results.study = made_study(inspection);
  apply(state_, GoToFrame{34});
  draw();
  const std::size_t drawn = views_->normals.texture().revision();
  EXPECT_GT(drawn, 0U);
  draw();
  EXPECT_EQ(views_->normals.texture().revision(), drawn);
  const float all = views_->normals.rms_at({0, 0});
  apply(state_, GoToFrame{12});
  draw();
  EXPECT_EQ(views_->normals.texture().revision(), drawn + 1);
  EXPECT_LT(views_->normals.rms_at({0, 0}), all);
  EXPECT_TRUE(std::isnan(views_->normals.rms_at({0.96, 0.05})));
  EXPECT_FALSE(views_->normals.contours().empty());
  state_.view.panes.side = find_pane("candidates", side_panes());
  for (const int frame : {0, 5, 20}) {
    apply(state_, GoToFrame{frame});
    EXPECT_TRUE(draw().empty());
  }
}

TEST_F(PanesTest, TimesOfTheSameTracksAreEqual) {
  Inspection inspection = made_inspection();
  inspection.settings.options.method = "gpo";
  inspection.timing = {500, 20, 3, 40, 30, 563};
  open(inspection);
  run_line(state_, "view timing");
  state_.document.compared = parse_configurations("ba");
  const auto compare_with_tracking_of = [&](double milliseconds) {
    Inspection other = inspection;
    other.settings = apply(parse_configuration("ba"), inspection.settings);
    other.timing.track = milliseconds;
    other.timing.total = milliseconds + 63;
    const auto result = std::make_shared<const Inspection>(other);
    state_.results.surveyed =
        std::make_shared<const SurveyResults>(SurveyResults{{other.settings, result, ""}});
    return drawer_image();
  };
  const cv::Mat equal = compare_with_tracking_of(500);
  ASSERT_EQ(shown_results(state_).size(), 2U);
  EXPECT_TRUE(same_bytes(equal, compare_with_tracking_of(1255)));
}

TEST_F(PanesTest, RowsOfTimesKeepTheirIds) {
  Inspection inspection = made_inspection();
  inspection.timing = {100, 20, 3, 40, 30, 163};
  open_pane(inspection, "timing");
  const Rectangle place = layout().drawer;
  const float x = place.right() - 40;
  for (float y = place.y + 8; y < place.bottom() && ImGui::GetHoveredID() == 0; y += 4)
    point_at(x, y);
  const ImGuiID id = ImGui::GetHoveredID();
  ASSERT_NE(id, 0U);
  std::vector<std::unique_ptr<ShownResult>> elsewhere;
  for (int i = 0; i < 10; ++i) {
    for (int k = 0; k < 100; ++k) elsewhere.push_back(std::make_unique<ShownResult>());
    draw();
    EXPECT_EQ(ImGui::GetHoveredID(), id);
  }
}

TEST_F(PanesTest, MessageLineShowsSuccessAfterAFailedJob) {
  open(made_inspection());
  say(state_, "saved a.png");
  draw_times(2);
  const cv::Mat image = context_.read_bgr();
  worker_.error = "cannot be read";
  draw_times(2);
  EXPECT_TRUE(same_bytes(image, context_.read_bgr()));
}

TEST_F(PanesTest, HasNoTimesInScreenshots) {
  Inspection inspection = made_inspection();
  state_.view.panes.drawer = find_pane("timing", drawers());
  for (const bool timings : {false, true}) {
    timings_ = timings;
    inspection.timing = {100, 20, 3, 40, 30, 163};
    open(inspection);
    const cv::Mat first = drawer_image();
    keep("timing", first);
    inspection.timing = {10, 220, 33, 4, 3, 270};
    open(inspection);
    EXPECT_EQ(same_bytes(first, drawer_image()), !timings);
  }
}

}  // namespace
}  // namespace gpo
