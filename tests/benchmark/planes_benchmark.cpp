// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/frontend/window_planes.h"
#include "engine/methods/initializers.h"
#include "tests/benchmark/measure.h"
#include "tests/benchmark/tables.h"
#include "tests/engine/simulated_room.h"

#include <fmt/format.h>

namespace gpo::bench {
namespace {

struct Rooms {
  const char* name;
  int planes;
  RotationModel rotations;
};

constexpr Rooms kRooms[] = {{"one plane, rotations known", 1, RotationModel::known},
                            {"three planes, rotations known", 3, RotationModel::known},
                            {"one plane, rotations free", 1, RotationModel::free},
                            {"three planes, rotations free", 3, RotationModel::free}};

/// 30 frames, 200 tracks, 0.2 px.
Window window_of(const Rooms& rooms) {
  test::RoomOptions options{.frames = 30, .planes = test::floor_and_walls()};
  options.planes.resize(rooms.planes);
  options.shares.assign(rooms.planes, 1.0 / rooms.planes);
  Window window = test::simulate_room(options).window;
  window.rotations = rooms.rotations;
  return window;
}

void solve(benchmark::State& state, const Rooms& rooms) {
  const Window window = window_of(rooms);
  Initialization result;
  measure(state, thread_ms, [&] { result = initialize_gpo_joint(window, {}, {}); });
  if (!result.ok) state.SkipWithError(result.reason.c_str());
  state.counters["planes"] = static_cast<double>(result.planes.size());
}

void extract(benchmark::State& state, const Rooms& rooms) {
  const Window window = window_of(rooms);
  measure(state, thread_ms, [&] { benchmark::DoNotOptimize(window_planes(window.points_px)); });
}

std::string solving(const Rooms& rooms) { return fmt::format("gpo_joint, {}", rooms.name); }
std::string extracting(const Rooms& rooms) { return fmt::format("extraction, {}", rooms.name); }

}  // namespace

void register_plane_benchmarks() {
  const auto add = [](const std::string& name, auto* run, const Rooms& rooms) {
    benchmark::RegisterBenchmark(name.c_str(),
                                 [rooms, run](benchmark::State& state) { run(state, rooms); })
        ->MinTime(0.1)
        ->Repetitions(kRepetitions);
  };
  for (const Rooms& rooms : kRooms) {
    add(solving(rooms), solve, rooms);
    add(extracting(rooms), extract, rooms);
  }
}

void print_plane_tables(const Results& results) {
  fmt::print("\nPlanes of a room, 30 frames, 200 tracks:\n\n");
  print_head({"window", "planes", "extraction [ms]", "`gpo_joint` [ms]"});
  for (const Rooms& rooms : kRooms)
    print_row({rooms.name,
               whole_number(results.least(solving(rooms), "planes")),
               cell(results.least(extracting(rooms), "ms")),
               cell(results.least(solving(rooms), "ms"))});
}

}  // namespace gpo::bench
