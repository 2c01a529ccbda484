// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/files/budget.h"

#include "engine/files/refuse.h"

#include <algorithm>
#include <atomic>
#include <ctime>
#include <map>
#include <mutex>
#include <utility>

namespace gpo {
namespace {

constexpr std::uint64_t kUnlimited = std::uint64_t{1} << 62;
constexpr std::uint64_t kBytesPerMessage = 16;
constexpr std::uint64_t kMessagesOfSmallBags = 1'000'000;
constexpr std::uint64_t kExpandedPerByte = 64;
constexpr std::uint64_t kPixelsPerByte = 4000;
constexpr double kSecondsPerByte = 1.0 / (1 << 20);
constexpr unsigned kChecksPerLookAtTheClock = 64;

std::uint64_t raised(std::uint64_t limit, double factor) {
  const double product = factor * static_cast<double>(limit);
  return product < static_cast<double>(kUnlimited) ? static_cast<std::uint64_t>(product)
                                                   : kUnlimited;
}

struct LimitState {
  Limits limits;
  double factor = 1;

  explicit LimitState(double of) : factor(of) {
    for (std::uint64_t* one : {&limits.hand_bytes,
                               &limits.json_bytes,
                               &limits.file_bytes,
                               &limits.yaml_values,
                               &limits.image_pixels,
                               &limits.video_pixels,
                               &limits.texels,
                               &limits.model_bytes,
                               &limits.triangles,
                               &limits.items,
                               &limits.results,
                               &limits.messages,
                               &limits.expanded_bytes,
                               &limits.decoded_pixels,
                               &limits.seconds})
      *one = raised(*one, of);
  }
};

/// Each that was set remains, as another thread may use it.
const LimitState* state_of(double factor) {
  static std::mutex mutex;
  static std::map<double, LimitState> all;
  const std::scoped_lock lock(mutex);
  return &all.try_emplace(factor, factor).first->second;
}

std::atomic<const LimitState*>& current() {
  static std::atomic<const LimitState*> of_process = state_of(1);
  return of_process;
}

const LimitState& state() { return *current(); }

std::uint64_t raised(std::uint64_t limit) { return raised(limit, state().factor); }

struct Spent {
  int budgets = 0;  ///< nested ones
  std::uint64_t items = 0;
  std::uint64_t messages = 0;
  std::uint64_t expanded_bytes = 0;
  std::uint64_t pixels = 0;
  fs::path input = {};  ///< the last one
  double (*clock)() = nullptr;
  double end_s = 0;
  unsigned checks = 0;
  std::set<fs::path> files = {};
  int examinations = 0;
};

thread_local Spent spent;

/// Returns whether a sum is within its limit. Without a budget, `count` alone is the sum.
bool adds(std::uint64_t& sum, std::uint64_t count, std::uint64_t most) {
  if (spent.budgets == 0) sum = 0;
  sum += std::min(count, kUnlimited - sum);
  return sum <= most;
}

double allowed_seconds(const fs::path& input) {
  std::error_code error;
  const auto bytes = fs::is_regular_file(input, error) ? fs::file_size(input, error) : 0;
  return error ? 0 : state().factor * kSecondsPerByte * static_cast<double>(bytes);
}

/// Other threads have no budget: they only help the one that opens.
void check_time() {
  if (spent.budgets == 0 || ++spent.checks % kChecksPerLookAtTheClock != 0) return;
  if (spent.clock() <= spent.end_s) return;
  refuse(
      spent.input,
      "opening it takes more processor time than is plausible for its size; --limits allows more");
}

}  // namespace

const Limits& limits() { return state().limits; }

void set_limits(double factor) { current() = state_of(factor); }

void refuse_size(const fs::path& place, std::string_view found, std::string_view expected) {
  refuse(place, "found {}, expected {}; --limits allows more", found, expected);
}

double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

Budget::Budget(const fs::path& input, double (*seconds)()) {
  if (spent.budgets++ == 0) {
    spent = {.budgets = 1, .clock = seconds};
    spent.end_s = seconds() + static_cast<double>(limits().seconds);
    const StopWatch* outer = current_watch();
    if (outer != nullptr) watch_.stop = outer->stop;
    watch_.at_check = [outer] {
      if (outer != nullptr && outer->at_check) outer->at_check();
      check_time();
    };
    scope_.emplace(&watch_);
  }
  outer_input_ = std::exchange(spent.input, input);
  spent.end_s += allowed_seconds(input);
}

Budget::~Budget() {
  --spent.budgets;
  spent.input = outer_input_;
}

std::set<fs::path> Budget::files() { return spent.files; }

void note_read(const fs::path& file) {
  if (spent.budgets > 0 && spent.examinations == 0) spent.files.insert(file);
}

Examination::Examination() { ++spent.examinations; }
Examination::~Examination() { --spent.examinations; }

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

void spend_pixels(const fs::path& file, std::uint64_t file_bytes, std::uint64_t pixels) {
  if (adds(spent.pixels, pixels, limits().decoded_pixels + raised(kPixelsPerByte * file_bytes)))
    return;
  refuse_size(file, "too many frames to decode for its size", "one that states their times");
}

}  // namespace gpo
