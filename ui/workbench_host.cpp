// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench_host.h"

#include "engine/base/error.h"
#include "engine/files/output_file.h"
#include "engine/window/timestamps.h"
#include "ui/workbench_window.h"

#include <algorithm>
#include <thread>

#include <fmt/format.h>

namespace gpo {
namespace {

double movie_rate_hz(const MovieRequest& request, const Recording& recording) {
  constexpr double kUnknown_hz = 30;
  if (request.rate_hz > 0) return request.rate_hz;
  const double recorded = rate_hz(recording.timestamps_ns);
  return recorded > 0 ? recorded : kUnknown_hz;
}

cv::Size movie_size(const WorkbenchState& state) {
  const Recording& recording = *state.document.recording;
  if (!state.view.panes.compare)
    return even_size({recording.camera.width, recording.camera.height});
  return even_size(
      default_compare_size(static_cast<int>(state.document.compared.size()), recording));
}

/// Returns "desk-0029.png", or with a number if that exists.
std::filesystem::path free_image_name(const WorkbenchState& state) {
  const std::string stem =
      state.document.recording
          ? fmt::format("{}-{:04}", state.document.recording->name, state.view.frame)
          : "window";
  std::filesystem::path name = stem + ".png";
  for (int i = 2; std::filesystem::exists(name); ++i) name = fmt::format("{}-{}.png", stem, i);
  return name;
}

}  // namespace

Movie::Movie(const MovieRequest& request, const WorkbenchState& state)
    : state_(state),
      view_(state.view.panes.compare ? "compare" : "picture"),
      size_(movie_size(state)),
      first_(state.document.settings.start),
      frames_(std::min(state.document.settings.frames,
                       state.frame_count() - state.document.settings.start)),
      video_(request.file, movie_rate_hz(request, *state.document.recording), size_) {}

void Movie::step(const Draw& draw) {
  if (finished()) return;
  state_.view.frame = first_ + done_;
  video_.add(draw(state_, view_, size_));
  ++done_;
  if (finished()) video_.finish();
}

WorkbenchHost::WorkbenchHost(Gui& gui,
                             Worker::Open open,
                             std::filesystem::path example,
                             const std::function<void()>& changed)
    : gui_(gui),
      fetcher_(changed),
      lister_(changed),
      survey_(changed),
      scan_(changed),
      worker_(std::move(open), changed) {
  link.example = std::move(example);
}

PanelInput WorkbenchHost::input() const {
  return {.state = state,
          .worker = link.worker,
          .survey = link.survey,
          .timings = timings,
          .writing = movie_ ? &movie_status_ : nullptr,
          .scan = &link.scan};
}

void WorkbenchHost::synchronize() {
  gui_.set_zoom(state.view.text_zoom);
  if ((movie_ || state.requests.movie) && std::exchange(state.requests.cancel, false)) {
    movie_.reset();
    state.requests.movie.reset();
    say(state, "movie canceled, the incomplete file was deleted");
  }
  gpo::synchronize(state, link, worker_, survey_, scan_);
  if (writing()) write_movie();
  for (const Screenshot& screenshot : std::exchange(state.requests.screenshots, {}))
    save(screenshot);
}

void WorkbenchHost::settle() {
  do {
    synchronize();
    if (link.busy()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  } while (busy());
  synchronize();
}

Commands WorkbenchHost::draw(double delta_seconds) {
  PanelInput shown = input();
  shown.fetcher = &fetcher_;
  shown.lister = &lister_;
  shown.example = link.example;
  return draw_workbench(shown, size, gui_, views_, delta_seconds);
}

cv::Mat WorkbenchHost::image(const std::string& view, std::optional<cv::Size> wanted) {
  return draw_view(view, wanted, input(), size, {gui_, views_});
}

/// Starts the movie if everything that it shows is computed, or continues it.
void WorkbenchHost::write_movie() {
  try {
    if (!movie_) movie_.emplace(*std::exchange(state.requests.movie, {}), state);
    movie_->step([this](const WorkbenchState& shown, const std::string& view, cv::Size pixels) {
      return draw_view(view, pixels, input().with(shown), size, {gui_, views_});
    });
    movie_status_ = {true, "movie", movie_->done(), movie_->of(), ""};
    if (movie_->finished()) say(state, "saved " + movie_->file().string());
    if (movie_->finished()) movie_.reset();
  } catch (const InputError& error) {
    movie_.reset();
    state.requests.movie.reset();
    say(state, error.what(), Severity::error);
  }
}

void WorkbenchHost::save(const Screenshot& screenshot) {
  const std::filesystem::path file =
      screenshot.file.empty() ? free_image_name(state) : screenshot.file;
  try {
    check_writable(file);
    write_image(file, image(screenshot.view, screenshot.size));
    say(state, "saved " + file.string());
  } catch (const InputError& error) {
    say(state, error.what(), Severity::error);
  }
}

}  // namespace gpo
