// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/error.h"
#include "engine/base/internal/background_job.h"
#include "engine/base/report_timer.h"
#include "engine/files/text_file.h"

#include <atomic>
#include <deque>
#include <new>
#include <semaphore>

#include <gmock/gmock.h>
#include <sys/resource.h>

namespace gpo {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;

TEST(Legible, EscapesControlsAndInvalidUtf8AndCutsBetweenCharacters) {
  EXPECT_EQ(legible("12.5 m/s, \u00e9 \u2013 \u65e5\u672c \U0001F600", 100),
            "12.5 m/s, \u00e9 \u2013 \u65e5\u672c \U0001F600");
  EXPECT_EQ(legible(std::string_view("a\nb\r\tc\0d\x1B[31m\x7F", 14), 100),
            "a\\nb\\r\\tc\\x00d\\x1B[31m\\x7F");
  EXPECT_EQ(legible("\xFF\xC0\x80\xED\xA0\x80", 100), "\\xFF\\xC0\\x80\\xED\\xA0\\x80");
  EXPECT_EQ(legible("\xC2\x9B", 100), "\\xC2\\x9B");  // a control of eight bits
  EXPECT_EQ(legible("\xE2\x82", 100), "\\xE2\\x82");  // truncated
  EXPECT_EQ(legible("\xF4\x90\x80\x80", 100), "\\xF4\\x90\\x80\\x80");
  EXPECT_EQ(legible("abcdef", 6), "abcdef");
  EXPECT_EQ(legible("abcdef", 5), "abcde...");
  EXPECT_EQ(legible("abc\u00e9", 4), "abc...");
  EXPECT_EQ(legible("abc\n", 4), "abc...");
}

TEST(InputErrors, AreOneShortLine) {
  const InputError error("a\nb" + std::string(1 << 20, 'x') + ", expected y");
  const std::string message = error.what();
  EXPECT_LE(message.size(), 1000U);
  EXPECT_TRUE(message.starts_with("a\\nbxxx")) << message;
  EXPECT_TRUE(message.ends_with("xxx, expected y")) << message;
  EXPECT_STREQ(InputError(error.what()).what(), error.what());  // idempotent
}

TEST(Messages, NameTheFileOfASystemError) {
  const fs::filesystem_error refused(
      "status", "/some/file", std::make_error_code(std::errc::too_many_symbolic_link_levels));
  EXPECT_EQ(message_of(refused), "/some/file: Too many levels of symbolic links");
  EXPECT_EQ(message_of(InputError("camera.yaml: is empty")), "camera.yaml: is empty");
  EXPECT_EQ(message_of(std::bad_alloc()), "not enough memory");
  EXPECT_EQ(message_of(std::logic_error("a\nbug")), "internal error, please report it: a\\nbug");
}

TEST(ReportTimer, IsDueEveryTenSeconds) {
  const ReportTimer::Clock::time_point begin{};
  ReportTimer timer(begin);
  for (const auto& [seconds, due] :
       {std::pair(0, false), {9, false}, {10, true}, {19, false}, {45, true}, {54, false}})
    EXPECT_EQ(timer.due(begin + std::chrono::seconds(seconds)), due) << seconds;
}

// A library must not change the process that loads it: the engine may not set global state of other
// libraries, look for the user's folders or depend on the environment.
/// UMat would use OpenCL if it is enabled, with different results.
constexpr const char* kNotInTheEngine =
    "av_log_set_level,av_log_set_callback,setUseOpenCL,setNumThreads,setUseOptimized,redirectError,"
    "UMat,getenv,setenv,setlocale,std::signal,sigaction,theRNG,srand(";

TEST(Engine, DoesNotChangeTheProcess) {
  int sources = 0;
  for (const auto& entry : fs::recursive_directory_iterator(GPO_SOURCE_DIR "/engine")) {
    const std::string ending = entry.path().extension().string();
    if (ending != ".cpp" && ending != ".h") continue;
    ++sources;
    const std::string text = read_file(entry.path());
    for (const std::string& name : split(kNotInTheEngine, ','))
      EXPECT_EQ(text.find(name), std::string::npos) << entry.path() << ": " << name;
  }
  EXPECT_GT(sources, 100);
}

void wake(BackgroundJob& job) {
  const auto lock = job.lock();
  job.wake();
}

/// Runs its only job when it is woken first.
BackgroundJob::Next once(BackgroundJob::Job job) {
  return [job]() mutable { return std::exchange(job, nullptr); };
}

/// An owner whose jobs begin, signal that and hold until the test releases them or they are
/// stopped. Multiples of ten never hold.
class BackgroundJobTest : public testing::Test {
 protected:
  ~BackgroundJobTest() override { released_ = true; }

