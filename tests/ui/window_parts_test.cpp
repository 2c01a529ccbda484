// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/images/images.h"
#include "tests/engine/test_folder.h"
#include "tests/ui/window_test.h"

#include <mutex>
#include <semaphore>
#include <set>
#include <thread>

#include <gmock/gmock.h>
#include <opencv2/imgproc.hpp>

namespace gpo {
namespace {

/// A window over a recording whose images are decoded only when the test releases them.
class WaitingImage : public test::WindowTest {
 protected:
  WaitingImage() {
    Inspection inspection = made_inspection();
    auto recording = std::make_shared<Recording>(*inspection.recording);
    recording->images = std::make_shared<const FrameCache>(
        recording->frame_count(), [this](int frame) { return decode(frame); });
    inspection.recording = recording;
    inspection_ = std::make_shared<const Inspection>(inspection);
    test::open(state_, inspection_);
    apply(state_, RunAction{"select track " + std::to_string(inspection_->tracks->ids[3])});
    timings_ = false;
    fetching_ = &fetcher_;
  }
  ~WaitingImage() override { released_.release(1000); }

  cv::Mat decode(int frame) {
    {
      const std::scoped_lock lock(mutex_);
      by_window_ = by_window_ || std::this_thread::get_id() == window_;
    }
    released_.acquire();
    return {480, 640, CV_8UC3, cv::Scalar::all(frame)};
  }
  void release_and_draw(int images) {
    released_.release(images);
    for (int i = 0; i < images; ++i) fetched_.acquire();
    draw();
  }
  void draw_frame(int frame) {
    apply(state_, GoToFrame{frame});
    draw();
  }

  const std::thread::id window_ = std::this_thread::get_id();
  std::counting_semaphore<> released_{0}, fetched_{0};
  std::mutex mutex_;
  bool by_window_ = false;
  ImageFetcher fetcher_{[this] { fetched_.release(); }};
};

TEST_F(WaitingImage, DrawsWithoutTheImageUntilItIsFetched) {
  draw();
  EXPECT_EQ(views_->image.revision(), 0U);
  EXPECT_EQ(shown_image(*views_), nullptr);
  const cv::Mat before = context_.read_bgr();
  release_and_draw(1);
  EXPECT_EQ(views_->image.revision(), 1U);
  EXPECT_EQ(views_->frame, state_.view.frame);
  EXPECT_FALSE(same_bytes(context_.read_bgr(), before));
  EXPECT_FALSE(by_window_) << "the window's thread must not decode";
}

TEST_F(WaitingImage, KeepsTheLastImageUntilTheNextIsFetched) {
  draw();
  release_and_draw(1);
  const int before = state_.view.frame;
  draw_frame(before - 5);
  EXPECT_EQ(views_->frame, before);
  EXPECT_NE(shown_image(*views_), nullptr);
  release_and_draw(1);
  EXPECT_EQ(views_->frame, before - 5);
  EXPECT_FALSE(by_window_);
}

TEST_F(WaitingImage, ShowsALateImageDuringPlayback) {
  const int first = state_.document.settings.start;
  for (int i = 0; i <= 3; ++i) draw_frame(first + i);
  release_and_draw(1);
  EXPECT_EQ(views_->frame, first);
  release_and_draw(1);
  EXPECT_EQ(views_->frame, first + 3);
}

TEST_F(WaitingImage, FetchesPatchesAndColumnsInTheBackground) {
  for (const char* view : {"view track", "view compare"}) {
    apply(state_, RunAction{view});
    draw();
  }
  EXPECT_TRUE(views_->patches[0].empty);
  release_and_draw(3);  // the current frame's, and the track's first and last
  EXPECT_NE(shown_image(*views_), nullptr);
  EXPECT_FALSE(views_->patches[0].empty);
  EXPECT_FALSE(views_->patches[1].empty);
  EXPECT_FALSE(by_window_);
}

TEST_F(WaitingImage, DecodesInTheWindowsThreadWithoutAFetcher) {
  released_.release(10);
  fetching_ = nullptr;
  draw();
  EXPECT_EQ(views_->image.revision(), 1U);
  EXPECT_TRUE(by_window_);
}

TEST_F(WaitingImage, ComputesTheLifeOfATrackOnce) {
  released_.release(1000);
  for (const char* drawer : {"view track", "view residuals"}) {
    apply(state_, RunAction{drawer});
    draw_times(3);
  }
  EXPECT_EQ(views_->lives.computed(), 1U);
  apply(state_, RunAction{"previous"});
  draw();
  EXPECT_EQ(views_->lives.computed(), 1U);
}

const std::vector<std::string> kCommands = {
    "mine=python3 mine.py --with %s and a lot of arguments that go on and on so that they do not "
    "fit "
    "into one line of the window",
    "other=rm -r everything"};

class QuestionTest : public DrawingTest {
 protected:
  std::optional<bool> draw() {
    context_.bind();
    return ask_for_commands(gui_, {1280, 720}, kCommands);
  }

