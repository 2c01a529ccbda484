// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/results/found_frames.h"

#include "engine/base/error.h"
#include "engine/files/text_file.h"
#include "engine/window/timestamps.h"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

namespace gpo {
namespace {

using Index = std::ptrdiff_t;
using MaybeIndex = std::optional<Index>;

/// Within half a frame.
MaybeIndex nearest(const std::vector<std::int64_t>& times_ns,
                   std::int64_t time_ns,
                   std::int64_t most_ns) {
  const auto after = std::ranges::lower_bound(times_ns, time_ns);
  MaybeIndex best;
  std::int64_t least = most_ns;
  for (Index i = after - times_ns.begin() - 1; i <= after - times_ns.begin(); ++i) {
    if (i < 0 || i >= std::ssize(times_ns)) continue;
    const std::int64_t off = std::abs(times_ns[i] - time_ns);
    if (off > least) continue;
    least = off;
    best = i;
  }
  return best;
}

std::vector<MaybeIndex> found_by_time(const ResultPoses& result, const Window& window) {
  const std::int64_t most_ns = median_period_ns(window.timestamps_ns) / 2;
  std::vector<MaybeIndex> found;
  for (const std::int64_t time : window.timestamps_ns)
    found.push_back(nearest(result.timestamps_ns, time, most_ns));
  return found;
}

std::vector<MaybeIndex> found_by_number(const ResultPoses& result, const Window& window) {
  std::vector<MaybeIndex> found;
  for (int i = 0; i < window.frame_count(); ++i) {
    const Index number = window.start + i;
    found.push_back(number < std::ssize(result.poses) ? MaybeIndex(number) : std::nullopt);
  }
  return found;
}

std::string_view file_name(std::string_view path) {
  return path.substr(path.find_last_of('/') + 1);  // npos + 1 is 0
}

/// How much of the ends of two paths is the same, in characters.
std::size_t same_end(std::string_view a, std::string_view b) {
  const auto [at, none] = std::ranges::mismatch(a.rbegin(), a.rend(), b.rbegin(), b.rend());
  return static_cast<std::size_t>(at - a.rbegin());
}

/// Of several pictures of the same name, in folders of their own, the one whose path is the
/// frame's.
MaybeIndex of_name(const ResultPoses& result, const std::string& path) {
  MaybeIndex best;
  bool sure = true;
  std::size_t most = 0;
  for (Index i = 0; i < std::ssize(result.names); ++i) {
    if (file_name(result.names[i]) != file_name(path)) continue;
    const std::size_t same = same_end(result.names[i], path);
    if (best && same == most) sure = false;
    if (best && same <= most) continue;
    sure = true;
    best = i;
    most = same;
  }
  if (!sure)
    throw InputError(
        fmt::format("two of its pictures are named {}, and neither's folder is this recording's",
                    file_name(path)));
  return best;
}

/// The time stamp [ns] that a picture's name is.
std::optional<std::int64_t> time_in_name(std::string_view name) {
  name = file_name(name);
  const auto time = parse_integer(name.substr(0, name.find_last_of('.')));
  return time && *time >= 0 && *time < INT64_MAX / 2 ? time : std::nullopt;
}

MaybeIndex of_time_in_name(const ResultPoses& result, std::int64_t time_ns, std::int64_t most_ns) {
  MaybeIndex best;
  std::int64_t least = most_ns;
  for (Index i = 0; i < std::ssize(result.names); ++i) {
    const auto time = time_in_name(result.names[i]);
    if (!time || std::abs(*time - time_ns) > least) continue;
    least = std::abs(*time - time_ns);
    best = i;
  }
  return best;
}

std::vector<MaybeIndex> found_by_name(const ResultPoses& result,
                                      const Window& window,
                                      const Sources& sources) {
  const bool named = std::ssize(sources.pictures) == window.frame_count();
  const std::int64_t most_ns = median_period_ns(window.timestamps_ns) / 2;
  std::vector<MaybeIndex> found;
  for (int i = 0; i < window.frame_count(); ++i) {
    MaybeIndex one;
    if (named) one = of_name(result, sources.pictures[i].generic_string());
    if (!one) one = of_time_in_name(result, window.timestamps_ns[i], most_ns);
    found.push_back(one);
  }
  return found;
}

}  // namespace

std::vector<std::optional<Pose>> found_cameras(const ResultPoses& result,
                                               PosedFrame frame,
                                               const Window& window,
                                               const Sources& sources) {
  if (frame == PosedFrame::body && !sources.T_body_camera)
    throw InputError(
        "its poses are taken as the body's, and the recording does not say where the camera is on "
        "it "
        "(T_BS); ,frame=camera says that they are the camera's");
  const Pose T_posed_camera = frame == PosedFrame::body ? *sources.T_body_camera : Pose{};
  const auto found = result.by == FoundBy::time     ? found_by_time(result, window)
                     : result.by == FoundBy::number ? found_by_number(result, window)
                                                    : found_by_name(result, window, sources);
  std::vector<std::optional<Pose>> cameras;
  cameras.reserve(found.size());
  for (const MaybeIndex& index : found)
    cameras.push_back(index ? std::optional(result.poses[*index] * T_posed_camera) : std::nullopt);
  return cameras;
}

}  // namespace gpo
