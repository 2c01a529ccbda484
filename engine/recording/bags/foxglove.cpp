// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// Converts Foxglove's messages (https://docs.foxglove.dev/docs/sdk/schemas) to those of ROS 2.
#include "engine/files/refuse.h"
#include "engine/recording/bags/message_cursor.h"
#include "engine/recording/bags/messages.h"

#include <algorithm>
#include <bit>

#include <nlohmann/json.hpp>

namespace gpo {
namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;
constexpr std::string_view kPrefix = "foxglove.";

/// A field by its name in JSON and its number in protobuf.
struct Field {
  const char* name;
  std::uint64_t number;
};

std::int64_t time_of(std::int64_t seconds, std::int64_t ns) {
  constexpr std::int64_t kMost_s = 4'000'000'000;
  return std::clamp<std::int64_t>(seconds, 0, kMost_s) * kSecond_ns +
         std::clamp<std::int64_t>(ns, 0, kSecond_ns);
}

// The sources below have the same functions. Fields must be read in the order of ROS' definitions,
// because its encodings have no names. Missing fields are 0 or empty.

class ProtobufMessage {
 public:
  explicit ProtobufMessage(std::string_view bytes) : bytes_(bytes) {
    ByteCursor cursor(bytes_);
    while (ok_ && cursor.more()) add_field(cursor);
  }

  bool ok() const { return ok_; }
  std::int64_t integer(Field field) const {
    const Value* value = last(field);
    return value == nullptr ? 0 : static_cast<std::int64_t>(value->number);
  }
  std::uint32_t size(Field field) const { return static_cast<std::uint32_t>(integer(field)); }
  std::string bytes(Field field) const {
    const Value* value = last(field);
    return value == nullptr ? "" : std::string(value->bytes);
  }
  std::string text(Field field) const { return bytes(field); }
  /// Packed numbers or one field for each.
  std::vector<double> doubles(Field field, std::size_t /*count*/ = 0) const {
    std::vector<double> numbers;
    for (const Value& value : values_) {
      if (value.field != field.number) continue;
      if (value.wire == eight_bytes) numbers.push_back(std::bit_cast<double>(value.number));
      ByteCursor packed(value.bytes);
      while (packed.more()) numbers.push_back(packed.number<double>());
    }
    return numbers;
  }
  double number(Field field) const { return std::bit_cast<double>(integer(field)); }
  ProtobufMessage part(Field field) const {
    const Value* value = last(field);
    return ProtobufMessage(value == nullptr ? std::string_view() : value->bytes);
  }
  std::int64_t time_ns() const {
    const ProtobufMessage time = part({"timestamp", 1});
    return time_of(time.integer({"seconds", 1}), time.integer({"nanos", 2}));
  }

 private:
  struct Value {
    std::uint64_t field = 0;
    std::uint64_t wire = 0;
    std::uint64_t number = 0;  ///< or the bits of a double
    std::string_view bytes{};
  };
  enum Wire : std::uint64_t { varint = 0, eight_bytes = 1, bytes_with_length = 2, four_bytes = 5 };

  std::uint64_t read_varint(ByteCursor& cursor) {
    std::uint64_t value = 0;
    for (int shift = 0; shift < 64; shift += 7) {
      const auto byte = cursor.number<std::uint8_t>();
      value |= std::uint64_t{byte & 0x7FU} << shift;
      if ((byte & 0x80) == 0) return value;
    }
    ok_ = false;
    return 0;
  }

  void add_field(ByteCursor& cursor) {
    constexpr std::size_t kMostFields = 10'000;
    const std::uint64_t key = read_varint(cursor);
    Value value{.field = key >> 3, .wire = key & 7};
    switch (value.wire) {
      case varint:
        value.number = read_varint(cursor);
        break;
      case eight_bytes:
        value.number = cursor.number<std::uint64_t>();
        break;
      case bytes_with_length:
        value.bytes = cursor.take(read_varint(cursor));
        break;
      case four_bytes:
        value.number = cursor.number<std::uint32_t>();
        break;
      default:
        ok_ = false;
    }
    ok_ = ok_ && cursor.ok() && values_.size() < kMostFields;
    if (ok_) values_.push_back(value);
  }

  const Value* last(Field field) const {
    const auto found = std::find_if(values_.rbegin(), values_.rend(), [&](const Value& value) {
      return value.field == field.number;
    });
    return found == values_.rend() ? nullptr : &*found;
  }

