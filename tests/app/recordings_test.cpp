// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/experiment/runner.h"
#include "engine/files/text_file.h"
#include "engine/geometry/pose.h"
#include "engine/geometry/statistics.h"
#include "engine/initialize.h"
#include "engine/inspection/inspector.h"
#include "engine/live.h"
#include "engine/methods/methods.h"
#include "engine/recording/layouts/open_recording.h"
#include "engine/synthesis/synthesize.h"
#include "tests/app/program.h"
#include "tests/engine/pipeline/simulated_frames.h"
#include "tests/engine/synthesis/small_recipe.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <functional>
#include <map>
#include <numeric>

#include <gmock/gmock.h>

namespace gpo::test {
namespace {

using testing::HasSubstr;

/// Limits for every method if there is enough parallax: about three times the observed errors.
constexpr double kMostPne_deg = 6;
constexpr double kMostAte_m = 0.006;

// Synthesizes missing recordings, which takes some minutes.
TEST(NineRecordings, EveryMethodSucceedsWithParallaxAndRefusesRotation) {
  const std::vector<std::string> names = rendered_recordings();
  std::string recipes;
  for (const std::string& name : names) recipes += "sequences/" + name + ".yaml ";
  const fs::path folder = fresh_folder() / "evaluation";
  succeeding("evaluate {}--lengths 30 --starts 0:30:30 --output {}", recipes, folder);
  const Experiment experiment = read_experiment(folder);
  const std::vector<Row> rows = collect_rows(experiment, std::span(&folder, 1));
  EXPECT_EQ(rows.size(), names.size() * 2 * experiment.configurations.size());
  EXPECT_GE(experiment.configurations.size(), methods().size() + 4);
  for (const Row& row : rows) {
    SCOPED_TRACE(row.recording + " " + row.configuration);
    if (row.recording == "rotation-dominant") {
      EXPECT_FALSE(row.ok());
      EXPECT_THAT(row.reason, HasSubstr("no parallax"));
      continue;
    }
    const bool of_all_tracks =
        row.configuration.ends_with("five-point") || row.configuration.ends_with("direct");
    if (of_all_tracks && !row.ok()) {
      EXPECT_THAT(row.reason, HasSubstr("nearly all tracks lie on one plane"));
      continue;
    }
    EXPECT_TRUE(row.ok()) << row.reason;
    // Without RANSAC, points off the plane distort it.
    if (!row.ok() || row.configuration == "gpo+no-ransac") continue;
    EXPECT_LT(row.pne_deg, kMostPne_deg);
    EXPECT_LT(row.ate_m, kMostAte_m);
  }
}

/// Errors of the normal in claimed standard deviations, by method.
std::map<std::string, std::vector<double>> sigmas_on_rendered(Preset preset) {
  std::map<std::string, std::vector<double>> sigmas;
  for (const std::string& name : rendered_recordings()) {
    const fs::path recipe = fs::path(GPO_SOURCE_DIR) / "sequences" / (name + ".yaml");
    Inspector inspector(
        open_recording(synthesized_recordings(std::span(&recipe, 1), GPO_RECORDINGS_DIR, 2)[0]));
    for (const Method& method : methods())
      for (const int start : {0, 30}) {
        Settings settings = with_preset({.start = start}, preset);
        settings.options.method = method.key;
        const auto inspection = inspector.inspect(settings);
        const Initialization& result = *inspection->initialization;
        if (!result.ok) continue;
        const double sigma_deg = result.uncertainty->normal_sigma_deg;
        EXPECT_TRUE(result.uncertainty->own) << name << method.key;
        EXPECT_EQ(result.verdict->normal_sigma_deg, sigma_deg) << name << method.key;
        EXPECT_EQ(inspection->growth.back().normal_sigma_deg, sigma_deg) << name << method.key;
        sigmas[method.key].push_back(*inspection->evaluation->pne_deg / sigma_deg);
      }
  }
  return sigmas;
}

class NineUncertainties : public testing::TestWithParam<Preset> {};
INSTANTIATE_TEST_SUITE_P(,
                         NineUncertainties,
                         testing::Values(Preset::best, Preset::paper),
                         [](const auto& each) { return std::string(to_string(each.param)); });

// Tracks from frame to frame drift alike in all regions, which no choice of tracks shows. The
// methods with free rotations and all points on the plane follow the drift.
TEST_P(NineUncertainties, MatchTheErrorsOfEveryMethod) {
  const bool drifts = GetParam() == Preset::paper;
  for (const auto& [method, sigmas] : sigmas_on_rendered(GetParam())) {
    const double middle = median(sigmas);
    RecordProperty(method, std::to_string(middle));
    EXPECT_GT(middle, 0.2) << method;
    EXPECT_LT(middle, drifts && (method == "pba" || method == "fpba") ? 3.5 : 2) << method;
  }
}

/// Empty if initialization failed.
json room_result(const std::string& name, int start, int frames = 20) {
  const Outcome outcome =
      program("run {} --start {} --frames {} --json -", shared(name), start, frames);
  return json::accept(outcome.out) ? json::parse(outcome.out) : json::object();
}

/// Without window 25: the baseline is a tenth of the distance, so that tracks on the wall pass the
/// gate of the floor's homography and tilt the floor by 6 deg.
TEST(RealRooms, FloorOfEurocIsFoundFirst) {
  SKIP_WITHOUT(shared("euroc-room"));
  std::vector<double> normal_deg, path_m;
  double bias_squares = 0, clock_squares = 0;
  const auto starts = {0, 5, 10, 15, 20, 30, 35, 40};
  for (const int start : starts) {
    const json result = room_result("euroc-room", start);
    ASSERT_EQ(result["status"], "ok") << start;
    normal_deg.push_back(result["metrics"]["pne_deg"]);
    path_m.push_back(result["metrics"]["ate_m"]);
    EXPECT_LT(normal_deg.back(), 3.5) << start;
    EXPECT_GE(result["planes"].size(), 2) << start;
    const std::array<double, 3> bias = result["bias_rad_s"];
    const std::array known{-0.0022, 0.0208, 0.0765};  // from the publishers of the data set
    const json& covariance = result["uncertainty"]["bias_covariance_rad2_s2"];
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(bias[k], known[k], 0.01) << start;
      bias_squares += std::pow(bias[k] - known[k], 2) / covariance[k][k].get<double>();
    }
    const double sigma_s = result["time_offset_sigma_s"];
    EXPECT_LT(sigma_s, 0.003) << start;
    clock_squares += std::pow(result["time_offset_s"].get<double>() / sigma_s, 2);
  }
  EXPECT_LT(bias_squares / static_cast<double>(3 * starts.size()), 2);
  EXPECT_LT(clock_squares / static_cast<double>(starts.size()), 3);  // the clocks are one
  EXPECT_LT(median(normal_deg), 1.5);
  EXPECT_LT(median(path_m), 0.003);
}

TEST(RealRooms, PlanesAreNamed) {
  SKIP_WITHOUT(shared("euroc-room"));
  int named_walls = 0;
  for (const int start : {0, 5, 10, 15, 20}) {
    const json result = room_result("euroc-room", start, 40);
    EXPECT_EQ(result["planes"][0]["name"], "floor") << start;
    for (std::size_t k = 1; k < result["planes"].size(); ++k) {
      const json& plane = result["planes"][k];
      EXPECT_EQ(plane.value("name", "wall"), "wall") << start;
      named_walls += plane.contains("name");
    }
  }
  EXPECT_GE(named_walls, 4);  // from start 15 on the uncertainty of the wall's normal is 41 deg
}

TEST(RealRooms, NormalErrorsMatchTheirStandardDeviations) {
  SKIP_WITHOUT(shared("euroc-room"));
  struct Known {
    std::string name;
    int end;
    double truth_deg = 0;  ///< default: from the board's poses
  };
  const int step = all_recordings() ? 20 : 40;
  std::vector<double> sigmas;
  for (const auto& [name, end, truth_deg] : {Known{"chessboard-dark", 280},
                                             {"chessboard-floor", 230},
                                             {"euroc-room", 41, 0.7},
                                             {"tags-mountain", 560, 0.2},
                                             {"tags-straight", 280, 0.2}})
    for (int start = 0; start < end; start += step) {
      json result = room_result(name, start);
      EXPECT_THAT(result.value("notes", std::vector<std::string>()),
                  testing::Each(HasSubstr("rolling shutter")))
          << "no jump of the truth: " << name << start;
      if (result.value("status", "") != "ok" || result["metrics"]["pne_deg"].is_null()) continue;
      const json board_deg = result["truth"]["normal_sigma_deg"];
      const double of_truth_deg =
          truth_deg == 0 && board_deg.is_number() ? board_deg.get<double>() : truth_deg;
      const double own_deg = result["uncertainty"]["normal_sigma_deg"];
      const double error_deg = result["metrics"]["pne_deg"];
      sigmas.push_back(error_deg / std::hypot(own_deg, of_truth_deg));
      EXPECT_TRUE(error_deg < 3 || result["verdict"]["readiness"] == "weak") << name << start;
    }
  ASSERT_GT(sigmas.size(), 1000 / step);
  EXPECT_GT(median(sigmas), 0.5);
  EXPECT_LT(median(sigmas), 2);
  const auto above_four = std::ranges::count_if(sigmas, [](double s) { return s > 4; });
  EXPECT_LE(static_cast<double>(above_four), 0.1 * static_cast<double>(sigmas.size()));
}

constexpr double kReadout_s = 0.02;
constexpr double kClock_s = 0.008;

json result_from(const fs::path& recording, int start, const std::string& more = "") {
  return run_json("{} --start {} --frames 30 {}", recording, start, more);
}

fs::path changed_room(const std::string& file,
                      const std::function<std::string(std::string)>& change) {
  fs::path folder = fs::path(GPO_TEST_OUTPUT_DIR) / ("changed-" + fs::path(file).stem().string());
  fs::remove_all(folder);
  fs::copy(small_room(), folder, fs::copy_options::recursive);
  const std::string before = read_file(folder / file), after = change(before);
  EXPECT_NE(before, after);
  write_file(folder / file, after);
  return folder;
}

/// Expects errors of normal, path, gravity and scale within their standard deviations.
void expect_accurate(const json& result) {
  ASSERT_EQ(result.value("status", ""), "ok") << result.dump().substr(0, 300);
  const json &metrics = result["metrics"], &inertial = result["inertial"];
  const double error_deg = metrics["pne_deg"];
  EXPECT_LT(error_deg, 0.8);
  EXPECT_LT(error_deg, 4 * result["uncertainty"]["normal_sigma_deg"].get<double>());
  EXPECT_LT(metrics["ate_m"], 0.002);
  EXPECT_LT(metrics["gravity_error_deg"], 1.5);
  EXPECT_LT(std::abs(std::log1p(metrics["scale_error_percent"].get<double>() / 100)),
            4 * inertial["sigma"].get<double>());
  EXPECT_EQ(result["planes"][0]["name"], "floor");
  EXPECT_GE(result["planes"].size(), 3);
  for (std::size_t k = 1; k < result["planes"].size(); ++k)
    EXPECT_NE(result["planes"][k].value("name", ""), "floor");
}

class RenderedRooms : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Starts, RenderedRooms, testing::Values(0, 20));

