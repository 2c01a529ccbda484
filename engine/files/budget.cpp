// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/files/budget.h"

#include "engine/files/refuse.h"

#include <algorithm>
#include <cmath>

namespace gpo {
namespace {

constexpr std::uint64_t kUnlimited = std::uint64_t{1} << 62;
constexpr std::uint64_t kBytesPerMessage = 16;
constexpr std::uint64_t kMessagesOfSmallBags = 1'000'000;
constexpr std::uint64_t kExpandedPerByte = 64;

struct LimitState {
  Limits limits;
  double factor = 1;
};

LimitState& state() {
  static LimitState of_process;
  return of_process;
}

std::uint64_t raised(std::uint64_t limit) {
  const double product = state().factor * static_cast<double>(limit);
  return product < static_cast<double>(kUnlimited) ? static_cast<std::uint64_t>(product)
                                                   : kUnlimited;
}

struct Spent {
  int budgets = 0;  ///< nested ones
  std::uint64_t items = 0;
  std::uint64_t messages = 0;
  std::uint64_t expanded_bytes = 0;
};

thread_local Spent spent;

/// Returns whether a sum is within its limit. Without a budget, `count` alone is the sum.
bool adds(std::uint64_t& sum, std::uint64_t count, std::uint64_t most) {
  if (spent.budgets == 0) sum = 0;
  sum += std::min(count, kUnlimited - sum);
  return sum <= most;
}

}  // namespace

const Limits& limits() { return state().limits; }

void set_limits(double factor) {
  state() = {Limits{}, factor};
  Limits& all = state().limits;
  for (std::uint64_t* one : {&all.hand_bytes,
                             &all.json_bytes,
                             &all.file_bytes,
                             &all.yaml_values,
                             &all.image_pixels,
                             &all.video_pixels,
                             &all.texels,
                             &all.model_bytes,
                             &all.triangles,
                             &all.items,
                             &all.results,
                             &all.messages,
                             &all.expanded_bytes})
    *one = raised(*one);
}

void refuse_size(const fs::path& place, std::string_view found, std::string_view expected) {
  refuse(place, "found {}, expected {}; --limits allows more", found, expected);
}

Budget::Budget() {
  if (spent.budgets++ == 0) spent = {.budgets = 1};
}

Budget::~Budget() { --spent.budgets; }

void spend_items(const fs::path& file, std::uint64_t count) {
  const std::uint64_t most = limits().items;
  if (adds(spent.items, count, most)) return;
  refuse_size(file, "too many rows or samples", fmt::format("at most {} in all files", most));
}

void spend_messages(const fs::path& file, std::uint64_t file_bytes, std::uint64_t count) {
  const std::uint64_t most =
      std::min(limits().messages, raised(kMessagesOfSmallBags + file_bytes / kBytesPerMessage));
  if (adds(spent.messages, count, most)) return;
  refuse_size(file,
              "too many messages",
              fmt::format("at most {} in a file of {} MiB", most, file_bytes >> 20));
}

void spend_expanded(const fs::path& file, std::uint64_t file_bytes, std::uint64_t bytes) {
  const std::uint64_t most = limits().expanded_bytes + raised(kExpandedPerByte * file_bytes);
  if (adds(spent.expanded_bytes, bytes, most)) return;
  refuse(file,
         "expands to more than {} MiB, which is implausible for its size; --limits allows more",
         most >> 20);
}

}  // namespace gpo
