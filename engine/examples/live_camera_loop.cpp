// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// live_camera_loop SOURCE FX FY CX CY [--picture OUT.png]: tracks corners in a camera (SOURCE is
// its number), a video or a folder of images until a window can be initialized, then draws a cube
// on the plane. With --picture it opens no window but writes the last frame. Exit code 1 without a
// cube.
#include <filesystem>
#include <iostream>
#include <numeric>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <gpo/live.h>
#include <opencv2/calib3d.hpp>
#include <opencv2/highgui.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/video.hpp>
#include <opencv2/videoio.hpp>

namespace {

/// The frames of a camera, a video or a folder with their times [ns].
class Source {
 public:
  explicit Source(const std::string& name) {
    if (std::filesystem::is_directory(name)) {
      cv::glob(name + "/*.*", files_);
    } else if (name.find_first_not_of("0123456789") == std::string::npos) {
      capture_.open(std::stoi(name));
    } else {
      capture_.open(name);
    }
  }
  bool next(cv::Mat& image, std::int64_t& time_ns) {
    ++count_;
    time_ns = count_ * 33'333'333LL;
    if (capture_.isOpened()) return capture_.read(image);
    if (count_ > files_.size()) return false;
    image = cv::imread(files_[count_ - 1]);
    return !image.empty();
  }

 private:
  std::vector<std::string> files_;
  cv::VideoCapture capture_;
  std::size_t count_ = 0;
};

/// Corners of the first frame, tracked from frame to frame.
struct Tracker {
  cv::Mat before;
  std::vector<cv::Point2f> corners;
  std::vector<std::int64_t> ids;

  void begin(const cv::Mat& gray) {
    cv::goodFeaturesToTrack(gray, corners, 200, 0.01, 12);
    ids.resize(corners.size());
    std::iota(ids.begin(), ids.end(), std::int64_t{0});
    before = gray.clone();
  }

  void track(const cv::Mat& gray) {
    std::vector<cv::Point2f> there, back;
    std::vector<unsigned char> found, found_back;
    cv::calcOpticalFlowPyrLK(before, gray, corners, there, found, {});
    cv::calcOpticalFlowPyrLK(gray, before, there, back, found_back, {});
    std::size_t kept = 0;
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const bool inside = cv::Rect2f(0, 0, gray.cols, gray.rows).contains(there[k]);
      if (!found[k] || !found_back[k] || !inside || cv::norm(back[k] - corners[k]) > 0.5) continue;
      corners[kept] = there[k];
      ids[kept++] = ids[k];
    }
    corners.resize(kept);
    ids.resize(kept);
    before = gray.clone();
  }

  gpo::Frame frame(std::int64_t time_ns) const {
    gpo::Frame frame{.timestamp_ns = time_ns, .ids = ids, .raw_px = {}};
    frame.raw_px.resize(2, static_cast<Eigen::Index>(ids.size()));
    for (std::size_t k = 0; k < ids.size(); ++k)
      frame.raw_px.col(static_cast<Eigen::Index>(k)) << corners[k].x, corners[k].y;
    return frame;
  }
};

/// Estimates the current camera from the points of the answer that are still visible.
bool pose_now(const gpo::WindowResult& answer,
              const Tracker& now,
              const cv::Matx33d& K,
              cv::Mat& r,
              cv::Mat& t) {
  std::vector<cv::Point3d> points;
  std::vector<cv::Point2d> pixels;
  for (const gpo::MapPoint& point : answer.initialization.points) {
    for (std::size_t k = 0; k < now.ids.size(); ++k) {
      if (now.ids[k] != answer.ids[point.track]) continue;
      points.emplace_back(point.position.x(), point.position.y(), point.position.z());
      pixels.push_back(now.corners[k]);
    }
  }
  return points.size() >= 8 && cv::solvePnPRansac(points, pixels, K, {}, r, t, false, 100, 3);
}

/// Draws a cube where the optical axis meets the plane.
void draw_cube(const gpo::Plane& plane,
               const cv::Matx33d& K,
               const cv::Mat& r,
               const cv::Mat& t,
               cv::Mat& image) {
  const Eigen::Vector3d z = plane.normal;
  const Eigen::Vector3d x = (Eigen::Vector3d::UnitX() - z * z.x()).normalized();
  const Eigen::Vector3d y = z.cross(x);
  const Eigen::Vector3d base = Eigen::Vector3d::UnitZ() * (-plane.distance / z.z());
  const double side = 0.2 * plane.distance;
  std::vector<cv::Point3d> corners;
  for (int k = 0; k < 8; ++k) {
    const Eigen::Vector3d p =
        base + side * ((k % 2 - 0.5) * x + (k / 2 % 2 - 0.5) * y + (k / 4) * z);
    corners.emplace_back(p.x(), p.y(), p.z());
  }
  std::vector<cv::Point2d> at;
  cv::projectPoints(corners, r, t, K, {}, at);
  // Corners whose numbers differ in one bit share an edge.
  for (const int bit : {1, 2, 4})
    for (int a = 0; a < 8; ++a)
      if (const int b = a | bit; a != b)
        cv::line(image, at[a], at[b], {0, 220, 255}, 2, cv::LINE_AA);
}

}  // namespace

int main(int argc, char** argv) try {
  std::vector<std::string> arguments(argv + 1, argv + argc);
  std::string output;
  if (arguments.size() == 7 && arguments[5] == "--picture") output = arguments[6];
  if (arguments.size() != 5 && output.empty()) return 2;
  Source source(arguments[0]);
  cv::Mat image;
  std::int64_t time_ns = 0;
  if (!source.next(image, time_ns)) return 2;

  const gpo::Camera camera{.width = image.cols,
                           .height = image.rows,
                           .fx = std::stod(arguments[1]),
                           .fy = std::stod(arguments[2]),
                           .cx = std::stod(arguments[3]),
                           .cy = std::stod(arguments[4])};
  const cv::Matx33d K(camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1);

  gpo::LiveInitializer initializer(camera);
  Tracker tracker;
  bool drawn = false, reported = false;
  do {
    cv::Mat gray;
    cv::cvtColor(image, gray, cv::COLOR_BGR2GRAY);
    tracker.corners.empty() ? tracker.begin(gray) : tracker.track(gray);
    gpo::LiveStatus status = initializer.add_frame(tracker.frame(time_ns));
    if (status.started_anew) {
      tracker.begin(gray);
      initializer = gpo::LiveInitializer(camera);
      status = initializer.add_frame(tracker.frame(time_ns));
    }
    // Frames of a file arrive faster than those of a camera, so wait for the solver.
    if (!output.empty()) status = initializer.wait();
    cv::Mat r, t;
    drawn = status.answer && pose_now(*status.answer, tracker, K, r, t);
    if (drawn) draw_cube(status.answer->initialization.plane, K, r, t, image);
    if (status.ready && !reported) std::cout << "ready with " << status.ready_frames << " frames\n";
    reported = status.ready;
    if (!output.empty()) cv::imwrite(output, image);
    if (!output.empty()) continue;
    cv::imshow("gpo", image);
    if (cv::waitKey(1) == 27) break;
  } while (source.next(image, time_ns));
  return drawn ? 0 : 1;
} catch (const std::exception& error) {
  std::cerr << error.what() << '\n';
  return 2;
}
