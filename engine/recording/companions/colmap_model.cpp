// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/companions/colmap_model.h"

#include "engine/files/byte_cursor.h"
#include "engine/files/refuse.h"
#include "engine/files/text_file.h"

#include <cmath>

namespace gpo {
namespace {

using Eigen::Vector3d;

/// Inverts COLMAP's x_camera = R(q) x_world + t. `numbers`: q_wxyz, t.
Pose camera_of(const std::array<double, 7>& numbers, const std::string& place) {
  constexpr double kMaxDeviation = 1e-2;
  const Eigen::Quaterniond q(numbers[0], numbers[1], numbers[2], numbers[3]);
  if (!(std::abs(q.norm() - 1) <= kMaxDeviation))
    fail_at(place, fmt::format("a quaternion of norm {:g}", q.norm()), "a unit quaternion");
  const Vector3d t(numbers[4], numbers[5], numbers[6]);
  if (!t.allFinite()) fail_at(place, "a translation that is not finite", "three finite numbers");
  return inverse({q.normalized().toRotationMatrix(), t});
}

void check_point(const Vector3d& point, const std::string& place) {
  if (!point.allFinite() || point.cwiseAbs().maxCoeff() > kMaxCoordinate)
    fail_at(place,
            fmt::format("({:g} {:g} {:g})", point.x(), point.y(), point.z()),
            fmt::format("three numbers up to {:g}", kMaxCoordinate));
}

Eigen::Matrix3Xd columns(const std::vector<Vector3d>& points) {
  Eigen::Matrix3Xd matrix(3, std::ssize(points));
  for (Eigen::Index j = 0; j < matrix.cols(); ++j) matrix.col(j) = points[j];
  return matrix;
}

std::optional<std::string_view> next_entry(TextLines& lines) {
  auto line = lines.next();
  while (line && (line->empty() || line->front() == '#')) line = lines.next();
  return line;
}

double take_number(std::string_view& rest, const std::string& place, const char* columns) {
  const std::string_view word = take_word(rest);
  const auto value = parse_number(word);
  if (!value)
    fail_at(place,
            word.empty() ? "the end of the line" : fmt::format("\"{}\"", word.substr(0, 40)),
            fmt::format("a finite number ({})", columns));
  return *value;
}

NamedPoses images_in_text(const fs::path& file, std::string_view text) {
  constexpr const char* kColumns = "IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME";
  NamedPoses images;
  TextLines lines(text);
  while (auto line = next_entry(lines)) {
    const std::string place = place_in(file, lines.number());
    take_number(*line, place, kColumns);
    std::array<double, 7> numbers{};
    for (double& number : numbers) number = take_number(*line, place, kColumns);
    take_number(*line, place, kColumns);
    if (line->empty()) fail_at(place, "no image name", kColumns);
    images.names.emplace_back(*line);
    images.poses.push_back(camera_of(numbers, place));
    lines.next();  // keypoints; may be empty
  }
  return images;
}

Eigen::Matrix3Xd points_in_text(const fs::path& file, std::string_view text) {
  constexpr const char* kColumns = "POINT3D_ID X Y Z R G B ERROR TRACK[]";
  std::vector<Vector3d> points;
  TextLines lines(text);
  while (auto line = next_entry(lines)) {
    const std::string place = place_in(file, lines.number());
    take_number(*line, place, kColumns);
    Vector3d point;
    for (double& number : point) number = take_number(*line, place, kColumns);
    check_point(point, place);
    points.push_back(point);
  }
  return columns(points);
}

class Entries {
 public:
  Entries(const fs::path& file, std::string_view bytes, const char* kind)
      : file_(file), bytes_(bytes), kind_(kind), cursor_(bytes) {
    count_ = cursor_.number<std::uint64_t>();
    if (!cursor_.ok()) fail_at(file_, "fewer than 8 bytes", "the number of entries");
  }

  bool next() {
    if (number_ == count_) {
      if (cursor_.more())
        fail_at(
            file_,
            fmt::format(
                "{} bytes after the last of {} entries", bytes_.size() - cursor_.place(), count_),
            "the end of the file");
      return false;
    }
    ++number_;
    begin_ = cursor_.place();
    return true;
  }
  ByteCursor& cursor() { return cursor_; }
  std::size_t left() const { return bytes_.size() - cursor_.place(); }
  std::string place() const {
    return fmt::format("{}: {} {}, byte {}", file_.string(), kind_, number_, begin_);
  }
  /// Throws InputError if the file ended. Call before using what was read.
  void check() const {
    if (!cursor_.ok()) fail_at(place(), "the end of the file", fmt::format("{} of them", count_));
  }
  /// Skips a list that starts with its length; `size`: bytes per element.
  void skip_list(std::uint64_t size) {
    const auto count = cursor_.number<std::uint64_t>();
    if (cursor_.ok() && count > left() / size)
      fail_at(place(), fmt::format("a list of {} in {} bytes", count, left()), "one that fits");
    cursor_.take(count * size);
  }

 private:
  const fs::path& file_;
  std::string_view bytes_;
  const char* kind_;
  ByteCursor cursor_;
  std::uint64_t count_ = 0;
  std::uint64_t number_ = 0;
  std::size_t begin_ = 0;
};

NamedPoses images_in_binary(const fs::path& file, std::string_view bytes) {
  NamedPoses images;
  Entries entries(file, bytes, "image");
  while (entries.next()) {
    ByteCursor& cursor = entries.cursor();
    cursor.number<std::uint32_t>();  // id
    std::array<double, 7> numbers{};
    for (double& number : numbers) number = cursor.number<double>();
    cursor.number<std::uint32_t>();  // camera id
    const std::size_t length = bytes.substr(cursor.place()).find('\0');
    const std::string_view name = cursor.take(length);
    cursor.take(1);
    entries.check();
    if (name.empty()) fail_at(entries.place(), "no image name", "one");
    images.names.emplace_back(name);
    images.poses.push_back(camera_of(numbers, entries.place()));
    entries.skip_list(24);  // keypoints: x, y, point id
    entries.check();
  }
  return images;
}

Eigen::Matrix3Xd points_in_binary(const fs::path& file, std::string_view bytes) {
  std::vector<Vector3d> points;
  Entries entries(file, bytes, "point");
  while (entries.next()) {
    ByteCursor& cursor = entries.cursor();
    cursor.number<std::uint64_t>();  // id
    Vector3d point;
    for (double& number : point) number = cursor.number<double>();
    cursor.take(3 + sizeof(double));  // color, error
    entries.skip_list(8);             // observations
    entries.check();
    check_point(point, entries.place());
    points.push_back(point);
  }
  return columns(points);
}

bool is_binary(const fs::path& file) { return file.extension() == ".bin"; }

}  // namespace

NamedPoses read_colmap_poses(const fs::path& file, std::string_view bytes) {
  NamedPoses images = is_binary(file) ? images_in_binary(file, bytes) : images_in_text(file, bytes);
  if (images.poses.empty()) fail_at(file, "no image", "a COLMAP model with images");
  return images;
}

Eigen::Matrix3Xd read_colmap_points(const fs::path& file, std::string_view bytes) {
  return is_binary(file) ? points_in_binary(file, bytes) : points_in_text(file, bytes);
}

}  // namespace gpo
