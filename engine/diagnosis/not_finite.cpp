// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/diagnosis/not_finite.h"

#include <cmath>
#include <initializer_list>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace gpo {
namespace {

/// Collects the name of the first number that is not finite.
class Search {
 public:
  void look(const std::string& name, double value) {
    if (found_.empty() && !std::isfinite(value)) found_ = name;
  }
  template <class Derived>
  void look(const std::string& name, const Eigen::DenseBase<Derived>& values) {
    if (found_.empty() && !values.derived().allFinite()) found_ = name;
  }
  template <class T>
  void look(const std::string& name, const std::optional<T>& value) {
    if (value) look(name, *value);
  }
  template <class T>
  void look(const std::string& name, const std::vector<T>& values) {
    for (std::size_t k = 0; k < values.size() && found_.empty(); ++k)
      look(fmt::format("{}[{}]", name, k), values[k]);
  }
  void look(const std::string& name, const Plane& plane) {
    look(name + ".normal", plane.normal);
    look(name + ".distance", plane.distance);
  }
  void look(const std::string& name, const Pose& pose) {
    look(name + ".R_wc", pose.R_wc);
    look(name + ".p_wc", pose.p_wc);
  }
  void look(const std::string& name, const Similarity& T) {
    look(name + ".scale", T.scale);
    look(name + ".R_ab", T.R_ab);
    look(name + ".t_ab", T.t_ab);
  }
  void look(const std::string& name, const PlaneEstimate& plane) {
    look(name + ".plane", plane.plane);
    look(name + ".normal_covariance", plane.normal_covariance);
    look(name + ".distance_sigma", plane.distance_sigma);
  }
  void look(const std::string& name, const PlaneUncertainty& plane) {
    look(name + ".normal_covariance", plane.normal_covariance);
    look(name + ".log_distance_sigma", plane.log_distance_sigma);
  }
  void look(const std::string& name, const MapPoint& point) {
    look(name + ".position", point.position);
  }
  void look(const std::string& name, const NoiseSpread& spread) {
    look(name + ".normal", spread.normal);
    look(name + ".centers", spread.centers);
    look(name + ".distance_ratios", spread.distance_ratios);
  }
  void look(const std::string& name, const SolverStep& step) {
    look(name + ".cost", step.cost);
    look(name + ".gradient", step.gradient);
    look(name + ".step", step.step);
    look(name + ".normal", step.normal);
  }
  void look(const std::string& name, const SolverReport& solver) {
    look(name + ".initial_cost", solver.initial_cost);
    look(name + ".final_cost", solver.final_cost);
    look(name + ".trace", solver.trace);
  }
  void look(const std::string& name, const Verdict& verdict) {
    look(name + ".normal_sigma_deg", verdict.normal_sigma_deg);
    look(name + ".rotation_rms_px", verdict.rotation_rms_px);
    look(name + ".noise_px", verdict.noise_px);
    look(name + ".largest_translation", verdict.largest_translation);
    if (!verdict.criterion) return;
    look(name + ".criterion.planes", verdict.criterion->planes);
    look(name + ".criterion.free_points", verdict.criterion->free_points);
  }
  void look(const std::string& name, const Uncertainty& u) {
    for (const auto& [field, value] :
         std::initializer_list<std::pair<const char*, std::optional<double>>>{
             {".sigma_px", u.sigma_px},
             {".normal_sigma_deg", u.normal_sigma_deg},
             {".bend_sigma_deg", u.bend_sigma_deg},
             {".neighbors_sigma_deg", u.neighbors_sigma_deg},
             {".clock_sigma_deg", u.clock_sigma_deg},
             {".late_s", u.late_s},
             {".shutter_sigma_deg", u.shutter_sigma_deg},
             {".neglected_row_delay_s", u.neglected_row_delay_s},
             {".lens_sigma_deg", u.lens_sigma_deg},
             {".typical_lens_sigma_deg", u.typical_lens_sigma_deg},
             {".time_offset_sigma_s", u.time_offset_sigma_s},
             {".row_delay_sigma_s", u.row_delay_sigma_s},
             {".bound_known_rotations_deg", u.bound_known_rotations_deg},
             {".bound_unknown_bias_deg", u.bound_unknown_bias_deg}})
      look(name + field, value);
    look(name + ".normal_covariance", u.normal_covariance);
    look(name + ".typical_lens_moves.results", u.typical_lens_moves.results);
    look(name + ".typical_lens_moves.poses", u.typical_lens_moves.poses);
    look(name + ".typical_lens_moves.row_delay_s", u.typical_lens_moves.row_delay_s);
    look(name + ".center_covariances", u.center_covariances);
    look(name + ".noise", u.noise);
    look(name + ".joint_covariance", u.joint_covariance);
    look(name + ".pose_covariance", u.pose_covariance);
    look(name + ".distance_ratio_sigmas", u.distance_ratio_sigmas);
    look(name + ".others", u.others);
    look(name + ".bias_covariance", u.bias_covariance);
  }
  std::string found() { return std::move(found_); }

