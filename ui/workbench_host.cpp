// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench_host.h"

#include "engine/base/error.h"
#include "engine/files/output_file.h"
#include "ui/workbench_window.h"

#include <thread>
#include <utility>

#include <fmt/format.h>

namespace gpo {
namespace {

/// "desk-0029.png", or with a number where that is taken.
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
  const JobStatus* writing = movie_ ? &movie_status_ : nullptr;
  return {state, link.worker, link.survey, timings, gui_.scale(), writing, &link.scan};
}

void WorkbenchHost::synchronize() {
  gui_.set_zoom(state.view.text_zoom);
  if ((movie_ || state.requests.movie) && std::exchange(state.requests.cancel, false)) {
    movie_.reset();
    state.requests.movie.reset();
    say(state, "Movie canceled, nothing was saved");
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
  return draw_view({view, wanted, size}, input(), gui_, views_);
}

/// Begins, when everything that it shows is computed, or goes on.
void WorkbenchHost::write_movie() {
  try {
    if (!movie_) movie_.emplace(*std::exchange(state.requests.movie, {}), state);
    movie_->step([this](const WorkbenchState& shown, const std::string& view, cv::Size pixels) {
      const PanelInput input{shown, link.worker, link.survey, timings, gui_.scale()};
      return draw_view({view, pixels, size}, input, gui_, views_);
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
