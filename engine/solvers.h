// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Every method on a window that the caller filled, with its uncertainty and verdict.
#include "engine/base/eigen_layout.h"
#include "engine/base/error.h"
#include "engine/methods/methods.h"
#include "engine/window/window.h"
