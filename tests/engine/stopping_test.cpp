// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Stops each kind of long work at a check that the test chooses, so that nothing depends on the
// speed of the machine.
#include "engine/base/internal/background_job.h"
#include "engine/base/parallel.h"
#include "engine/base/stop.h"
#include "engine/calibration/calibrate.h"
#include "engine/experiment/row.h"
#include "engine/inspection/inspector.h"
#include "engine/recording/board/board.h"
#include "engine/recording/layouts/open_recording.h"
#include "engine/recording/layouts/write_recording.h"
#include "engine/results/result_method.h"
#include "engine/synthesis/synthesize.h"
#include "tests/engine/recording/bags/small_bag.h"
#include "tests/engine/recording/images/made_video.h"
#include "tests/engine/synthesis/small_recipe.h"
#include "tests/engine/test_folder.h"

#include <atomic>
#include <limits>

namespace gpo::test {
namespace {

namespace fs = std::filesystem;

struct Outcome {
  int checks = 0;  ///< calls of `check_stop`
  int late = 0;    ///< after the request
  bool stopped = false;
};

/// Requests a stop at the check with this number, from 1 on.
Outcome stopped_at(int number, const std::function<void()>& work) {
  std::stop_source source;
  std::atomic<int> checks = 0, late = 0;
  const StopWatch watch{source.get_token(), [&] {
                          if (source.stop_requested()) ++late;
                          if (++checks == number) source.request_stop();
                        }};
  const StopScope scope(&watch);
  try {
    work();
    return {checks, late, false};
  } catch (const Stopped&) {
    return {checks, late, true};
  }
}

Outcome undisturbed(const std::function<void()>& work) {
  return stopped_at(std::numeric_limits<int>::max(), work);
}

TEST(Stop, ScopesNestAndEnd) {
  std::stop_source source;
  source.request_stop();
  const StopWatch stopped{.stop = source.get_token()};
  EXPECT_NO_THROW(check_stop());
  {
    const StopScope scope(&stopped);
    EXPECT_THROW(check_stop(), Stopped);
    {
      const StopScope to_the_end(nullptr);
      EXPECT_NO_THROW(check_stop());
    }
    EXPECT_TRUE(current_stop().stop_requested());
  }
  EXPECT_FALSE(current_stop().stop_possible());
}

TEST(Stop, ReachesTheThreadsOfAParallelLoop) {
  const auto loop = [] { in_parallel(1000, 3, [](int) {}); };
  EXPECT_EQ(undisturbed(loop).checks, 1000);
  const Outcome outcome = stopped_at(500, loop);
  EXPECT_TRUE(outcome.stopped);
  EXPECT_LE(outcome.late, 2);  // each other thread once
}

TEST(Stop, DoesNotHideTheErrorThatCausedIt) {
  std::stop_source source;
  const StopWatch watch{.stop = source.get_token()};
  const StopScope scope(&watch);
  const auto fail_once = [&](int i) {
    if (i != 100) return;
    source.request_stop();
    throw InputError("line 100 is broken");
  };
  EXPECT_EQ(error_of([&] { in_parallel(1000, 3, fail_once); }), "line 100 is broken");
}

TEST(Stop, EndsABackgroundJobWithoutAnError) {
  std::atomic<bool> runs = false, taken = false;
  BackgroundJob job([&]() -> BackgroundJob::Job {
    if (taken.exchange(true)) return nullptr;
    return [&](const std::stop_token&) {
      while (true) {
        runs = true;
        check_stop();
        std::this_thread::yield();
      }
    };
  });
  auto lock = job.lock();
  job.wake();
  lock.unlock();
  while (!runs) std::this_thread::yield();
  lock.lock();
  job.cancel();
  job.wait_until_idle(lock);
  EXPECT_EQ(job.status().error, "");
}

std::string lines(int count, const std::function<std::string(int)>& line) {
  std::string text;
  for (int i = 0; i < count; ++i) text += line(i) + "\n";
  return text;
}

std::shared_ptr<const Recording> desk() {
  return open_recording(GPO_SOURCE_DIR "/sequences/desk", {.tracks = {}, .cache_bytes = 0});
}

void write_as(RecordingFormat format, const TestFolder& folder, const char* name) {
  const auto opened = open_recording(folder.path() / "in" / "small.bag");
  write_recording(*opened, opened->truth, format, folder.path() / "out" / name);
}

/// Work that reads from the folder `in` and writes to `out`.
struct LongWork {
  const char* name;
  int least_checks;  ///< grow with the input, so that one piece of it delays a stop
  void (*prepare)(const TestFolder& folder);
  void (*work)(const TestFolder& folder);
};

void PrintTo(const LongWork& one, std::ostream* stream) { *stream << one.name; }

const LongWork kReading[] = {
    {"csv",
     6000,
     [](const TestFolder& folder) {
       folder.write("in/tracks.csv", "frame,track,x,y\n" + lines(2000, [](int i) {
                                       return fmt::format("{},{},3,4", i % 10, i);
                                     }));
     },
     [](const TestFolder& folder) { read_tracks(folder.path() / "in/tracks.csv", 10); }},
    {"results_of_evaluate",
     2000,
     [](const TestFolder& folder) {
       folder.write("in/results.csv",
                    "recording,configuration,start,frames,status\n" +
                        lines(2000, [](int i) { return fmt::format("desk,gpo,{},5,ok", i); }));
     },
     [](const TestFolder& folder) { read_results(folder.path() / "in/results.csv", {}); }},
    {"trajectory",
     2000,
     [](const TestFolder& folder) {
       folder.write("in/path.txt",
                    lines(2000, [](int i) { return fmt::format("{} 0 0 0 0 0 0 1", 0.1 * i); }));
     },
     [](const TestFolder& folder) { read_result_poses(folder.path() / "in/path.txt"); }},
    {"colmap_points",
     2000,
     [](const TestFolder& folder) {
       folder.write("in/points3D.txt",
                    lines(2000, [](int i) { return fmt::format("{} 1 2 3 0 0 0 0.5", i); }));
     },
     [](const TestFolder& folder) { read_result_points(folder.path() / "in/points3D.txt"); }},
    {"video",
     100,
     [](const TestFolder& folder) {
       make_video(folder.path() / "in/v.mp4",
                  std::vector<cv::Mat>(100, cv::Mat(48, 64, CV_8UC3, cv::Scalar(9, 9, 9))));
     },
     [](const TestFolder& folder) { open_recording(folder.path() / "in/v.mp4"); }},
    {"bag",
     40,
     [](const TestFolder& folder) { write_small_bag(folder.path() / "in/small.bag", ros1_writer); },
     [](const TestFolder& folder) { open_recording(folder.path() / "in/small.bag"); }},
    {"mcap",
     40,
     [](const TestFolder& folder) {
       write_small_bag(folder.path() / "in/small.mcap", mcap_writer);
     },
     [](const TestFolder& folder) { open_recording(folder.path() / "in/small.mcap"); }},
    {"euroc", 100, [](const TestFolder&) {}, [](const TestFolder&) { desk(); }},
    {"identity", 60, [](const TestFolder&) {}, [](const TestFolder&) { content_of(*desk()); }}};

const LongWork kComputing[] = {
    {"inspection",
     10,
     [](const TestFolder&) {},
     [](const TestFolder&) { Inspector(desk()).inspect({.frames = 10}); }},
    {"board",
     60,
     [](const TestFolder&) {},
     [](const TestFolder&) {
       find_calibration_views(*desk()->images, Board{9, 6, 0.025}, 30, {});
     }},
    {"convert_to_euroc",
     20,
     [](const TestFolder& folder) { write_small_bag(folder.path() / "in/small.bag", ros1_writer); },
     [](const TestFolder& folder) { write_as(RecordingFormat::euroc, folder, "euroc"); }},
    {"convert_to_mcap",
     20,
     [](const TestFolder& folder) { write_small_bag(folder.path() / "in/small.bag", ros1_writer); },
     [](const TestFolder& folder) { write_as(RecordingFormat::mcap, folder, "a.mcap"); }},
    {"synthesis",
     20,
     [](const TestFolder&) {},
     [](const TestFolder& folder) {
       synthesize(recipe_of(small_recipe_text()), folder.path() / "out" / "made", {}, 2);
     }}};

class EveryWork : public testing::TestWithParam<LongWork> {};
INSTANTIATE_TEST_SUITE_P(Reading, EveryWork, testing::ValuesIn(kReading), [](const auto& info) {
  return std::string(info.param.name);
});
INSTANTIATE_TEST_SUITE_P(Computing, EveryWork, testing::ValuesIn(kComputing), [](const auto& info) {
  return std::string(info.param.name);
});

TEST_P(EveryWork, StopsAtTheNextCheckAndLeavesNoOutput) {
  const LongWork& one = GetParam();
  const TestFolder folder;
  fs::create_directories(folder.path() / "in");
  const fs::path out = folder.path() / "out";
  one.prepare(folder);
  const auto work = [&] {
    fs::remove_all(out);
    fs::create_directories(out);
    one.work(folder);
  };
  const Outcome whole = undisturbed(work);
  EXPECT_FALSE(whole.stopped);
  EXPECT_GE(whole.checks, one.least_checks);
  for (const int number : {1, whole.checks / 3, whole.checks * 9 / 10}) {
    const Outcome outcome = stopped_at(number, work);
    EXPECT_TRUE(outcome.stopped) << number;
    constexpr int kThreads = 64;  // each may check once more, and their cleanup
    EXPECT_LE(outcome.checks, number + kThreads);
    EXPECT_TRUE(fs::is_empty(out)) << number;
  }
  EXPECT_FALSE(undisturbed(work).stopped);
}

TEST(Stop, LeavesAVideoThatDecodesTheSameImages) {
  const TestFolder folder;
  std::vector<cv::Mat> images;
  for (int i = 0; i < 40; ++i)
    images.emplace_back(48, 64, CV_8UC3, cv::Scalar(6 * i, 255 - 6 * i, 90));
  make_video(folder.path() / "v.mp4", images, {.b_frames = true});
  const auto read = [&] {
    return open_recording(folder.path() / "v.mp4", {.tracks = {}, .cache_bytes = 0});
  };
  const auto expected = read(), disturbed = read();
  const auto decode = [&] { disturbed->images->bgr(35); };
  for (const int number : {2, 3, 5, 8}) {
    disturbed->images->forget();
    EXPECT_TRUE(stopped_at(number, decode).stopped) << number;
    for (const int frame : {36, 35, 11})
      EXPECT_EQ(cv::norm(disturbed->images->bgr(frame), expected->images->bgr(frame), cv::NORM_INF),
                0)
          << number << " " << frame;
  }
}

}  // namespace
}  // namespace gpo::test
