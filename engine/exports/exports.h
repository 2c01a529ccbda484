// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/exports/scene.h"

#include <span>
#include <string>

namespace gpo {

/// A format that other programs read.
struct ExportFormat {
  const char* key;     ///< in commands: "colmap"
  const char* title;   ///< for menus
  const char* ending;  ///< usual file ending; empty: a folder
  const char* help;    ///< one line
  /// Returns the content of the file; null for a format that writes by itself.
  std::string (*content)(const ExportScene& scene, ExportNotes& notes);
  /// Writes a folder, or a file part by part; null if `content` is not.
  void (*write)(const ExportScene& scene, const fs::path& path, ExportNotes& notes) = nullptr;

  bool is_folder() const { return *ending == '\0'; }
};

/// Returns all formats. Command line, window, scripts and Python read this table.
std::span<const ExportFormat> export_formats();

/// Throws InputError that lists the formats for an unknown key.
const ExportFormat& export_format(const std::string& key);

/// An export to write.
struct ExportRequest {
  const ExportFormat* format = nullptr;
  fs::path path;
};

/// Parses "FORMAT=PATH". Throws InputError.
ExportRequest parse_export(const std::string& text);

/// Throws InputError if the path cannot be written: a folder must be new or empty, as for all
/// commands; a file is replaced.
void check_export(const ExportRequest& request);

/// Writes a result whole or not at all, in the world of `export_world`. Throws InputError if the
/// initialization failed, a requested scale or world is unknown, or the path cannot be written.
ExportNotes write_export(const Inspection& inspection,
                         const ExportChoices& choices,
                         const ExportRequest& request);

/// Returns the map points of the leading plane in the format `ply`, for `run --points`. Throws
/// InputError if the initialization failed.
std::string map_points_ply(const Inspection& inspection, const ExportWorld& world);

}  // namespace gpo
