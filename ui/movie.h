// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/recording/images/video_encoder.h"
#include "ui/workbench/state.h"

#include <functional>

namespace gpo {

/// The window's frames on their way into a movie, one a step: the picture with its overlays at the
/// recording's own size, or in compare mode the columns.
class Movie {
 public:
  /// Draws a view of a state at a size.
  using Draw = std::function<cv::Mat(const WorkbenchState&, const std::string& view, cv::Size)>;

  /// Of what the state shows now; what changes in the window later does not change the movie.
  /// Throws InputError where the file cannot be written.
  Movie(const MovieRequest& request, const WorkbenchState& state);

  /// Draws and writes the next frame, and after the last one gives the file its name. Throws
  /// InputError.
  void step(const Draw& draw);

  int done() const { return done_; }
  int of() const { return frames_; }
  bool finished() const { return done_ == frames_; }
  const std::filesystem::path& file() const { return video_.file(); }

 private:
  WorkbenchState state_;
  std::string view_;
  cv::Size size_;
  int first_, frames_, done_ = 0;
  VideoEncoder video_;
};

}  // namespace gpo
