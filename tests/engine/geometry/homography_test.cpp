// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/geometry/homography.h"

#include "engine/planes/inliers.h"
#include "tests/engine/largest.h"
#include "tests/engine/simulated_window.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>

#include <Eigen/LU>
#include <gmock/gmock.h>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/eigen.hpp>

namespace gpo::test {
namespace {

using Eigen::Matrix3d, Eigen::Vector3d;

std::vector<cv::Point2d> to_points(const Eigen::Matrix2Xd& x) {
  std::vector<cv::Point2d> points;
  for (const auto& column : x.colwise()) points.emplace_back(column.x(), column.y());
  return points;
}

double largest_difference_px(const Matrix3d& A, const Matrix3d& B) {
  double largest = 0;
  for (int u = 0; u < 640; u += 64)
    for (int v = 0; v < 480; v += 48) {
      const Eigen::Vector2d px(u, v);
      largest = std::max(largest, (transfer(A, px) - transfer(B, px)).norm());
    }
  return largest;
}

TEST(Homography, FitIsExactWithoutNoise) {
  const Simulation s = simulate({.motion = Motion::orbit, .noise_px = 0});
  const auto four =
      fit_homography(s.window.points_px[0].leftCols(4), s.window.points_px[29].leftCols(4));
  const auto all = fit_homography(s.window.points_px[0], s.window.points_px[29]);
  EXPECT_LT(largest_difference_px(*four, s.window.H_i1[29]), 1e-5);
  EXPECT_LT(largest_difference_px(*all, s.window.H_i1[29]), 1e-7);
}

TEST(Homography, RefinementMatchesOpenCvUnlessPointsAreCollinearOrTooFew) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Simulation s = simulate({.motion = Motion::wander, .seed = seed});
    const auto& from = s.window.points_px[0];
    const auto& to = s.window.points_px[20];
    Matrix3d theirs;
    cv::cv2eigen(cv::findHomography(to_points(from), to_points(to), 0), theirs);
    const Matrix3d ours = refine_homography(*fit_homography(from, to), from, to);
    EXPECT_LT(largest_difference_px(ours, theirs), 0.01);
  }
  Eigen::Matrix2Xd line(2, 6);
  line << 0, 1, 2, 3, 4, 5, 0, 2, 4, 6, 8, 10;
  EXPECT_FALSE(fit_homography(line, line));
  EXPECT_FALSE(fit_homography(line.leftCols(4), line.leftCols(4)));
  EXPECT_FALSE(
      homography_ransac(Eigen::Matrix2Xd::Random(2, 3), Eigen::Matrix2Xd::Random(2, 3), {}));
}

TEST(HomographyRansac, FindsExactlyTheInliersRepeatablyAndKeepsAllIfDisabled) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Simulation s = simulate({.motion = Motion::sideways, .off_plane = 0.3, .seed = seed});
    const auto found =
        homography_ransac(s.window.points_px[0], s.window.points_px[29], {.seed = seed});
    ASSERT_TRUE(found);
    int wrong = 0;
    for (int j = 0; j < 150; ++j) wrong += found->inlier[j] != s.on_plane[j] ? 1 : 0;
    EXPECT_LE(wrong, 3);  // noise of 0.5 px against a threshold of 2 px
    EXPECT_LT(largest_difference_px(found->H, s.window.H_i1[29]), 2.0);
  }
  const Simulation s = simulate({.off_plane = 0.3});
  const auto a = homography_ransac(s.window.points_px[0], s.window.points_px[29], {.seed = 5});
  const auto b = homography_ransac(s.window.points_px[0], s.window.points_px[29], {.seed = 5});
  EXPECT_EQ(a->H, b->H);
  EXPECT_EQ(a->inlier, b->inlier);
  const auto off =
      homography_ransac(s.window.points_px[0], s.window.points_px[29], {.enabled = false});
  EXPECT_EQ(std::ranges::count(off->inlier, true), 150);
}

Matrix3d homography_of(const HomographyMotion& m) {
  return m.R_21 * (Matrix3d::Identity() - m.tau * m.normal.transpose());
}

/// A motion of up to about 0.8 d with the plane in front, and H with any scale and sign.
struct RandomMotion {
  HomographyMotion motion;
  Matrix3d H;
};

RandomMotion random_motion(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto vector = [&] { return Vector3d(uniform(random), uniform(random), uniform(random)); };
  RandomMotion r;
  r.motion.R_21 = so3_exp(0.4 * vector());
  r.motion.tau = 0.45 * vector();
  r.motion.normal = (Vector3d(0, 0, -1) + 0.8 * vector()).normalized();
  r.H = 7 * uniform(random) * homography_of(r.motion);
  return r;
}

