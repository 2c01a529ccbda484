// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/bags/messages.h"

#include "engine/files/refuse.h"
#include "engine/recording/bags/message_cursor.h"

#include <algorithm>
#include <cmath>
#include <deque>

#include <Eigen/Geometry>
#include <fmt/ranges.h>

namespace gpo {
namespace {

struct PoseType {
  const char* type;
  bool has_child;  ///< true if a child_frame_id follows the header
};
constexpr std::array<PoseType, 4> kPoseTypes = {{{"geometry_msgs/PoseStamped", false},
                                                 {"geometry_msgs/PoseWithCovarianceStamped", false},
                                                 {"geometry_msgs/TransformStamped", true},
                                                 {"nav_msgs/Odometry", true}}};

template <class Message, class Fill>
std::optional<Message> read_whole(std::string_view bytes, MessageEncoding encoding, Fill fill) {
  MessageCursor cursor(bytes, encoding);
  Message message;
  message.header = cursor.header();
  fill(cursor, message);
  return cursor.ok() ? std::optional(std::move(message)) : std::nullopt;
}

void fill_pose(MessageCursor& cursor, PoseMessage& message, bool has_child) {
  if (has_child) message.child_frame_id = cursor.text();
  message.position = cursor.vector();
  for (double& value : message.quaternion_xyzw) value = cursor.number<double>();
}

/// Reads a vector and its covariance; nullopt if the covariance says that it was not measured.
std::optional<Eigen::Vector3d> measured_vector(MessageCursor& cursor) {
  const Eigen::Vector3d vector = cursor.vector();
  const bool measured = cursor.doubles(9).front() != -1;
  return measured ? std::optional(vector) : std::nullopt;
}

constexpr std::uint32_t kLongestSide = 100'000;  // [px]

/// ROS' name of a lens model; all others have ours.
struct RosModel {
  const char* name;
  Distortion distortion;
  std::vector<std::size_t> counts;  ///< numbers of coefficients
};

const std::vector<RosModel>& ros_models() {
  static const std::vector<RosModel> kModels = [] {
    std::vector<RosModel> models = {
        {"plumb_bob", Distortion::radial_tangential, {4, 5}},
        {"rational_polynomial", Distortion::radial_tangential, {8, 12, 14}},
        {"equidistant", Distortion::equidistant, {4}},
        {"fisheye", Distortion::equidistant, {4}}};
    for (const LensModel& ours : lens_models())
      if (ours.distortion > Distortion::equidistant)
        models.push_back({ours.name, ours.distortion, ours.counts});
    return models;
  }();
  return kModels;
}

/// Returns K, or the left part of P if some driver left K empty; zeros without a calibration.
std::array<double, 9> intrinsics_of(const CameraInfoMessage& info) {
  std::array<double, 9> k{};
  const bool from_P = lacks_matrix(info);
  for (std::size_t i = 0; i < k.size(); ++i) {
    const auto& matrix = from_P ? info.P : info.K;
    const std::size_t place = from_P ? i / 3 * 4 + i % 3 : i;
    if (place < matrix.size()) k[i] = matrix[place];
  }
  return k;
}

void set_lens(Camera& camera, const CameraInfoMessage& info, const std::string& name) {
  const auto zero = [](double k) { return k == 0; };
  const auto model = std::ranges::find(ros_models(), info.distortion_model, &RosModel::name);
  if (std::ranges::all_of(info.D, zero)) {  // also if there are none
    if (model == ros_models().end() || model->distortion != Distortion::equidistant) return;
    camera.distortion = Distortion::equidistant;  // an ideal fisheye is no pinhole
    camera.coefficients.assign(4, 0);
    return;
  }
  if (model == ros_models().end())
    refuse(name,
           "`distortion_model`: found \"{}\", expected plumb_bob, rational_polynomial or "
           "equidistant",
           info.distortion_model);
  if (std::ranges::find(model->counts, info.D.size()) == model->counts.end())
    refuse(name,
           "`D`: found {}, expected {} for {}",
           counted(info.D.size(), "number"),
           fmt::join(model->counts, " or "),
           model->name);
  if (!are_coefficients(info.D))
    refuse(name, "`D`: found an implausible coefficient, expected magnitudes of the order of 1");
  camera.distortion = model->distortion;
  camera.coefficients = info.D;
  if (const auto fault = coefficient_fault(camera)) refuse(name, "`D`: found {}", *fault);
  // ROS writes five coefficients also for four calibrated ones.
  if (model->distortion == Distortion::radial_tangential && info.D.size() == 5 &&
      info.D.back() == 0)
    camera.coefficients.pop_back();
}

std::string plain(const std::string& frame) {
  return frame.starts_with('/') ? frame.substr(1) : frame;
}

}  // namespace

std::optional<Pose> PoseMessage::pose() const {
  if (!(std::abs(quaternion_xyzw.norm() - 1) <= 1e-2) || !position.allFinite()) return std::nullopt;
  return Pose{Eigen::Quaterniond(quaternion_xyzw).normalized().toRotationMatrix(), position};
}

bool is_image_type(const std::string& type) {
  return type == "sensor_msgs/Image" || type == "sensor_msgs/CompressedImage";
}

bool is_pose_type(const std::string& type) {
  return std::ranges::find(kPoseTypes, type, &PoseType::type) != kPoseTypes.end();
}

std::optional<MessageHeader> read_header(std::string_view bytes, MessageEncoding encoding) {
  MessageCursor cursor(bytes, encoding);
  MessageHeader header = cursor.header();
  return cursor.ok() ? std::optional(std::move(header)) : std::nullopt;
}

std::optional<ImageMessage> read_image(std::string_view bytes, MessageEncoding encoding) {
  return read_whole<ImageMessage>(bytes, encoding, [](MessageCursor& cursor, auto& message) {
    message.height = cursor.number<std::uint32_t>();
    message.width = cursor.number<std::uint32_t>();
    message.encoding = cursor.text();
    message.big_endian = cursor.number<std::uint8_t>() != 0;
    message.step = cursor.number<std::uint32_t>();
    message.data = cursor.bytes();
  });
}

std::optional<std::string_view> read_compressed_image(std::string_view bytes,
                                                      MessageEncoding encoding) {
  MessageCursor cursor(bytes, encoding);
  cursor.header();
  cursor.text();  // format
  const std::string_view file = cursor.bytes();
  return cursor.ok() ? std::optional(file) : std::nullopt;
}

std::optional<CameraInfoMessage> read_camera_info(std::string_view bytes,
                                                  MessageEncoding encoding) {
  return read_whole<CameraInfoMessage>(bytes, encoding, [](MessageCursor& cursor, auto& message) {
    message.height = cursor.number<std::uint32_t>();
    message.width = cursor.number<std::uint32_t>();
    message.distortion_model = cursor.text();
    message.D = cursor.doubles();
    message.K = cursor.doubles(9);
    cursor.doubles(9);  // rectification
    message.P = cursor.doubles(12);
  });
}

std::optional<ImuMessage> read_imu(std::string_view bytes, MessageEncoding encoding) {
  return read_whole<ImuMessage>(bytes, encoding, [](MessageCursor& cursor, auto& message) {
    cursor.doubles(4 + 9);  // orientation, its covariance
    message.angular_velocity = measured_vector(cursor);
    message.linear_acceleration = measured_vector(cursor);
  });
}

std::optional<PoseMessage> read_pose(std::string_view bytes,
                                     MessageEncoding encoding,
                                     const std::string& type) {
  const auto known = std::ranges::find(kPoseTypes, type, &PoseType::type);
  if (known == kPoseTypes.end()) return std::nullopt;
  return read_whole<PoseMessage>(bytes, encoding, [&](MessageCursor& cursor, auto& message) {
    fill_pose(cursor, message, known->has_child);
  });
}

std::optional<std::vector<PoseMessage>> read_transforms(std::string_view bytes,
                                                        MessageEncoding encoding) {
  MessageCursor cursor(bytes, encoding);
  const auto count = cursor.number<std::uint32_t>();
  std::vector<PoseMessage> transforms;
  for (std::uint32_t i = 0; i < count && cursor.ok(); ++i) {
    transforms.emplace_back().header = cursor.header();
    fill_pose(cursor, transforms.back(), true);
  }
  return cursor.ok() ? std::optional(std::move(transforms)) : std::nullopt;
}

bool is_calibrated(const CameraInfoMessage& info) { return intrinsics_of(info)[0] != 0; }

bool lacks_matrix(const CameraInfoMessage& info) { return info.K.empty() || info.K[0] == 0; }

Camera camera_of(const CameraInfoMessage& info, const std::string& name) {
  const auto k = intrinsics_of(info);
  if (k[1] != 0 || k[3] != 0 || k[6] != 0 || k[7] != 0 || k[8] != 1)
    refuse(name, "`K`: found a matrix of another form, expected [fx, 0, cx, 0, fy, cy, 0, 0, 1]");
  if (!is_focal_length(k[0]) || !is_focal_length(k[4]))
    refuse(name, "`K`: found {:g}, {:g}, expected plausible fx, fy > 0 in pixels", k[0], k[4]);
  if (std::max(info.width, info.height) > kLongestSide)
    refuse(name, "`width`: found {}x{}, expected pixels", info.width, info.height);
  Camera camera{.width = static_cast<int>(info.width),
                .height = static_cast<int>(info.height),
                .fx = k[0],
                .fy = k[4],
                .cx = k[2],
                .cy = k[5]};
  if (!has_near_principal_point(camera))
    refuse(name,
           "`K`: found {:g}, {:g}, expected cx, cy in pixels, near the image center",
           k[2],
           k[5]);
  if (!std::isfinite(camera.cx) || !std::isfinite(camera.cy))
    refuse(name, "`K`: found no numbers, expected cx, cy in pixels");
  set_lens(camera, info, name);
  return camera;
}

CameraInfoMessage camera_info_of(const Camera& camera) {
  CameraInfoMessage info;
  info.width = static_cast<std::uint32_t>(camera.width);
  info.height = static_cast<std::uint32_t>(camera.height);
  info.K = {camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1};
  info.D = camera.coefficients;
  if (camera.distortion >= Distortion::equidistant) {
    info.distortion_model = lens_model(camera.distortion).name;
    return info;
  }
  constexpr std::size_t kPlumbBob = 5;
  info.D.resize(std::max(info.D.size(), kPlumbBob), 0);
  info.distortion_model = info.D.size() == kPlumbBob ? "plumb_bob" : "rational_polynomial";
  return info;
}

std::optional<Pose> transform_between(const std::vector<PoseMessage>& transforms,
                                      const std::string& from,
                                      const std::string& to) {
  std::multimap<std::string, std::pair<std::string, Pose>> neighbors;
  for (const PoseMessage& one : transforms) {
    const auto T_parent_child = one.pose();
    if (!T_parent_child) continue;
    const std::string parent = plain(one.header.frame_id);
    const std::string child = plain(one.child_frame_id);
    neighbors.emplace(parent, std::pair(child, *T_parent_child));
    neighbors.emplace(child, std::pair(parent, inverse(*T_parent_child)));
  }
  std::map<std::string, Pose> reached = {{plain(from), Pose{}}};  // T_from_frame
  std::deque<std::string> open = {plain(from)};
  while (!open.empty()) {
    const std::string frame = open.front();
    open.pop_front();
    if (frame == plain(to)) return reached[frame];
    const auto [first, last] = neighbors.equal_range(frame);
    for (auto i = first; i != last; ++i) {
      const auto& [next, T_frame_next] = i->second;
      if (reached.emplace(next, reached[frame] * T_frame_next).second) open.push_back(next);
    }
  }
  return std::nullopt;
}

}  // namespace gpo
