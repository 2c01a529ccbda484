// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/error.h"
#include "engine/files/text_file.h"
#include "engine/recording/images/images.h"
#include "engine/window/timestamps.h"

#include <algorithm>
#include <cctype>
#include <chrono>
#include <cmath>
#include <limits>
#include <regex>
#include <set>

#include <fmt/ranges.h>

namespace gpo {
namespace {

using Words = std::vector<std::string>;

bool is_digit_char(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

/// Returns the letters of a name, in lower case, and its numbers apart.
struct NameParts {
  Words words;                       ///< "frame", "color"
  std::vector<std::string> numbers;  ///< "000012"
  std::string pattern;               ///< "frame-#.color.png"
};

NameParts parts_of(const fs::path& file) {
  NameParts parts;
  std::string word, number;
  const std::string name = lower_case(file.filename().string());
  for (const char c : name + " ") {
    const bool digit = is_digit_char(c);
    if (!digit && !number.empty()) {
      parts.numbers.push_back(std::exchange(number, ""));
      parts.pattern += '#';
    }
    if (digit) number += c;
    if (!digit && c != ' ') parts.pattern += c;
    if (std::isalpha(static_cast<unsigned char>(c)) != 0) {
      word += c;
    } else if (!word.empty()) {
      parts.words.push_back(std::exchange(word, ""));
    }
  }
  return parts;
}

const Words kDepth = split("depth,depths,disp,disparity,range", ',');
const Words kDerived = split(
    "mask,masks,normal,normals,semantic,semantics,label,labels,seg,instance,conf,confidence", ',');
const Words kSecond = split("right,r,ir,infra,infrared,thermal", ',');

enum class Rank { camera, second, derived, depth };

bool has_any(const Words& words, const Words& of) {
  return std::ranges::any_of(words,
                             [&](const auto& word) { return std::ranges::count(of, word) > 0; });
}

Rank rank_of(const Words& words) {
  if (has_any(words, kDepth)) return Rank::depth;
  if (has_any(words, kDerived)) return Rank::derived;
  return has_any(words, kSecond) ? Rank::second : Rank::camera;
}

const char* reason_of(Rank rank) {
  if (rank == Rank::depth) return "depth, by its name";
  return rank == Rank::derived ? "no images of a camera, by its name" : "another sequence";
}

FoundFile other_sequence(const std::vector<fs::path>& files, Rank rank) {
  return {files.front(),
          "",
          fmt::format("{}: {}", counted(files.size(), "image"), reason_of(rank)),
          files};
}

/// Returns the unreadable images whose names have the rank of those that are read.
std::vector<FoundFile> unreadable_among(const std::vector<fs::path>& read, const fs::path& folder) {
  if (read.empty()) return {};
  std::vector<FoundFile> found = unreadable_images(folder);
  const Rank rank = rank_of(parts_of(read.front()).words);
  std::erase_if(found, [&](const auto& one) { return rank_of(parts_of(one.file).words) != rank; });
  return found;
}

/// Splits by the text around the numbers; sequences with the same numbers are different ones.
ImageSequence sequence_in(const fs::path& folder) {
  ImageSequence found;
  std::map<std::string, std::vector<fs::path>> groups;
  std::map<std::string, std::set<std::string>> numbers;
  for (const fs::path& file : numbered_images(folder)) {
    const NameParts parts = parts_of(file);
    groups[parts.pattern].push_back(file);
    if (!parts.numbers.empty()) numbers[parts.pattern].insert(parts.numbers.front());
  }
  std::vector<std::tuple<Rank, std::ptrdiff_t, std::string>> order;  // longest first within a rank
  for (const auto& [pattern, files] : groups)
    order.emplace_back(rank_of(parts_of(files.front()).words), -std::ssize(files), pattern);
  std::ranges::sort(order);
  std::set<std::string> taken;
  for (const auto& [rank, count, pattern] : order) {
    const auto& files = groups[pattern];
    const auto twice = [&](const std::string& number) { return taken.contains(number); };
    const bool same = std::ranges::any_of(numbers[pattern], twice);
    if (rank == Rank::depth || same || (rank != Rank::camera && !found.files.empty())) {
      auto& others = rank == Rank::camera ? found.left_out : found.others;
      others.push_back(other_sequence(files, rank));
      continue;
    }
    found.files.insert(found.files.end(), files.begin(), files.end());
    taken.insert(numbers[pattern].begin(), numbers[pattern].end());
  }
  if (order.size() > 1) {
    const std::set<fs::path> kept(found.files.begin(), found.files.end());
    found.files = numbered_images(folder);  // in the order of the numbers
    std::erase_if(found.files, [&](const fs::path& file) { return !kept.contains(file); });
  }
  const auto unreadable = unreadable_among(found.files, folder);
  found.left_out.insert(found.left_out.end(), unreadable.begin(), unreadable.end());
  return found;
}

/// Returns the subfolders of a folder that may have the images.
Words usual_subfolders(const fs::path& folder) {
  Words names = {"images", "frames", "rgb", "data"};
  const auto is_recording = [](const fs::path& file) {
    return is_bag_name(file) || file.filename() == "tracks.csv";
  };
  if (!files_of_kind(folder, is_recording).empty()) return names;
  const Words of_data_sets = {
      "color", "image_0", "image_2", "image_left", "left", "image_00/data", "image_02/data"};
  names.insert(names.end(), of_data_sets.begin(), of_data_sets.end());
  if (is_file(folder / "traj.txt")) names.emplace_back("results");
  return names;
}

/// A time in the name of a file.
struct NamedTime {
  std::int64_t whole = 0;
  std::string decimals;  ///< digits behind the decimal point; empty: a whole number
  bool pair = false;     ///< "SEC_NSEC"
  bool clock = false;    ///< hours, minutes and seconds
  std::string before;    ///< the name up to the time
};

/// Reads a date with hours, minutes and seconds ("20240131_120059933", "2024-01-31_12-00-59.933");
/// without a date these need separators and decimals ("12_00_59.933000").
std::optional<NamedTime> clock_time(const std::string& stem) {
  static const std::regex kForm(
      R"((?:.*?\D)??(?:((?:19|20)\d\d)([-_.]?)(\d\d)\2(\d\d)[-_T. ]{0,3})?)"
      R"((\d\d)([-_.:]?)(\d\d)\6(\d\d)(?:([-_.,]?)(\d+))?\D*)");
  std::smatch parts;
  if (!std::regex_match(stem, parts, kForm)) return std::nullopt;
  const bool dated = parts[1].matched;
  const bool point = parts[9] == "." || parts[9] == ",";
  if (parts.length(10) % 3 != 0 && !(dated && point)) return std::nullopt;
  if (!dated && (parts.length(6) == 0 || parts.length(9) == 0)) return std::nullopt;
  const auto number = [&](int part) {
    return static_cast<int>(parse_integer(parts[part].str()).value_or(0));
  };
  constexpr int kHours = 24, kMinutes = 60, kSeconds = 60;
  if (number(5) >= kHours || number(7) >= kMinutes || number(8) >= kSeconds) return std::nullopt;
  std::chrono::sys_days day{};
  if (dated) {
    const auto date = std::chrono::year(number(1)) / number(3) / number(4);
    if (!date.ok()) return std::nullopt;
    day = date;
  }
  const auto time = day + std::chrono::hours(number(5)) + std::chrono::minutes(number(7)) +
                    std::chrono::seconds(number(8));
  std::string decimals = parts[10];
  decimals.resize(9, '0');
  return NamedTime{time.time_since_epoch().count(), decimals, false, true, ""};
}

/// Reads a clock's time, the last number of a name, or its last two as "SEC.DECIMALS" or
/// "SEC_NSEC".
std::optional<NamedTime> named_time(const fs::path& file) {
  const std::string stem = file.stem().string();
  if (const auto time = clock_time(stem)) return time;
  const auto number_before = [&](std::size_t end) {
    std::size_t begin = end;
    while (begin > 0 && is_digit_char(stem[begin - 1])) --begin;
    return begin;
  };
  std::size_t end = stem.size();
  while (end > 0 && !is_digit_char(stem[end - 1])) --end;
  const std::size_t begin = number_before(end);
  const std::string last = stem.substr(begin, end - begin);
  if (last.empty()) return std::nullopt;
  if (begin > 1 && (stem[begin - 1] == '.' || stem[begin - 1] == '_' || stem[begin - 1] == '-')) {
    const std::size_t first = number_before(begin - 1);
    const auto seconds = parse_integer(stem.substr(first, begin - 1 - first));
    const bool dot = stem[begin - 1] == '.';
    constexpr std::int64_t kLeast_s = 1'000'000'000, kMost_s = 4'000'000'000;  // 2001 to 2096
    if (seconds && *seconds <= kMost_s && (dot || *seconds >= kLeast_s))
      return NamedTime{*seconds, last, !dot, false, stem.substr(0, first)};
  }
  const auto whole = parse_integer(last);
  if (!whole) return std::nullopt;
  return NamedTime{*whole, "", false, false, stem.substr(0, begin)};
}

/// Returns whether 64 bits can store the last of the numbers in nanoseconds.
bool fit_in_64_bits(const std::vector<std::int64_t>& sorted, std::int64_t unit) {
  return sorted.back() <= std::numeric_limits<std::int64_t>::max() / unit;
}

/// Returns the nanoseconds per unit of times that count from about zero; 0 if the numbers may be
/// those of frames, whose steps are all alike (0, 10, 20) where those of rounded times are not
/// (0, 33, 67).
std::int64_t unit_from_zero(const std::vector<std::int64_t>& sorted, std::int64_t step) {
  constexpr double kLeastStep_s = 0.015, kMostStep_s = 0.25, kJitter = 0.05;
  constexpr std::int64_t kMillisecond_ns = 1'000'000;
  constexpr std::size_t kLeastTimes = 5;
  for (const std::int64_t unit : {kMillisecond_ns, std::int64_t{1000}, std::int64_t{1}}) {
    const double step_s = 1e-9 * static_cast<double>(unit) * static_cast<double>(step);
    if (!fit_in_64_bits(sorted, unit) || sorted.size() < kLeastTimes || step_s < kLeastStep_s ||
        step_s > kMostStep_s)
      continue;
    bool differ = unit != kMillisecond_ns;
    for (std::size_t i = 1; i < sorted.size(); ++i) {
      const double steps =
          static_cast<double>(sorted[i] - sorted[i - 1]) / static_cast<double>(step);
      const double whole = std::max(1.0, std::round(steps));
      if (std::abs(steps - whole) > whole * std::max(kJitter, 1.01 / static_cast<double>(step)))
        return 0;
      differ = differ || steps != whole;
    }
    return differ ? unit : 0;
  }
  return 0;
}

/// Returns the nanoseconds per unit of whole numbers: by their size if they count from 1970,
/// nanoseconds if they are large and far apart, or by their steps; 0 if they are frame numbers or
/// dates.
std::int64_t unit_of(const std::vector<NamedTime>& times) {
  constexpr double kFirst_s = 1e9, kLast_s = 4e9;  // 2001 to 2096
  constexpr std::int64_t kLeast_ns = 1'000'000'000, kLeastStep_ns = 2'000'000;
  constexpr double kMostStep_s = 20;
  constexpr std::int64_t kMost_ns = 1'000'000'000;
  std::vector<std::int64_t> sorted;
  for (const NamedTime& time : times) sorted.push_back(time.whole);
  std::ranges::sort(sorted);
  const std::int64_t step = median_period_ns(sorted);
  for (const std::int64_t unit : {1, 1000, 1000000}) {
    const double unit_s = 1e-9 * static_cast<double>(unit);
    const double first_s = static_cast<double>(sorted.front()) * unit_s;
    if (fit_in_64_bits(sorted, unit) && first_s >= kFirst_s && first_s <= kLast_s &&
        static_cast<double>(step) * unit_s < kMostStep_s)
      return unit;
  }
  if (sorted.front() >= kLeast_ns && step >= kLeastStep_ns) return 1;
  return step > 0 && step < kMost_ns ? unit_from_zero(sorted, step) : 0;
}

std::int64_t nanoseconds(const NamedTime& time, std::int64_t unit, bool padded) {
  constexpr std::int64_t kSecond = 1'000'000'000;
  if (time.decimals.empty()) return time.whole * unit;
  std::string decimals = time.decimals.substr(0, 9);
  if (!time.pair || padded) decimals.resize(9, '0');
  return time.whole * kSecond + parse_integer(decimals).value_or(0);
}

/// Returns the times of all names; empty if one has none or another form.
std::vector<NamedTime> named_times(const std::vector<fs::path>& files) {
  std::vector<NamedTime> times;
  for (const fs::path& file : files) {
    const auto time = named_time(file);
    const bool alike =
        time && (times.empty() || (time->decimals.empty() == times[0].decimals.empty() &&
                                   time->pair == times[0].pair && time->clock == times[0].clock));
    if (!alike) return {};
    times.push_back(*time);
  }
  return times;
}

const char* unit_name(const NamedTime& time, std::int64_t unit) {
  if (time.clock) return "hours, minutes and seconds";
  if (time.pair) return "seconds and nanoseconds";
  if (!time.decimals.empty()) return "seconds";
  if (unit == 1) return "nanoseconds";
  return unit == 1000 ? "microseconds" : "milliseconds";
}

}  // namespace

ImageSequence find_image_sequence(const fs::path& folder) {
  if (!is_folder(folder)) return {};
  ImageSequence found = sequence_in(folder);
  for (const std::string& name : usual_subfolders(folder)) {
    if (!is_folder(folder / name)) continue;
    ImageSequence inner = sequence_in(folder / name);
    if (found.files.empty()) {
      found.files = inner.files;
      found.left_out = inner.left_out;
    } else if (!inner.files.empty()) {
      found.others.push_back(other_sequence(inner.files, Rank::second));
    }
    found.others.insert(found.others.end(), inner.others.begin(), inner.others.end());
  }
  if (found.files.empty()) return found;
  for (const char* name : {"depth", "right", "image_1", "image_3", "image_right", "masks"}) {
    if (!is_folder(folder / name)) continue;
    const auto files = numbered_images(folder / name);
    if (!files.empty())
      found.others.push_back(other_sequence(files, rank_of(parts_of(folder / name).words)));
  }
  return found;
}

void report_left_out(Recording& recording, const std::vector<FoundFile>& left_out) {
  constexpr std::size_t kShown = 3;
  if (left_out.empty()) return;
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < std::min(kShown, left_out.size()); ++i)
    texts.push_back(
        fmt::format("{} ({})", left_out[i].file.filename().string(), left_out[i].reason));
  if (left_out.size() > kShown)
    texts.push_back(fmt::format("{} more names of images", left_out.size() - kShown));
  recording.notes.push_back(fmt::format("not read: {}", fmt::join(texts, ", ")));
  recording.files.insert(recording.files.end(), left_out.begin(), left_out.end());
}

std::optional<TimesInNames> times_in_names(std::vector<fs::path>& files) {
  if (files.size() < 2) return std::nullopt;
  const std::vector<NamedTime> times = named_times(files);
  if (times.empty()) return std::nullopt;
  const NamedTime& first = times.front();
  const bool decimals = !first.decimals.empty();
  // Milli-, micro- or nanoseconds with leading zeros; otherwise nanoseconds without them.
  const std::size_t digits = first.decimals.size();
  const bool padded = digits % 3 == 0 && std::ranges::all_of(times, [&](const auto& time) {
                        return time.decimals.size() == digits;
                      });
  // Fewer digits are parts of a name such as "v1.2".
  if (decimals && !first.pair && first.decimals.size() < 3) return std::nullopt;
  const std::int64_t unit = decimals ? 1 : unit_of(times);
  if (unit == 0) return std::nullopt;
  std::vector<std::pair<std::int64_t, fs::path>> sorted;
  for (std::size_t i = 0; i < files.size(); ++i)
    sorted.emplace_back(nanoseconds(times[i], unit, padded), files[i]);
  std::ranges::sort(sorted);
  TimesInNames found{.times_ns = {}, .unit = unit_name(first, unit)};
  for (const auto& [time, file] : sorted) found.times_ns.push_back(time);
  const auto& ns = found.times_ns;
  const bool ascending = std::ranges::adjacent_find(ns, std::greater_equal<>()) == ns.end();
  const double hz = ascending ? 1e9 / static_cast<double>(median_period_ns(ns)) : 0;
  // Numbers of frames after a date look like whole seconds, those of photos within a second like
  // milliseconds.
  constexpr std::int64_t kSecond_ns = 1'000'000'000;
  const auto is_whole = [&](std::int64_t time_ns) { return time_ns % kSecond_ns == 0; };
  if (first.clock && std::ranges::all_of(ns, is_whole)) return std::nullopt;
  if (!(hz > 0.05 && hz < (first.clock ? 500 : 2000))) return std::nullopt;
  // A number that begins anew when another one before it grows is no time.
  const bool same_text =
      std::ranges::adjacent_find(times, std::not_equal_to(), &NamedTime::before) == times.end();
  const auto file_of = [](const auto& one) { return one.second; };
  if (!same_text && !std::ranges::equal(sorted, files, {}, file_of)) return std::nullopt;
  std::ranges::transform(sorted, files.begin(), file_of);
  return found;
}

}  // namespace gpo