double difference(const HomographyMotion& a, const HomographyMotion& b) {
  const Vector3d parts(
      largest(a.R_21 - b.R_21), largest(a.tau - b.tau), largest(a.normal - b.normal));
  return largest(parts);
}

double nearest(const std::vector<HomographyMotion>& motions, const HomographyMotion& wanted) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& motion : motions) least = std::min(least, difference(motion, wanted));
  return least;
}

double scale_error(const Matrix3d& a, const Matrix3d& b) {
  const Matrix3d a1 = a / a.norm();
  const Matrix3d b1 = b / b.norm();
  return std::min((a1 - b1).norm(), (a1 + b1).norm());
}

TEST(Decomposition, ContainsTrueMotionAndTwinUnlessTheyCoincideOrTheCameraOnlyRotates) {
  for (std::uint64_t seed = 1; seed <= 1000; ++seed) {
    const RandomMotion truth = random_motion(seed);
    const auto motions = decompose_homography(truth.H);
    EXPECT_EQ(motions.size(), 4U);
    EXPECT_LT(nearest(motions, truth.motion), 1e-6) << seed;
    for (std::size_t k = 0; k < motions.size(); k += 2) {  // both signs
      EXPECT_EQ(motions[k].R_21, motions[k + 1].R_21);
      EXPECT_EQ(motions[k].tau, -motions[k + 1].tau);
      EXPECT_EQ(motions[k].normal, -motions[k + 1].normal);
    }
    for (const HomographyMotion& m : motions) {
      EXPECT_LT((m.R_21.transpose() * m.R_21 - Matrix3d::Identity()).norm(), 1e-9) << seed;
      EXPECT_NEAR(m.R_21.determinant(), 1, 1e-9) << seed;
      EXPECT_NEAR(m.normal.norm(), 1, 1e-12) << seed;
      EXPECT_LT(scale_error(homography_of(m), truth.H), 1e-10) << seed;
    }
  }
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    HomographyMotion truth = random_motion(seed).motion;
    truth.tau = (seed % 2 == 0 ? 0.3 : -0.4) * truth.normal;
    const auto motions = decompose_homography(homography_of(truth));
    ASSERT_FALSE(motions.empty());
    int same = 0;
    for (const HomographyMotion& motion : motions) {
      EXPECT_TRUE(motion.R_21.allFinite() && motion.tau.allFinite() && motion.normal.allFinite());
      same += difference(motion, truth) < 1e-6 ? 1 : 0;
    }
    EXPECT_EQ(same, 2) << seed;
  }
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const Matrix3d R = random_motion(seed).motion.R_21;
    EXPECT_TRUE(decompose_homography(R).empty());
    EXPECT_TRUE(decompose_homography(-3 * R).empty());
  }
  const Matrix3d flat = Vector3d(1, 2, 3).asDiagonal() * Matrix3d::Ones();
  EXPECT_TRUE(decompose_homography(flat).empty());
  EXPECT_TRUE(decompose_homography(Matrix3d::Zero()).empty());
  EXPECT_TRUE(decompose_homography(Matrix3d::Constant(std::nan(""))).empty());
}

TEST(Decomposition, MatchesOpenCv) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const RandomMotion truth = random_motion(seed);
    const Matrix3d positive = truth.H.determinant() > 0 ? truth.H : Matrix3d(-truth.H);
    cv::Mat H;
    cv::eigen2cv(positive, H);
    std::vector<cv::Mat> R_cv, t_cv, n_cv;
    cv::decomposeHomographyMat(H, cv::Mat::eye(3, 3, CV_64F), R_cv, t_cv, n_cv);
    ASSERT_EQ(R_cv.size(), 4U);
    const auto ours = decompose_homography(truth.H);
    for (std::size_t k = 0; k < 4; ++k) {
      HomographyMotion theirs;  // H' = R + t n^T = R (I - tau n^T)
      Vector3d t;
      cv::cv2eigen(R_cv[k], theirs.R_21);
      cv::cv2eigen(t_cv[k], t);
      cv::cv2eigen(n_cv[k], theirs.normal);
      theirs.tau = -theirs.R_21.transpose() * t;
      EXPECT_LT(nearest(ours, theirs), 1e-6) << seed;
    }
  }
}

