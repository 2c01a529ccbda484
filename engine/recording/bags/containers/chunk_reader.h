// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace gpo {

/// A file of which parts are read, by several threads at once.
class FileBytes {
 public:
  /// Throws InputError where it cannot be read, or is no regular file.
  explicit FileBytes(const std::filesystem::path& path);
  ~FileBytes();
  FileBytes(const FileBytes&) = delete;
  FileBytes& operator=(const FileBytes&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::uint64_t size() const { return size_; }
  /// So many bytes, fewer where the file ends before. Throws InputError.
  std::string read(std::uint64_t place, std::uint64_t count) const;

 private:
  std::filesystem::path path_;
  int descriptor_;
  std::uint64_t size_ = 0;
};

/// What people are told of a file that is read up to a place only.
std::string cut_note(const FileBytes& file, std::uint64_t place);

/// How the chunks of bags are compressed.
enum class Compression { none, bz2, lz4, zstd };

/// By the name that bags have for it; nothing for others.
std::optional<Compression> compression_named(std::string_view name);

struct Decompressed {
  std::string bytes;   ///< up to where the stored ones are cut or broken
  bool whole = false;  ///< to their end
};

/// Stops where there is more than `most_bytes`: few bytes can stand for very many.
Decompressed decompress(std::string_view stored, Compression compression, std::size_t most_bytes);

/// A stretch of a bag in which messages lie.
struct Chunk {
  std::uint64_t place = 0;   ///< in the file
  std::uint64_t stored = 0;  ///< bytes there
  std::uint64_t size = 0;    ///< bytes when decompressed, as the file says
  Compression compression = Compression::none;
  std::uint32_t crc32 = 0;  ///< of the decompressed bytes; 0: nobody says
  bool cut = false;         ///< what there is of it is read
};

/// Reads parts of a bag's chunks. Of compressed ones the last few are kept, so that messages that
/// lie beside each other cost one decompression. Safe to share between threads.
class ChunkReader {
 public:
  explicit ChunkReader(std::shared_ptr<const FileBytes> file) : file_(std::move(file)) {}

  std::uint32_t add(const Chunk& chunk);
  const Chunk& chunk(std::uint32_t number) const { return chunks_[number]; }
  std::size_t count() const { return chunks_.size(); }
  void clear() { chunks_.clear(); }

  /// So many bytes, fewer where the chunk ends before. With `check_sum` also the sum of an
  /// uncompressed chunk is compared, for which all of it must be read. Throws InputError: a
  /// compressed chunk that is broken, another sum.
  std::string read(std::uint32_t chunk,
                   std::uint64_t place,
                   std::uint64_t count,
                   bool check_sum = false) const;
  /// All of one that may be cut or broken, up to there, without keeping it. Throws InputError where
  /// it is whole but has another sum.
  Decompressed contents(std::uint32_t chunk) const;
  /// Throws the InputError of a message that does not lie there as a whole.
  [[noreturn]] void fail_message(std::uint32_t chunk, std::uint64_t place) const;
  /// From now on it may be cut.
  void allow_cut(std::uint32_t chunk) { chunks_[chunk].cut = true; }

 private:
  using Cached = std::pair<std::uint32_t, std::shared_ptr<const std::string>>;

  std::shared_ptr<const std::string> kept(std::uint32_t chunk) const;

  std::shared_ptr<const FileBytes> file_;
  std::vector<Chunk> chunks_;
  mutable std::mutex mutex_;
  mutable std::list<Cached> recent_;  ///< most recently used first
};

}  // namespace gpo
