// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/studies/normal_study.h"
#include "ui/look/palette.h"
#include "ui/look/zoom.h"
#include "ui/views/image/image_texture.h"

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

struct ImDrawList;

namespace gpo {

/// What a method says the normal is.
struct NormalAnswer {
  std::string name;  ///< of its configuration, for people
  std::uint32_t rgb = 0;
  std::shared_ptr<const Inspection> inspection;  ///< of an initialization that is ok
  bool current = false;

  const Eigen::Vector3d& normal() const { return inspection->initialization->plane.normal; }
};

/// Pieces of lines on the disc.
using Contours = std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>>;

/// The map of a study up to a frame, in the graphics memory. Needs its context.
class NormalsMap {
 public:
  /// Brings the map of the window's first frames into the texture, where it is not there yet.
  void update(const std::shared_ptr<const NormalStudy>& study, int frames);

  const ImageTexture& texture() const { return texture_; }
  /// Lines of the same RMS: 1, 2 and 5 times powers of ten [px].
  const Contours& contours() const { return contours_; }
  /// RMS that a plane of the normal at this place of the disc leaves [px]; NaN where there is none.
  float rms_at(const Eigen::Vector2d& disc) const;
  /// The colors' range [px]: that of the whole window, so that frames compare.
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

/// What is drawn; the study is of the inspection's window.
struct NormalsContent {
  const Inspection& inspection;
  std::shared_ptr<const NormalStudy> study;
  std::vector<NormalAnswer> answers;  ///< the current one first
  int frame = 0;                      ///< counts in the recording

  /// Of the window, up to the shown one: 1 to all.
  int frames() const;
};

/// The part of the rectangle in which the disc is drawn, zoomed and hovered.
ScreenRect disc_rect(const ScreenRect& rect);

/// Draws the hemisphere of normals that a camera can see as a disc: what a plane of each would
/// cost, the candidates of the frames, clusters, the solver's path, the answers and the truth.
void draw_normals_view(ImDrawList& list,
                       const ScreenRect& rect,
                       NormalsMap& map,
                       const NormalsContent& content,
                       const NormalsZoom& zoom);

/// What is known of the normal at a place of the disc, some lines; empty off the disc.
std::string normal_text(const NormalsMap& map,
                        const NormalsContent& content,
                        const Eigen::Vector2d& disc);

}  // namespace gpo
