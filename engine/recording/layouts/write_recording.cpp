// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/layouts/write_recording.h"

#include "engine/files/refuse.h"
#include "engine/files/text_file.h"
#include "engine/recording/bags/messages.h"
#include "engine/recording/companions/companion_files.h"
#include "engine/recording/images/images.h"
#include "engine/recording/layouts/open_recording.h"
#include "engine/window/timestamps.h"

#include <algorithm>

#include <fmt/ranges.h>

namespace gpo {
namespace {

constexpr const char* kCamera = "camera";
constexpr const char* kImu = "imu";
constexpr const char* kWorld = "world";

enum class Topic { images, camera_info, imu, truth, tf_static };
const std::vector<BagTopic> kTopics = {{"/image_raw", "sensor_msgs/Image"},
                                       {"/camera_info", kCameraInfoType},
                                       {"/imu", kImuType},
                                       {"/ground_truth", "geometry_msgs/TransformStamped"},
                                       {"/tf_static", kTransformsType}};

struct Planned {
  Topic topic;
  std::int64_t time_ns;  ///< camera's clock
  int number;            ///< index of the image, pose or sample
};

std::vector<Planned> plan_of(const Recording& recording, const std::optional<GroundTruth>& poses) {
  std::vector<Planned> plan;
  for (int i = 0; i < recording.frame_count(); ++i) {
    const std::int64_t time = recording.timestamps_ns[i];
    plan.push_back({Topic::camera_info, time, i});
    plan.push_back({Topic::images, time, i});
    if (poses && poses->poses[i]) plan.push_back({Topic::truth, time, i});
  }
  if (const auto& gyroscope = recording.gyroscope) {
    for (std::size_t i = 0; i < gyroscope->timestamps_ns.size(); ++i)
      plan.push_back({Topic::imu,
                      gyroscope->timestamps_ns[i] - gyroscope->time_offset_ns,
                      static_cast<int>(i)});
  }
  std::ranges::stable_sort(plan, {}, &Planned::time_ns);
  const std::int64_t first = plan.front().time_ns;
  const bool mounted = recording.gyroscope && (recording.T_body_camera ||
                                               !recording.gyroscope->R_gyro_camera.isIdentity(0));
  if (mounted) plan.insert(plan.begin(), {Topic::tf_static, first, 0});
  return plan;
}

struct Messages {
  const Recording& recording;
  const std::optional<GroundTruth>& poses;
  MessageEncoding encoding;
  SteadyQuaternions steady{};

  std::string operator()(const Planned& one) {
    switch (one.topic) {
      case Topic::images:
        return image(one);
      case Topic::camera_info: {
        CameraInfoMessage info = camera_info_of(recording.camera);
        info.header = {one.time_ns, kCamera};
        return camera_info_bytes(info, encoding);
      }
      case Topic::imu:
        return sample(one);
      case Topic::truth: {
        const Pose& pose = *poses->poses[one.number];
        const Eigen::Vector4d q = steady(pose.R_wc).coeffs();
        return transform_bytes({{one.time_ns, kWorld}, kCamera, pose.p_wc, q}, encoding);
      }
      case Topic::tf_static:
        return transforms_bytes({mounting(one.time_ns)}, encoding);
    }
    return {};
  }

  std::string image(const Planned& one) const {
    const cv::Mat unpadded = gray_if_gray(recording.images->bgr(one.number));
    const cv::Mat pixels = unpadded.isContinuous() ? unpadded : unpadded.clone();
    const bool gray = pixels.channels() == 1;
    const std::size_t bytes = pixels.total() * pixels.elemSize();
    return image_bytes({.header = {one.time_ns, kCamera},
                        .height = static_cast<std::uint32_t>(pixels.rows),
                        .width = static_cast<std::uint32_t>(pixels.cols),
                        .encoding = gray ? "mono8" : "bgr8",
                        .step = static_cast<std::uint32_t>(pixels.cols * pixels.elemSize()),
                        .data = {reinterpret_cast<const char*>(pixels.data), bytes}},
                       encoding);
  }