  BackgroundJob::Job next() {
    if (requests_.empty()) return nullptr;
    const int request = requests_.front();
    requests_.pop_front();
    return [this, request](const std::stop_token& stop) { work(request, stop); };
  }

  void work(int request, const std::stop_token& stop) {
    started_.push_back(request);
    job_.report(stop, "working", request, 60);
    begun_.release();
    while (request % 10 != 0 && !released_ && !stop.stop_requested()) std::this_thread::yield();
    if (request < 0) throw InputError("request is negative");
    job_.publish(stop, [&] { results_.push_back(request); });
  }

  /// The newest request wins.
  void replace(int request) {
    const auto lock = job_.lock();
    job_.cancel();
    requests_ = {request};
    job_.wake();
  }
  void append(int request) {
    const auto lock = job_.lock();
    requests_.push_back(request);
    job_.wake();
  }
  void cancel() {
    const auto lock = job_.lock();
    requests_.clear();
    job_.cancel();
  }
  JobStatus status() {
    const auto lock = job_.lock();
    return job_.status();
  }
  void wait_until_idle() {
    auto lock = job_.lock();
    job_.wait_until_idle(lock);
  }

  std::atomic<bool> released_ = false;
  std::counting_semaphore<> begun_{0};
  std::vector<int> started_;  ///< by the job's thread; the test reads it when that is idle
  std::deque<int> requests_;
  std::vector<int> results_;
  BackgroundJob job_{[this] { return next(); }};
};

TEST_F(BackgroundJobTest, RunsRequestsInOrder) {
  for (const int request : {10, 20, 30}) append(request);
  wait_until_idle();
  EXPECT_THAT(results_, ElementsAre(10, 20, 30));
  EXPECT_FALSE(status().busy);
}

TEST_F(BackgroundJobTest, NewestRequestReplacesRunningAndWaitingOnes) {
  replace(1);
  begun_.acquire();
  replace(2);
  begun_.acquire();
  append(3);
  replace(40);
  wait_until_idle();
  EXPECT_THAT(started_, ElementsAre(1, 2, 40));
  EXPECT_THAT(results_, ElementsAre(40));
}

TEST_F(BackgroundJobTest, DropsResultOfAStoppedJobThatFinishes) {
  replace(1);
  begun_.acquire();
  {
    const auto lock = job_.lock();
    released_ = true;
    job_.cancel();
    requests_ = {20};
    job_.wake();
  }
  wait_until_idle();
  EXPECT_THAT(results_, ElementsAre(20));
}

TEST_F(BackgroundJobTest, CancelEndsTheRunningJobAndRunsNoOther) {
  append(1);
  begun_.acquire();
  append(2);
  cancel();
  wait_until_idle();
  EXPECT_THAT(started_, ElementsAre(1));
  EXPECT_THAT(results_, testing::IsEmpty());
  EXPECT_EQ(status().error, "");
  append(30);
  wait_until_idle();
  EXPECT_THAT(results_, ElementsAre(30));
}

TEST_F(BackgroundJobTest, CancelBeforeTheJobIsTakenLeavesItIdle) {
  {
    const auto lock = job_.lock();
    requests_ = {1};
    job_.wake();
    EXPECT_TRUE(job_.busy());
    requests_.clear();
    job_.cancel();
    EXPECT_FALSE(job_.busy());
  }
  append(20);
  wait_until_idle();
  EXPECT_THAT(started_, ElementsAre(20));
}

TEST_F(BackgroundJobTest, ReportsProgressWhileItRunsOnly) {
  append(41);
  begun_.acquire();
  const JobStatus running = status();
  EXPECT_TRUE(running.busy);
  EXPECT_EQ(running.stage, "working");
  EXPECT_EQ(running.done, 41);
  EXPECT_EQ(running.of, 60);
  cancel();
  wait_until_idle();
  EXPECT_EQ(status().stage, "");
  EXPECT_EQ(status().of, 0);
}

TEST_F(BackgroundJobTest, ExceptionIsTheErrorUntilTheNextRequest) {
  append(-10);
  wait_until_idle();
  EXPECT_EQ(status().error, "request is negative");
  cancel();
  EXPECT_EQ(status().error, "request is negative");
  append(1);
  EXPECT_EQ(status().error, "");
  released_ = true;
  wait_until_idle();
  EXPECT_THAT(results_, ElementsAre(1));
}

TEST_F(BackgroundJobTest, ExceptionOfAStoppedJobIsDropped) {
  append(-1);
  begun_.acquire();
  cancel();
  wait_until_idle();
  EXPECT_EQ(status().error, "");
}

TEST(BackgroundJob, CallsBackAfterReportsAndJobsButNotAfterAReplacedJob) {
  std::binary_semaphore begun{0};
  std::deque<bool> holds{true, false};
  int changes = 0;  // read when the thread has ended
  {
    BackgroundJob job(
        [&] {
          if (holds.empty()) return BackgroundJob::Job();
          const bool hold = holds.front();
          holds.pop_front();
          return BackgroundJob::Job([&, hold](const std::stop_token& stop) {
            begun.release();
            while (hold && !stop.stop_requested()) std::this_thread::yield();
            job.report(stop, "dropped if stopped", 0, 0);
          });
        },
        [&] { ++changes; });
    wake(job);
    begun.acquire();
    auto lock = job.lock();
    job.cancel();
    job.wake();
    job.wait_until_idle(lock);
  }
  EXPECT_EQ(changes, 2);  // the second job's report and its end
}

TEST(BackgroundJob, StatusIsIdleWhenTheLastChangeIsAnnounced) {
  std::binary_semaphore announced{0};
  bool busy = true;
  BackgroundJob job(once([](const auto&) {}), [&] {
    const auto lock = job.lock();
    busy = job.status().busy;
    announced.release();
  });
  wake(job);
  announced.acquire();
  EXPECT_FALSE(busy);
}

TEST(BackgroundJob, IsDestroyedWhileItRunsAndRunsNoOtherJob) {
  std::binary_semaphore begun{0};
  int started = 0;
  {
    BackgroundJob job([&] {
      return BackgroundJob::Job([&](const std::stop_token& stop) {
        ++started;
        begun.release();
        while (!stop.stop_requested()) std::this_thread::yield();
      });
    });
    wake(job);
    begun.acquire();
  }
  EXPECT_EQ(started, 1);
}

TEST(BackgroundJob, IsDestroyedWithoutEverBeingWoken) {
  const BackgroundJob job([] { return BackgroundJob::Job(); });
}

TEST(BackgroundJob, LowPriorityRunsBehindTheOthers) {
  int niceness = 0;
  BackgroundJob job(once([&](const std::stop_token&) { niceness = getpriority(PRIO_PROCESS, 0); }),
                    {},
                    BackgroundJob::Priority::low);
  wake(job);
  auto lock = job.lock();
  job.wait_until_idle(lock);
  EXPECT_GE(niceness, 10);
}

}  // namespace
}  // namespace gpo
