// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/files/byte_cursor.h"
#include "engine/files/text_file.h"
#include "engine/recording/bags/messages.h"

#include <algorithm>
#include <stdexcept>

#include <Eigen/Geometry>
#include <fmt/format.h>

namespace gpo {
namespace {

class MessageBytes {
 public:
  explicit MessageBytes(MessageEncoding encoding) : cdr_(encoding == MessageEncoding::cdr) {}

  template <class T>
  void number(T value) {
    if (cdr_) bytes_.resize((bytes_.size() + sizeof(T) - 1) / sizeof(T) * sizeof(T));
    bytes_ += stored(value);
  }
  void data(std::string_view data) {
    number(static_cast<std::uint32_t>(data.size()));
    bytes_ += data;
  }
  void text(const std::string& text) {
    data(cdr_ ? std::string_view(text.c_str(), text.size() + 1) : std::string_view(text));
  }
  void doubles(const auto& values) {
    for (const double value : values) number(value);
  }
  void header(const MessageHeader& header) {
    constexpr std::int64_t kSecond = 1'000'000'000;
    std::int64_t seconds = header.stamp_ns / kSecond;
    if (header.stamp_ns % kSecond < 0) --seconds;
    if (!cdr_) number(std::uint32_t{0});  // seq
    number(static_cast<std::int32_t>(seconds));
    number(static_cast<std::uint32_t>(header.stamp_ns - seconds * kSecond));
    text(header.frame_id);
  }
  std::string message() const { return (cdr_ ? std::string("\0\1\0\0", 4) : "") + bytes_; }

