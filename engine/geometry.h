// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Cameras, poses, planes and homographies.
#include "engine/base/eigen_layout.h"
#include "engine/base/error.h"
#include "engine/geometry/camera.h"
#include "engine/geometry/decompositions.h"
#include "engine/geometry/homography.h"
#include "engine/geometry/plane.h"
#include "engine/geometry/pose.h"