  std::string_view bytes_;
  std::vector<Value> values_;
  bool ok_ = true;
};

/// Decodes base64 up to the first other character.
std::string from_base64(std::string_view text) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::array<int, 256> values{};
  values.fill(-1);
  for (std::size_t i = 0; i < kDigits.size(); ++i)
    values[static_cast<unsigned char>(kDigits[i])] = static_cast<int>(i);
  std::string bytes;
  bytes.reserve(text.size() / 4 * 3);
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    const int value = values[static_cast<unsigned char>(c)];
    if (value < 0) break;
    bits = bits << 6 | static_cast<std::uint32_t>(value);
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes += static_cast<char>(bits >> count & 0xFF);
  }
  return bytes;
}

class JsonMessage {
 public:
  explicit JsonMessage(std::string_view text) : JsonMessage(parse_json(text)) {}

  bool ok() const { return json_.is_object(); }
  double number(Field field) const {
    const Json value = member(field);
    return value.is_number() ? value.get<double>() : 0;
  }
  std::int64_t integer(Field field) const {
    const Json value = member(field);
    return value.is_number_integer() ? value.get<std::int64_t>() : 0;
  }
  std::uint32_t size(Field field) const { return static_cast<std::uint32_t>(integer(field)); }
  std::string text(Field field) const {
    const Json value = member(field);
    return value.is_string() ? value.get<std::string>() : "";
  }
  std::string bytes(Field field) const { return from_base64(text(field)); }
  std::vector<double> doubles(Field field, std::size_t /*count*/ = 0) const {
    std::vector<double> numbers;
    for (const Json& value : member(field))
      numbers.push_back(value.is_number() ? value.get<double>() : 0);
    return numbers;
  }
  JsonMessage part(Field field) const { return JsonMessage(member(field)); }
  std::int64_t time_ns() const {
    const JsonMessage time = part({"timestamp", 1});
    return time_of(time.integer({"sec", 1}), time.integer({"nsec", 2}));
  }

 private:
  using Json = nlohmann::ordered_json;

  explicit JsonMessage(Json json) : json_(std::move(json)) {}
  Json member(Field field) const {
    const auto found = json_.is_object() ? json_.find(field.name) : json_.end();
    return found == json_.end() ? Json() : *found;
  }

  Json json_;
};

/// foxglove_msgs in an encoding of ROS.
class RosMessage {
 public:
  RosMessage(std::string_view bytes, MessageEncoding encoding) : cursor_(bytes, encoding) {}

  bool ok() const { return cursor_.ok(); }
  double number(Field /*field*/) { return cursor_.number<double>(); }
  std::uint32_t size(Field /*field*/) { return cursor_.number<std::uint32_t>(); }
  std::string text(Field /*field*/) { return cursor_.text(); }
  std::string bytes(Field /*field*/) { return std::string(cursor_.bytes()); }
  std::vector<double> doubles(Field /*field*/, std::size_t count = 0) {
    return count == 0 ? cursor_.doubles() : cursor_.doubles(count);
  }
  RosMessage& part(Field /*field*/) { return *this; }
  std::int64_t time_ns() { return cursor_.time_ns(); }

 private:
  MessageCursor cursor_;
};

MessageHeader header_of(auto& source, std::uint64_t frame_field) {
  MessageHeader header;
  header.stamp_ns = source.time_ns();
  header.frame_id = source.text({"frame_id", frame_field});
  return header;
}

std::string image_file(auto& source) {
  const MessageHeader header = header_of(source, 4);
  return compressed_image_bytes(header, source.bytes({"data", 2}), MessageEncoding::cdr);
}

std::string raw_image(auto& source) {
  ImageMessage image;
  image.header = header_of(source, 7);
  image.width = source.size({"width", 2});
  image.height = source.size({"height", 3});
  image.encoding = source.text({"encoding", 4});
  image.step = source.size({"step", 5});
  const std::string data = source.bytes({"data", 6});
  image.data = data;
  return image_bytes(image, MessageEncoding::cdr);
}

std::string camera_calibration(auto& source) {
  CameraInfoMessage info;
  info.header = header_of(source, 9);
  info.width = source.size({"width", 2});
  info.height = source.size({"height", 3});
  info.distortion_model = source.text({"distortion_model", 4});
  info.D = source.doubles({"D", 5});
  info.K = source.doubles({"K", 6}, 9);
  source.doubles({"R", 7}, 9);
  info.P = source.doubles({"P", 8}, 12);
  info.K.resize(9);
  info.P.resize(12);
  return camera_info_bytes(info, MessageEncoding::cdr);
}

template <int N>
Eigen::Matrix<double, N, 1> vector_of(auto&& source) {
  constexpr std::array<const char*, 4> kNames = {"x", "y", "z", "w"};
  Eigen::Matrix<double, N, 1> vector;
  for (int i = 0; i < N; ++i) vector[i] = source.number({kNames[i], std::uint64_t(i) + 1});
  return vector;
}

