// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/bags/containers/bag.h"

#include "engine/base/stop.h"
#include "engine/files/refuse.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <numeric>
#include <system_error>

#include <bzlib.h>
#include <fcntl.h>
#include <lz4frame.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>
#include <zstd.h>

namespace gpo {
namespace {

/// Allowance for black images, which compress extremely well.
constexpr std::uint64_t kAlwaysAllowed = std::uint64_t{32} << 20;
constexpr std::uint64_t kMostRatio = 256;
constexpr std::size_t kKeptBytes = std::size_t{64} << 20;

std::uint64_t most_bytes(const Chunk& chunk) {
  const std::uint64_t most = limits().file_bytes;
  return std::min(most, kAlwaysAllowed + kMostRatio * std::min(chunk.stored, most));
}

void check_sum_of(const FileBytes& file, const Chunk& chunk, const std::string& bytes) {
  if (chunk.crc32 == 0) return;
  const std::uint32_t sum = crc32_of(bytes);
  if (sum == chunk.crc32) return;
  refuse(file.path(),
         "broken chunk at byte {}: found checksum {:08x}, expected {:08x}",
         chunk.place,
         sum,
         chunk.crc32);
}

constexpr std::size_t kStep = std::size_t{1} << 18;
/// A chunk's stated size may be wrong; larger ones grow step by step.
constexpr std::size_t kMostReserved = std::size_t{1} << 26;

struct Step {
  std::size_t read = 0;
  std::size_t written = 0;
  bool ended = false;  ///< end of the stream
  bool broken = false;
};

/// Calls `step(input, output)` until the stream ends, breaks or makes no progress.
template <class Decoder>
Decompressed run(std::string_view stored, std::size_t most_bytes, Decoder&& step) {
  Decompressed result;
  std::string part(std::min(kStep, most_bytes + 1), '\0');
  result.bytes.reserve(std::min(most_bytes, kMostReserved) + part.size());
  while (result.bytes.size() <= most_bytes) {
    check_stop();
    const Step done = step(stored, part);
    if (done.broken) return result;
    result.bytes.append(part, 0, done.written);
    stored.remove_prefix(done.read);
    if (done.ended) {
      result.whole = result.bytes.size() <= most_bytes;
      return result;
    }
    if (done.read == 0 && done.written == 0) return result;
  }
  return result;
}

Decompressed from_none(std::string_view stored, std::size_t most_bytes) {
  return {std::string(stored.substr(0, most_bytes)), stored.size() <= most_bytes};
}

Decompressed from_bz2(std::string_view stored, std::size_t most_bytes) {
  bz_stream stream{};
  if (BZ2_bzDecompressInit(&stream, 0, 0) != BZ_OK) return {};
  const std::unique_ptr<bz_stream, int (*)(bz_stream*)> end(&stream, BZ2_bzDecompressEnd);
  return run(stored, most_bytes, [&](std::string_view input, std::string& output) {
    const auto all = static_cast<unsigned>(std::min(input.size(), kStep));
    stream.next_in = const_cast<char*>(input.data());  // bzlib only reads it
    stream.avail_in = all;
    stream.next_out = output.data();
    stream.avail_out = static_cast<unsigned>(output.size());
    const int code = BZ2_bzDecompress(&stream);
    return Step{all - stream.avail_in,
                output.size() - stream.avail_out,
                code == BZ_STREAM_END,
                code != BZ_OK && code != BZ_STREAM_END};
  });
}

Decompressed from_lz4(std::string_view stored, std::size_t most_bytes) {
  LZ4F_dctx* context = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&context, LZ4F_VERSION)) != 0) return {};
  const std::unique_ptr<LZ4F_dctx, LZ4F_errorCode_t (*)(LZ4F_dctx*)> end(
      context, LZ4F_freeDecompressionContext);
  return run(stored, most_bytes, [&](std::string_view input, std::string& output) {
    Step done{input.size(), output.size()};
    const std::size_t hint =
        LZ4F_decompress(context, output.data(), &done.written, input.data(), &done.read, nullptr);
    done.broken = LZ4F_isError(hint) != 0;
    done.ended = hint == 0;
    return done;
  });
}

