// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/stop.h"
#include "engine/files/refuse.h"
#include "engine/recording/bags/messages.h"
#include "engine/recording/images/images.h"

#include <algorithm>
#include <cstring>

#include <fmt/ranges.h>
#include <opencv2/imgproc.hpp>

namespace gpo {
namespace {

constexpr int kNoConversion = -1;

struct PixelFormat {
  const char* name;
  int type;                     ///< OpenCV's type of the stored pixels
  int conversion;               ///< OpenCV's conversion to blue, green, red
  std::uint32_t half_rows = 2;  ///< stored rows for two rows of the image: NV12 has colors below

  std::uint64_t rows(const ImageMessage& image) const {
    return std::uint64_t{image.height} * half_rows / 2;
  }
};

// ROS names a Bayer pattern by the first two pixels of its first two rows, OpenCV by the second and
// third of its second row: rggb is its BG.
constexpr std::array<PixelFormat, 26> kPixelFormats = {
    {{"mono8", CV_8UC1, cv::COLOR_GRAY2BGR},
     {"8UC1", CV_8UC1, cv::COLOR_GRAY2BGR},
     {"mono16", CV_16UC1, cv::COLOR_GRAY2BGR},
     {"16UC1", CV_16UC1, cv::COLOR_GRAY2BGR},
     {"bgr8", CV_8UC3, kNoConversion},
     {"8UC3", CV_8UC3, kNoConversion},
     {"rgb8", CV_8UC3, cv::COLOR_RGB2BGR},
     {"bgra8", CV_8UC4, cv::COLOR_BGRA2BGR},
     {"8UC4", CV_8UC4, cv::COLOR_BGRA2BGR},
     {"rgba8", CV_8UC4, cv::COLOR_RGBA2BGR},
     {"bgr16", CV_16UC3, kNoConversion},
     {"rgb16", CV_16UC3, cv::COLOR_RGB2BGR},
     {"bayer_rggb8", CV_8UC1, cv::COLOR_BayerBG2BGR},
     {"bayer_bggr8", CV_8UC1, cv::COLOR_BayerRG2BGR},
     {"bayer_gbrg8", CV_8UC1, cv::COLOR_BayerGR2BGR},
     {"bayer_grbg8", CV_8UC1, cv::COLOR_BayerGB2BGR},
     {"bayer_rggb16", CV_16UC1, cv::COLOR_BayerBG2BGR},
     {"bayer_bggr16", CV_16UC1, cv::COLOR_BayerRG2BGR},
     {"bayer_gbrg16", CV_16UC1, cv::COLOR_BayerGR2BGR},
     {"bayer_grbg16", CV_16UC1, cv::COLOR_BayerGB2BGR},
     {"yuv422", CV_8UC2, cv::COLOR_YUV2BGR_UYVY},
     {"uyvy", CV_8UC2, cv::COLOR_YUV2BGR_UYVY},
     {"yuv422_yuy2", CV_8UC2, cv::COLOR_YUV2BGR_YUY2},
     {"yuyv", CV_8UC2, cv::COLOR_YUV2BGR_YUY2},
     {"nv12", CV_8UC1, cv::COLOR_YUV2BGR_NV12, 3},
     {"nv21", CV_8UC1, cv::COLOR_YUV2BGR_NV21, 3}}};

const PixelFormat& format_of(const ImageMessage& image, const std::string& name) {
  const auto found = std::ranges::find(kPixelFormats, image.encoding, &PixelFormat::name);
  if (found != kPixelFormats.end()) return *found;
  refuse(name,
         "found pixel encoding \"{}\", expected one of ROS' gray and color encodings with 8 or 16 "
         "bits such as mono8, bgr8, rgb8, bayer_rggb8 or mono16",
         image.encoding);
}

cv::Mat stored_pixels(const ImageMessage& image, const PixelFormat& format) {
  cv::Mat pixels(static_cast<int>(format.rows(image)), static_cast<int>(image.width), format.type);
  const std::size_t row = pixels.cols * pixels.elemSize();
  for (int y = 0; y < pixels.rows; ++y)
    std::memcpy(pixels.ptr(y), image.data.data() + std::size_t{image.step} * y, row);
  if (image.big_endian && pixels.depth() == CV_16U)
    for (int y = 0; y < pixels.rows; ++y)
      for (std::size_t i = 0; i + 1 < row; i += 2)
        std::swap(pixels.ptr(y)[i], pixels.ptr(y)[i + 1]);
  return pixels;
}

void check_data_size(const ImageMessage& image,
                     const PixelFormat& format,
                     const std::string& name) {
  check_image_size(name, image.width, image.height);
  const std::uint64_t row = std::uint64_t{image.width} * CV_ELEM_SIZE(format.type);
  const std::uint64_t rows = format.rows(image);
  if (rows > 0 && row > 0 && image.step >= row &&
      image.data.size() >= std::uint64_t{image.step} * (rows - 1) + row)
    return;
  refuse(name,
         "found {} bytes in rows of {}, expected an image of {}x{} {}",
         image.data.size(),
         image.step,
         image.width,
         image.height,
         image.encoding);
}

cv::Mat decode_raw(const ImageMessage& image, const std::string& name) {
  const PixelFormat& format = format_of(image, name);
  check_data_size(image, format, name);
  cv::Mat pixels = stored_pixels(image, format);
  if (format.conversion == kNoConversion) return pixels;
  cv::Mat bgr;
  try {
    cv::cvtColor(pixels, bgr, format.conversion);
  } catch (const cv::Exception&) {
    refuse(name,
           "an image of {}x{} cannot have the encoding {}",
           image.width,
           image.height,
           image.encoding);
  }
  return bgr;
}

constexpr std::size_t kMostTransforms = 100'000;

struct Image {
  MessageHeader header;
  BagMessage message;
};

struct Reading {
  const Bag& bag;
  BagContents contents{};
  std::vector<Image> images{};
  bool some_without_stamp = false;
};

template <class T>
T required(const Reading& reading, const BagMessage& message, std::optional<T> made) {
  if (made) return *std::move(made);
  const Bag& bag = reading.bag;
  const BagTopic& topic = bag.topics[message.topic];
  const auto number = std::count_if(bag.messages.data(), &message, [&](const BagMessage& other) {
    return other.topic == message.topic;
  });
  refuse(bag.file,
         "{}: message {} is truncated or broken, expected {}",
         topic.name,
         number,
         topic.type);
}

template <class T>
T stamped(Reading& reading, const BagMessage& message, std::optional<T> read) {
  T made = required(reading, message, std::move(read));
  if (made.header.stamp_ns != 0) return made;
  made.header.stamp_ns = message.recorded_ns;
  reading.some_without_stamp |= message.recorded_ns != 0;
  return made;
}

void add(Reading& reading, const BagMessage& message, TopicRole role) {
  BagContents& contents = reading.contents;
  if (role == TopicRole::camera_info && contents.camera_info) return;
  const BagTopic& topic = reading.bag.topics[message.topic];
  const std::string bytes = reading.bag.read(message, kMostSmallBytes);
  if (role == TopicRole::image) {
    const auto header = read_header(bytes, topic.encoding);
    const auto image = header ? std::optional(Image{*header, message}) : std::nullopt;
    reading.images.push_back(stamped(reading, message, image));
  } else if (role == TopicRole::camera_info) {
    contents.camera_info = required(reading, message, read_camera_info(bytes, topic.encoding));
  } else if (role == TopicRole::imu || role == TopicRole::gyroscope) {
    contents.imu.push_back(stamped(reading, message, read_imu(bytes, topic.encoding)));
  } else if (role == TopicRole::accelerometer) {
    contents.accelerometer.push_back(stamped(reading, message, read_imu(bytes, topic.encoding)));
  } else {
    PoseMessage pose = stamped(reading, message, read_pose(bytes, topic.encoding, topic.type));
    const auto& truth = contents.truth;
    if (truth.empty() || truth.front().child_frame_id == pose.child_frame_id)
      contents.truth.push_back(std::move(pose));
  }
}

void add_transforms(Reading& reading, const BagMessage& message) {
  auto& all = reading.contents.transforms;
  if (all.size() > kMostTransforms) return;
  const std::string bytes = reading.bag.read(message, kWholeMessage);
  const MessageEncoding encoding = reading.bag.topics[message.topic].encoding;
  const auto some = required(reading, message, read_transforms(bytes, encoding));
  all.insert(all.end(), some.begin(), some.end());
}

template <class T>
void put_in_order(std::vector<T>& all, const char* things, std::vector<std::string>& notes) {
  const auto time = [](const T& one) { return one.header.stamp_ns; };
  std::ranges::stable_sort(all, {}, time);
  const auto same_time = [&](const T& a, const T& b) { return time(a) == time(b); };
  const auto again = std::unique(all.begin(), all.end(), same_time);  // clang 14 cannot do ranges'
  if (again == all.end()) return;
  notes.push_back(
      fmt::format("ignoring {} {} with repeated time stamps", all.end() - again, things));
  all.erase(again, all.end());
}

}  // namespace

cv::Mat bag_image(std::string_view bytes, const BagTopic& topic, const std::string& name) {
  if (topic.type == "sensor_msgs/CompressedImage") {
    if (const auto file = read_compressed_image(bytes, topic.encoding))
      return decode_image(*file, name);
  } else if (const auto message = read_image(bytes, topic.encoding)) {
    return decode_raw(*message, name);
  }
  refuse(name, "truncated or broken message, expected {}", topic.type);
}

void join_accelerations(BagContents& contents, const Eigen::Matrix3d& R_gyro_accelerometer) {
  constexpr std::int64_t kLongestGap_ns = 100'000'000;
  std::vector<ImuMessage> measured = contents.accelerometer;
  std::erase_if(measured, [](const ImuMessage& one) { return !one.linear_acceleration; });
  for (ImuMessage& one : contents.imu) one.linear_acceleration.reset();
  const auto time = [](const ImuMessage& one) { return one.header.stamp_ns; };
  std::vector<ImuMessage> joined;
  std::int64_t longest_ns = 0;
  for (ImuMessage one : contents.imu) {
    const auto after = std::ranges::lower_bound(measured, time(one), {}, time);
    if (after == measured.end()) break;
    if (after == measured.begin() && time(*after) != time(one)) continue;
    const auto before = time(*after) == time(one) ? after : after - 1;
    const auto gap = static_cast<double>(time(*after) - time(*before));
    const double share = gap > 0 ? static_cast<double>(time(one) - time(*before)) / gap : 0;
    longest_ns = std::max(longest_ns, time(*after) - time(*before));
    one.linear_acceleration = R_gyro_accelerometer * ((1 - share) * *before->linear_acceleration +
                                                      share * *after->linear_acceleration);
    joined.push_back(std::move(one));
  }
  if (!joined.empty() && longest_ns <= kLongestGap_ns) {
    contents.imu = std::move(joined);
    return;
  }
  contents.notes.push_back(
      joined.empty() ? std::string("accelerations not used: none while the gyroscope measures")
                     : fmt::format("accelerations not used: a gap of {:.2f} s",
                                   1e-9 * static_cast<double>(longest_ns)));
}

/// Messages of some encodings store the frame behind the image.
std::string camera_frame_of(const Bag& bag, const Image& image) {
  if (!image.header.frame_id.empty()) return image.header.frame_id;
  const auto header =
      read_header(bag.read(image.message, kWholeMessage), bag.topics[image.message.topic].encoding);
  return header ? header->frame_id : "";
}

BagContents read_contents(const Bag& bag, const TopicRoles& roles, const ReadProgress& progress) {
  Reading reading{bag};
  for (const BagMessage& message : bag.messages) {
    check_stop();
    if (progress)
      progress(static_cast<double>(&message - bag.messages.data()) /
               static_cast<double>(bag.messages.size()));
    const BagTopic& topic = bag.topics[message.topic];
    const auto role = std::ranges::find(roles.topics, std::optional(message.topic));
    if (role != roles.topics.end())
      add(reading, message, static_cast<TopicRole>(role - roles.topics.begin()));
    else if (topic.type == kTransformsType && topic.name.ends_with("tf_static") &&
             topic.encoding != MessageEncoding::unknown)
      add_transforms(reading, message);
  }

  BagContents& contents = reading.contents;
  put_in_order(reading.images, "images", contents.notes);
  put_in_order(contents.imu, "gyroscope samples", contents.notes);
  put_in_order(contents.accelerometer, "accelerometer samples", contents.notes);
  put_in_order(contents.truth, "poses", contents.notes);
  for (const Image& image : reading.images) {
    contents.image_times_ns.push_back(image.header.stamp_ns);
    contents.images.push_back(image.message);
  }
  contents.camera_frame = camera_frame_of(bag, reading.images.front());
  if (reading.some_without_stamp)
    contents.notes.emplace_back("using the times of recording for messages without time stamps");
  return std::move(reading.contents);
}

}  // namespace gpo
