// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/files/text_file.h"

#include <cstdint>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace gpo {

struct MessageHeader {
  std::int64_t stamp_ns = 0;  ///< 0 if unknown
  std::string frame_id;
};

enum class MessageEncoding { ros1, cdr, protobuf, json, unknown };

struct BagTopic {
  std::string name;  ///< "/cam0/image_raw"
  std::string type;  ///< "sensor_msgs/Image", also for ROS 2
  MessageEncoding encoding = MessageEncoding::unknown;
  std::int64_t messages = 0;
  std::string stored_type{};  ///< in the file, if the messages are converted to `type`

  const std::string& shown_type() const { return stored_type.empty() ? type : stored_type; }
};

struct BagMessage {
  int topic = 0;                 ///< index in `Bag::topics`
  std::int64_t recorded_ns = 0;  ///< by the recorder's clock
  std::uint32_t chunk = 0;       ///< `chunk` and `place` depend on the container
  std::uint64_t place = 0;
  std::uint32_t part = 0;  ///< index in `Bag::files`
};

/// Index of a bag in any container, or of several that follow each other; the messages stay there.
struct Bag {
  fs::path file;                     ///< for messages: the first
  std::vector<fs::path> files;       ///< all parts in the order of time
  std::vector<BagTopic> topics;      ///< sorted by name
  std::vector<BagMessage> messages;  ///< in the order of the file, for fast sequential reading
  std::vector<std::string> notes;    ///< "truncated or broken at byte 1000 of ..."
  /// Returns the bytes of a message, or the first `most_bytes` of them. Thread-safe. Throws
  /// InputError if they are broken.
  std::function<std::string(const BagMessage& message, std::uint64_t most_bytes)> read;
};

inline constexpr std::uint64_t kWholeMessage = UINT64_MAX;

/// More than an image of 64 million pixels.
inline constexpr std::uint64_t kMostMessageBytes = std::uint64_t{256} << 20;

/// Collects a bag's topics: connections with the same name and type are one topic.
class TopicList {
 public:
  /// `file_bytes` limits the number of messages.
  TopicList(Bag& bag, std::uint64_t file_bytes) : bag_(bag), file_bytes_(file_bytes) {}

  /// Assigns the file's `id` to a topic, unless it is known already. Converts ROS 2's
  /// "sensor_msgs/msg/Image" to "sensor_msgs/Image".
  void add(std::int64_t id, std::string_view name, std::string_view type, MessageEncoding encoding);
  bool knows(std::int64_t id) const { return by_id_.contains(id); }
  /// Ignores messages with unknown ids.
  void add_message(std::int64_t id,
                   std::int64_t recorded_ns,
                   std::uint32_t chunk,
                   std::uint64_t place);
  /// Sorts the bag's topics by name and its messages in the order of the file, and counts those of
  /// each topic; the last call.
  void finish();

 private:
  Bag& bag_;
  std::uint64_t file_bytes_;
  std::map<std::int64_t, int> by_id_;
  std::map<std::pair<std::string, std::string>, int> by_name_;
};

/// A file for thread-safe random access.
class FileBytes {
 public:
  explicit FileBytes(const fs::path& path) : FileBytes(path, path) {}
  /// Reads `content` in place of `path`, which remains its name.
  FileBytes(const fs::path& path, const fs::path& content);
  ~FileBytes();
  FileBytes(const FileBytes&) = delete;
  FileBytes& operator=(const FileBytes&) = delete;

  const fs::path& path() const { return path_; }
  std::uint64_t size() const { return size_; }
  /// Reads `count` bytes, fewer at the end of the file. Throws InputError.
  std::string read(std::uint64_t place, std::uint64_t count) const;

 private:
  fs::path path_;
  int descriptor_;
  std::uint64_t size_ = 0;
};

/// Note for people about a file that is truncated or broken at `place`.
std::string truncation_note(const FileBytes& file, std::uint64_t place);

enum class Compression { none, bz2, lz4, zstd };

/// Returns the compression by its name in bags; nullopt if unknown.
std::optional<Compression> compression_named(std::string_view name);

struct Decompressed {
  std::string bytes;   ///< up to where the input is truncated or broken
  bool whole = false;  ///< to the end
};

/// Decompresses at most about `most_bytes`.
Decompressed from_zstd(std::string_view stored, std::size_t most_bytes);

std::uint32_t crc32_of(std::string_view bytes);

/// A section of a bag with messages.
struct Chunk {
  std::uint64_t place = 0;   ///< in the file
  std::uint64_t stored = 0;  ///< bytes in the file
  std::uint64_t size = 0;    ///< bytes when decompressed, according to the file
  Compression compression = Compression::none;
  std::uint32_t crc32 = 0;  ///< checksum after decompression; 0: unknown
  bool truncated = false;   ///< truncated, but read as far as possible
};

