// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/images/frame_faults.h"

#include "engine/base/error.h"
#include "engine/geometry/statistics.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <system_error>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <opencv2/imgproc.hpp>

namespace gpo {
namespace {

constexpr std::size_t kMostScanned = 400;
constexpr int kLeastFrames = 8;

double difference(const cv::Mat& a, const cv::Mat& b) {
  return cv::norm(a, b, cv::NORM_L1) / static_cast<double>(a.total());
}

/// Marks runs of frames that equal the one before, between frames that differ as usual. A run at
/// the beginning or end may be a camera at rest, unless it is as short as others.
void mark_repeats(std::span<const double> steps, std::vector<FrameFault>& faults) {
  constexpr double kMoving = 0.4;  // gray levels between successive frames
  constexpr double kAlike = 0.06;  // share of the usual difference
  constexpr double kBeside = 0.3;
  std::vector<double> moving;
  for (std::size_t i = 0; i < steps.size(); ++i)
    if (steps[i] > kMoving && faults[i] == FrameFault::none && faults[i + 1] == FrameFault::none)
      moving.push_back(steps[i]);
  if (moving.size() < 3) return;
  const double usual = median(moving);
  constexpr int kSeveral = 3;
  const int count = static_cast<int>(steps.size());  // steps[i]: from frame i to i + 1
  std::vector<std::pair<int, int>> runs;
  for (int i = 0; i < count; ++i) {
    if (steps[i] > kAlike * usual) continue;
    int end = i;
    while (end < count && steps[end] <= kAlike * usual) ++end;
    const bool moves_before = i == 0 || steps[i - 1] > kBeside * usual;
    const bool moves_after = end == count || steps[end] > kBeside * usual;
    if (moves_before && moves_after) runs.emplace_back(i, end);
    i = end;
  }
  int between = 0, longest = 0;
  const auto is_between = [&](int begin, int end) { return begin > 0 && end < count; };
  for (const auto& [begin, end] : runs) {
    if (!is_between(begin, end)) continue;
    ++between;
    longest = std::max(longest, end - begin);
  }
  for (const auto& [begin, end] : runs)
    if (is_between(begin, end) || (between >= kSeveral && end - begin <= longest))
      for (int k = begin; k < end; ++k) faults[k + 1] = FrameFault::repeated;
}

void mark_black_and_flashes(std::span<const cv::Mat> thumbnails, std::vector<FrameFault>& faults) {
  constexpr double kBlack = 20, kLit = 40, kFlash = 40, kAgree = 15;  // gray levels
  std::vector<double> means, spreads;
  for (const cv::Mat& image : thumbnails) {
    cv::Scalar mean, spread;
    cv::meanStdDev(image, mean, spread);
    means.push_back(mean[0]);
    spreads.push_back(spread[0]);
  }
  const bool is_lit = median(means) > kLit;
  for (std::size_t i = 0; i < means.size(); ++i)
    if (is_lit && means[i] < kBlack && spreads[i] < kBlack / 4) faults[i] = FrameFault::black;
  for (std::size_t i = 1; i + 1 < means.size(); ++i) {
    if (faults[i] != FrameFault::none || std::abs(means[i - 1] - means[i + 1]) > kAgree) continue;
    if (std::abs(means[i] - (means[i - 1] + means[i + 1]) / 2) > kFlash)
      faults[i] = FrameFault::flash;
  }
}

/// Returns whether sizes of image files hint at equal or empty images.
bool may_have_faults(std::span<const fs::path> files) {
  constexpr double kSmall = 0.4;  // share of the median
  std::vector<double> sizes;
  std::error_code none;
  for (const fs::path& file : files)
    sizes.push_back(static_cast<double>(fs::file_size(file, none)));
  const double usual = median(sizes);
  for (std::size_t i = 0; i < sizes.size(); ++i)
    if (sizes[i] < kSmall * usual || (i > 0 && sizes[i] == sizes[i - 1])) return true;
  return false;
}

std::vector<cv::Mat> thumbnails_of(const FrameCache& images, int first, int count) {
  std::vector<cv::Mat> thumbnails(count);
  std::vector<int> frames(count);
  std::iota(frames.begin(), frames.end(), first);
  for_each_image(images, frames, {}, [&](int frame, const cv::Mat& gray) {
    thumbnails[frame - first] = thumbnail_of(gray);
  });
  return thumbnails;
}

std::string numbers_of(std::span<const FrameFault> faults, FrameFault fault, int first) {
  constexpr std::size_t kShown = 6;
  std::vector<int> numbers;
  for (std::size_t i = 0; i < faults.size(); ++i)
    if (faults[i] == fault) numbers.push_back(first + static_cast<int>(i));
  const std::size_t count = numbers.size();
  numbers.resize(std::min(count, kShown));
  return fmt::format("{} ({}{})", count, fmt::join(numbers, ", "), count > kShown ? ", ..." : "");
}

template <class Value>
void keep_only(std::span<const int> kept, std::vector<Value>& values, std::size_t all) {
  if (values.size() != all) return;
  std::vector<Value> remaining;
  for (const int i : kept) remaining.push_back(values[i]);
  values = std::move(remaining);
}

}  // namespace

std::vector<FrameFault> faults_of(std::span<const cv::Mat> thumbnails) {
  std::vector<FrameFault> faults(thumbnails.size(), FrameFault::none);
  if (thumbnails.size() < kLeastFrames) return faults;
  std::vector<double> steps;
  for (std::size_t i = 1; i < thumbnails.size(); ++i)
    steps.push_back(difference(thumbnails[i - 1], thumbnails[i]));
  mark_black_and_flashes(thumbnails, faults);
  mark_repeats(steps, faults);
  return faults;
}

cv::Mat thumbnail_of(const cv::Mat& gray) {
  cv::Mat small;
  cv::resize(gray, small, {64, 48}, 0, 0, cv::INTER_AREA);
  return small;
}

std::string text_of(std::span<const FrameFault> faults, int first) {
  constexpr std::pair<FrameFault, const char*> kKinds[] = {
      {FrameFault::repeated, "repeat the image before"},
      {FrameFault::black, "are black"},
      {FrameFault::flash, "are far brighter or darker than their neighbors"}};
  std::vector<std::string> parts;
  for (const auto& [fault, meaning] : kKinds)
    if (std::ranges::count(faults, fault) > 0)
      parts.push_back(fmt::format("{} {}", numbers_of(faults, fault, first), meaning));
  return fmt::format("{}", fmt::join(parts, ", "));
}

bool is_searched_whole(const Recording& recording) {
  return recording.timestamps_ns.size() <= kMostScanned;
}

void leave_out_faulty_frames(Recording& recording, const SearchedFrames& searched) {
  const std::size_t all = recording.timestamps_ns.size();
  if (!recording.images || !recording.tracks.empty() || all == 0) return;
  const bool whole = is_searched_whole(recording);
  const std::size_t first = whole ? 0 : std::min<std::size_t>(std::max(searched.first, 0), all - 1);
  const std::size_t count =
      whole ? all : std::min<std::size_t>(std::max(searched.count, 0), all - first);
  std::vector<FrameFault> faults(all, FrameFault::none);
  try {
    const auto& files = recording.image_files;
    if (files.size() == all && !may_have_faults(std::span(files).subspan(first, count))) return;
    std::ranges::copy(faults_of(thumbnails_of(
                          *recording.images, static_cast<int>(first), static_cast<int>(count))),
                      faults.begin() + static_cast<std::ptrdiff_t>(first));
  } catch (const InputError&) {
    return;  // a window that contains the broken image reports it
  }
  std::vector<int> kept;
  for (std::size_t i = 0; i < all; ++i)
    if (faults[i] == FrameFault::none) kept.push_back(static_cast<int>(i));
  if (kept.size() == all || kept.size() < 2) return;
  recording.notes.push_back(
      fmt::format("{} of {} frames are left out: {}", all - kept.size(), all, text_of(faults)));
  keep_only(kept, recording.timestamps_ns, all);
  keep_only(kept, recording.image_files, all);
  if (recording.truth) keep_only(kept, recording.truth->poses, all);
  // The cache below it keeps the images.
  recording.images = std::make_shared<const FrameCache>(
      static_cast<int>(kept.size()),
      [images = recording.images, kept](int index) { return images->bgr(kept[index]); },
      0);
}

}  // namespace gpo
