// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/recording/companions/companion_files.h"

#include <span>

namespace gpo {

/// A format of lens files in YAML, XML or JSON.
struct LensFormat {
  const char* name;
  const char* keys;  ///< each of these recognizes it: "value0 camera/fx"
  Calibration (*read)(const YamlEntry& root);
};

/// All formats in the order of their precedence.
std::span<const LensFormat> lens_formats();

/// Returns the format with one of its keys in the file; null if there is none.
const LensFormat* lens_format_of(const YamlEntry& root);

/// Parses a lens file of any syntax. Throws InputError.
YamlEntry load_lens_file(const fs::path& file);

/// Returns the file in the same folder that has the camera of VINS-Fusion's configuration; nullopt
/// for other files. Throws InputError.
std::optional<fs::path> named_camera_file(const YamlEntry& root);

/// A format of lens files without keys.
struct LensTable {
  const char* name;
  bool (*is)(const fs::path& file, std::string_view bytes);
  Calibration (*read)(const fs::path& file, std::string_view bytes);
};

const LensTable* lens_table_of(const fs::path& file, std::string_view bytes);

// Readers of other programs' keys.
Calibration read_basalt(const YamlEntry& root);
Calibration read_orb_slam(const YamlEntry& root);
Calibration read_vins_fusion(const YamlEntry& root);
Calibration read_camodocal(const YamlEntry& root);
Calibration read_nerfstudio(const YamlEntry& root);
Calibration read_nice_slam(const YamlEntry& root);
Calibration read_kitti(const YamlEntry& root);

// Parts of a camera, checked. All throw InputError with the entry's line and key.
void set_resolution(Camera& camera, const YamlEntry& entry, double width, double height);
/// `k`: fx, fy, cx, cy.
void set_intrinsics(Camera& camera, const YamlEntry& entry, const std::array<double, 4>& k);
void set_coefficients(Camera& camera, const YamlEntry& entry, std::vector<double> values);
/// Returns the list of distortion coefficients under any of its usual keys; nullopt without one.
std::optional<YamlEntry> find_coefficients(const YamlEntry& map);
/// Throws InputError if a key of the map names a distortion other than zero, and is neither the
/// entry `read` nor one of `others` (separated by blanks): the lens would be read as one without
/// it.
void check_distortion_is_read(const YamlEntry& map,
                              const std::optional<YamlEntry>& read,
                              const std::string& others = "");
/// Converts the focal lengths of a model's authors to ours, at the principal point.
void convert_focal_lengths(Camera& camera);
/// Sets the offset from seconds; `rate_hz` likewise.
void set_time_offset(Calibration& calibration, const YamlEntry& seconds);
void set_rate(Calibration& calibration, const YamlEntry& rate);
/// Returns a rotation and a translation as a pose.
Pose rigid_motion_of(const YamlEntry& entry, const Eigen::Matrix4d& T);

}  // namespace gpo