  OffscreenContext context_{1280, 720};
  Gui gui_;
};

TEST_F(QuestionTest, WaitsForOneOfItsButtons) {
  for (int i = 0; i < 5; ++i) EXPECT_FALSE(draw());
  std::set<bool> answers;
  for (int y = 300; y < 500; y += 10)
    for (int x = 340; x < 940; x += 60) {
      ImGui::GetIO().MousePos = {static_cast<float>(x), static_cast<float>(y)};
      draw();
      ImGui::GetIO().MouseDown[0] = true;
      draw();
      ImGui::GetIO().MouseDown[0] = false;
      const auto answer = draw();
      if (!answer) continue;
      EXPECT_FALSE(answers.empty() && *answer) << "the left button means no";
      answers.insert(*answer);
    }
  EXPECT_EQ(answers, (std::set<bool>{false, true}));
}

TEST_F(QuestionTest, ShowsItsText) {
  for (int i = 0; i < 3; ++i) draw();
  const cv::Mat image = context_.read_bgr();
  keep("question", image);
  cv::Mat gray, different;
  cv::extractChannel(image, gray, 1);
  cv::compare(gray, gray.at<std::uint8_t>(0, 0), different, cv::CMP_NE);
  EXPECT_GT(cv::countNonZero(different), 20'000);
}

TEST(Glossary, ExplainsEachTermOnce) {
  std::set<std::string> terms;
  for (const auto& [term, meaning] : glossary()) {
    EXPECT_TRUE(terms.insert(term).second) << term;
    EXPECT_THAT(meaning, testing::EndsWith(".")) << term;
  }
  EXPECT_EQ(terms.size(), 35U);
  EXPECT_THAT(terms, testing::IsSupersetOf({"verdict", "baseline |t| [d]", "cube anchor"}));
}

class HelpOverlay : public test::WindowTest {};

TEST_F(HelpOverlay, ShowsKeysFirstAndTheGlossaryOnRequest) {
  open(made_inspection());
  state_.view.show_help = true;
  draw_times(3);
  const cv::Mat keys = context_.read_bgr();
  state_.view.help_page = HelpPage::glossary;
  draw_times(3);
  const cv::Mat terms = context_.read_bgr();
  keep("glossary", terms);
  EXPECT_FALSE(same_bytes(keys, terms));
  for (const HelpPage page : {HelpPage::manual, HelpPage::about}) {
    state_.view.help_page = page;
    draw_times(3);
    keep(page == HelpPage::manual ? "manual" : "about", context_.read_bgr());
    EXPECT_FALSE(same_bytes(terms, context_.read_bgr()));
  }
}

TEST(Manual, HasNoMarksAndEndsBeforeTheDevelopersPart) {
  EXPECT_TRUE(manual().front().heading);
  std::string all;
  for (const ManualLine& line : manual()) all += line.text + "\n";
  EXPECT_THAT(all, testing::HasSubstr("right click"));
  for (const char* mark : {"`", "**", "](", "Adding to the window", "```"})
    EXPECT_THAT(all, testing::Not(testing::HasSubstr(mark)));
}

TEST_F(HelpOverlay, TourShowsACardThatGoesOnAtAClick) {
  open(made_inspection());
  applies_ = true;
  draw_times(3);
  const cv::Mat without = context_.read_bgr();
  run_line(state_, "tour");
  draw_times(3);
  keep("tour", context_.read_bgr());
  EXPECT_FALSE(same_bytes(without, context_.read_bgr()));
  run_line(state_, "tour off");
  draw_times(3);
  EXPECT_TRUE(same_bytes(without, context_.read_bgr()));
}

TEST_F(HelpOverlay, FailedWindowHasABannerWithWaysOut) {
  open(made_inspection({.ok = false}));
  draw_times(3);
  keep("banner", context_.read_bgr());
  const WindowLayout shown = window_layout({.width = kWidth, .height = kHeight, .failed = true});
  std::set<std::string> lines;
  const float y = shown.banner.y + shown.banner.height / 2;
  for (float x = shown.banner.right() - 20; x > shown.banner.x; x -= 24)
    lines.insert(test::line_of(click(x, y)));
  EXPECT_TRUE(lines.contains("find-start"));
  EXPECT_TRUE(ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel) ||
              lines.size() > 1)
      << "another method";
}

TEST_F(HelpOverlay, LiveWindowHasABannerThatFreezes) {
  open(made_inspection({.ok = false}));
  LiveView live{.address = "camera:0"};
  live.capture = {.state = CaptureState::running, .size = {640, 480}, .captured = 9, .dropped = 2};
  state_.live = live;
  draw_times(3);
  keep("live-banner", context_.read_bgr());
  const WindowLayout shown = window_layout({.width = kWidth, .height = kHeight, .failed = true});
  const float y = shown.banner.y + shown.banner.height / 2;
  EXPECT_EQ(test::line_of(click(shown.banner.right() - 40, y)), "freeze");
  EXPECT_EQ(test::line_of(click(shown.banner.x + 40, y)), "") << "no ways out of a failure";
}

TEST_F(HelpOverlay, ClosesOnAClickBesideIt) {
  open(made_inspection());
  state_.view.show_help = true;
  draw();
  EXPECT_EQ(test::line_of(click(20, 400)), "escape");
}

using testing::HasSubstr;
namespace fs = std::filesystem;
using test::TestFolder;

std::vector<cv::Mat> frames_of(const fs::path& file) {
  VideoDecoder video(file);
  std::vector<cv::Mat> frames;
  for (int i = 0; i < std::ssize(video.index().times); ++i) frames.push_back(video.decode(i));
  return frames;
}

double mean_difference(const cv::Mat& a, const cv::Mat& b) {
  return cv::norm(a, b, cv::NORM_L1) / static_cast<double>(a.total() * a.channels());
}

class MovieTest : public DrawingTest {
 protected:
  MovieTest() {
    state_.requests.open = "made";
    host_.timings = false;
    host_.settle();
  }
  static Worker::Opened open() {
    static const auto made = std::make_shared<const Inspection>(made_inspection());
    return {made->recording, [](const Settings& settings, std::stop_token, const Progress&) {
              auto inspection = std::make_shared<Inspection>(*made);
              inspection->settings = settings;
              return inspection;
            }};
  }

