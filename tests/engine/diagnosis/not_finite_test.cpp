// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/diagnosis/not_finite.h"

#include "engine/diagnosis/diagnosis.h"

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace gpo::test {
namespace {

constexpr double kBad[] = {std::numeric_limits<double>::quiet_NaN(),
                           std::numeric_limits<double>::infinity(),
                           -std::numeric_limits<double>::infinity()};

/// A result in which every number is set.
Initialization complete_result() {
  Initialization result;
  result.ok = true;
  result.planes = {
      {.plane = {}, .normal_covariance = Eigen::Matrix3d::Zero(), .distance_sigma = 1}};
  result.cameras.resize(2);
  result.points = {{0, Eigen::Vector3d::UnitZ()}};
  result.solver.trace = {{.normal = Eigen::Vector3d::UnitZ()}};
  result.transfer_rms_px = result.reprojection_rms_px = 1;
  result.bias_rad_s = Eigen::Vector3d::Zero();
  result.time_offset_s = result.time_offset_correction_s = result.row_delay_s = 0;
  result.lens_residual = LensResidual{};
  result.lens_residual->coefficients_px.setZero();
  result.own_noise = {.centers = {Eigen::Matrix3d::Zero()}, .distance_ratios = {1}};
  Uncertainty u;
  u.bend_sigma_deg = u.neighbors_sigma_deg = u.clock_sigma_deg = u.late_s = u.shutter_sigma_deg = 0;
  u.neglected_row_delay_s = u.lens_sigma_deg = u.typical_lens_sigma_deg = 0;
  u.time_offset_sigma_s = u.row_delay_sigma_s = 0;
  u.bound_known_rotations_deg = u.bound_unknown_bias_deg = 0;
  u.typical_lens_moves = {
      Eigen::MatrixXd::Zero(2, 2), Eigen::MatrixXd::Zero(2, 2), Eigen::MatrixXd::Zero(1, 2)};
  u.center_covariances = {Eigen::Matrix3d::Zero(), Eigen::Matrix3d::Zero()};
  u.noise = *result.own_noise;
  u.joint_covariance = u.pose_covariance = Eigen::MatrixXd::Zero(3, 3);
  u.distance_ratio_sigmas = {0, 1};
  u.others = {{}};
  u.bias_covariance = Eigen::Matrix3d::Zero();
  result.uncertainty = u;
  result.verdict = {.normal_sigma_deg = 1,
                    .rotation_rms_px = 1,
                    .noise_px = 1,
                    .largest_translation = 1,
                    .criterion = SceneCriterion{}};
  return result;
}

/// A field of a result, by its name.
template <class T>
struct Field {
  std::string name;
  std::function<void(T&, double)> set;
};

std::vector<Field<Initialization>> fields_of_result() {
  using R = Initialization;
  return {
      {"plane.normal", [](R& r, double x) { r.plane.normal.x() = x; }},
      {"plane.distance", [](R& r, double x) { r.plane.distance = x; }},
      {"planes[0].plane.normal", [](R& r, double x) { r.planes[0].plane.normal.z() = x; }},
      {"planes[0].normal_covariance",
       [](R& r, double x) { (*r.planes[0].normal_covariance)(1, 2) = x; }},
      {"planes[0].distance_sigma", [](R& r, double x) { r.planes[0].distance_sigma = x; }},
      {"cameras[1].R_wc", [](R& r, double x) { r.cameras[1].R_wc(2, 2) = x; }},
      {"cameras[1].p_wc", [](R& r, double x) { r.cameras[1].p_wc.y() = x; }},
      {"points[0].position", [](R& r, double x) { r.points[0].position.y() = x; }},
      {"solver.initial_cost", [](R& r, double x) { r.solver.initial_cost = x; }},
      {"solver.final_cost", [](R& r, double x) { r.solver.final_cost = x; }},
      {"solver.trace[0].cost", [](R& r, double x) { r.solver.trace[0].cost = x; }},
      {"solver.trace[0].gradient", [](R& r, double x) { r.solver.trace[0].gradient = x; }},
      {"solver.trace[0].step", [](R& r, double x) { r.solver.trace[0].step = x; }},
      {"solver.trace[0].normal", [](R& r, double x) { r.solver.trace[0].normal->x() = x; }},
      {"rms_px", [](R& r, double x) { r.rms_px = x; }},
      {"transfer_rms_px", [](R& r, double x) { r.transfer_rms_px = x; }},
      {"reprojection_rms_px", [](R& r, double x) { r.reprojection_rms_px = x; }},
      {"bias_rad_s", [](R& r, double x) { r.bias_rad_s->x() = x; }},
      {"time_offset_s", [](R& r, double x) { r.time_offset_s = x; }},
      {"time_offset_correction_s", [](R& r, double x) { r.time_offset_correction_s = x; }},
      {"row_delay_s", [](R& r, double x) { r.row_delay_s = x; }},
      {"lens_residual.coefficients_px",
       [](R& r, double x) { r.lens_residual->coefficients_px(6, 1) = x; }},
      {"own_noise.normal", [](R& r, double x) { r.own_noise->normal(0, 0) = x; }},
      {"own_noise.centers[0]", [](R& r, double x) { r.own_noise->centers[0](0, 0) = x; }},
      {"own_noise.distance_ratios[0]", [](R& r, double x) { r.own_noise->distance_ratios[0] = x; }},
      {"verdict.normal_sigma_deg", [](R& r, double x) { r.verdict->normal_sigma_deg = x; }},
      {"verdict.rotation_rms_px", [](R& r, double x) { r.verdict->rotation_rms_px = x; }},
      {"verdict.noise_px", [](R& r, double x) { r.verdict->noise_px = x; }},
      {"verdict.largest_translation", [](R& r, double x) { r.verdict->largest_translation = x; }},
      {"verdict.criterion.planes", [](R& r, double x) { r.verdict->criterion->planes = x; }},
      {"verdict.criterion.free_points",
       [](R& r, double x) { r.verdict->criterion->free_points = x; }}};
}

std::vector<Field<Initialization>> numbers_of_uncertainty() {
  using U = Uncertainty;
  std::vector<Field<Initialization>> fields;
  const auto of_uncertainty = [&](const char* name, auto field) {
    fields.push_back({std::string("uncertainty.") + name,
                      [field](Initialization& r, double x) { field(*r.uncertainty) = x; }});
  };
  of_uncertainty(
      "sigma_px", [](U & u) -> auto& { return u.sigma_px; });
  of_uncertainty(
      "normal_sigma_deg", [](U & u) -> auto& { return u.normal_sigma_deg; });
  of_uncertainty(
      "bend_sigma_deg", [](U & u) -> auto& { return u.bend_sigma_deg; });
  of_uncertainty(
      "neighbors_sigma_deg", [](U & u) -> auto& { return u.neighbors_sigma_deg; });
  of_uncertainty(
      "clock_sigma_deg", [](U & u) -> auto& { return u.clock_sigma_deg; });
  of_uncertainty(
      "late_s", [](U & u) -> auto& { return u.late_s; });
  of_uncertainty(
      "shutter_sigma_deg", [](U & u) -> auto& { return u.shutter_sigma_deg; });
  of_uncertainty(
      "neglected_row_delay_s", [](U & u) -> auto& { return u.neglected_row_delay_s; });
  of_uncertainty(
      "lens_sigma_deg", [](U & u) -> auto& { return u.lens_sigma_deg; });
  of_uncertainty(
      "typical_lens_sigma_deg", [](U & u) -> auto& { return u.typical_lens_sigma_deg; });
  of_uncertainty(
      "time_offset_sigma_s", [](U & u) -> auto& { return u.time_offset_sigma_s; });
  of_uncertainty(
      "row_delay_sigma_s", [](U & u) -> auto& { return u.row_delay_sigma_s; });
  of_uncertainty(
      "bound_known_rotations_deg", [](U & u) -> auto& { return u.bound_known_rotations_deg; });
  of_uncertainty(
      "bound_unknown_bias_deg", [](U & u) -> auto& { return u.bound_unknown_bias_deg; });
  return fields;
}

std::vector<Field<Initialization>> matrices_of_uncertainty() {
  using U = Uncertainty;
  std::vector<Field<Initialization>> fields;
  const auto of_uncertainty = [&](const char* name, auto field) {
    fields.push_back({std::string("uncertainty.") + name,
                      [field](Initialization& r, double x) { field(*r.uncertainty) = x; }});
  };
  of_uncertainty(
      "normal_covariance", [](U & u) -> auto& { return u.normal_covariance(1, 0); });
  of_uncertainty(
      "typical_lens_moves.results",
      [](U & u) -> auto& { return u.typical_lens_moves.results(1, 0); });
  of_uncertainty(
      "typical_lens_moves.poses", [](U & u) -> auto& { return u.typical_lens_moves.poses(1, 0); });
  of_uncertainty(
      "typical_lens_moves.row_delay_s",
      [](U & u) -> auto& { return u.typical_lens_moves.row_delay_s(0, 1); });
  of_uncertainty(
      "center_covariances[1]", [](U & u) -> auto& { return u.center_covariances[1](0, 1); });
  of_uncertainty(
      "noise.normal", [](U & u) -> auto& { return u.noise.normal(0, 1); });
  of_uncertainty(
      "joint_covariance", [](U & u) -> auto& { return u.joint_covariance(0, 1); });
  of_uncertainty(
      "pose_covariance", [](U & u) -> auto& { return u.pose_covariance(0, 1); });
  of_uncertainty(
      "distance_ratio_sigmas[1]", [](U & u) -> auto& { return u.distance_ratio_sigmas[1]; });
  of_uncertainty(
      "others[0].normal_covariance",
      [](U & u) -> auto& { return u.others[0].normal_covariance(0, 1); });
  of_uncertainty(
      "others[0].log_distance_sigma",
      [](U & u) -> auto& { return u.others[0].log_distance_sigma; });
  of_uncertainty(
      "bias_covariance", [](U & u) -> auto& { return (*u.bias_covariance)(0, 1); });
  return fields;
}

TEST(NotFinite, NamesEachFieldOfAResult) {
  std::vector<Field<Initialization>> fields = fields_of_result();
  for (const auto& more : {numbers_of_uncertainty(), matrices_of_uncertainty()})
    fields.insert(fields.end(), more.begin(), more.end());
  EXPECT_EQ(first_not_finite(complete_result()), "");
  EXPECT_EQ(first_not_finite(Initialization{}), "");
  for (const auto& [name, set] : fields) {
    for (const double bad : kBad) {
      Initialization result = complete_result();
      set(result, bad);
      EXPECT_EQ(first_not_finite(result), name);
    }
  }
}

TEST(NotFinite, NamesEachFieldOfGravityAndErrors) {
  using I = InertialAlignment;
  const std::vector<Field<I>> of_inertial{
      {"gravity_m_s2", [](I& i, double x) { i.gravity_m_s2.y() = x; }},
      {"direction_covariance", [](I& i, double x) { i.direction_covariance(1, 1) = x; }},
      {"gravity_sigma_deg", [](I& i, double x) { i.gravity_sigma_deg = x; }},
      {"scale", [](I& i, double x) { i.scale = x; }},
      {"log_scale_sigma", [](I& i, double x) { i.log_scale_sigma = x; }},
      {"velocities_m_s[0]", [](I& i, double x) { i.velocities_m_s[0].y() = x; }},
      {"accelerometer_bias_m_s2", [](I& i, double x) { i.accelerometer_bias_m_s2.y() = x; }},
      {"accelerometer_bias_covariance",
       [](I& i, double x) { i.accelerometer_bias_covariance(0, 1) = x; }},
      {"misfit", [](I& i, double x) { i.misfit = x; }}};
  using E = Evaluation;
  const std::vector<Field<E>> of_errors{
      {"T_true_est.scale", [](E& e, double x) { e.T_true_est->scale = x; }},
      {"T_true_est.R_ab", [](E& e, double x) { e.T_true_est->R_ab(0, 1) = x; }},
      {"T_true_est.t_ab", [](E& e, double x) { e.T_true_est->t_ab.x() = x; }},
      {"scale", [](E& e, double x) { e.scale = x; }},
      {"ate_m", [](E& e, double x) { e.ate_m = x; }},
      {"pne_deg", [](E& e, double x) { e.pne_deg = x; }},
      {"pne_aligned_deg", [](E& e, double x) { e.pne_aligned_deg = x; }},
      {"pde_m", [](E& e, double x) { e.pde_m = x; }},
      {"pne_bound_deg", [](E& e, double x) { e.pne_bound_deg = x; }},
      {"tracks_px", [](E& e, double x) { e.tracks_px = x; }},
      {"pne_sigmas", [](E& e, double x) { e.pne_sigmas = x; }},
      {"scale_ratio", [](E& e, double x) { e.scale_ratio = x; }},
      {"path_error_m", [](E& e, double x) { e.path_error_m = x; }},
      {"path_error_percent", [](E& e, double x) { e.path_error_percent = x; }},
      {"scale_error_percent", [](E& e, double x) { e.scale_error_percent = x; }},
      {"gravity_error_deg", [](E& e, double x) { e.gravity_error_deg = x; }}};
  for (const double bad : kBad) {
    for (const auto& [name, set] : of_inertial) {
      InertialAlignment inertial{.scale_known = true, .velocities_m_s = {Eigen::Vector3d::Zero()}};
      EXPECT_EQ(first_not_finite(inertial), "");
      set(inertial, bad);
      EXPECT_EQ(first_not_finite(inertial), name);
    }
    for (const auto& [name, set] : of_errors) {
      Evaluation errors{.T_true_est = Similarity{}};
      EXPECT_EQ(first_not_finite(errors), "");
      set(errors, bad);
      EXPECT_EQ(first_not_finite(errors), name);
    }
  }
}

TEST(NotFinite, AllowsAnUnknownScale) {
  EXPECT_EQ(first_not_finite(InertialAlignment{
                .log_scale_sigma = std::numeric_limits<double>::infinity(), .scale_known = false}),
            "");
}

TEST(NotFinite, IsNeverReady) {
  for (const double bad : kBad) {
    const Verdict numbers{.normal_sigma_deg = bad, .largest_translation = 0.3};
    const Evidence evidence{.numbers = &numbers};
    const auto findings = findings_of(evidence, {Of::length});
    ASSERT_NE(find_finding(findings, "not-finite"), nullptr);
    EXPECT_EQ(verdict_of(findings, evidence).readiness, Readiness::degenerate);
    EXPECT_EQ(verdict_of(findings, evidence).reason.find("nan"), std::string::npos);
  }
  Initialization result = complete_result();
  result.cameras[1].p_wc.x() = std::numeric_limits<double>::quiet_NaN();
  const Verdict numbers = *result.verdict;
  const Evidence evidence{.numbers = &numbers, .result = &result};
  const auto findings = findings_of(evidence, {Of::length});
  EXPECT_EQ(verdict_of(findings, evidence).readiness, Readiness::degenerate);
  EXPECT_FALSE(judged(verdict_of(findings, evidence), result).ok);
}

}  // namespace
}  // namespace gpo::test
