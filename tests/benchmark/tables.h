// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tests/benchmark/results.h"
#include "tests/benchmark/windows.h"

namespace gpo::bench {

// Each file of benchmarks registers its own, and prints the README's tables of them.

/// Every method on simulated windows, one thread.
void register_method_benchmarks(const SharedWindows& windows);
void print_method_tables(const Results& results);

/// What GPO consists of, and growing windows: simulated windows, one thread.
void register_part_benchmarks(const SharedWindows& windows);
void print_part_tables(const Results& results);

/// Stages from picture to window, one thread.
void register_frontend_benchmarks();
void print_frontend_tables(const Results& results);

/// Rooms of one plane and of three, one thread.
void register_plane_benchmarks();
void print_plane_tables(const Results& results);

/// Gravity and meters of simulated poses, one thread.
void register_inertial_benchmarks();
void print_inertial_tables(const Results& results);

/// The front door's live form, frame by frame.
void register_live_benchmarks();
void print_live_tables(const Results& results);

/// Views off-screen at 1280x720.
void register_view_benchmarks();
void print_view_tables(const Results& results);

/// Windows a second of `evaluate`.
void register_evaluate_benchmarks();
void print_evaluate_tables(const Results& results);

}  // namespace gpo::bench
