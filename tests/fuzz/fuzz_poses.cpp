// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// Other programs' results. The first byte chooses what the rest is read as.
#include "engine/results/result_poses.h"
#include "tests/fuzz/fuzzed_file.h"
#include "tests/fuzz/targets.h"

void gpo::fuzz::fuzz_poses(std::string_view bytes) {
  if (bytes.empty()) return;
  const char kind = bytes[0];
  bytes.remove_prefix(1);
  gpo::fuzz::parse([&] {
    switch (kind) {
      case 'b':
        gpo::read_colmap_images("images.bin", bytes);
        break;
      case 't':
        gpo::read_colmap_images("images.txt", bytes);
        break;
      case 'p':
        gpo::read_colmap_points("points3D.bin", bytes);
        break;
      case 'q':
        gpo::read_colmap_points("points3D.txt", bytes);
        break;
      case 'y':
        gpo::read_ply_points("points.ply", bytes);
        break;
      default:
        gpo::read_result_poses(gpo::fuzz::file_of(bytes));
    }
  });
}