TEST_P(RenderedRooms, FloorGravityAndScaleAreEstimated) {
  const json result = result_from(small_room(), GetParam());
  expect_accurate(result);
  const std::array truth{-0.0031, 0.0212, 0.0771};
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(result["bias_rad_s"][k], truth[k], 0.002);
}

TEST_P(RenderedRooms, RollingShutterIsEstimated) {
  const json result = result_from(small_room(kReadout_s), GetParam());
  expect_accurate(result);
  EXPECT_NEAR(result["row_delay_s"], kReadout_s / 240, 0.1 * kReadout_s / 240);
}

TEST_P(RenderedRooms, WrongDistortionStaysWithinTheUncertainty) {
  const auto bend = [](const std::string& text) {
    return replaced(text, {{"0.092", "0.080"}, {"-0.184", "-0.150"}});
  };
  expect_accurate(result_from(changed_room("mav0/cam0/sensor.yaml", bend), GetParam()));
}

TEST_P(RenderedRooms, LateClockIsEstimated) {
  const auto delay = [](const std::string& text) {
    std::string late;
    for (std::string line : split(text, '\n')) {
      if (!line.starts_with('#'))
        line.replace(
            0, line.find(','), std::to_string(std::stoll(line) + std::llround(1e9 * kClock_s)));
      late += line + "\n";
    }
    return late;
  };
  const json result = result_from(changed_room("mav0/imu0/data.csv", delay), GetParam());
  expect_accurate(result);
  EXPECT_NEAR(result["time_offset_s"], kClock_s, 0.001);
  EXPECT_LT(std::abs(result["time_offset_s"].get<double>() - kClock_s),
            3 * result["time_offset_sigma_s"].get<double>());
}