  TestFolder folder_;
  /// Draws a frame of the window after the next frame of a movie, if one is written.
  Commands draw_window() {
    host_.synchronize();
    context_.bind();
    return host_.draw();
  }

  OffscreenContext context_{1280, 720};
  Gui gui_;
  WorkbenchHost host_{gui_, [](const auto&...) { return open(); }, "example"};
  WorkbenchState& state_ = host_.state;
  const fs::path file_ = folder_.path() / "m.mp4";
};

TEST_F(MovieTest, HasTheFramesOfTheWindowAtTheRecordingsSize) {
  ASSERT_TRUE(state_.document.recording);
  run_line(state_, "set start 5");
  host_.settle();
  run_line(state_, "export-video " + file_.string());
  host_.settle();
  const std::vector<cv::Mat> frames = frames_of(file_);
  ASSERT_EQ(frames.size(), static_cast<std::size_t>(state_.document.settings.frames));
  const Camera& camera = state_.document.recording->camera;
  EXPECT_EQ(frames[0].size(), even_size({camera.width, camera.height}));
  run_line(state_, "frame 5");
  EXPECT_LT(mean_difference(frames[0], host_.image("picture", frames[0].size())), 8);
  EXPECT_GT(mean_difference(frames[0], frames.back()), 8);
  EXPECT_THAT(state_.messages.text, HasSubstr("saved"));
}

TEST_F(MovieTest, WritesOneFramePerCallAndDeletesACanceledFile) {
  run_line(state_, "export-video " + file_.string() + " 12.5");
  const int frame = state_.view.frame;
  for (int i = 0; i < 5; ++i) {
    EXPECT_TRUE(host_.busy());
    host_.synchronize();
  }
  EXPECT_EQ(state_.view.frame, frame);
  EXPECT_FALSE(fs::exists(file_));
  EXPECT_FALSE(fs::is_empty(folder_.path()));
  run_line(state_, "escape");
  host_.synchronize();
  EXPECT_FALSE(host_.busy());
  EXPECT_TRUE(fs::is_empty(folder_.path()));
  EXPECT_THAT(state_.messages.text, HasSubstr("canceled"));
}

TEST_F(MovieTest, LeavesClicksAndTheWheelToTheWindow) {
  const WindowLayout shown = window_layout({.width = 1280, .height = 720});
  ImGuiIO& io = ImGui::GetIO();
  io.MousePos = {27 + 3 * 34, shown.timeline.y + shown.timeline.height / 2};
  for (int i = 0; i < 3; ++i) draw_window();
  run_line(state_, "export-video " + file_.string());
  draw_window();
  io.MouseDown[0] = true;
  EXPECT_TRUE(draw_window().empty());
  io.MouseDown[0] = false;
  EXPECT_EQ(test::line_of(draw_window()), "next");
  io.MousePos = {shown.image.x + 100, shown.image.y + 300};
  for (int i = 0; i < 2; ++i) draw_window();
  io.MouseWheel = 1;
  EXPECT_NE(test::find<ZoomImage>(draw_window()), nullptr);
  EXPECT_TRUE(host_.writing());
}

TEST_F(MovieTest, RejectsWrongNamesRatesAndFolders) {
  EXPECT_THAT(test::refusal(state_, "export-video a.avi"), HasSubstr(".mp4"));
  EXPECT_THAT(test::refusal(state_, "export-video a.mp4 0"), HasSubstr("1 to 240"));
  EXPECT_THAT(test::refusal(state_, "export-video /nowhere/a.mp4"), HasSubstr("/nowhere"));
  EXPECT_FALSE(host_.busy());
}

TEST_F(MovieTest, ShowsTheColumnsInCompareMode) {
  const auto draw = [this](const WorkbenchState& shown, const std::string& view, cv::Size size) {
    EXPECT_EQ(view, "compare");
    state_.view.frame = shown.view.frame;
    return host_.image(view, size);
  };
  WorkbenchState two = state_;
  two.view.panes.compare = true;
  two.document.compared = parse_configurations("gpo,ba");
  two.document.settings.options.method = "gpo";
  two.document.settings.frames = 4;
  Movie movie({file_, 10}, two);
  while (!movie.finished()) movie.step(draw);
  const std::vector<cv::Mat> frames = frames_of(file_);
  ASSERT_EQ(frames.size(), 4U);
  EXPECT_EQ(frames[0].size(), even_size(default_compare_size(2, *state_.document.recording)));
}

}  // namespace
}  // namespace gpo
