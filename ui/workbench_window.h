// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/panels/panels.h"
#include "ui/window_output.h"
#include "ui/workbench/work/live_host.h"
#include "ui/workbench/work/writers.h"

namespace gpo {

/// Draws one frame of the window into the bound framebuffer. Returns what the user did.
Commands draw_workbench(const PanelInput& input,
                        cv::Size size,
                        Gui& gui,
                        Views& views,
                        double delta_seconds = Gui::kFixedFrame_s);

/// Dear ImGui and the caches for views in the current OpenGL context.
struct Drawing {
  Gui& gui;
  Views& views;
};

/// Returns one view of the window: CV_8UC3, BGR. `view`: a name of `panes()`; by default as large
/// as in a window of `window_size`, the image as large as in the recording. Throws InputError for
/// an unknown view, and if there is nothing to draw yet.
cv::Mat draw_view(const std::string& view,
                  std::optional<cv::Size> wanted,
                  const PanelInput& input,
                  cv::Size window_size,
                  const Drawing& drawing);

/// Returns a view of an inspection: CV_8UC3, BGR, reproducible. `after`: cameras after its window;
/// null: none. Throws InputError without OpenGL.
cv::Mat snapshot_pane(const std::string& view,
                      const std::shared_ptr<const Inspection>& inspection,
                      int frame,
                      std::optional<cv::Size> size,
                      const std::shared_ptr<const Extrapolation>& after = {});

/// The same of a live source, as its window shows it.
cv::Mat snapshot_live(const std::string& view,
                      const LiveView& live,
                      const Settings& settings,
                      std::optional<cv::Size> size);

/// Draws a frame that only asks whether to start the commands of a session. Returns the answer,
/// nullopt until then. Escape means no.
std::optional<bool> ask_for_commands(Gui& gui,
                                     cv::Size size,
                                     const std::vector<std::string>& commands);

/// A workbench with its workers and views, on screen or off. Needs its OpenGL context.
class WorkbenchHost {
 public:
  /// `open` opens recordings. `changed` is called on other threads if there is something new.
  WorkbenchHost(Gui& gui,
                Worker::Open open,
                fs::path example,
                const std::function<void()>& changed = {});

  WorkbenchState state;
  WorkerLink link;
  LiveHost live;
  bool timings = true;  ///< false: dashes instead of times, to make screenshots comparable
  bool reads_models_at_once = false;    ///< while it draws, instead of in the background
  cv::Size size = cv::Size(1280, 720);  ///< window size [px]

  /// Exchanges results with the workers and fulfills requests, at most one frame of a movie.
  void synchronize();
  bool busy() const {
    return link.busy() || movie_ || state.requests.movie || exporting() || wants_report(state);
  }
  /// Returns whether the next call of `synchronize` writes a frame of a movie.
  bool writing() const { return movie_ || (state.requests.movie && !link.busy()); }
  void settle();
  /// Draws a frame into the bound framebuffer, without waiting for images. Returns the commands.
  Commands draw(double delta_seconds = Gui::kFixedFrame_s);
  /// Returns whether the last frame differed from the one before.
  bool redrawn() const { return !views_.window.redrawn().empty(); }
  /// Returns the window or one view of it, with all images: CV_8UC3, BGR. Throws InputError.
  cv::Mat image(const std::string& view, std::optional<cv::Size> wanted = {});

 private:
  /// A context of Dear ImGui and caches to draw a movie and a report between the window's frames.
  /// In the window's own context these drawings would consume its clicks and keys.
  struct Apart {
    Gui gui;
    Views views;
  };

  PanelInput input() const;
  cv::Mat draw_apart(const WorkbenchState& shown, const std::string& view, cv::Size pixels);
  void save(const Screenshot& wanted);
  void write_movie();
  bool exporting() const {
    return exports_.busy() || !state.requests.exports.empty() || recordings_.busy() ||
           state.requests.save_recording;
  }

  Gui& gui_;
  std::optional<Movie> movie_;    ///< being written
  std::unique_ptr<Apart> apart_;  ///< null unless a movie or a report is written
  Views views_;
  std::string model_error_;  ///< the last one that was shown
  ImageFetcher fetcher_;
  FolderLister lister_;
  ModelReader models_;
  ExportWriter exports_;
  Survey survey_;
  Scan scan_;
  RecordingWriter recordings_;
  Worker worker_;
};

}  // namespace gpo
