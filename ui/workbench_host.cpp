// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench_host.h"

#include "engine/error.h"
#include "engine/output_file.h"
#include "ui/workbench_window.h"

#include <thread>
#include <utility>

#include <fmt/format.h>

namespace gpo {
namespace {

/// "desk-0029.png", or with a number where that is taken.
std::filesystem::path free_picture_name(const WorkbenchState& state) {
  const std::string stem =
      state.recording ? fmt::format("{}-{:04}", state.recording->name, state.frame) : "window";
  std::filesystem::path name = stem + ".png";
  for (int i = 2; std::filesystem::exists(name); ++i) name = fmt::format("{}-{}.png", stem, i);
  return name;
}

}  // namespace

WorkbenchHost::WorkbenchHost(Gui& gui,
                             Worker::Open open,
                             std::filesystem::path example,
                             std::function<void()> changed)
    : gui_(gui),
      example_(std::move(example)),
      survey_(changed),
      worker_(std::move(open), changed) {}

void WorkbenchHost::synchronize() {
  gpo::synchronize(state, link, worker_, survey_, example_);
  for (const Screenshot& screenshot : std::exchange(state.wishes.screenshots, {})) save(screenshot);
}

void WorkbenchHost::settle() {
  do {
    synchronize();
    if (link.busy()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  } while (link.busy());
  synchronize();
}

Commands WorkbenchHost::draw(double delta_seconds) {
  return draw_workbench(input(), size, gui_, views_, delta_seconds);
}

cv::Mat WorkbenchHost::picture(const std::string& view, std::optional<cv::Size> wanted) {
  return draw_view(view, wanted, input(), size, gui_, views_);
}

void WorkbenchHost::save(const Screenshot& screenshot) {
  const std::filesystem::path file =
      screenshot.file.empty() ? free_picture_name(state) : screenshot.file;
  try {
    check_writable(file);
    write_picture(file, picture(screenshot.view, screenshot.size));
    say(state, "saved " + file.string());
  } catch (const InputError& error) {
    say(state, error.what(), Severity::error);
  }
}

}  // namespace gpo