struct Method {
  const char* name;
  Decompressed (*decompress)(std::string_view stored, std::size_t most_bytes);
};

constexpr std::array<Method, 4> kMethods = {
    {{"none", from_none}, {"bz2", from_bz2}, {"lz4", from_lz4}, {"zstd", from_zstd}}};

[[noreturn]] void fail(const fs::path& path) {
  refuse(path, "cannot be read: {}", std::generic_category().message(errno));
}

}  // namespace

Decompressed from_zstd(std::string_view stored, std::size_t most_bytes) {
  const std::unique_ptr<ZSTD_DStream, std::size_t (*)(ZSTD_DStream*)> stream(ZSTD_createDStream(),
                                                                             ZSTD_freeDStream);
  if (!stream) return {};
  return run(stored, most_bytes, [&](std::string_view input, std::string& output) {
    ZSTD_inBuffer in{input.data(), input.size(), 0};
    ZSTD_outBuffer out{output.data(), output.size(), 0};
    const std::size_t hint = ZSTD_decompressStream(stream.get(), &out, &in);
    return Step{in.pos, out.pos, hint == 0 && in.pos == in.size, ZSTD_isError(hint) != 0};
  });
}

std::uint32_t crc32_of(std::string_view bytes) {
  return static_cast<std::uint32_t>(
      crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

std::uint32_t ChunkReader::add(const Chunk& chunk) {
  chunks_.push_back(chunk);
  return static_cast<std::uint32_t>(chunks_.size() - 1);
}

Decompressed ChunkReader::contents(std::uint32_t number) const {
  const Chunk& chunk = chunks_[number];
  const std::string stored = file_->read(chunk.place, std::min(chunk.stored, limits().file_bytes));
  Decompressed result =
      kMethods[static_cast<std::size_t>(chunk.compression)].decompress(stored, most_bytes(chunk));
  result.whole = result.whole && stored.size() == chunk.stored;
  spend_expanded(file_->path(), file_->size(), result.bytes.size());
  if (result.whole) check_sum_of(*file_, chunk, result.bytes);
  return result;
}

std::shared_ptr<const std::string> ChunkReader::cached(std::uint32_t number) const {
  const std::scoped_lock lock(mutex_);  // held while decompressing: others wait for the same chunk
  const auto found = std::ranges::find(recent_, number, &CachedChunk::first);
  if (found != recent_.end()) {
    recent_.splice(recent_.begin(), recent_, found);
    return found->second;
  }
  Decompressed made = contents(number);
  const Chunk& chunk = chunks_[number];
  if (!made.whole && !chunk.truncated)
    refuse(file_->path(), "broken chunk at byte {}, expected {} bytes", chunk.place, chunk.size);
  recent_.emplace_front(number, std::make_shared<const std::string>(std::move(made.bytes)));
  std::size_t bytes = 0;
  for (auto i = recent_.begin(); i != recent_.end(); ++i) {
    bytes += i->second->size();
    if (bytes <= kKeptBytes || i == recent_.begin()) continue;
    recent_.erase(i, recent_.end());
    break;
  }
  return recent_.front().second;
}

std::string ChunkReader::read(std::uint32_t number,
                              std::uint64_t place,
                              std::uint64_t count,
                              bool check_sum) const {
  const Chunk& chunk = chunks_[number];
  const bool checked = check_sum && chunk.crc32 != 0 && chunk.stored <= limits().file_bytes;
  if (chunk.compression == Compression::none && !checked) {
    if (place >= chunk.stored) return {};
    return file_->read(chunk.place + place, std::min(count, chunk.stored - place));
  }
  const auto bytes = cached(number);
  return place < bytes->size() ? bytes->substr(place, count) : std::string();
}

std::optional<Compression> compression_named(std::string_view name) {
  if (name.empty()) return Compression::none;  // MCAP
  for (std::size_t i = 0; i < kMethods.size(); ++i)
    if (name == kMethods[i].name) return static_cast<Compression>(i);
  return std::nullopt;
}

// O_NONBLOCK avoids waiting for the writer of a pipe.
FileBytes::FileBytes(const fs::path& path, const fs::path& content)
    : path_(path), descriptor_(open(content.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {
  if (descriptor_ < 0) fail(path);
  struct stat about {};
  const bool known = fstat(descriptor_, &about) == 0;
  if (known && S_ISREG(about.st_mode)) {
    size_ = static_cast<std::uint64_t>(about.st_size);
    // Opening skips from message to message; readahead would be wasted.
    posix_fadvise(descriptor_, 0, 0, POSIX_FADV_RANDOM);
    return;
  }
  close(descriptor_);
  if (!known) fail(path);
  refuse(path, "not a regular file, expected a bag");
}

FileBytes::~FileBytes() { close(descriptor_); }

std::string FileBytes::read(std::uint64_t place, std::uint64_t count) const {
  if (place >= size_) return {};
  std::string bytes(std::min(count, size_ - place), '\0');
  std::size_t done = 0;
  while (done < bytes.size()) {
    check_stop();
    const ssize_t got = pread(
        descriptor_, bytes.data() + done, bytes.size() - done, static_cast<off_t>(place + done));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) fail(path_);
    if (got == 0) break;  // the file was shortened
    done += static_cast<std::size_t>(got);
  }
  bytes.resize(done);
  return bytes;
}

std::string truncation_note(const FileBytes& file, std::uint64_t place) {
  return fmt::format(
      "the bag is truncated or broken in the record at byte {} of {}: later messages are ignored",
      place,
      file.size());
}

void TopicList::add(std::int64_t id,
                    std::string_view name,
                    std::string_view type,
                    MessageEncoding encoding) {
  if (knows(id)) return;
  std::string of_ros_1(type);
  if (const auto at = of_ros_1.find("/msg/"); at != std::string::npos) of_ros_1.erase(at, 4);
  const auto [found, is_new] =
      by_name_.emplace(std::pair(std::string(name), of_ros_1), static_cast<int>(by_name_.size()));
  if (is_new) bag_.topics.push_back({std::string(name), of_ros_1, encoding});
  by_id_[id] = found->second;
}

void TopicList::add_message(std::int64_t id,
                            std::int64_t recorded_ns,
                            std::uint32_t chunk,
                            std::uint64_t place) {
  const auto found = by_id_.find(id);
  if (found == by_id_.end()) return;
  // Limited so that differences of times do not overflow.
  spend_messages(bag_.file, file_bytes_);
  const std::int64_t time = std::clamp(recorded_ns, std::int64_t{0}, std::int64_t{1} << 61);
  bag_.messages.push_back({found->second, time, chunk, place});
}

void TopicList::finish() {
  std::vector<int> order(bag_.topics.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, {}, [&](int i) { return bag_.topics[i].name; });
  std::vector<int> new_place(order.size());
  std::vector<BagTopic> sorted;
  for (const int old : order) {
    new_place[old] = static_cast<int>(sorted.size());
    sorted.push_back(std::move(bag_.topics[old]));
  }
  bag_.topics = std::move(sorted);
  for (BagMessage& message : bag_.messages) {
    message.topic = new_place[message.topic];
    ++bag_.topics[message.topic].messages;
  }
  std::ranges::sort(bag_.messages, {}, [](const BagMessage& message) {
    return std::pair(message.chunk, message.place);
  });
}

Bag BagOpening::finish(DataPlace (*find_data)(const ChunkReader&, const BagMessage&, bool)) {
  topics.finish();
  bag.read = [chunks = std::shared_ptr<const ChunkReader>(chunks), find_data, file = bag.file](
                 const BagMessage& message, std::uint64_t most_bytes) {
    const bool all = most_bytes == kWholeMessage;
    const auto [begin, size] = find_data(*chunks, message, all);
    std::string bytes;
    if (size > 0) bytes = chunks->read(message.chunk, begin, std::min(size, most_bytes), all);
    if (bytes.empty() || (all && bytes.size() < size))
      refuse(file,
             "incomplete message at byte {} of the chunk at byte {}",
             message.place,
             chunks->chunk(message.chunk).place);
    return bytes;
  };
  return std::move(bag);
}

}  // namespace gpo
