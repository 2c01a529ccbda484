// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/context/gui.h"
#include "ui/movie.h"
#include "ui/panels/panels.h"
#include "ui/workbench/work/worker_link.h"

#include <filesystem>
#include <functional>
#include <optional>

#include <opencv2/core/types.hpp>

namespace gpo {

/// A workbench at work, with those who compute for it and what it is drawn with; in a window and
/// off-screen alike. Needs the OpenGL context in which it was made to be current.
class WorkbenchHost {
 public:
  /// `open` opens recordings. `example`: the recording shipped with the program. `changed` is
  /// called on other threads when there is something new to show.
  WorkbenchHost(Gui& gui,
                Worker::Open open,
                std::filesystem::path example,
                const std::function<void()>& changed = {});

  WorkbenchState state;
  WorkerLink link;
  bool timings = true;  ///< false: milliseconds are dashes, so that pictures compare
  cv::Size size = cv::Size(1280, 720);  ///< of the window [px]

  /// Exchanges with worker, survey and scan, and fulfills the requests of the state but `quit`.
  /// Returns at once; a movie that is written takes one of its frames a call.
  void synchronize();
  /// Whether something is computed or written.
  bool busy() const { return link.busy() || movie_ || state.requests.movie; }
  /// Whether the next call of `synchronize` writes a frame of a movie.
  bool writing() const { return movie_ || (state.requests.movie && !link.busy()); }
  /// Until nothing is computed any more.
  void settle();
  /// One frame of the window into the framebuffer that is bound. Returns what the user did. Waits
  /// for no picture: `changed` is called when it has come.
  Commands draw(double delta_seconds = Gui::kFixedFrame_s);
  /// Whether the last frame was another than the one before.
  bool redrawn() const { return !views_.window.redrawn().empty(); }
  /// The window, or one view of it alone, at any size: CV_8UC3, BGR, with all of its pictures.
  /// Throws InputError for an unknown view.
  cv::Mat image(const std::string& view, std::optional<cv::Size> wanted = {});

 private:
  PanelInput input() const;
  void save(const Screenshot& screenshot);
  void write_movie();

  Gui& gui_;
  std::optional<Movie> movie_;  ///< is being written
  JobStatus movie_status_;      ///< how far it is
  Views views_;
  ImageFetcher fetcher_;
  FolderLister lister_;
  Survey survey_;
  Scan scan_;
  Worker worker_;
};

}  // namespace gpo
