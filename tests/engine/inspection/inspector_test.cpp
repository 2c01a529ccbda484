// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inspection/inspector.h"

#include "engine/inspection/report/report.h"
#include "engine/methods/methods.h"
#include "tests/engine/desk.h"
#include "tests/engine/test_folder.h"

#include <algorithm>

#include <gmock/gmock.h>

namespace gpo::test {
namespace {

using testing::HasSubstr, testing::MatchesRegex;

std::shared_ptr<const Inspection> inspect_desk(const Settings& settings) {
  return Inspector(desk()).inspect(settings);
}

std::string result_of(const Inspection& inspection) {
  nlohmann::ordered_json json = to_json(inspection);
  json.erase("timing_ms");
  return json.dump();
}

TEST(Inspector, CachesAStageUntilItsOwnInputsChange) {
  Inspector inspector(desk());
  Settings settings{.frames = 12};
  const auto first = inspector.inspect(settings);
  settings.options.ransac_threshold_px = 1.0;
  const auto threshold = inspector.inspect(settings);
  EXPECT_EQ(first->tracks, threshold->tracks);
  EXPECT_EQ(first->truth, threshold->truth);
  EXPECT_LT(threshold->window->inlier_count(0), first->window->inlier_count(0));
  settings.start = 3;
  const auto moved = inspector.inspect(settings);
  EXPECT_NE(first->tracks, moved->tracks);
  EXPECT_EQ(moved->window->start, 3);
}

TEST(Inspector, CachesTheTracksOfBothTrackings) {
  Inspector inspector(desk());
  const Settings drifting{.frames = 12, .tracking = Tracking::frame_to_frame};
  const Settings anchored{.frames = 12, .tracking = Tracking::anchored};
  const auto first = inspector.inspect(drifting), other = inspector.inspect(anchored);
  EXPECT_NE(first->tracks->raw_px[11], other->tracks->raw_px[11]);
  EXPECT_LT(other->initialization->rms_px, first->initialization->rms_px);
  EXPECT_EQ(to_json(*other)["settings"]["tracking"], "anchored");
  int tracked = 0;
  const auto count = [&](const std::string& stage, int, int) { tracked += stage == "tracking"; };
  const auto again = inspector.inspect(drifting, {}, count);
  inspector.inspect(anchored, {}, count);
  EXPECT_EQ(tracked, 0);
  EXPECT_EQ(again->initialization->rms_px, first->initialization->rms_px);
}

TEST(Inspector, SelectsInliersAsRequested) {
  Inspector inspector(desk());
  const auto inspected = [&](std::optional<Inliers> inliers, std::optional<bool> ransac) {
    Settings settings{.frames = 12};
    settings.options.inliers = inliers;
    settings.options.ransac = ransac;
    return inspector.inspect(settings);
  };
  const auto used = [](const auto& inspection) {
    return to_json(*inspection)["settings"]["inliers"];
  };
  const auto per_frame = inspected(Inliers::per_frame, {});
  const auto consistent = inspected(Inliers::consistent, {});
  EXPECT_EQ(consistent->tracks, per_frame->tracks);
  EXPECT_NE(consistent->window->inlier, per_frame->window->inlier);
  EXPECT_EQ(used(per_frame), "per-frame");
  EXPECT_EQ(used(consistent), "consistent");
  EXPECT_THAT(to_text(*consistent), HasSubstr("lost, consistent"));
  const auto planes = inspected({}, {});
  EXPECT_EQ(used(planes), "planes");
  EXPECT_EQ(planes->window->planes[0].tracks.size(),
            to_json(*planes)["planes"][0]["tracks"].size());
  const auto all = inspected(Inliers::consistent, false);
  EXPECT_THAT(inliers_note(*all), MatchesRegex("tracks, [0-9]+ lost"));
  EXPECT_EQ(used(all), "per-frame");
  const auto cached = inspected({}, true);
  EXPECT_EQ(result_of(*cached), result_of(*inspect_desk(cached->settings)));
}

TEST(Inspector, WritesPlanesOfAJudgedSceneAndARefusedSolution) {
  const auto judged = inspect_desk({.frames = 12});
  EXPECT_FALSE(to_json(*judged)["verdict"]["planes"].empty());
  Initialization initialization = *judged->initialization;
  initialization.verdict->scene = SceneKind::unknown;
  Inspection inspection = *judged;
  inspection.initialization = std::make_shared<Initialization>(initialization);
  EXPECT_TRUE(to_json(inspection)["verdict"]["planes"].empty());
  inspection.initialization =
      std::make_shared<Initialization>(refused("wrong minimum", *judged->initialization));
  const auto before = to_json(*judged), json = to_json(inspection);
  EXPECT_FALSE(before.contains("refused"));
  EXPECT_EQ(json["reason"], "wrong minimum");
  EXPECT_TRUE(json["plane"].is_null() && json["frames"][11]["p_wc"].is_null());
  EXPECT_EQ(json["refused"]["plane"], before["plane"]);
  for (const char* key : {"index", "p_wc", "q_wc_xyzw"})
    EXPECT_EQ(json["refused"]["frames"][11][key], before["frames"][11][key]);
}

TEST(Inspector, ReusesALongerWindowForAShorterOne) {
  Recording from_board = *desk();
  from_board.truth.reset();
  for (const auto& recording : {desk(), std::make_shared<const Recording>(from_board)}) {
    Inspector used(recording);
    const Settings settings{.start = 2, .frames = 9};
    const auto longer = used.inspect({.start = 2, .frames = 16});
    int tracked = 0;
    const auto shorter = used.inspect(settings, {}, [&](const std::string& stage, int, int) {
      const bool solves = stage == "initializing" || stage.find("iteration") != std::string::npos;
      tracked += solves ? 0 : 1;
    });
    EXPECT_EQ(tracked, 0);  // neither tracked nor searched for the board
    EXPECT_EQ(result_of(*shorter), result_of(*Inspector(recording).inspect(settings)));
    EXPECT_LT(shorter->timing.track, longer->timing.track);
    EXPECT_GT(shorter->timing.track, 0);
  }
}

TEST(Inspector, EndsTracksOfAShorterWindowAsIfAlone) {
  Inspector used(desk());
  const auto longer = used.inspect({.frames = 30}), shorter = used.inspect({.frames = 12});
  const auto alone = inspect_desk({.frames = 12});
  ASSERT_EQ(shorter->tracks->forward_backward_px.size(), 12U);
  int ends = 0, later = 0;
  for (int j = 0; j < shorter->tracks->track_count(); ++j) {
    const auto& end = shorter->tracks->ends[j];
    ASSERT_EQ(end.has_value(), alone->tracks->ends[j].has_value());
    later += longer->tracks->ends[j].has_value() && !end ? 1 : 0;
    if (!end) continue;
    ++ends;
    EXPECT_LT(end->frame, 12);
    EXPECT_EQ(end->frame, alone->tracks->ends[j]->frame);
    EXPECT_EQ(end->reason, alone->tracks->ends[j]->reason);
  }
  EXPECT_GT(ends, 0);
  EXPECT_GT(later, 0);
}

TEST(Inspector, ExcludesTracksAndRestoresThem) {
  Inspector inspector(desk());
  const auto whole = inspector.inspect({.frames = 12});
  const auto without = inspector.inspect({.frames = 12, .exclude = {3, 17}});
  EXPECT_EQ(without->tracks, whole->tracks);
  EXPECT_EQ(without->window->track_count(), whole->window->track_count());
  for (int i = 0; i < 12; ++i)
    for (const int j : {3, 17}) {
      EXPECT_FALSE(without->window->inlier[i][j]);
      EXPECT_FALSE(without->window->points_px[i].col(j).allFinite());
    }
  EXPECT_NE(without->initialization->plane.normal, whole->initialization->plane.normal);
  EXPECT_EQ(to_json(*without)["settings"]["exclude"], (std::vector<int>{3, 17}));
  EXPECT_FALSE(to_json(*whole)["settings"].contains("exclude"));
  EXPECT_EQ(result_of(*inspector.inspect({.frames = 12})), result_of(*whole));
}

/// Returns the recording with its own tracks, of which a few jump.
std::shared_ptr<const Recording> with_gross_outliers(const std::vector<std::int64_t>& wrong) {
  Recording recording = *desk();
  const auto inspection = inspect_desk({.frames = 12, .options = {.method = "gpo"}});
  const Tracks& tracks = *inspection->tracks;
  for (int i = 0; i < 12; ++i)
    for (int j = 0; j < tracks.track_count(); ++j) {
      if (!tracks.seen(11, j) || !inspection->window->inlier[11][j]) continue;
      const bool jumps = i > 0 && std::ranges::find(wrong, j) != wrong.end();
      recording.tracks.push_back(
          {i, j, tracks.raw_px[i].col(j) + Eigen::Vector2d(jumps ? 4.0 * i : 0, 0)});
    }
  return std::make_shared<const Recording>(std::move(recording));
}

TEST(Inspector, IgnoresExcludedGrossOutliers) {
  const auto clean =
      Inspector(with_gross_outliers({})).inspect({.frames = 12, .options = {.ransac = false}});
  const std::vector<std::int64_t> ids(clean->tracks->ids.begin() + 5,
                                      clean->tracks->ids.begin() + 8);
  const auto recording = with_gross_outliers(ids);
  Recording bare = *recording;
  std::erase_if(bare.tracks, [&](const TrackObservation& o) {
    return std::ranges::find(ids, o.track) != ids.end();
  });
  for (const Method& method : methods()) {
    SCOPED_TRACE(method.key);
    Settings settings{.frames = 12, .options = {.method = method.key, .ransac = false}};
    const auto never = Inspector(std::make_shared<const Recording>(bare)).inspect(settings);
    Inspector inspector(recording);
    const auto spoiled = inspector.inspect(settings);
    settings.exclude = ids;
    const auto freed = inspector.inspect(settings);
    ASSERT_TRUE(freed->initialization->ok) << freed->initialization->reason;
    // Methods that use all tracks find the outliers themselves.
    const double more = method.needs_plane ? 0 : 1e-6;
    EXPECT_LT(freed->initialization->rms_px,
              spoiled->initialization->ok ? spoiled->initialization->rms_px + more : 100);
    EXPECT_LT(angle_deg(freed->initialization->plane.normal, never->initialization->plane.normal),
              1e-3);
    EXPECT_NEAR(freed->initialization->rms_px, never->initialization->rms_px, 1e-6);
  }
}

TEST(Inspector, StopsWhileTrackingAndRestarts) {
  Inspector inspector(desk());
  std::stop_source source;
  int tracked = 0;
  const auto stopped =
      inspector.inspect({.frames = 12}, source.get_token(), [&](const auto&, int done, int) {
        tracked = done;
        if (done == 4) source.request_stop();
      });
  EXPECT_EQ(stopped, nullptr);
  EXPECT_EQ(tracked, 4);
  EXPECT_NE(inspector.inspect({.frames = 12}), nullptr);
}

// It stops between the rotations and the method, so that the stages after the window are new.
TEST(Inspector, DoesNotCacheAStoppedGrowth) {
  const auto alone = inspect_desk({.frames = 12, .options = {.method = "gpo"}});
  Inspector inspector(desk());
  std::stop_source source;
  Settings settings{.frames = 12, .options = {.method = "ba"}};
  const auto stopped =
      inspector.inspect(settings, source.get_token(), [&](const std::string& stage, int, int) {
        if (stage == "initializing") source.request_stop();
      });
  EXPECT_EQ(stopped, nullptr);
  settings.options.method = "gpo";
  const auto next = inspector.inspect(settings);
  ASSERT_EQ(next->growth.size(), 11U);
  for (int k = 0; k < 11; ++k) EXPECT_EQ(next->growth[k].reason, alone->growth[k].reason);
}

TEST(Inspector, PlacesTheCubeOnTheBoardAsInTruth) {
  const auto inspection = inspect_desk({});
  ASSERT_TRUE(inspection->cube && inspection->true_cube);
  EXPECT_TRUE(inspection->cube->on_board);
  // The bundled recording's squares measure 25 mm.
  EXPECT_NEAR(inspection->true_cube->unit, 0.025, 0.0002);
  EXPECT_NEAR(inspection->cube->unit * *inspection->evaluation->scale, 0.025, 0.0005);
  const Plane& plane = inspection->initialization->plane;
  EXPECT_NEAR(plane.normal.dot(inspection->cube->origin) + plane.distance, 0, 1e-12);
}

TEST(Inspector, PassesTheUncertaintyOfRotationsToTheWindow) {
  Inspector inspector(desk());
  const auto window = [&](RotationSource source) {
    return inspector.inspect({.frames = 16, .options = {.rotations = source}})->window;
  };
  const Eigen::Vector3d own = desk()->gyroscope->bias_rad_s;
  const auto gyro = window(RotationSource::gyro);
  EXPECT_EQ(gyro->rotations, RotationModel::bias);
  EXPECT_EQ(gyro->gyro->bias_rad_s, own);
  EXPECT_EQ(gyro->gyro->prior_rad_s, own);
  EXPECT_EQ(gyro->gyro->d_bias.size(), 16U);
  const auto calibrated = window(RotationSource::gyro_calibrated);
  EXPECT_EQ(calibrated->rotations, RotationModel::bias);
  EXPECT_NE(calibrated->gyro->bias_rad_s, own);
  EXPECT_EQ(calibrated->gyro->prior_rad_s, own);
  for (const auto& [source, model] : {std::pair(RotationSource::averaging, RotationModel::free),
                                      std::pair(RotationSource::truth, RotationModel::known)}) {
    EXPECT_EQ(window(source)->rotations, model);
    EXPECT_FALSE(window(source)->gyro);
  }
}

// The desk is one plane, on which five-point rotations are ambiguous.
TEST(Inspector, ReportsWhyItAveragesWithoutAGyroscope) {
  Recording bare = *desk();
  bare.gyroscope.reset();
  Inspector inspector(std::make_shared<const Recording>(bare));
  const auto automatic = inspector.inspect({.frames = 16});
  EXPECT_EQ(automatic->rotations_used, RotationSource::averaging);
  EXPECT_EQ(to_json(*automatic)["settings"]["rotations"], "averaging");
  const std::string reason = to_json(*automatic)["rotations_note"];
  EXPECT_THAT(reason, HasSubstr("five-point rotations: ambiguous"));
  EXPECT_THAT(to_text(*automatic), HasSubstr("averaging (" + reason + ")"));
  const auto requested =
      inspector.inspect({.frames = 16, .options = {.rotations = RotationSource::averaging}});
  EXPECT_EQ(requested->window->R_wc, automatic->window->R_wc);
  EXPECT_FALSE(to_json(*requested).contains("rotations_note"));
  for (const auto source : {RotationSource::five_point, RotationSource::direct}) {
    const auto rejected = inspector.inspect({.frames = 16, .options = {.rotations = source}});
    EXPECT_EQ(rejected->rotations_used, source);
    EXPECT_FALSE(rejected->initialization->ok);
    EXPECT_THAT(rejected->initialization->reason, HasSubstr("nearly all tracks lie on one plane"));
  }
}

TEST(Inspector, ReportsInputThatARecordingLacks) {
  const auto error_with = [](const Recording& recording, const Settings& settings) {
    return error_of(
        [&] { Inspector(std::make_shared<const Recording>(recording)).inspect(settings); });
  };
  const Settings by_gyro{.options = {.rotations = RotationSource::gyro}};
  const Settings by_truth{.options = {.rotations = RotationSource::truth}};
  Recording bare = *desk();
  bare.truth->poses[7].reset();
  EXPECT_THAT(error_with(bare, by_truth), HasSubstr("frame 7 has no ground truth"));
  bare.gyroscope.reset();
  bare.truth.reset();
  bare.board.reset();
  EXPECT_EQ(error_with(bare, by_gyro), "rotations: gyro: desk has no gyroscope");
  EXPECT_THAT(error_with(bare, by_truth), HasSubstr("rotations: truth: desk has no ground truth"));
  bare.images.reset();
  EXPECT_THAT(error_with(bare, {}), HasSubstr("no images and no tracks"));
  const int last = inspect_desk({.frames = 12})->tracks->track_count() - 1;
  EXPECT_EQ(
      error_with(*desk(), {.frames = 12, .exclude = {3, 9999}}),
      "exclude: track 9999 is not in the window, which has tracks 0 to " + std::to_string(last));
}

TEST(Inspector, NamesFaultyFramesOfAWindowInTheMiddleOfALongRecording) {
  constexpr int kFrames = 500, kBlack = 412;
  Recording longer = *desk();
  const int count = longer.frame_count();
  for (int i = count; i < kFrames; ++i)
    longer.timestamps_ns.push_back(longer.timestamps_ns.back() + 50'000'000);
  longer.gyroscope.reset();
  longer.truth.reset();
  longer.board.reset();
  longer.images = std::make_shared<const FrameCache>(kFrames, [=](int i) {
    const cv::Mat image = desk()->images->bgr(i % count);
    return i == kBlack ? cv::Mat(0 * image) : image;
  });
  Inspector inspector(std::make_shared<const Recording>(std::move(longer)));
  const auto note_at = [&](int start) {
    const auto inspection = inspector.inspect({.start = start, .frames = 12});
    const Finding* found = find_finding(inspection->findings, "faulty-frames");
    return found == nullptr ? "" : found->sentence;
  };
  EXPECT_EQ(note_at(count), "");
  EXPECT_EQ(note_at(kBlack - 6), "faulty frames: 1 (412) are black; `--start 406` leaves them out");
}

}  // namespace
}  // namespace gpo::test
