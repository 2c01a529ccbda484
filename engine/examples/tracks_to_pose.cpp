// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// tracks_to_pose TRACKS.csv FX FY CX CY: estimates the plane and the last camera from lines
// "frame,track,x,y" of undistorted pixels (30 frames per second). Exit code 1 if that fails.
#include <cstdio>
#include <fstream>
#include <iostream>
#include <map>
#include <string>

#include <gpo/initialize.h>

int main(int argc, char** argv) {
  if (argc != 6) return 2;
  const gpo::Camera camera{.fx = std::stod(argv[2]),
                           .fy = std::stod(argv[3]),
                           .cx = std::stod(argv[4]),
                           .cy = std::stod(argv[5])};
  std::map<int, gpo::Frame> numbered;
  std::ifstream file(argv[1]);
  for (std::string line; std::getline(file, line);) {
    int frame = 0;
    long id = 0;
    double x = 0, y = 0;
    if (std::sscanf(line.c_str(), "%d,%ld,%lf,%lf", &frame, &id, &x, &y) != 4) continue;
    gpo::Frame& f = numbered[frame];
    f.timestamp_ns = frame * 1'000'000'000LL / 30;
    f.ids.push_back(id);
    f.raw_px.conservativeResize(2, f.raw_px.cols() + 1);
    f.raw_px.rightCols<1>() << x, y;
  }
  std::vector<gpo::Frame> frames;
  for (auto& [number, frame] : numbered) frames.push_back(std::move(frame));
  const gpo::Initialization result = gpo::initialize(camera, frames).initialization;
  if (!result.ok) std::cerr << result.reason << '\n';
  if (!result.ok) return 1;
  std::cout << "verdict " << result.verdict->reason << "\nnormal "
            << result.plane.normal.transpose() << "\ncenter "
            << result.cameras.back().p_wc.transpose() << "\npoints " << result.points.size()
            << '\n';
}
