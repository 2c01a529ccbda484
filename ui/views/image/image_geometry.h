// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/pose.h"
#include "engine/geometry/rolling_camera.h"
#include "ui/views/model/solid_model.h"
#include "ui/views/overlay/overlay.h"

#include <Eigen/Geometry>

namespace gpo {

/// Indices of `cube_corners`. The first face is the base; the corners of a face are in turn.
// clang-format off
inline constexpr std::array<std::array<int, 2>, 12> kCubeEdges = {
    {{0, 1}, {0, 2}, {0, 4}, {1, 3}, {1, 5}, {2, 3}, {2, 6}, {3, 7}, {4, 5}, {4, 6}, {5, 7}, {6, 7}}};
// clang-format on
inline constexpr std::array<std::array<int, 4>, 6> kCubeFaces = {
    {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}}};

using Outline = std::vector<Vector2d>;
using Outlines = std::vector<Outline>;

/// An edge as a polyline in the image; empty if it is invisible.
struct CubeEdge {
  std::array<int, 2> corners;
  bool base;    ///< part of the square on the plane
  bool hidden;  ///< behind the cube's own faces
  Outline raw_px;
};

/// A face's outline in the image, cut at the camera; empty if nothing of it is in front.
struct CubeFace {
  std::array<int, 4> corners;
  bool base;
  bool facing;  ///< its outside is towards the camera
  Outline raw_px;
  std::vector<double> heights;  ///< one per point of the outline: above the base, 0 to 1
};

struct CubeImage {
  std::vector<CubeEdge> edges;  ///< 12
  std::vector<CubeFace> faces;  ///< 6
};

/// Projects a cube (`cube_corners`); its edges are bent by the lens and clipped at the camera.
CubeImage cube_in_image(const RollingCamera& camera,
                        const Pose& pose,
                        const CubeCorners& corners_w);

struct CubeSize {
  double side;              ///< [unit of the estimate]
  double height_sides = 1;  ///< height in sides; more than 1: a tower
};

/// Projects the virtual cube into a frame of the window; nullopt if the initialization failed.
std::optional<CubeImage> estimated_cube(const Inspection& inspection, int frame, CubeSize size);

/// Projects the cube of any plane. The initialization is ok.
CubeImage cube_on(const Inspection& inspection, int frame, const CubeAnchor& anchor, CubeSize size);

/// Returns all cubes, the nearest to the frame's camera last. The initialization is ok.
std::vector<CubeAnchor> cubes_far_to_near(const Inspection& inspection, int frame);

/// Returns the nearest cube at a pixel; nullopt if there is none. The initialization is ok.
std::optional<CubeAnchor> cube_at(const Inspection& inspection,
                                  int frame,
                                  CubeSize size,
                                  const Vector2d& raw_px);

/// The same cube on the true plane, by the true pose; nullopt if one of them is unknown.
std::optional<CubeImage> true_cube(const Inspection& inspection, int frame, CubeSize size);

/// Multiplies the image distance from a reference. Edges and faces incomplete in one are empty.
CubeImage exaggerated(CubeImage cube, const CubeImage& reference, double times);

/// Returns outlines of the shadow around the cube, outermost first; empty if one is not visible.
/// The initialization is ok.
Outlines contact_shadow(const Inspection& inspection,
                        int frame,
                        const CubeAnchor& anchor,
                        double side);

/// Returns the pieces of the horizon in the image, bent by the lens. `up_w` has any length.
Outlines horizon_in_image(RollingCamera camera, const Pose& pose, const Vector3d& up_w);

using Triangle = std::array<Vector2d, 3>;

/// Parts of an image that are nearer to the camera than the cube.
struct Occluder {
  int plane = 0;  ///< its number in the window
  std::vector<Triangle> triangles_raw_px;
};

/// Returns the planes, except that of the cube (nullopt: the leading one), that hide the cube in a
/// frame. A plane is visible in small Delaunay triangles of its tracks without other tracks inside,
/// and hides the cube if all of the cube seen through them is behind it.
std::vector<Occluder> occluders(const Inspection& inspection,
                                int frame,
                                const CubeCorners& cube_w,
                                std::optional<int> of_plane = std::nullopt);

struct ImageCanvas : Area {
  const Camera& camera;
  ImageMapping mapping;

  ImVec2 at(const Vector2d& raw_px) const { return to_imgui(to_screen(mapping, raw_px)); }
  /// `width` at scale 1 [px].
  void polyline(const Outline& raw_px, ImU32 color, float width) const;
};

/// Draws the image and the background around it; an empty field if the texture is null or empty.
void draw_image(const ImageCanvas& canvas, ImageTexture* image);

/// Draws the part of the image within a triangle.
void draw_part(const ImageCanvas& canvas, const ImageTexture& image, const Triangle& triangle);

/// Returns the color of a cube's edges on its plane: that of the plane.
std::uint32_t cube_color(const CubeAnchor& anchor, const Window& window);
/// Returns the color of its faces.
std::uint32_t cube_face_color(const CubeAnchor& anchor, const Window& window);

/// Draws only edges, those of the base in `rgb`; those behind the cube are thin.
void draw_wireframe(const ImageCanvas& canvas, const CubeImage& cube, std::uint32_t rgb);

struct CubeBody {
  const CubeImage& cube;
  Outlines rings;                      ///< `contact_shadow`
  std::uint32_t edges = 0, faces = 0;  ///< colors
};
/// Draws the cube in soft light; of a model only shadow and base.
void draw_body(const ImageCanvas& canvas, const CubeBody& body, bool model);

/// Returns a box on the screen around all edges.
Eigen::AlignedBox2d bounds(const ImageCanvas& canvas, const CubeImage& cube);

/// Draws only edges, dashed.
void draw_dashed_cube(const ImageCanvas& canvas, const CubeImage& cube, std::uint32_t rgb);

/// Draws the model's triangles in front of the camera from far to near, its points at `points_w`.
void draw_model(const ImageCanvas& canvas,
                const RollingCamera& camera,
                const Pose& pose,
                const SolidModel& model,
                const std::vector<Vector3d>& points_w);

/// Returns the color of a mask's outline.
std::uint32_t mask_color(MaskKind kind);

/// Draws a mask's outline in dashes and dots, and hatches a mask that leaves out its tracks.
void draw_mask(const ImageCanvas& canvas, const Mask& mask);

}  // namespace gpo