  std::string sample(const Planned& one) const {
    const Gyroscope& gyroscope = *recording.gyroscope;
    ImuMessage message{{one.time_ns, kImu}, gyroscope.rates_rad_s[one.number], {}};
    if (!gyroscope.accelerations_m_s2.empty())
      message.linear_acceleration = gyroscope.accelerations_m_s2[one.number];
    return imu_bytes(message, encoding);
  }

  PoseMessage mounting(std::int64_t time_ns) const {
    const Eigen::Matrix3d& R_gyro_camera = recording.gyroscope->R_gyro_camera;
    const Pose T_body_camera = recording.T_body_camera.value_or(Pose{});
    const Eigen::Vector3d p_gyro =
        R_gyro_camera * T_body_camera.R_wc.transpose() * T_body_camera.p_wc;
    return {{time_ns, kImu}, kCamera, p_gyro, Eigen::Quaterniond(R_gyro_camera).coeffs()};
  }
};

std::string lens_and_source_yaml(const Recording& recording) {
  const CameraSource source = recording.camera_source;
  return lens_yaml(recording.camera) +
         (source == CameraSource::file ? "" : fmt::format("source: {}\n", to_string(source)));
}

std::string truth_yaml(const GroundTruth& truth) {
  std::string source = truth.source;
  if (const std::size_t at = source.rfind(kOriginally); at != std::string::npos)
    source.erase(0, at + kOriginally.size());
  std::ranges::replace_if(
      source, [](char c) { return c == '\\' || c == '"' || c == '\n'; }, '_');
  return fmt::format(
      "source: \"{}\"  # before the conversion\nupright: {}\n", source, truth.upright);
}

std::map<std::string, std::string> beside_bag(const Recording& recording,
                                              const std::optional<GroundTruth>& poses) {
  auto files = sidecar_texts(recording);
  const Gyroscope usual;
  const Gyroscope& gyroscope = recording.gyroscope ? *recording.gyroscope : usual;
  if (gyroscope.bias_sigma_rad_s != usual.bias_sigma_rad_s ||
      gyroscope.noise_density != usual.noise_density || !gyroscope.bias_rad_s.isZero(0))
    files["imu.yaml"] = bias_yaml(gyroscope);
  const auto has_pose = [](const auto& pose) { return pose.has_value(); };
  if (poses)
    files["groundtruth.yaml"] =
        truth_yaml(*poses) + (std::ranges::all_of(poses->poses, has_pose) ? "" : kNoInterpolation);
  const Camera& camera = recording.camera;
  if (!camera.sigmas.empty() || camera.readout || camera.readout_direction ||
      recording.camera_source != CameraSource::file)
    files["camera.yaml"] = lens_and_source_yaml(recording);
  return files;
}

/// Returns a bag in the folder, or another recording than the written one, to which the sidecar
/// files would belong, too; nullopt if there is none.
std::optional<fs::path> other_recording(const fs::path& folder, const Recording& written) {
  const auto is_other = [&](const fs::path& file) {
    const auto is_it = [&](const fs::path& one) { return same_file(one, file); };
    return !is_it(written.path) && std::ranges::none_of(written.image_files, is_it);
  };
  if (const auto bags = files_of_kind(folder, FileKind::bag); !bags.empty()) return bags.front();
  if (find_euroc(folder) && is_other(folder)) return folder;
  for (const auto& files :
       {files_of_kind(folder, FileKind::video), find_image_sequence(folder).files})
    if (const auto found = std::ranges::find_if(files, is_other); found != files.end())
      return *found;
  return std::nullopt;
}

/// Throws InputError if the sidecar files would change another recording, or its files this one.
void check_beside(const fs::path& folder,
                  const std::map<std::string, std::string>& files,
                  const Recording& recording) {
  for (const std::string& name : split(
           "plane.yaml board.yaml imu.yaml camera.yaml groundtruth.txt groundtruth.yaml tracks.csv",
           ' ')) {
    const auto ours = files.find(name);
    const auto there = if_file(folder / name);
    if (!there || (ours != files.end() && read_file(*there) == ours->second)) continue;
    refuse(*there, "belongs to another recording; choose a folder without it");
  }
  const auto is_new = [&](const auto& one) { return !is_file(folder / one.first); };
  if (!is_folder(folder) || std::ranges::none_of(files, is_new)) return;
  const std::string first = std::ranges::find_if(files, is_new)->first;
  if (const auto other = other_recording(folder, recording))
    refuse(*other,
           "would be read with the {} of the new bag; choose a folder without other recordings",
           first);
}

/// Files that are removed again unless all of them and the bag are finished.
class Sidecars {
 public:
  Sidecars() = default;
  ~Sidecars() {
    std::error_code none;
    for (const fs::path& file : written_) fs::remove(file, none);
  }
  Sidecars(const Sidecars&) = delete;
  Sidecars& operator=(const Sidecars&) = delete;

