// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/camera.h"
#include "engine/geometry/pose.h"
#include "engine/recording/bags/containers/bag.h"

#include <opencv2/core.hpp>

namespace gpo {

// ROS messages of a recording, with ROS' names of fields. The readers return nullopt if the bytes
// are truncated or not in the topic's encoding.

/// sensor_msgs/Image
struct ImageMessage {
  MessageHeader header;
  std::uint32_t height = 0;
  std::uint32_t width = 0;
  std::string encoding;  ///< "mono8"
  bool big_endian = false;
  std::uint32_t step = 0;  ///< bytes a row
  std::string_view data;   ///< points into the message's bytes
};

struct CameraInfoMessage {
  MessageHeader header;
  std::uint32_t height = 0;
  std::uint32_t width = 0;
  std::string distortion_model;  ///< "plumb_bob"
  std::vector<double> D;
  std::vector<double> K;    ///< 3 x 3, row by row
  std::vector<double> P{};  ///< 3 x 4, of the rectified image; empty: K without distortion
};

/// sensor_msgs/Imu, without its orientation
struct ImuMessage {
  MessageHeader header;
  // A sensor that the device lacks has -1 as the first element of its covariance.
  std::optional<Eigen::Vector3d> angular_velocity;     ///< [rad/s]
  std::optional<Eigen::Vector3d> linear_acceleration;  ///< [m/s^2]
};

/// geometry_msgs/PoseStamped, PoseWithCovarianceStamped and TransformStamped, nav_msgs/Odometry:
/// a pose in the header's frame.
struct PoseMessage {
  MessageHeader header;
  std::string child_frame_id;  ///< the frame with this pose; empty if the type has no such field
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< [m]
  Eigen::Vector4d quaternion_xyzw = Eigen::Vector4d::Zero();

  /// nullopt if the quaternion is not a unit quaternion.
  std::optional<Pose> pose() const;
};

/// Enough for a header, and for a whole Imu or pose with frame names of plausible length.
inline constexpr std::uint64_t kMostSmallBytes = 2048;

bool is_image_type(const std::string& type);
bool is_pose_type(const std::string& type);
inline constexpr const char* kCameraInfoType = "sensor_msgs/CameraInfo";
inline constexpr const char* kImuType = "sensor_msgs/Imu";
inline constexpr const char* kTransformsType = "tf2_msgs/TFMessage";

/// Reads the header of any type above; needs only the beginning of the message.
std::optional<MessageHeader> read_header(std::string_view bytes, MessageEncoding encoding);
std::optional<ImageMessage> read_image(std::string_view bytes, MessageEncoding encoding);
/// Returns the image file in a sensor_msgs/CompressedImage, a part of `bytes`.
std::optional<std::string_view> read_compressed_image(std::string_view bytes,
                                                      MessageEncoding encoding);
std::optional<CameraInfoMessage> read_camera_info(std::string_view bytes, MessageEncoding encoding);
std::optional<ImuMessage> read_imu(std::string_view bytes, MessageEncoding encoding);
std::optional<PoseMessage> read_pose(std::string_view bytes,
                                     MessageEncoding encoding,
                                     const std::string& type);
/// tf2_msgs/TFMessage
std::optional<std::vector<PoseMessage>> read_transforms(std::string_view bytes,
                                                        MessageEncoding encoding);

/// False for the zeros that ROS' drivers send without a calibration.
bool is_calibrated(const CameraInfoMessage& info);
/// Returns whether K is missing, so that `camera_of` takes the matrix from P.
bool lacks_matrix(const CameraInfoMessage& info);

/// Throws InputError that begins with `name` if the camera is not supported.
Camera camera_of(const CameraInfoMessage& info, const std::string& name);

/// The inverse of `camera_of`; leaves the header empty.
CameraInfoMessage camera_info_of(const Camera& camera);

/// Returns T_from_to, x_from = R x_to + p, along the given transforms in either direction; nullopt
/// if they do not connect the frames.
std::optional<Pose> transform_between(const std::vector<PoseMessage>& transforms,
                                      const std::string& from,
                                      const std::string& to);

/// Decodes the image of a message on a `topic` of images: blue, green, red, 8 or 16 bits each.
/// Throws InputError that begins with `name`.
cv::Mat bag_image(std::string_view bytes, const BagTopic& topic, const std::string& name);

/// Writes a bag: messages in the order of time, then the end.
struct BagWriter {
  MessageEncoding encoding;  ///< required for the messages
  std::function<void(int topic, std::int64_t time_ns, const std::string& bytes)> write;
  /// Throws InputError if the file is incomplete.
  std::function<void()> finish;
};

/// Files of one recording.
struct BagFiles {
  std::vector<fs::path> files;     ///< in the order of time; compressed ones may end in .zstd
  std::vector<std::string> notes;  ///< "rec_1.db3 is missing"
};

/// Finds the parts of a recording: a file, or a folder with one bag, with rosbag2's metadata.yaml,
/// or with the numbered parts of one recording (NAME_0, NAME_1, ...). Throws InputError if a folder
/// has several others.
BagFiles find_bag_files(const fs::path& path);

/// Returns whether the folder has rosbag2's metadata.yaml.
bool has_bag_metadata(const fs::path& folder);

/// Opens all parts as one bag, with Foxglove's messages converted. Throws InputError.
Bag open_recorded_bag(const BagFiles& found, const ReadProgress& progress = {});

/// Converts a message of Foxglove's CompressedImage, RawImage, CameraCalibration or PoseInFrame to
/// that of ROS 2. Returns nullopt if it is broken.
std::optional<std::string> converted_foxglove(std::string_view bytes,
                                              const std::string& schema,
                                              MessageEncoding encoding);

/// ROS 1 with uncompressed chunks of 768 KiB. `message_type` must know the topics' types.
BagWriter ros1_writer(const fs::path& file, const std::vector<BagTopic>& topics);

BagWriter mcap_writer(const fs::path& file, const std::vector<BagTopic>& topics);

/// A topic of an MCAP file and the schema of its messages.
struct McapChannel {
  std::string topic;       ///< "/camera/image"
  std::string schema;      ///< name: "foxglove.CompressedImage"
  std::string definition;  ///< text of the schema
};

/// MCAP with messages in JSON, whose schemas are JSON schemas.
BagWriter mcap_json_writer(const fs::path& file, const std::vector<McapChannel>& channels);

std::string image_bytes(const ImageMessage& message, MessageEncoding encoding);
/// sensor_msgs/CompressedImage: the bytes of an image file.
std::string compressed_image_bytes(const MessageHeader& header,
                                   std::string_view file,
                                   MessageEncoding encoding);
std::string camera_info_bytes(const CameraInfoMessage& message, MessageEncoding encoding);
/// Marks orientation and covariances as unknown.
std::string imu_bytes(const ImuMessage& message, MessageEncoding encoding);
/// geometry_msgs/TransformStamped
std::string transform_bytes(const PoseMessage& message, MessageEncoding encoding);
/// tf2_msgs/TFMessage
std::string transforms_bytes(const std::vector<PoseMessage>& messages, MessageEncoding encoding);

/// Description of a type that a bag contains for its readers.
struct MessageType {
  const char* ros1_sum;    ///< MD5 of the definition
  std::string definition;  ///< its fields, and those of the types of its fields
};

/// Knows the types above. Throws std::out_of_range for others.
MessageType message_type(const std::string& name, MessageEncoding encoding);

/// `imu` has both sensors; `gyroscope` and `accelerometer` are topics with one each.
enum class TopicRole { image, camera_info, imu, truth, gyroscope, accelerometer };
inline constexpr int kTopicRoles = 6;
template <>
struct ChoiceKeys<TopicRole>
    : NamedKeys<"topic", "image", "camera_info", "imu", "truth", "gyroscope", "accelerometer"> {};

/// Names of the topics that the user chose.
using TopicChoices = std::map<TopicRole, std::string>;

/// Parses "image=/cam0/image_raw", one text for each role; `pose` means `truth`. Throws
/// SettingError.
TopicChoices parse_topic_choices(const std::vector<std::string>& texts);

struct TopicRoles {
  std::array<std::optional<int>, kTopicRoles> topics;  ///< indices in `Bag::topics`
  std::vector<std::string> notes;                      ///< "several topics with ..."