 private:
  bool cdr_;
  std::string bytes_;  ///< without CDR's head, to which alignment is relative
};

void add_transform(MessageBytes& bytes, const PoseMessage& message) {
  bytes.header(message.header);
  bytes.text(message.child_frame_id);
  bytes.doubles(message.position);
  bytes.doubles(message.quaternion_xyzw);
}

struct Definition {
  const char* name;
  const char* fields;
  const char* ros1_sum;
};

constexpr std::array<Definition, 9> kDefinitions = {
    {{"sensor_msgs/Image",
      "std_msgs/Header header\nuint32 height\nuint32 width\nstring encoding\nuint8 is_bigendian\n"
      "uint32 step\nuint8[] data\n",
      "060021388200f6f0f447d0fcd9c64743"},
     {"sensor_msgs/CameraInfo", "", "c9a58c1b0b154e0e6da7578cb991d214"},
     {"sensor_msgs/RegionOfInterest",
      "uint32 x_offset\nuint32 y_offset\nuint32 height\nuint32 width\nbool do_rectify\n",
      ""},
     {"sensor_msgs/Imu",
      "std_msgs/Header header\ngeometry_msgs/Quaternion orientation\n"
      "float64[9] orientation_covariance\ngeometry_msgs/Vector3 angular_velocity\n"
      "float64[9] angular_velocity_covariance\ngeometry_msgs/Vector3 linear_acceleration\n"
      "float64[9] linear_acceleration_covariance\n",
      "6a62c6daae103f4ff57a132d6f95cec2"},
     {"geometry_msgs/TransformStamped",
      "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/Transform transform\n",
      "b5764a33bfeb3588febc2682852579b0"},
     {"tf2_msgs/TFMessage",
      "geometry_msgs/TransformStamped[] transforms\n",
      "94810edda583a504dfda3829e70d7eec"},
     {"geometry_msgs/Transform",
      "geometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation\n",
      ""},
     {"geometry_msgs/Vector3", "float64 x\nfloat64 y\nfloat64 z\n", ""},
     {"geometry_msgs/Quaternion", "float64 x\nfloat64 y\nfloat64 z\nfloat64 w\n", ""}}};

constexpr std::string_view kTime = "builtin_interfaces/Time";
const Definition& definition_of(std::string_view name) {
  const auto found = std::ranges::find(kDefinitions, name, &Definition::name);
  if (found == kDefinitions.end()) throw std::out_of_range("unknown message type");
  return *found;
}

std::string fields_of(std::string_view name, bool ros1) {
  if (name == "std_msgs/Header")
    return ros1 ? "uint32 seq\ntime stamp\nstring frame_id\n"
                : "builtin_interfaces/Time stamp\nstring frame_id\n";
  if (name != "sensor_msgs/CameraInfo") return definition_of(name).fields;
  const std::string matrices = ros1 ? "float64[] D\nfloat64[9] K\nfloat64[9] R\nfloat64[12] P\n"
                                    : "float64[] d\nfloat64[9] k\nfloat64[9] r\nfloat64[12] p\n";
  return "std_msgs/Header header\nuint32 height\nuint32 width\nstring distortion_model\n" +
         matrices + "uint32 binning_x\nuint32 binning_y\nsensor_msgs/RegionOfInterest roi\n";
}

void add_parts(std::vector<std::string>& parts, std::string_view fields, bool ros1) {
  TextLines lines(fields);
  while (const auto line = lines.next()) {
    const std::string type(line->substr(0, line->find_first_of("[ ")));
    const bool known = type == kTime || std::ranges::find(parts, type) != parts.end();
    if (known || type.find('/') == std::string::npos) continue;
    parts.push_back(type);
    add_parts(parts, fields_of(type, ros1), ros1);
  }
}
/// ROS' convention: 0 is unknown, -1 in the first element is not measured.
std::array<double, 9> covariance(bool measured) { return {measured ? 0.0 : -1.0}; }

}  // namespace

std::string image_bytes(const ImageMessage& message, MessageEncoding encoding) {
  MessageBytes bytes(encoding);
  bytes.header(message.header);
  bytes.number(message.height);
  bytes.number(message.width);
  bytes.text(message.encoding);
  bytes.number(static_cast<std::uint8_t>(message.big_endian));
  bytes.number(message.step);
  bytes.data(message.data);
  return bytes.message();
}

std::string compressed_image_bytes(const MessageHeader& header,
                                   std::string_view file,
                                   MessageEncoding encoding) {
  MessageBytes bytes(encoding);
  bytes.header(header);
  bytes.text("");  // format
  bytes.data(file);
  return bytes.message();
}

std::string camera_info_bytes(const CameraInfoMessage& message, MessageEncoding encoding) {
  MessageBytes bytes(encoding);
  bytes.header(message.header);
  bytes.number(message.height);
  bytes.number(message.width);
  bytes.text(message.distortion_model);
  bytes.number(static_cast<std::uint32_t>(message.D.size()));
  bytes.doubles(message.D);
  bytes.doubles(message.K);
  const auto& k = message.K;
  bytes.doubles(std::array<double, 9>{1, 0, 0, 0, 1, 0, 0, 0, 1});
  const std::vector<double> rectified = {k[0], 0, k[2], 0, 0, k[4], k[5], 0, 0, 0, 1, 0};
  bytes.doubles(message.P.empty() ? rectified : message.P);
  for (int i = 0; i < 6; ++i) bytes.number(std::uint32_t{0});  // binning, region of interest
  bytes.number(std::uint8_t{0});
  return bytes.message();
}

std::string imu_bytes(const ImuMessage& message, MessageEncoding encoding) {
  MessageBytes bytes(encoding);
  bytes.header(message.header);
  bytes.doubles(std::array<double, 4>{0, 0, 0, 1});
  bytes.doubles(covariance(false));
  for (const auto& vector : {message.angular_velocity, message.linear_acceleration}) {
    bytes.doubles(vector.value_or(Eigen::Vector3d::Zero()));
    bytes.doubles(covariance(vector.has_value()));
  }
  return bytes.message();
}

std::string transform_bytes(const PoseMessage& message, MessageEncoding encoding) {
  MessageBytes bytes(encoding);
  add_transform(bytes, message);
  return bytes.message();
}

std::string transforms_bytes(const std::vector<PoseMessage>& messages, MessageEncoding encoding) {
  MessageBytes bytes(encoding);
  bytes.number(static_cast<std::uint32_t>(messages.size()));
  for (const PoseMessage& message : messages) add_transform(bytes, message);
  return bytes.message();
}

MessageType message_type(const std::string& name, MessageEncoding encoding) {
  const bool ros1 = encoding == MessageEncoding::ros1;
  MessageType type{definition_of(name).ros1_sum, fields_of(name, ros1)};
  std::vector<std::string> parts;
  add_parts(parts, type.definition, ros1);
  if (!ros1) parts.emplace_back(kTime);
  for (const std::string& part : parts)
    type.definition +=
        fmt::format("{:=<80}\nMSG: {}\n{}",
                    "",
                    part,
                    part == kTime ? "int32 sec\nuint32 nanosec\n" : fields_of(part, ros1));
  return type;
}

}  // namespace gpo
