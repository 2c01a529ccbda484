// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <string_view>

namespace gpo::fuzz {

void fuzz_answer(std::string_view bytes);
void fuzz_bag(std::string_view bytes);
void fuzz_calibration(std::string_view bytes);
void fuzz_experiment(std::string_view bytes);
void fuzz_logs(std::string_view bytes);
void fuzz_message(std::string_view bytes);
void fuzz_image(std::string_view bytes);
void fuzz_poses(std::string_view bytes);
void fuzz_recipe(std::string_view bytes);
void fuzz_recording(std::string_view bytes);
void fuzz_results(std::string_view bytes);
void fuzz_script(std::string_view bytes);
void fuzz_session(std::string_view bytes);
void fuzz_sidecars(std::string_view bytes);
void fuzz_tables(std::string_view bytes);
void fuzz_video(std::string_view bytes);

/// A parser that reads any bytes or refuses them; seeds are in seeds/NAME, former crashes in
/// crashes/NAME.
struct Target {
  const char* name;
  void (*read)(std::string_view bytes);
};

inline constexpr std::array kTargets = {
    Target{"answer", fuzz_answer},
    Target{"bag", fuzz_bag},
    Target{"calibration", fuzz_calibration},
    Target{"experiment", fuzz_experiment},
    Target{"logs", fuzz_logs},
    Target{"message", fuzz_message},
    Target{"picture", fuzz_image},
    Target{"poses", fuzz_poses},
    Target{"recipe", fuzz_recipe},
    Target{"recording", fuzz_recording},
    Target{"results", fuzz_results},
    Target{"script", fuzz_script},
    Target{"session", fuzz_session},
    Target{"sidecars", fuzz_sidecars},
    Target{"tables", fuzz_tables},
    Target{"video", fuzz_video},
};

/// Silences the libraries that print about broken files. Call it once, before any target.
void quiet_libraries();

}  // namespace gpo::fuzz