 private:
  std::string found_;
};

}  // namespace

std::string first_not_finite(const Initialization& result) {
  Search search;
  search.look("plane", result.plane);
  search.look("planes", result.planes);
  search.look("cameras", result.cameras);
  search.look("points", result.points);
  search.look("solver", result.solver);
  search.look("rms_px", result.rms_px);
  search.look("transfer_rms_px", result.transfer_rms_px);
  search.look("reprojection_rms_px", result.reprojection_rms_px);
  search.look("bias_rad_s", result.bias_rad_s);
  search.look("time_offset_s", result.time_offset_s);
  search.look("time_offset_correction_s", result.time_offset_correction_s);
  search.look("row_delay_s", result.row_delay_s);
  if (result.lens_residual)
    search.look("lens_residual.coefficients_px", result.lens_residual->coefficients_px);
  search.look("own_noise", result.own_noise);
  search.look("uncertainty", result.uncertainty);
  search.look("verdict", result.verdict);
  return search.found();
}

std::string first_not_finite(const InertialAlignment& inertial) {
  Search search;
  search.look("gravity_m_s2", inertial.gravity_m_s2);
  search.look("direction_covariance", inertial.direction_covariance);
  search.look("gravity_sigma_deg", inertial.gravity_sigma_deg);
  search.look("scale", inertial.scale);
  if (inertial.scale_known) search.look("log_scale_sigma", inertial.log_scale_sigma);
  search.look("velocities_m_s", inertial.velocities_m_s);
  search.look("accelerometer_bias_m_s2", inertial.accelerometer_bias_m_s2);
  search.look("accelerometer_bias_covariance", inertial.accelerometer_bias_covariance);
  search.look("misfit", inertial.misfit);
  return search.found();
}

std::string first_not_finite(const Evaluation& evaluation) {
  Search search;
  search.look("T_true_est", evaluation.T_true_est);
  search.look("scale", evaluation.scale);
  search.look("ate_m", evaluation.ate_m);
  search.look("pne_deg", evaluation.pne_deg);
  search.look("pne_aligned_deg", evaluation.pne_aligned_deg);
  search.look("pde_m", evaluation.pde_m);
  search.look("pne_bound_deg", evaluation.pne_bound_deg);
  search.look("tracks_px", evaluation.tracks_px);
  search.look("pne_sigmas", evaluation.pne_sigmas);
  search.look("scale_ratio", evaluation.scale_ratio);
  search.look("path_error_m", evaluation.path_error_m);
  search.look("path_error_percent", evaluation.path_error_percent);
  search.look("scale_error_percent", evaluation.scale_error_percent);
  search.look("gravity_error_deg", evaluation.gravity_error_deg);
  return search.found();
}

std::string first_not_finite(const Verdict& verdict) {
  Search search;
  search.look("verdict", verdict);
  return search.found();
}

}  // namespace gpo
