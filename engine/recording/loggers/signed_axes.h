// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string_view>

#include <Eigen/Core>

namespace gpo {

/// The rotation that three axes by name stand for, an upper-case letter for an axis, a lower-case
/// one for its opposite: row i of "YxZ" is e_y, -e_x, e_z. Nothing where the text is none, or
/// mirrors.
std::optional<Eigen::Matrix3d> signed_axes(std::string_view text);

}  // namespace gpo
