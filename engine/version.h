// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Semantic version of the headers installed below `gpo/`. CMake reads it from here.
#define GPO_VERSION_MAJOR 1
#define GPO_VERSION_MINOR 0
#define GPO_VERSION_PATCH 0
/// For comparisons: 10203 is 1.2.3.
#define GPO_VERSION_NUMBER (GPO_VERSION_MAJOR * 10000 + GPO_VERSION_MINOR * 100 + GPO_VERSION_PATCH)