constexpr int kMostFrames = 40;

std::shared_ptr<const Recording> recording_of(const std::string& name) {
  if (fs::exists(shared(name))) return open_recording(shared(name));
  const fs::path recipe = GPO_SOURCE_DIR "/sequences/" + name + ".yaml";
  if (!fs::exists(recipe)) return nullptr;
  return open_recording(synthesized_recordings(std::span(&recipe, 1), GPO_RECORDINGS_DIR, 2)[0]);
}

std::shared_ptr<const Inspection> run(Inspector& inspector, int frames) {
  Settings settings;
  settings.frames = frames;
  settings.options.lens = Lens::exact;
  settings.options.method_options.error =
      ErrorModel::transfer;  // `LiveInitializer` uses it here, too
  return inspector.inspect(settings);
}

bool is_ready(const Inspection& window) {
  const Initialization& result = *window.initialization;
  return result.ok && result.verdict && result.verdict->readiness == Readiness::ready;
}

struct Expected {
  std::string name;
  bool ready;
  bool better = false;  ///< longer windows are also ready and agree
};

std::vector<Expected> expected() {
  std::vector<Expected> all;
  for (const std::string& name : rendered_recordings()) {
    const bool ready = name != "low-parallax" && name != "rotation-dominant";
    all.push_back({name, ready, ready});
  }
  all.push_back({"euroc-room", true, true});
  return all;
}