TEST(Decomposition, FeasibleMotionsContainTruthAndPointsBehindCamerasAreCounted) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Simulation s = simulate({.motion = Motion::orbit, .noise_px = 0, .seed = seed});
    const auto motions = decompose_homography(s.window.H_i1[29], s.window.K, s.window.points_px[0]);
    EXPECT_THAT(motions.size(), testing::AnyOf(1, 2));
    const HomographyMotion truth{
        s.cameras[29].R_wc.transpose(), -s.cameras[29].p_wc, s.plane.normal};
    EXPECT_LT(nearest(motions, truth), 1e-6);
  }
  Eigen::Matrix3Xd rays(3, 2);
  rays << 0, 0.5, 0, 0, 1, 1;
  const Vector3d facing(0, 0, -1);
  const Matrix3d I = Matrix3d::Identity();
  EXPECT_EQ(points_behind({I, Vector3d(0.1, 0, 0), facing}, rays), 0);
  EXPECT_EQ(points_behind({I, Vector3d(0.1, 0, 0), -facing}, rays), 2);
  EXPECT_EQ(points_behind({so3_exp({0, 3, 0}), Vector3d(0.1, 0, 0), facing}, rays), 2);
  EXPECT_EQ(points_behind({I, Vector3d(0, 0, -1.5), facing}, rays), 2);  // beyond the plane
}

TEST(Decomposition, OnePointOverTheHorizonOfAFloorDoesNotRejectTheTrueMotion) {
  const HomographyMotion truth{so3_exp({0.02, -0.05, 0.01}), {0.3, 0, 0.4}, {0, -1, 0}};
  const Matrix3d K = Vector3d(500, 500, 1).asDiagonal();
  Eigen::Matrix2Xd visible_px(2, 100);
  for (int j = 0; j < 100; ++j) visible_px.col(j) << -250 + 5 * j, 5 + 2 * j;
  const Matrix3d H = K * homography_of(truth) * K.inverse();
  for (const int beyond : {0, 1, 3}) {
    visible_px.row(1).head(beyond).setConstant(-0.5);
    const double error = nearest(decompose_homography(H, K, visible_px), truth);
    EXPECT_EQ(error < 1e-9, beyond <= 2) << beyond;
  }
}

constexpr double kDelta = 1e-6;

struct TransferCase {
  FrameState state;
  Vector3d ray;
};

TransferCase random_case(std::uint64_t seed) {
  std::srand(static_cast<unsigned>(seed));
  TransferCase c;
  c.state.R_cw = so3_exp(0.2 * Vector3d::Random());
  c.ray = (0.4 * Eigen::Vector2d::Random()).homogeneous();
  c.state.normal = (Vector3d(0, 0, -1) + 0.5 * Vector3d::Random()).normalized();
  c.state.tangents = normal_tangents(c.state.normal);
  c.state.tau_c = 0.3 * Vector3d::Random();
  c.state.fx = 480;
  c.state.fy = 500;
  return c;
}

/// Returns the pixel after a step over (normal, phi, t).
Eigen::Vector2d pixel_after(const TransferCase& c, const Eigen::Matrix<double, 9, 1>& step) {
  FrameState state = c.state;
  state.normal += step.head<3>();
  const Eigen::Matrix3d turned = so3_exp(step.segment<3>(3)).transpose();
  state.R_cw = turned * state.R_cw;
  state.tau_c = turned * (state.tau_c + step.tail<3>());
  return transfer_on_plane(state, c.ray).pixel;
}

TEST(Transfer, MatchesProjectionOfPlanePointAndFiniteDifferences) {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const TransferCase c = random_case(seed);
    const FrameState& s = c.state;
    const Transfer t = transfer_on_plane(s, c.ray);
    const Vector3d point = c.ray * (-1 / s.normal.dot(c.ray));  // on n.P + 1 = 0
    const Vector3d seen = s.R_cw * point + s.tau_c;             // p_wc = -d tau
    const Eigen::Vector2d expected(s.fx * seen.x() / seen.z(), s.fy * seen.y() / seen.z());
    EXPECT_LT((t.pixel - expected).norm(), 1e-9);
    EXPECT_EQ(t.in_front(), t.y.z() > 0);
    Eigen::Matrix<double, 2, 9> J;
    J << t.d_normal(), t.d_rotation(), t.d_translation();
    for (int k = 0; k < 9; ++k) {
      const Eigen::Matrix<double, 9, 1> h = kDelta * Eigen::Matrix<double, 9, 1>::Unit(k);
      const Eigen::Vector2d d = (pixel_after(c, h) - pixel_after(c, -h)) / (2 * kDelta);
      EXPECT_LT((J.col(k) - d).norm(), 1e-6 * std::max(1.0, d.norm())) << k;
    }
    const Eigen::Matrix<double, 2, 8> all = t.jacobian(s.tangents);
    EXPECT_EQ(all.leftCols<2>(), t.d_normal() * s.tangents);
    EXPECT_EQ(all.rightCols<6>(), J.rightCols<6>());
  }
}

}  // namespace
}  // namespace gpo::test