std::string pose_in_frame(auto& source) {
  PoseMessage message;
  message.header = header_of(source, 2);
  auto&& pose = source.part({"pose", 3});
  message.position = vector_of<3>(pose.part({"position", 1}));
  message.quaternion_xyzw = vector_of<4>(pose.part({"orientation", 2}));
  return transform_bytes(message, MessageEncoding::cdr);
}

struct Schema {
  std::string_view name;  ///< behind "foxglove."
  const char* ros_type;   ///< type of the converted messages
};
constexpr std::array<Schema, 4> kSchemas = {{{"CompressedImage", "sensor_msgs/CompressedImage"},
                                             {"RawImage", "sensor_msgs/Image"},
                                             {"CameraCalibration", kCameraInfoType},
                                             {"PoseInFrame", "geometry_msgs/TransformStamped"}}};

/// Returns the schema of a type such as "foxglove.RawImage" or "foxglove_msgs/RawImage"; the number
/// of schemas if it is another one.
std::size_t schema_of(std::string_view type) {
  for (const std::string_view prefix : {kPrefix, std::string_view("foxglove_msgs/")})
    if (type.starts_with(prefix))
      return std::ranges::find(kSchemas, type.substr(prefix.size()), &Schema::name) -
             kSchemas.begin();
  return kSchemas.size();
}

/// Returns an image message with its time alone, from the first bytes of the stored one: official
/// writers store the time before the image, protobuf's store the frame behind it. nullopt if the
/// time is not in these bytes.
std::optional<std::string> converted_time(std::string_view beginning, MessageEncoding encoding) {
  MessageHeader header;
  if (encoding == MessageEncoding::protobuf)
    header.stamp_ns = ProtobufMessage(beginning).time_ns();
  else if (encoding != MessageEncoding::json)
    header.stamp_ns = RosMessage(beginning, encoding).time_ns();
  if (header.stamp_ns == 0) return std::nullopt;
  return compressed_image_bytes(header, "", MessageEncoding::cdr);
}

std::optional<std::string> converted(auto source, std::size_t schema) {
  if (!source.ok()) return std::nullopt;
  std::string bytes = schema == 0   ? image_file(source)
                      : schema == 1 ? raw_image(source)
                      : schema == 2 ? camera_calibration(source)
                                    : pose_in_frame(source);
  return source.ok() ? std::optional(std::move(bytes)) : std::nullopt;
}

}  // namespace

std::optional<std::string> converted_foxglove(std::string_view bytes,
                                              const std::string& schema,
                                              MessageEncoding encoding) {
  const std::size_t known = schema_of(schema);
  if (known == kSchemas.size()) return std::nullopt;
  if (encoding == MessageEncoding::protobuf) return converted(ProtobufMessage(bytes), known);
  if (encoding == MessageEncoding::json) return converted(JsonMessage(bytes), known);
  return converted(RosMessage(bytes, encoding), known);
}

Bag open_recorded_bag(const BagFiles& found, const ReadProgress& progress) {
  Bag bag = open_bags(found.files, progress);
  bag.notes.insert(bag.notes.begin(), found.notes.begin(), found.notes.end());
  const std::vector<BagTopic> stored = bag.topics;
  bool converts = false;
  for (BagTopic& topic : bag.topics) {
    const std::size_t schema = schema_of(topic.type);
    const bool foxglove = schema < kSchemas.size() && topic.encoding != MessageEncoding::unknown;
    const bool ros =
        topic.encoding == MessageEncoding::ros1 || topic.encoding == MessageEncoding::cdr;
    if (foxglove) {
      topic.stored_type = topic.type;
      topic.type = kSchemas[schema].ros_type;
      topic.encoding = MessageEncoding::cdr;
      converts = true;
    } else if (!ros) {
      topic.encoding = MessageEncoding::unknown;
    }
  }
  if (!converts) return bag;
  bag.read = [stored, file = bag.file, read = std::move(bag.read)](const BagMessage& message,
                                                                   std::uint64_t most_bytes) {
    const BagTopic& topic = stored[message.topic];
    const std::size_t schema = schema_of(topic.type);
    if (schema == kSchemas.size()) return read(message, most_bytes);
    if (is_image_type(kSchemas[schema].ros_type) && most_bytes < kWholeMessage)
      if (auto header = converted_time(read(message, most_bytes), topic.encoding))
        return *std::move(header);
    auto bytes = converted_foxglove(read(message, kWholeMessage), topic.type, topic.encoding);
    if (!bytes) refuse(file, "{}: broken message, expected {}", topic.name, topic.type);
    if (bytes->size() > most_bytes) bytes->resize(most_bytes);
    return *std::move(bytes);
  };
  return bag;
}

}  // namespace gpo