  std::optional<int> of(TopicRole role) const { return topics[static_cast<std::size_t>(role)]; }
};

/// Finds a topic with messages of the right type for each role: the chosen one, otherwise the one
/// with the longest common prefix with the images' topic, otherwise the first by name. Topics with
/// `depth` or `accel` in their names come last. Calibrations of zeros have no role. If no topic has
/// rates and accelerations, gyroscope and accelerometer are found apart. Throws InputError if there
/// are no images or a chosen topic is missing.
TopicRoles topic_roles(const Bag& bag, const TopicChoices& choices);

/// "/imu (sensor_msgs/Imu, 200), ...", abbreviated if there are many.
std::string topics_text(const Bag& bag);

/// A recording's data in a bag, sorted by the time stamps of the messages' headers, strictly
/// ascending. Messages without a time stamp have the time of recording.
struct BagContents {
  std::vector<std::int64_t> image_times_ns;
  std::vector<BagMessage> images;                ///< one for each time
  std::string camera_frame;                      ///< `frame_id` of the first image
  std::optional<CameraInfoMessage> camera_info;  ///< the first
  std::vector<ImuMessage> imu;                   ///< from the topic with rates
  std::vector<ImuMessage> accelerometer;         ///< empty unless it has a topic of its own
  std::vector<PoseMessage> truth;
  std::vector<PoseMessage> transforms;  ///< from /tf_static
  std::vector<std::string> notes;       ///< about ignored messages
};

/// Joins the accelerometer's topic to the rates: interpolates linearly at their times, as
/// RealSense's driver does. Drops rates before and after the accelerations. Without effect, but
/// with a note, if accelerations are missing for more than 0.1 s in between. `R_gyro_accelerometer`
/// rotates into the gyroscope's axes.
void join_accelerations(BagContents& contents, const Eigen::Matrix3d& R_gyro_accelerometer);

/// Reads the messages of all topics with a role, of images only the headers. Throws InputError if a
/// message is truncated or not of its type.
BagContents read_contents(const Bag& bag,
                          const TopicRoles& roles,
                          const ReadProgress& progress = {});

}  // namespace gpo