/// Compares live initialization with `run` on windows of every length.
class LiveRecordings : public testing::TestWithParam<Expected> {};

/// CPU time of this thread, independent of the load of the machine.
double thread_ms() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

TEST_P(LiveRecordings, AreReadyTogetherWithRunAndStayReady) {
  const auto recording = recording_of(GetParam().name);
  if (!recording) GTEST_SKIP() << "no recordings in " << GPO_SHARED_DIR;
  const int most = std::min(kMostFrames, recording->frame_count());
  Inspector inspector(recording);
  const auto longest = run(inspector, most);
  LiveOptions options{.background = false, .most_frames = most};
  options.initialize.lens = Lens::exact;
  options.initialize.method_options.error = ErrorModel::transfer;  // the tracks are anchored
  LiveInitializer initializer(recording->camera, options, recording->gyroscope);
  std::shared_ptr<const WindowResult> first;
  std::vector<double> ms;
  const std::vector<Frame> frames = frames_of(*longest);
  for (int i = 0; i < most; ++i) {
    const double begin_ms = thread_ms();
    const LiveStatus status = initializer.add_frame(frames[i]);
    ms.push_back(thread_ms() - begin_ms);
    ASSERT_FALSE(status.started_anew) << status.reason;
    if (!first && i > 0) {
      const auto alone = run(inspector, i + 1);
      ASSERT_EQ(status.ready, is_ready(*alone)) << i + 1 << " frames: " << status.reason;
      if (status.ready) expect_same(*alone->initialization, status.answer->initialization);
      if (status.ready) first = status.answer;
    } else if (first) {
      ASSERT_TRUE(status.ready);
      const double turn_deg =
          angle_deg(first->initialization.plane.normal, status.answer->initialization.plane.normal);
      EXPECT_LE(turn_deg, 4 * *first->initialization.verdict->normal_sigma_deg) << i + 1;
    }
  }
  const LiveStatus last = initializer.status();
  EXPECT_EQ(last.ready, GetParam().ready);
  EXPECT_EQ(last.answer && last.answer->window.frame_count() > 20, GetParam().better)
      << last.reason;
  fmt::print("{}: ready at {}, mean {:.2f} ms, worst {:.1f} ms; {}\n",
             GetParam().name,
             last.ready_frames,
             std::accumulate(ms.begin(), ms.end(), 0.0) / most,
             std::ranges::max(ms),
             last.reason);
}

INSTANTIATE_TEST_SUITE_P(All, LiveRecordings, testing::ValuesIn(expected()), [](const auto& info) {
  std::string name = info.param.name;
  std::ranges::replace(name, '-', '_');
  return name;
});

}  // namespace
}  // namespace gpo::test
