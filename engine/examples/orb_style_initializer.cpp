// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// A replacement for the two-view reconstruction of ORB-SLAM-like systems with the same interface:
// call it with the keypoints of the initial and the current frame and their matches, for each frame
// until it returns true. It stores the matches of earlier frames and uses all of them.
//   orb_style_initializer FOLDER FX FY CX CY: tries it on a folder of images.
#include <algorithm>
#include <iostream>
#include <string>
#include <vector>

#include <gpo/initialize.h>
#include <opencv2/features2d.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

class GpoReconstruction {
 public:
  /// K applies to undistorted keypoints.
  explicit GpoReconstruction(const cv::Matx33d& K)
      : camera_{.fx = K(0, 0), .fy = K(1, 1), .cx = K(0, 2), .cy = K(1, 2)} {}

  /// vMatches12: index of the current keypoint for each initial one, or -1. T21 transforms points
  /// from the initial to the current camera; unit: the plane's distance. Restarts if the initial
  /// frame changes.
  bool Reconstruct(const std::vector<cv::KeyPoint>& vKeys1,
                   const std::vector<cv::KeyPoint>& vKeys2,
                   const std::vector<int>& vMatches12,
                   cv::Matx44d& T21,
                   std::vector<cv::Point3f>& vP3D,
                   std::vector<bool>& vbTriangulated) {
    if (frames_.empty() || !is_initial(vKeys1)) begin(vKeys1);
    gpo::Frame frame{
        .timestamp_ns = frames_.back().timestamp_ns + 33'333'333, .ids = {}, .raw_px = {}};
    frame.raw_px.resize(2, static_cast<Eigen::Index>(vKeys1.size()));
    for (std::size_t k = 0; k < vMatches12.size(); ++k) {
      if (vMatches12[k] < 0) continue;
      const cv::Point2f& p = vKeys2[vMatches12[k]].pt;
      frame.raw_px.col(static_cast<Eigen::Index>(frame.ids.size())) << p.x, p.y;
      frame.ids.push_back(static_cast<std::int64_t>(k));
    }
    frame.raw_px.conservativeResize(2, static_cast<Eigen::Index>(frame.ids.size()));
    frames_.push_back(std::move(frame));
    const gpo::WindowResult result = gpo::initialize(camera_, frames_);
    reason_ = result.why_not_ready();
    if (!result.is_ready()) return false;

    const gpo::Pose& now = result.initialization.cameras.back();
    const Eigen::Matrix3d R = now.R_wc.transpose();
    const Eigen::Vector3d t = -R * now.p_wc;
    T21 = cv::Matx44d::eye();
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) T21(i, j) = R(i, j);
      T21(i, 3) = t(i);
    }
    vP3D.assign(vKeys1.size(), {});
    vbTriangulated.assign(vKeys1.size(), false);
    for (const gpo::MapPoint& point : result.initialization.points) {
      const auto k = static_cast<std::size_t>(result.ids[point.track]);
      const Eigen::Vector3f p = point.position.cast<float>();
      vP3D[k] = {p.x(), p.y(), p.z()};
      vbTriangulated[k] = vMatches12[k] >= 0;
    }
    return true;
  }

  /// Returns the reason why the last call failed.
  const std::string& reason() const { return reason_; }

 private:
  bool is_initial(const std::vector<cv::KeyPoint>& keys) const {
    const auto& px = frames_.front().raw_px;
    return px.cols() == static_cast<Eigen::Index>(keys.size()) &&
           (keys.empty() || (px(0, 0) == keys[0].pt.x && px(1, 0) == keys[0].pt.y));
  }
  void begin(const std::vector<cv::KeyPoint>& keys) {
    gpo::Frame frame{.timestamp_ns = 0, .ids = {}, .raw_px = {}};
    frame.raw_px.resize(2, static_cast<Eigen::Index>(keys.size()));
    for (std::size_t k = 0; k < keys.size(); ++k) {
      frame.ids.push_back(static_cast<std::int64_t>(k));
      frame.raw_px.col(static_cast<Eigen::Index>(k)) << keys[k].pt.x, keys[k].pt.y;
    }
    frames_ = {std::move(frame)};
  }

  gpo::Camera camera_;
  std::vector<gpo::Frame> frames_;
  std::string reason_;
};

namespace {

struct Features {
  std::vector<cv::KeyPoint> keys;
  cv::Mat descriptors;
};

/// Detects features on the finest level only, because others are too inaccurate (as in ORB-SLAM's
/// initialization).
Features features_of(const std::string& file) {
  Features features;
  cv::ORB::create(1500, 1.2F, 1)
      ->detectAndCompute(
          cv::imread(file, cv::IMREAD_GRAYSCALE), {}, features.keys, features.descriptors);
  return features;
}

std::vector<int> matches_of(const Features& from, const Features& to) {
  std::vector<cv::DMatch> found;
  cv::BFMatcher(cv::NORM_HAMMING, true).match(from.descriptors, to.descriptors, found);
  std::vector<int> matches(from.keys.size(), -1);
  for (const cv::DMatch& m : found) {
    const double distance_px = cv::norm(from.keys[m.queryIdx].pt - to.keys[m.trainIdx].pt);
    if (m.distance < 40 && distance_px < 100) matches[m.queryIdx] = m.trainIdx;
  }
  return matches;
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 6) return 2;
  std::vector<std::string> files;
  cv::glob(std::string(argv[1]) + "/*.*", files);
  const auto number = [&](int k) { return std::stod(argv[k]); };
  const cv::Matx33d K(number(2), 0, number(4), 0, number(3), number(5), 0, 0, 1);
  GpoReconstruction reconstruction(K);
  const Features first = features_of(files.at(0));
  for (std::size_t i = 2; i < files.size(); i += 2) {
    const Features now = features_of(files[i]);
    cv::Matx44d T21;
    std::vector<cv::Point3f> points;
    std::vector<bool> triangulated;
    if (!reconstruction.Reconstruct(
            first.keys, now.keys, matches_of(first, now), T21, points, triangulated)) {
      std::cerr << "image " << i << ": " << reconstruction.reason() << '\n';
      continue;
    }
    const auto count = std::count(triangulated.begin(), triangulated.end(), true);
    std::cout << "initialized by image " << i << ", points " << count << "\nT21\n" << T21 << '\n';
    return 0;
  }
  return 1;
} catch (const std::exception& error) {
  std::cerr << error.what() << '\n';
  return 2;
}