  void write(const fs::path& file, const std::string& text) {
    if (is_file(file)) return;  // with the same text, see `check_beside`
    write_file(file, text);
    written_.push_back(file);
  }
  void finish() { written_.clear(); }

 private:
  std::vector<fs::path> written_;
};

void check_bag(const Recording& recording,
               const std::vector<Planned>& plan,
               RecordingFormat format,
               const fs::path& output) {
  const bool mcap = format == RecordingFormat::mcap;
  const char* ending = mcap ? ".mcap" : ".bag";
  if (lower_case(output.extension().string()) != ending)
    refuse(output, "wrong extension, expected {}", ending);
  std::error_code none;
  if (fs::exists(output, none)) refuse(output, "already exists; choose a new file");
  if (!recording.images) refuse(recording.path, "has no images, which a bag needs");
  const std::int64_t first = plan.front().time_ns;
  const std::int64_t second = 1'000'000'000;
  if (first < (mcap ? std::numeric_limits<std::int32_t>::min() * second : 0))
    refuse(recording.path,
           "time {} ns is before 1970, which ROS 1 cannot store; choose a name that ends in .mcap",
           first);
  if (const std::int64_t last = plan.back().time_ns; last / second >> (mcap ? 31 : 32) > 0)
    refuse(recording.path,
           "time {} ns is too late for a bag, which ends in {}",
           last,
           mcap ? 2038 : 2106);
}

void write_bag(const Recording& recording,
               const std::optional<GroundTruth>& poses,
               RecordingFormat format,
               const fs::path& output,
               const WriteProgress& progress) {
  const auto plan = plan_of(recording, poses);
  check_bag(recording, plan, format, output);
  const fs::path folder = folder_of(output);
  const auto files = beside_bag(recording, poses);
  check_beside(folder, files, recording);
  make_folder(folder);
  AtomicFile unfinished(output);
  const auto open = format == RecordingFormat::mcap ? mcap_writer : ros1_writer;
  const BagWriter writer = open(unfinished.path(), kTopics);
  Messages messages{recording, poses, writer.encoding};
  for (const Planned& one : plan) {
    writer.write(static_cast<int>(one.topic), one.time_ns, messages(one));
    if (progress && one.topic == Topic::images) progress(one.number + 1, recording.frame_count());
  }
  writer.finish();
  Sidecars sidecars;
  for (const auto& [name, text] : files) sidecars.write(folder / name, text);
  unfinished.finish();
  sidecars.finish();
}

std::string camera_yaml(const Recording& recording) {
  std::string text = "sensor_type: camera\n" + lens_and_source_yaml(recording);
  if (recording.T_body_camera) text += transformation_yaml(*recording.T_body_camera);
  if (const double rate = rate_hz(recording.timestamps_ns); is_image_rate(rate))
    text += fmt::format("rate_hz: {:.6g}\n", rate);
  if (recording.gyroscope && recording.gyroscope->time_offset_ns != 0)
    text += fmt::format("timeshift_cam_imu: {}  # [s] gyroscope's clock - camera's clock\n",
                        static_cast<double>(recording.gyroscope->time_offset_ns) * 1e-9);
  return text;
}

std::string imu_yaml(const Gyroscope& gyroscope, const Pose& T_body_camera) {
  const Pose T_body_gyro{T_body_camera.R_wc * gyroscope.R_gyro_camera.transpose(),
                         Eigen::Vector3d::Zero()};
  return fmt::format("sensor_type: imu\n{}rate_hz: {}\n{}",
                     transformation_yaml(T_body_gyro),
                     rate_hz(gyroscope.timestamps_ns),
                     bias_yaml(gyroscope));
}

std::string imu_csv(const Gyroscope& gyroscope) {
  const bool accelerations = !gyroscope.accelerations_m_s2.empty();
  std::string text = std::string(kGyroscopeHead) + (accelerations ? kAccelerometerHead : "") + "\n";
  for (std::size_t i = 0; i < gyroscope.timestamps_ns.size(); ++i) {
    text += std::to_string(gyroscope.timestamps_ns[i]) + cells(gyroscope.rates_rad_s[i]);
    if (accelerations) text += cells(gyroscope.accelerations_m_s2[i]);
    text += '\n';
  }
  return text;
}

std::string truth_csv(const Recording& recording, const GroundTruth& truth) {
  std::string text = std::string("#timestamp [ns]") + kPoseHead + "\n";
  const Pose T_camera_body = inverse(recording.T_body_camera.value_or(Pose{}));
  SteadyQuaternions steady;
  for (std::size_t i = 0; i < truth.poses.size(); ++i) {
    if (!truth.poses[i]) continue;
    const Pose body = *truth.poses[i] * T_camera_body;
    text += std::to_string(recording.timestamps_ns[i]) + cells(body.p_wc) +
            quaternion_cells(steady(body.R_wc)) + "\n";
  }
  return text;
}

void write_images(const Recording& recording, const fs::path& cam, const WriteProgress& progress) {
  make_folder(cam / "data");
  std::string list = kImageListHead;
  for (int i = 0; i < recording.frame_count(); ++i) {
    const std::string name = fmt::format("{:019d}.png", recording.timestamps_ns[i]);
    list += fmt::format("{},{}\n", recording.timestamps_ns[i], name);
    if (!recording.images) continue;
    write_image(cam / "data" / name, gray_if_gray(recording.images->bgr(i)));
    if (progress) progress(i + 1, recording.frame_count());
  }
  write_file(cam / "data.csv", list);
}

void write_euroc(const Recording& recording,
                 const std::optional<GroundTruth>& truth,
                 const fs::path& folder,
                 const WriteProgress& progress) {
  AtomicFolder unfinished(folder);
  const fs::path mav = unfinished.path() / "mav0";
  make_folder(mav / "cam0");
  write_file(mav / "cam0" / "sensor.yaml", camera_yaml(recording));
  if (const auto& gyroscope = recording.gyroscope) {
    make_folder(mav / "imu0");
    write_file(mav / "imu0" / "sensor.yaml",
               imu_yaml(*gyroscope, recording.T_body_camera.value_or(Pose{})));
    write_file(mav / "imu0" / "data.csv", imu_csv(*gyroscope));
  }
  if (truth) {
    const fs::path estimate = mav / "state_groundtruth_estimate0";
    make_folder(estimate);
    write_file(estimate / "data.csv", truth_csv(recording, *truth));
    write_file(estimate / "sensor.yaml",
               "sensor_type: visual-inertial\n" + transformation_yaml(Pose{}) + truth_yaml(*truth) +
                   kNoInterpolation);
  }
  for (const auto& [name, text] : sidecar_texts(recording))
    write_file(unfinished.path() / name, text);
  write_images(recording, mav / "cam0", progress);
  unfinished.finish();
}

}  // namespace

std::string cells(const Eigen::Ref<const Eigen::VectorXd>& values, std::optional<int> decimals) {
  std::string text;
  for (const double value : values)
    text += decimals ? fmt::format(",{:.{}f}", value, *decimals) : fmt::format(",{}", value);
  return text;
}

std::string quaternion_cells(const Eigen::Quaterniond& q, std::optional<int> decimals) {
  return cells(Eigen::Vector4d(q.w(), q.x(), q.y(), q.z()), decimals);
}

Eigen::Quaterniond SteadyQuaternions::operator()(const Eigen::Matrix3d& R) {
  Eigen::Quaterniond q(R);
  if (q.dot(previous_) < 0) q.coeffs() *= -1;
  previous_ = q;
  return q;
}

std::string yaml_list(std::span<const double> values, std::optional<int> digits) {
  return digits ? fmt::format("[{:.{}g}]", fmt::join(values, ", "), *digits)
                : fmt::format("[{}]", fmt::join(values, ", "));
}

std::string yaml_list(const Eigen::Vector3d& values) {
  return yaml_list(std::span(values.data(), 3));
}

std::string transformation_yaml(const Pose& pose) {
  std::string rows;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Matrix3d& R = pose.R_wc;
    rows += fmt::format("         {}, {}, {}, {},\n", R(i, 0), R(i, 1), R(i, 2), pose.p_wc[i]);
  }
  return fmt::format("T_BS:\n  cols: 4\n  rows: 4\n  data: [\n{}         0, 0, 0, 1]\n", rows);
}

