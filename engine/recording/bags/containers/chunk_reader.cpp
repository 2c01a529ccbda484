// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/bags/containers/chunk_reader.h"

#include "engine/base/error.h"

#include <algorithm>

#include <fmt/format.h>
#include <zlib.h>

namespace gpo {
namespace {

constexpr std::uint64_t kMostChunkBytes = std::uint64_t{256} << 20;
/// A black picture compresses to next to nothing, a hostile file to less.
constexpr std::uint64_t kAlwaysAllowed = std::uint64_t{32} << 20;
constexpr std::uint64_t kMostRatio = 256;
constexpr std::size_t kKeptBytes = std::size_t{64} << 20;

std::uint64_t most_bytes(const Chunk& chunk) {
  const std::uint64_t stored = std::min(chunk.stored, kMostChunkBytes);
  return std::min(kMostChunkBytes, kAlwaysAllowed + kMostRatio * stored);
}

void check_sum_of(const FileBytes& file, const Chunk& chunk, const std::string& bytes) {
  if (chunk.crc32 == 0) return;
  const auto sum = crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
  if (sum == chunk.crc32) return;
  throw InputError(
      fmt::format("{}: found a broken chunk at byte {}: its sum is {:08x}, expected {:08x}",
                  file.path().string(),
                  chunk.place,
                  sum,
                  chunk.crc32));
}

}  // namespace

std::uint32_t ChunkReader::add(const Chunk& chunk) {
  chunks_.push_back(chunk);
  return static_cast<std::uint32_t>(chunks_.size() - 1);
}

Decompressed ChunkReader::contents(std::uint32_t number) const {
  const Chunk& chunk = chunks_[number];
  const std::string stored = file_->read(chunk.place, std::min(chunk.stored, kMostChunkBytes));
  Decompressed result = decompress(stored, chunk.compression, most_bytes(chunk));
  result.whole = result.whole && stored.size() == chunk.stored;
  if (result.whole) check_sum_of(*file_, chunk, result.bytes);
  return result;
}

std::shared_ptr<const std::string> ChunkReader::kept(std::uint32_t number) const {
  const std::scoped_lock lock(mutex_);  // also while it decompresses: others want the same one
  const auto found = std::ranges::find(recent_, number, &Kept::first);
  if (found != recent_.end()) {
    recent_.splice(recent_.begin(), recent_, found);
    return found->second;
  }
  Decompressed made = contents(number);
  const Chunk& chunk = chunks_[number];
  if (!made.whole && !chunk.cut) {
    throw InputError(fmt::format("{}: found a broken chunk at byte {}, expected one of {} bytes",
                                 file_->path().string(),
                                 chunk.place,
                                 chunk.size));
  }
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

void ChunkReader::fail_message(std::uint32_t number, std::uint64_t place) const {
  throw InputError(fmt::format("{}: found no whole message at byte {} of the chunk at {}",
                               file_->path().string(),
                               place,
                               chunks_[number].place));
}

std::string ChunkReader::read(std::uint32_t number,
                              std::uint64_t place,
                              std::uint64_t count,
                              bool check_sum) const {
  const Chunk& chunk = chunks_[number];
  const bool checked = check_sum && chunk.crc32 != 0 && chunk.stored <= kMostChunkBytes;
  if (chunk.compression == Compression::none && !checked) {
    if (place >= chunk.stored) return {};
    return file_->read(chunk.place + place, std::min(count, chunk.stored - place));
  }
  const auto bytes = kept(number);
  return place < bytes->size() ? bytes->substr(place, count) : std::string();
}

}  // namespace gpo
