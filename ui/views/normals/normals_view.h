// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/studies/studies.h"
#include "ui/views/overlay/overlay.h"

struct ImDrawList;

namespace gpo {

/// Line segments on the disc.
using Contours = std::vector<std::pair<Vector2d, Vector2d>>;

/// The map of a study up to a frame, in graphics memory. Needs its context.
class NormalsMap {
 public:
  /// Uploads the map of the window's first `frames` if it has changed.
  void update(const std::shared_ptr<const NormalStudy>& study, int frames);

  const ImageTexture& texture() const { return texture_; }
  /// Lines of equal RMS: 1, 2 and 5 times powers of ten [px].
  const Contours& contours() const { return contours_; }
  /// Returns the RMS of planes with this normal [px]; infinite if tracks are behind a camera.
  float rms_at(const Vector2d& disc) const;
  /// Color range [px]: that of the whole window, so that frames compare.
  float low_px() const { return low_px_; }
  float high_px() const { return high_px_; }

 private:
  std::shared_ptr<const NormalStudy> study_;
  int frames_ = 0;
  Theme theme_ = Theme::dark;
  std::vector<float> rms_px_;
  Contours contours_;
  float low_px_ = 0.1F, high_px_ = 1;
  ImageTexture texture_;
};

/// Content of the view; the study is of the inspection's window.
struct NormalsContent {
  const Inspection& inspection;
  std::shared_ptr<const NormalStudy> study;
  std::vector<ShownResult> answers;  ///< successful ones, the current one first
  int frame = 0;                     ///< counted in the recording

  /// Returns the number of frames of the window up to the shown one, at least 2.
  int frames() const;
  std::vector<PlaneEstimate> further_planes() const;
};

ScreenRect disc_rect(const ScreenRect& rect);

/// Draws the hemisphere of visible normals as a disc with the reprojection error of each.
void draw_normals_view(const Area& area,
                       NormalsMap& map,
                       const NormalsContent& content,
                       const NormalsZoom& zoom);

/// Describes the normal at a place of the disc, in some lines; empty outside of the disc.
std::string normal_text(const NormalsMap& map, const NormalsContent& content, const Vector2d& disc);

}  // namespace gpo
