// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/files/yaml_entry.h"

#include <filesystem>

namespace gpo {

/// Whether the first thing in a file is a tag. Throws InputError where it cannot be read.
bool is_xml(const std::filesystem::path& file);

/// Parses an XML file as OpenCV's FileStorage writes it into what its YAML would have been:
/// elements are keys, several words are a list, `<_>` are the items of a list. Throws InputError.
YamlEntry load_opencv_xml(const std::filesystem::path& file);

}  // namespace gpo
