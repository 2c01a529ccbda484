// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/diagnosis/focal_change.h"

#include "engine/geometry/transfer.h"
#include "engine/methods/plane/plane_motion.h"
#include "engine/methods/plane/rolling_shutter.h"
#include "engine/methods/uncertainty/shares.h"

#include <cmath>
#include <vector>

namespace gpo {
namespace {

/// Change of the points, one matrix per frame [px].
using FrameMoves = std::vector<Eigen::Matrix2Xd>;

/// Returns the moves by a focal length that doubles until the last frame. Observed positions would
/// bias the estimate: their noise is also in the residuals. Transferred ones do not.
FrameMoves moves_by_doubling(const Window& window, const PlaneMotion& motion) {
  const Eigen::Vector2d center = window.K.topRightCorner<2, 1>();
  const Eigen::Vector2d focal(window.K(0, 0), window.K(1, 1));
  const auto& times_ns = window.timestamps_ns;
  const auto span_ns = static_cast<double>(times_ns.back() - times_ns.front());
  FrameMoves moves_px;
  for (int i = 0; i < window.frame_count(); ++i) {
    FrameState state;
    state.R_cw = motion.R_wc[i].transpose();
    state.tau_c = state.R_cw * motion.tau[i];
    state.normal = motion.normal;
    state.fx = focal.x();
    state.fy = focal.y();
    const double time = static_cast<double>(times_ns[i] - times_ns.front()) / span_ns;
    Eigen::Matrix2Xd& move_px = moves_px.emplace_back(window.points_px[0].colwise() - center);
    for (auto point : move_px.colwise()) {
      const Eigen::Vector2d image = point.cwiseQuotient(focal);
      point = time * transfer_on_plane(state, image.homogeneous()).pixel;
    }
  }
  return moves_px;
}

/// The points of a solution, which errors displace.
struct Estimator {
  Window window;
  const PlaneMotion& motion;
  RotationModel rotations;

  std::optional<Multiple> multiple(const FrameMoves& moves_px) const {
    return multiple_of({window, plane_observations(window), motion}, rotations, moves_px);
  }
  Estimator displaced(const FrameMoves& moves_px, double times) const {
    Estimator other = *this;
    for (std::size_t i = 0; i < moves_px.size(); ++i)
      other.window.points_px[i] += times * moves_px[i];
    return other;
  }
};

/// Subtracts from the moves what an error of the row delay explains of them.
void make_independent_of_row_delay(const Estimator& solved, FrameMoves& moves_px) {
  constexpr double kSmall = 0.01;
  const Window rolling = without_rolling_shutter(
      solved.window, solved.motion, solved.rotations, unknown_row_delay(solved.window));
  const FrameMoves& by_delay_px = rolling.row_delay_moves_px;
  const auto before = solved.multiple(by_delay_px);
  const auto after = solved.displaced(moves_px, kSmall).multiple(by_delay_px);
  if (!before || !after) return;
  for (std::size_t i = 0; i < moves_px.size(); ++i)
    moves_px[i] += (after->value - before->value) / kSmall * by_delay_px[i];
}

}  // namespace

std::optional<FocalChange> focal_change(const Window& window, const Initialization& result) {
  if (!result.ok) return std::nullopt;
  const PlaneMotion motion = motion_of(result.plane, result.cameras);
  const Estimator solved{as_seen_at_time_stamps(window, result),
                         motion,
                         window.gyro ? RotationModel::bias : RotationModel::free};
  FrameMoves moves_px = moves_by_doubling(solved.window, motion);
  if (result.row_delay_s) make_independent_of_row_delay(solved, moves_px);
  const auto change = solved.multiple(moves_px);
  if (!change) return std::nullopt;
  double variance = change->sigma * change->sigma;
  for (const FrameMoves& error_px :
       window.lens_moves_px.empty() ? typical_lens_moves_px(window) : window.lens_moves_px)
    if (const auto moved = solved.displaced(error_px, 1).multiple(moves_px))
      variance += std::pow(moved->value - change->value, 2);
  return FocalChange{-change->value, std::sqrt(variance)};
}

}  // namespace gpo
