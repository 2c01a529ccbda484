// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/stop.h"
#include "engine/files/paths.h"

#include <cstdint>
#include <optional>
#include <set>
#include <string_view>

namespace gpo {

/// Limits for inputs, so that a small or damaged file cannot exhaust the memory. Files and images
/// within them are read as a whole; the levels of nested lists are limited elsewhere, since deeper
/// ones overflow the stack.
struct Limits {
  // For each file.
  std::uint64_t hand_bytes = std::uint64_t{1} << 20;    ///< configurations, scripts
  std::uint64_t json_bytes = std::uint64_t{16} << 20;   ///< sessions, definitions of experiments
  std::uint64_t file_bytes = std::uint64_t{256} << 20;  ///< tables, images, chunks of bags
  std::uint64_t yaml_values = 100'000;                  ///< after aliases are expanded
  std::uint64_t image_pixels = 64'000'000;
  std::uint64_t video_pixels = 100'000'000;  ///< one frame
  std::uint64_t texels = 160'000'000;        ///< about 0.5 GB, and twice that while painted
  std::uint64_t model_bytes = std::uint64_t{64} << 20;  ///< a 3-D model
  std::uint64_t triangles = 200'000;  ///< sorting and projecting more takes too long
  // For one input with all its files, see `Budget`.
  std::uint64_t items = 8'000'000;                         ///< rows, samples, frames
  std::uint64_t results = 500'000;                         ///< rows of `evaluate`, which are long
  std::uint64_t messages = 64'000'000;                     ///< in a bag; fewer in small bags
  std::uint64_t expanded_bytes = std::uint64_t{64} << 20;  ///< plus 64 times the bytes of the file
  std::uint64_t decoded_pixels = 20'000'000'000;           ///< plus 4000 for each byte of the video
  std::uint64_t seconds = 120;                             ///< processor time; 1 more for each MiB
};

/// Returns the processor time of this thread [s].
double processor_seconds();

/// Returns the limits of this process. Thread-safe.
const Limits& limits();
/// Multiplies the usual limits by a factor of at least 1; infinity: none. Applies to all that is
/// opened or decoded from now on. Thread-safe.
void set_limits(double factor);

/// Throws InputError "PLACE: found FOUND, expected EXPECTED; --limits allows more".
[[noreturn]] void refuse_size(const fs::path& place,
                              std::string_view found,
                              std::string_view expected);

/// Sums what an input with all its files costs, on the thread that opens it and while this lives.
/// A budget within another one adds to the outer one. Waiting for a disk or a network costs
/// nothing: it shows its progress and can be stopped.
class Budget {
 public:
  /// The size of `input` allows more time, if it is a file. From then on `check_stop` throws
  /// InputError when the time is over.
  explicit Budget(const fs::path& input, double (*seconds)() = processor_seconds);
  ~Budget();
  Budget(const Budget&) = delete;
  Budget& operator=(const Budget&) = delete;

  /// Returns the files that `read_file` has read in this thread since the outermost budget began.
  static std::set<fs::path> files();

 private:
  fs::path outer_input_;
  StopWatch watch_;
  std::optional<StopScope> scope_;  ///< set in the outermost budget
};

/// Adds to `Budget::files`.
void note_read(const fs::path& file);

/// While it exists, files read in this thread are not added to `Budget::files`: it is only found
/// out what they are.
class Examination {
 public:
  Examination();
  ~Examination();
  Examination(const Examination&) = delete;
  Examination& operator=(const Examination&) = delete;
};

// Each adds to the thread's budget, if there is one. Throws InputError past the limit.
void spend_items(const fs::path& file, std::uint64_t count = 1);
/// At most 1 million messages plus one for each 16 bytes of the file.
void spend_messages(const fs::path& file, std::uint64_t file_bytes, std::uint64_t count = 1);
/// Bytes that are decompressed while a file of `file_bytes` is opened.
void spend_expanded(const fs::path& file, std::uint64_t file_bytes, std::uint64_t bytes);
/// Pixels of frames that are decoded while a video of `file_bytes` is opened.
void spend_pixels(const fs::path& file, std::uint64_t file_bytes, std::uint64_t pixels);

}  // namespace gpo