/// Reads parts of a bag's chunks. The last few decompressed ones are cached, so that neighboring
/// messages cost one decompression. Thread-safe.
class ChunkReader {
 public:
  explicit ChunkReader(std::shared_ptr<const FileBytes> file) : file_(std::move(file)) {}

  std::uint32_t add(const Chunk& chunk);
  const Chunk& chunk(std::uint32_t number) const { return chunks_[number]; }
  void clear() { chunks_.clear(); }

  /// Reads `count` bytes, fewer at the end of the chunk. `check_sum` verifies the checksum of an
  /// uncompressed chunk, too, for which all of it must be read. Throws InputError for a broken
  /// compressed chunk and a wrong checksum.
  std::string read(std::uint32_t chunk,
                   std::uint64_t place,
                   std::uint64_t count,
                   bool check_sum = false) const;
  /// Returns a chunk as far as it is readable, without caching it. Throws InputError if it is
  /// complete but has a wrong checksum, and past the limit of `spend_expanded`.
  Decompressed contents(std::uint32_t chunk) const;
  void allow_truncation(std::uint32_t chunk) { chunks_[chunk].truncated = true; }

 private:
  using CachedChunk = std::pair<std::uint32_t, std::shared_ptr<const std::string>>;

  std::shared_ptr<const std::string> cached(std::uint32_t chunk) const;

  std::shared_ptr<const FileBytes> file_;
  std::vector<Chunk> chunks_;
  mutable std::mutex mutex_;
  mutable std::list<CachedChunk> recent_;  ///< most recently used first
};

struct DataPlace {
  std::uint64_t begin = 0;
  std::uint64_t size = 0;  ///< 0 if the message is broken or too large
};

/// State while the index of a bag with chunks is built.
struct BagOpening {
  BagOpening(const std::shared_ptr<const FileBytes>& from, const ReadProgress& progress)
      : file(from),
        chunks(std::make_shared<ChunkReader>(from)),
        topics(bag, from->size()),
        progress(progress) {
    bag.file = from->path();
  }
  /// Reports that the file has been read up to `place`.
  void report(std::uint64_t place) const {
    if (progress) progress(static_cast<double>(place) / static_cast<double>(file->size() + 1));
  }
  /// Completes the bag. `find_data` may read from the chunk, and verifies its checksum if
  /// `check_sum`.
  Bag finish(DataPlace (*find_data)(const ChunkReader& chunks,
                                    const BagMessage& message,
                                    bool check_sum));

  std::shared_ptr<const FileBytes> file;
  std::shared_ptr<ChunkReader> chunks;
  Bag bag;
  TopicList topics;
  ReadProgress progress;
};

/// Opens a bag of any container, recognized by its first bytes. The file, or each of its messages,
/// may be compressed by zstd. Such a file is decompressed into the temporary folder, where it has
/// no name after opening and uses space as long as the bag is open. Throws InputError.
Bag open_bag(const fs::path& file, const ReadProgress& progress = {});

/// Returns whether a file begins as a bag, or as one that is compressed by zstd.
bool is_bag(const FileBytes& file);

/// Opens several bags as one. Their topics are the same if name and type are. Throws InputError.
Bag open_bags(const std::vector<fs::path>& files, const ReadProgress& progress = {});

inline constexpr std::string_view kRos1Magic = "#ROSBAG V2.0\n";
inline constexpr std::string_view kMcapMagic = "\x89MCAP0\r\n";
inline constexpr std::string_view kSqliteMagic{"SQLite format 3\0", 16};
inline constexpr std::string_view kZstdMagic = "\x28\xB5\x2F\xFD";

/// Reads the index of a ROS 1 bag or of an MCAP file. If it is missing or unusable, builds one from
/// the whole file, up to where it is truncated or broken. Throws InputError.
Bag open_ros1_bag(const std::shared_ptr<const FileBytes>& file, const ReadProgress& progress);
Bag open_mcap(const std::shared_ptr<const FileBytes>& file, const ReadProgress& progress);

/// Reads the index of a ROS 2 bag in a database, the tables `topics` and `messages`, as far as a
/// truncated file is readable. `content` is opened in place of `file`. Throws InputError.
Bag open_sqlite_bag(const fs::path& file, const fs::path& content, const ReadProgress& progress);

enum class McapOp : std::uint8_t {
  header = 1,
  footer = 2,
  schema = 3,
  channel = 4,
  message = 5,
  chunk = 6,
  message_index = 7,
  chunk_index = 8,
  statistics = 11,
  data_end = 15
};

inline constexpr std::uint64_t kMcapRecordHead = 9;  ///< kind and length of the content

enum class Ros1Op : std::uint8_t {
  message = 2,
  bag_header = 3,
  index = 4,
  chunk = 5,
  chunk_info = 6,
  connection = 7
};

}  // namespace gpo
