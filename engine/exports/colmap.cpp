// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// A COLMAP model (https://colmap.github.io/format.html), text and binary. COLMAP's pixels begin at
// the corner of the image: the center of the top-left pixel is (0.5, 0.5).
#include "engine/base/error.h"
#include "engine/exports/scene.h"
#include "engine/files/output_file.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gpo {
namespace {

using Eigen::Vector2d, Eigen::Vector3d;

constexpr double kHalfPixel = 0.5;
constexpr std::int64_t kNoPoint = -1;
constexpr int kCameraId = 1;

struct ColmapCamera {
  const char* model = "PINHOLE";
  int number = 1;  ///< the number of the model in binary files
  std::vector<double> parameters;
  bool distorted = false;  ///< observations are in the recorded image, else in the undistorted one
};

struct ColmapImage {
  std::string name;
  Eigen::Quaterniond q_cw;
  Vector3d t_cw;
  std::vector<Vector2d> pixels = {};      ///< COLMAP's
  std::vector<std::int64_t> points = {};  ///< one per pixel
};

struct ColmapPoint {
  std::int64_t id = 0;
  const ScenePoint* point = nullptr;
  double error_px = 0;                          ///< mean over the track
  std::vector<std::pair<int, int>> track = {};  ///< image id, index of the pixel
};

struct ColmapModelFiles {
  ColmapCamera camera;
  std::vector<ColmapImage> images;
  std::vector<ColmapPoint> points;
};

std::vector<double> padded(std::vector<double> values, std::size_t count) {
  values.resize(std::max(values.size(), count), 0);
  return values;
}

/// Returns COLMAP's model of the lens. Lenses that it lacks are those of the undistorted image.
ColmapCamera colmap_camera(const Camera& camera) {
  constexpr std::size_t kOpenCv = 4, kFullOpenCv = 8;
  const std::vector<double> center{camera.cx + kHalfPixel, camera.cy + kHalfPixel};
  const std::vector<double>& k = camera.coefficients;
  const auto with = [&](const char* model, int number, double focal, std::vector<double> lens) {
    ColmapCamera made{model, number, {focal * camera.fx, focal * camera.fy}, true};
    made.parameters.insert(made.parameters.end(), center.begin(), center.end());
    made.parameters.insert(made.parameters.end(), lens.begin(), lens.end());
    return made;
  };
  if (has_distortion(camera)) {
    if (camera.distortion == Distortion::radial_tangential && k.size() <= kOpenCv)
      return with("OPENCV", 4, 1, padded(k, kOpenCv));
    if (camera.distortion == Distortion::radial_tangential && k.size() <= kFullOpenCv)
      return with("FULL_OPENCV", 6, 1, padded(k, kFullOpenCv));
    if (camera.distortion == Distortion::equidistant)
      return with("OPENCV_FISHEYE", 5, 1, padded(k, kOpenCv));
    if (camera.distortion == Distortion::field_of_view && !k.empty() && k[0] > 0)
      return with("FOV", 7, k[0] / (2 * std::tan(k[0] / 2)), k);
    if (camera.distortion == Distortion::thin_prism_fisheye)
      return with("THIN_PRISM_FISHEYE", 10, 1, padded(k, kFullOpenCv));
  }
  if (camera.fx == camera.fy)
    return {"SIMPLE_PINHOLE", 0, {camera.fx, center[0], center[1]}, false};
  return {"PINHOLE", 1, {camera.fx, camera.fy, center[0], center[1]}, false};
}

/// Tracks may have any number as an id, COLMAP's points have none below zero.
std::int64_t point_id(const Tracks& tracks, int column) {
  const bool usable = std::ranges::all_of(tracks.ids, [](std::int64_t id) { return id >= 0; });
  return usable ? tracks.ids[column] : column;
}

/// Returns COLMAP's pixel of an undistorted one; nullopt if the lens does not show it.
std::optional<Vector2d> colmap_pixel(const ExportScene& scene,
                                     const ColmapCamera& camera,
                                     Vector2d pixel) {
  if (camera.distorted) pixel = distort(scene.inspection.recording->camera, pixel);
  if (!pixel.allFinite()) return std::nullopt;
  return Vector2d(pixel.array() + kHalfPixel);
}

/// Adds the observations of a frame; returns the index of each observed column.
std::map<int, int> add_pixels(const ExportScene& scene,
                              const ColmapCamera& camera,
                              int frame,
                              ColmapImage& image) {
  const Window& window = *scene.inspection.window;
  std::map<int, int> index_of;
  for (int j = 0; j < window.track_count(); ++j) {
    const auto pixel = colmap_pixel(scene, camera, window.points_px[frame].col(j));
    if (!pixel) continue;
    index_of.emplace(j, static_cast<int>(image.pixels.size()));
    image.pixels.push_back(*pixel);
    image.points.push_back(kNoPoint);
  }
  return index_of;
}

ColmapModelFiles colmap_model(const ExportScene& scene) {
  const Inspection& inspection = scene.inspection;
  ColmapModelFiles model{colmap_camera(inspection.recording->camera), {}, {}};
  std::vector<std::map<int, int>> index_of;
  for (int i = 0; i < std::ssize(scene.cameras); ++i) {
    const Pose from_world = inverse(scene.cameras[i]);
    ColmapImage image{image_name(*inspection.recording, inspection.window->start + i),
                      Eigen::Quaterniond(from_world.R_wc).normalized(),
                      from_world.p_wc};
    index_of.push_back(add_pixels(scene, model.camera, i, image));
    model.images.push_back(std::move(image));
  }
  for (const ScenePoint& point : scene.points) {
    ColmapPoint made{point_id(*inspection.tracks, point.track), &point};
    double errors_px = 0;
    for (const int i : point.frames) {
      const auto index = index_of[i].find(point.track);
      const Vector3d seen = inspection.window->K * to_camera(scene.cameras[i], point.position);
      const auto predicted = colmap_pixel(scene, model.camera, seen.hnormalized());
      if (index == index_of[i].end() || !predicted) continue;
      errors_px += (model.images[i].pixels[index->second] - *predicted).norm();
      made.track.emplace_back(i, index->second);
    }
    if (made.track.size() < 2) continue;  // COLMAP's programs expect two images
    made.error_px = errors_px / static_cast<double>(made.track.size());
    for (const auto& [image, index] : made.track) model.images[image].points[index] = made.id;
    model.points.push_back(std::move(made));
  }
  return model;
}

struct ColmapFiles {
  std::string cameras, images, points;
};

ColmapFiles text_files(const ColmapModelFiles& model, const ExportScene& scene) {
  const Camera& camera = scene.inspection.recording->camera;
  ColmapFiles files;
  files.cameras = fmt::format(
      "# Camera list with one line of data per camera:\n"
      "#   CAMERA_ID, MODEL, WIDTH, HEIGHT, PARAMS[]\n"
      "# Number of cameras: 1\n{} {} {} {} {}\n",
      kCameraId,
      model.camera.model,
      camera.width,
      camera.height,
      fmt::join(model.camera.parameters, " "));
  files.images = fmt::format(
      "# Image list with two lines of data per image:\n"
      "#   IMAGE_ID, QW, QX, QY, QZ, TX, TY, TZ, CAMERA_ID, NAME\n"
      "#   POINTS2D[] as (X, Y, POINT3D_ID)\n"
      "# Number of images: {}\n",
      model.images.size());
  for (std::size_t i = 0; i < model.images.size(); ++i) {
    const ColmapImage& image = model.images[i];
    files.images += fmt::format("{} {} {} {} {} {}\n",
                                i + 1,
                                image.q_cw.w(),
                                fmt::join(image.q_cw.vec(), " "),
                                fmt::join(image.t_cw, " "),
                                kCameraId,
                                image.name);
    for (std::size_t k = 0; k < image.pixels.size(); ++k)
      files.images += fmt::format("{}{} {} {}",
                                  k == 0 ? "" : " ",
                                  image.pixels[k].x(),
                                  image.pixels[k].y(),
                                  image.points[k]);
    files.images += '\n';
  }
  files.points = fmt::format(
      "# 3D point list with one line of data per point:\n"
      "#   POINT3D_ID, X, Y, Z, R, G, B, ERROR, TRACK[] as (IMAGE_ID, "
      "POINT2D_IDX)\n# Number of points: {}\n",
      model.points.size());
  for (const ColmapPoint& made : model.points) {
    files.points += fmt::format("{} {} {} {}",
                                made.id,
                                fmt::join(made.point->position, " "),
                                fmt::join(made.point->color, " "),
                                made.error_px);
    for (const auto& [image, index] : made.track)
      files.points += fmt::format(" {} {}", image + 1, index);
    files.points += '\n';
  }
  return files;
}

ColmapFiles binary_files(const ColmapModelFiles& model, const ExportScene& scene) {
  const Camera& camera = scene.inspection.recording->camera;
  ColmapFiles files;
  put_numbers(files.cameras,
              std::uint64_t{1},
              std::uint32_t{kCameraId},
              std::int32_t{model.camera.number},
              static_cast<std::uint64_t>(camera.width),
              static_cast<std::uint64_t>(camera.height));
  for (const double parameter : model.camera.parameters) put_numbers(files.cameras, parameter);
  put_numbers(files.images, std::uint64_t{model.images.size()});
  for (std::size_t i = 0; i < model.images.size(); ++i) {
    const ColmapImage& image = model.images[i];
    const Eigen::Quaterniond& q = image.q_cw;
    put_numbers(files.images, static_cast<std::uint32_t>(i + 1), q.w(), q.x(), q.y(), q.z());
    for (const double t : image.t_cw) put_numbers(files.images, t);
    put_numbers(files.images, std::uint32_t{kCameraId});
    files.images += image.name + '\0';
    put_numbers(files.images, std::uint64_t{image.pixels.size()});
    for (std::size_t k = 0; k < image.pixels.size(); ++k)
      put_numbers(files.images, image.pixels[k].x(), image.pixels[k].y(), image.points[k]);
  }
  put_numbers(files.points, std::uint64_t{model.points.size()});
  for (const ColmapPoint& made : model.points) {
    put_numbers(files.points, made.id);
    for (const double x : made.point->position) put_numbers(files.points, x);
    for (const std::uint8_t channel : made.point->color) put_numbers(files.points, channel);
    put_numbers(files.points, made.error_px, std::uint64_t{made.track.size()});
    for (const auto& [image, index] : made.track)
      put_numbers(files.points, std::int32_t{image + 1}, std::int32_t{index});
  }
  return files;
}

void write_files(const fs::path& folder, const char* ending, const ColmapFiles& files) {
  write_file(folder / fmt::format("cameras{}", ending), files.cameras);
  write_file(folder / fmt::format("images{}", ending), files.images);
  write_file(folder / fmt::format("points3D{}", ending), files.points);
}

void add_notes(const ColmapModelFiles& model, const ExportScene& scene, ExportNotes& notes) {
  double errors_px = 0;
  for (const ColmapPoint& made : model.points) errors_px += made.error_px;
  const auto count = static_cast<double>(std::max<std::size_t>(model.points.size(), 1));
  notes.push_back(fmt::format("{}, {}, camera {}; mean reprojection error {:.4f} px; {}",
                              counted(model.images.size(), "image"),
                              counted(model.points.size(), "point"),
                              model.camera.model,
                              errors_px / count,
                              scene.world.description()));
  const Inspection& inspection = scene.inspection;
  const Camera& camera = inspection.recording->camera;
  if (!model.camera.distorted && has_distortion(camera))
    notes.push_back(
        fmt::format("COLMAP has no model of the lens {} with {}: camera and observations are those "
                    "of the undistorted image. Undistort the images before COLMAP uses them",
                    lens_model(camera.distortion).name,
                    counted(camera.coefficients.size(), "coefficient")));
  if (inspection.initialization->row_delay_s)
    notes.emplace_back(
        "the result has a rolling shutter: COLMAP has one pose per image, so its errors are "
        "higher");
  for (const std::string& left_out : scene.left_out) notes.push_back("left out: " + left_out);
  if (scene.points.size() > model.points.size())
    notes.push_back(fmt::format("left out: {} seen in one frame",
                                counted(scene.points.size() - model.points.size(), "point")));
}

}  // namespace

void write_colmap(const ExportScene& scene, const fs::path& folder, ExportNotes& notes) {
  const ColmapModelFiles model = colmap_model(scene);
  write_files(folder, ".txt", text_files(model, scene));
  write_files(folder, ".bin", binary_files(model, scene));
  add_notes(model, scene, notes);
}

}  // namespace gpo
