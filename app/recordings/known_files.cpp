// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "app/recordings/known_files.h"

#include "engine/base/error.h"
#include "engine/experiment/results_file.h"
#include "engine/files/folder.h"
#include "engine/files/yaml_entry.h"
#include "engine/recording/pictures/picture_files.h"
#include "ui/workbench/session/session_file.h"

#include <algorithm>
#include <array>
#include <initializer_list>

#include <fmt/format.h>

namespace gpo {
namespace {

namespace fs = std::filesystem;

/// Whether it is YAML or JSON with one of these keys. What cannot be read is none of ours: who
/// reads it next will say what is wrong.
bool has_key(const fs::path& file, std::initializer_list<const char*> keys) {
  constexpr std::array kEndings = {".yaml", ".yml", ".json"};
  if (std::ranges::find(kEndings, file.extension()) == kEndings.end()) return false;
  try {
    const YamlEntry root = load_yaml(file);
    return std::ranges::any_of(keys, [&](const char* key) { return find(root, key).has_value(); });
  } catch (const InputError&) {
    return false;
  }
}

bool is_board(const fs::path& file) { return has_key(file, {"pattern"}); }
bool is_plane(const fs::path& file) { return has_key(file, {"normal"}); }
bool is_mounting(const fs::path& file) { return has_key(file, {"T_truth_camera"}); }
bool is_calibration(const fs::path& file) {
  return has_key(file, {"intrinsics", "camera_matrix", "cam0", "K", "distortion_model"});
}

struct KnownFile {
  bool (*is)(const fs::path& file);
  const char* what;
  const char* instead;
};

constexpr const char* kItsFolder = "a recording, such as the folder that it lies in";
constexpr std::array<KnownFile, 7> kKnownFiles = {
    {{is_session, "a session", "a recording; `view --session` opens it"},
     {is_results, "results of `evaluate`", "a recording; the window opens it"},
     {is_picture_name, "one picture", "a recording, such as a folder of numbered pictures"},
     {is_board, "the description of a printed board", kItsFolder},
     {is_plane, "the true plane of a recording", kItsFolder},
     {is_mounting, "how a truth was measured", kItsFolder},
     {is_calibration, "the calibration of a camera", kItsFolder}}};

}  // namespace

void refuse_known_file(const fs::path& path) {
  if (!is_file(path)) return;
  for (const KnownFile& known : kKnownFiles) {
    if (!known.is(path)) continue;
    throw InputError(
        fmt::format("{}: found {}, expected {}", path.string(), known.what, known.instead));
  }
}

}  // namespace gpo
