// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace gpo {

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

}  // namespace gpo