std::string bias_yaml(const Gyroscope& gyroscope) {
  std::string text;
  if (!gyroscope.bias_rad_s.isZero(0))
    text = fmt::format("gyroscope_bias: {}  # [rad/s]\n", yaml_list(gyroscope.bias_rad_s));
  return text + fmt::format(
                    "gyroscope_bias_sigma: {}  # [rad/s]\n"
                    "gyroscope_noise_density: {}  # [rad/s/sqrt(Hz)]\n",
                    gyroscope.bias_sigma_rad_s,
                    gyroscope.noise_density);
}

std::string lens_uncertainty_yaml(const Camera& camera, std::optional<int> sigma_digits) {
  // With fewer digits strong correlations are no longer positive semidefinite.
  constexpr int kCovarianceDigits = 9;
  const std::span<const double> sigmas = camera.sigmas;
  if (sigmas.empty()) return "";
  std::string text =
      fmt::format("intrinsics_sigma: {}\n", yaml_list(sigmas.first(4), sigma_digits));
  if (sigmas.size() > 4)
    text += fmt::format("distortion_coefficients_sigma: {}\n",
                        yaml_list(sigmas.subspan(4), sigma_digits));
  if (camera.covariance.empty()) return text;
  const auto digits = sigma_digits ? std::optional(kCovarianceDigits) : std::nullopt;
  return text + fmt::format("intrinsics_covariance: {}  # upper triangle, row by row\n",
                            yaml_list(camera.covariance, digits));
}

