// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace gpo {

/// Least |tau| of the farthest camera in a window that is ready [plane distance]. In simulated
/// windows it is below 0.0065 without parallax, above 0.042 at low parallax, and above 0.24 in all
/// others.
inline constexpr double kReadyTranslation = 0.06;

/// Normal uncertainty above which a window is weak or degenerate [deg]. Simulated windows with 0.5
/// px of noise: 1.9 to 12 deg for pure rotations, 0.17 to 0.41 deg at low parallax (4 % of d),
/// below 0.06 deg otherwise; a room 0.1 to 0.4 deg.
inline constexpr double kWeakSigma_deg = 0.5;
inline constexpr double kDegenerateSigma_deg = 10;

}  // namespace gpo
