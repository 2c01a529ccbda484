// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/diagnosis/not_finite.h"
#include "engine/inspection/inspector.h"
#include "engine/inspection/report/report.h"
#include "engine/recording/layouts/open_recording.h"
#include "engine/save_window.h"
#include "tests/engine/pipeline/simulated_frames.h"
#include "tests/engine/test_folder.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

namespace gpo::test {
namespace {

namespace fs = std::filesystem;

bool has_number_not_finite(const nlohmann::ordered_json& json) {
  if (json.is_number_float()) return !std::isfinite(json.get<double>());
  return std::ranges::any_of(json, [](const auto& element) {
    return (element.is_structured() || element.is_number_float()) && has_number_not_finite(element);
  });
}

bool has_word_not_finite(const std::string& text) {
  static const std::regex word(R"((^|[^A-Za-z0-9_])-?(nan|inf)([^A-Za-z0-9_]|$))");
  return std::regex_search(text, word);
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// Writes a recording of tracks, camera, gyroscope and truth in text files.
void write_recording(const TestFolder& folder) {
  SimulationOptions options = noisy(Motion::orbit, 1, 0.2);
  options.frames = 10;
  options.points = 60;
  options.gyro_bias_rad_s = 0.01;
  const Simulation simulation = simulate(options);
  const Gyroscope gyroscope = simulated_gyroscope(options);
  save_window(
      folder.path() / "r", camera_of(simulation.window), frames_of(simulation.window), &gyroscope);
  std::string truth = "#timestamp,px,py,pz,qw,qx,qy,qz\n";
  for (std::size_t i = 0; i < simulation.cameras.size(); ++i) {
    const Eigen::Quaterniond q(simulation.cameras[i].R_wc);
    const Eigen::Vector3d& p = simulation.cameras[i].p_wc;
    truth += fmt::format("{},{},{},{},{},{},{},{}\n",
                         simulation.window.timestamps_ns[i],
                         p.x(),
                         p.y(),
                         p.z(),
                         q.w(),
                         q.x(),
                         q.y(),
                         q.z());
  }
  folder.write("r/mav0/state_groundtruth_estimate0/data.csv", truth);
  folder.write("r/plane.yaml",
               fmt::format("normal: [{}, {}, {}]\ndistance: {}\n",
                           simulation.plane.normal.x(),
                           simulation.plane.normal.y(),
                           simulation.plane.normal.z(),
                           simulation.plane.distance));
}

/// Fails if a number of the recording's inspection is not finite, or is printed so.
void expect_refused_or_finite(const fs::path& folder, const std::string& file) {
  try {
    const auto inspection = Inspector(open_recording(folder)).inspect({.frames = 10});
    EXPECT_EQ(first_not_finite(*inspection->initialization), "");
    if (inspection->evaluation) EXPECT_EQ(first_not_finite(*inspection->evaluation), "");
    if (inspection->inertial) EXPECT_EQ(first_not_finite(*inspection->inertial), "");
    EXPECT_FALSE(has_number_not_finite(to_json(*inspection)));
    EXPECT_FALSE(has_word_not_finite(to_text(*inspection))) << to_text(*inspection);
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find(file), std::string::npos) << error.what();
    EXPECT_EQ(std::ranges::count(std::string(error.what()), '\n'), 0) << error.what();
  }
}

TEST(NotFiniteInputs, AreRefusedOrLeftOutWhereverTheyAre) {
  const TestFolder folder;
  write_recording(folder);
  const fs::path recording = folder.path() / "r";
  static const std::regex number(R"([-+]?[0-9][0-9.eE+-]*)");
  int tried = 0;
  for (const auto& entry : fs::recursive_directory_iterator(recording)) {
    if (!entry.is_regular_file()) continue;
    const std::string file = fs::relative(entry.path(), folder.path()).string();
    const std::string content = folder.read(file);
    const std::vector<std::string> lines = lines_of(content);
    const bool table = file.ends_with(".csv");
    for (std::size_t row = table ? 3 : 0; row < (table ? 4 : lines.size()); ++row) {
      const std::string& line = lines[row];
      if (line.starts_with("#")) continue;
      for (std::sregex_iterator at(line.begin(), line.end(), number), end; at != end; ++at) {
        for (const char* bad : {"nan", "-inf", ".nan", ".inf"}) {
          if (table == (bad[0] == '.')) continue;
          std::vector<std::string> changed = lines;
          changed[row].replace(at->position(), at->length(), bad);
          folder.write(file, fmt::format("{}\n", fmt::join(changed, "\n")));
          SCOPED_TRACE(file + ": " + changed[row]);
          expect_refused_or_finite(recording, entry.path().filename().string());
          ++tried;
        }
      }
    }
    folder.write(file, content);
  }
  EXPECT_GT(tried, 60);
  EXPECT_EQ(Inspector(open_recording(recording)).inspect({.frames = 10})->initialization->ok, true);
}

}  // namespace
}  // namespace gpo::test