std::string readout_yaml(const Camera& camera) {
  std::string text;
  if (camera.readout_direction)
    text = fmt::format("readout_direction: {}\n", to_string(*camera.readout_direction));
  if (!camera.readout) return text;
  return text + fmt::format("readout_s: {}  # first row to last\nreadout_sigma_s: {}\n",
                            camera.readout->seconds,
                            camera.readout->sigma_s);
}

std::string lens_yaml(const Camera& camera) {
  return fmt::format(
             "resolution: [{}, {}]\ncamera_model: pinhole\nintrinsics: {}  # fx, fy, cx, cy\n"
             "distortion_model: {}\ndistortion_coefficients: {}\n",
             camera.width,
             camera.height,
             yaml_list(std::array{camera.fx, camera.fy, camera.cx, camera.cy}),
             distortion_name(camera.distortion),
             yaml_list(camera.coefficients)) +
         lens_uncertainty_yaml(camera) + readout_yaml(camera);
}

void write_recording(const Recording& recording,
                     const std::optional<GroundTruth>& truth,
                     RecordingFormat format,
                     const fs::path& output,
                     const WriteProgress& progress) {
  if (format == RecordingFormat::euroc) return write_euroc(recording, truth, output, progress);
  write_bag(recording, truth, format, output, progress);
}

}  // namespace gpo
