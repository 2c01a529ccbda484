// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/internal/stop.h"
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
  int type;        ///< OpenCV's type of the stored pixels
  int conversion;  ///< OpenCV's conversion to blue, green, red
};

// ROS names a Bayer pattern by the first two pixels of its first two rows, OpenCV by the second and
// third of its second row: rggb is its BG.
constexpr std::array<PixelFormat, 24> kPixelFormats = {
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
     {"yuyv", CV_8UC2, cv::COLOR_YUV2BGR_YUY2}}};

const PixelFormat& format_of(const ImageMessage& image, const std::string& name) {
  const auto found = std::ranges::find(kPixelFormats, image.encoding, &PixelFormat::name);
  if (found != kPixelFormats.end()) return *found;
  refuse(name,
         "found pixel encoding \"{}\", expected one of ROS' gray and color encodings with 8 or 16 "
         "bits such as mono8, bgr8, rgb8, bayer_rggb8 or mono16",
         image.encoding);
}

cv::Mat stored_pixels(const ImageMessage& image, const PixelFormat& format) {
  cv::Mat pixels(static_cast<int>(image.height), static_cast<int>(image.width), format.type);
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
  const std::uint64_t rows = image.height;
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

struct RoleKind {
  bool (*fits)(const std::string& type);
  const char* things;    ///< "several topics with THINGS"
  const char* expected;  ///< the types
  const char* unlikely;  ///< word in the names of topics with other data
};

constexpr std::array<RoleKind, kTopicRoles> kRoles = {
    {{is_image_type, "images", "sensor_msgs/Image or CompressedImage", "depth"},
     {[](const std::string& type) { return type == kCameraInfoType; },
      "calibrations",
      "sensor_msgs/CameraInfo",
      "depth"},
     {[](const std::string& type) { return type == kImuType; },
      "a gyroscope",
      "sensor_msgs/Imu",
      "accel"},
     {is_pose_type,
      "poses",
      "geometry_msgs/PoseStamped, PoseWithCovarianceStamped, TransformStamped or "
      "nav_msgs/Odometry",
      "covariance"}}};

bool fits(const BagTopic& topic, const RoleKind& kind) {
  return topic.messages > 0 && topic.encoding != MessageEncoding::unknown && kind.fits(topic.type);
}

int chosen(const Bag& bag, const RoleKind& kind, const std::string& name) {
  for (std::size_t i = 0; i < bag.topics.size(); ++i)
    if (bag.topics[i].name == name && fits(bag.topics[i], kind)) return static_cast<int>(i);
  const auto same_name = std::ranges::find(bag.topics, name, &BagTopic::name);
  const std::string found =
      same_name == bag.topics.end()
          ? fmt::format("no topic {} among {}", name, topics_text(bag))
          : fmt::format("{} messages of {} in {}", same_name->messages, same_name->type, name);
  refuse(bag.file, "--topic: found {}, expected {}", found, kind.expected);
}

std::optional<int> found(const Bag& bag,
                         TopicRole role,
                         const std::string& like,
                         std::vector<std::string>& notes) {
  const RoleKind& kind = kRoles[static_cast<std::size_t>(role)];
  std::vector<int> all;
  for (std::size_t i = 0; i < bag.topics.size(); ++i)
    if (fits(bag.topics[i], kind)) all.push_back(static_cast<int>(i));
  if (all.empty()) return std::nullopt;
  const int best = *std::ranges::max_element(all, {}, [&](int i) {
    const std::string& name = bag.topics[i].name;
    const auto common = std::ranges::mismatch(name, like).in1 - name.begin();
    return std::pair(name.find(kind.unlikely) == std::string::npos, common);
  });
  if (all.size() == 1 || role == TopicRole::camera_info) return best;
  const int other = all.front() == best ? all[1] : all.front();
  notes.push_back(fmt::format("{} topics with {}: using {}; choose another with --topic {}={}",
                              all.size(),
                              kind.things,
                              bag.topics[best].name,
                              to_string(role),
                              bag.topics[other].name));
  return best;
}

/// Enough for a header, and for a whole Imu or pose with frame names of plausible length.
constexpr std::uint64_t kMostSmallBytes = 2048;
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
  } else if (role == TopicRole::imu) {
    contents.imu.push_back(stamped(reading, message, read_imu(bytes, topic.encoding)));
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

TopicChoices parse_topic_choices(const std::vector<std::string>& texts) {
  TopicChoices choices;
  for (const std::string& text : texts) {
    const auto equals = text.find('=');
    if (equals == std::string::npos || equals + 1 == text.size())
      refuse_setting("topic", "found '{}', expected ROLE=NAME, e.g. image=/cam0/image_raw", text);
    const auto role = choice<TopicRole>(text.substr(0, equals));
    if (!choices.emplace(role, text.substr(equals + 1)).second)
      refuse_setting("topic", "found {} twice", to_string(role));
  }
  return choices;
}

TopicRoles topic_roles(const Bag& bag, const TopicChoices& choices) {
  TopicRoles roles;
  std::string like;
  for (int i = 0; i < kTopicRoles; ++i) {
    const auto role = static_cast<TopicRole>(i);
    const auto choice = choices.find(role);
    auto& topic = roles.topics[i];
    topic = choice == choices.end() ? found(bag, role, like, roles.notes)
                                    : std::optional(chosen(bag, kRoles[i], choice->second));
    if (role != TopicRole::image) continue;
    if (!topic)
      refuse(bag.file,
             "found no images among {}, expected a topic of type {}",
             topics_text(bag),
             kRoles[i].expected);
    like = bag.topics[*topic].name;
  }
  return roles;
}

std::string topics_text(const Bag& bag) {
  constexpr std::size_t kShown = 10;
  constexpr std::size_t kLongest = 60;
  if (bag.topics.empty()) return "no topics";
  std::vector<std::string> texts;
  for (const BagTopic& topic : bag.topics) {
    if (texts.size() == kShown) break;
    texts.push_back(fmt::format("{} ({}, {})",
                                legible(topic.name, kLongest),
                                legible(topic.type, kLongest),
                                topic.messages));
  }
  if (bag.topics.size() > kShown)
    texts.push_back(fmt::format("{} more", bag.topics.size() - kShown));
  return fmt::format("{}", fmt::join(texts, ", "));
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
  put_in_order(contents.truth, "poses", contents.notes);
  for (const Image& image : reading.images) {
    contents.image_times_ns.push_back(image.header.stamp_ns);
    contents.images.push_back(image.message);
  }
  contents.camera_frame = reading.images.front().header.frame_id;
  if (reading.some_without_stamp)
    contents.notes.emplace_back("using the times of recording for messages without time stamps");
  return std::move(reading.contents);
}

}  // namespace gpo
