// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/files/refuse.h"
#include "engine/files/text_file.h"
#include "engine/recording/companions/companion_files.h"
#include "engine/recording/images/images.h"
#include "engine/recording/layouts/open_recording.h"

namespace gpo {
namespace {

struct OpenedBag {
  std::shared_ptr<const Bag> bag;
  TopicRoles roles;
  BagContents contents;

  const BagTopic& topic(TopicRole role) const { return bag->topics[*roles.of(role)]; }
  TopicRole role_of_rates() const {
    return roles.of(TopicRole::imu) ? TopicRole::imu : TopicRole::gyroscope;
  }
  std::string name(TopicRole role) const {
    return fmt::format("{}: {}", bag->file.string(), topic(role).name);
  }
};

/// Accelerations of a topic of their own are at the rates' times afterwards.
void join_topics_of_imu(OpenedBag& opened) {
  BagContents& contents = opened.contents;
  if (contents.accelerometer.empty()) return;
  const std::string& frame = contents.accelerometer.front().header.frame_id;
  const auto T =
      transform_between(contents.transforms, contents.imu.front().header.frame_id, frame);
  join_accelerations(contents, T.value_or(Pose{}).R_wc);
}

OpenedBag open_with_roles(const fs::path& path,
                          const TopicChoices& choices,
                          const ReadProgress& progress) {
  OpenedBag opened;
  opened.bag = std::make_shared<const Bag>(open_recorded_bag(find_bag_files(path), progress));
  opened.roles = topic_roles(*opened.bag, choices);
  opened.contents = read_contents(*opened.bag, opened.roles, progress);
  join_topics_of_imu(opened);
  return opened;
}

std::shared_ptr<const FrameCache> images_of(const OpenedBag& opened,
                                            Camera& camera,
                                            std::size_t cache_bytes) {
  const auto& messages = opened.contents.images;
  const auto read = [bag = opened.bag, topic = opened.topic(TopicRole::image), messages](
                        int frame) {
    const std::string name = fmt::format("{}: {}: image {}", bag->file.string(), topic.name, frame);
    return NamedImage{bag_image(bag->read(messages[frame], kWholeMessage), topic, name), name};
  };
  return cache_images(static_cast<int>(messages.size()), read, camera, cache_bytes);
}

std::optional<Calibration> calibration_of(const OpenedBag& opened,
                                          const fs::path& folder,
                                          Recording& recording) {
  CalibrationSearch search = search_calibration({folder});
  const auto& info = opened.contents.camera_info;
  const bool calibrated = info.has_value();
  if (const auto file = if_file(folder / "camera.yaml")) {
    if (calibrated)
      recording.notes.push_back("using camera.yaml instead of " +
                                opened.topic(TopicRole::camera_info).name);
    search.file = *file;
  } else if (calibrated && search.file) {
    search.unused.push_back({*search.file, "", "the bag has a calibration"});
    search.file.reset();
  }
  const auto beside = search.file ? std::optional(read_calibration(*search.file)) : std::nullopt;
  report_calibration(recording, search, beside.value_or(Calibration{}));
  if (beside || !calibrated) return beside;
  Calibration calibration;
  calibration.camera = camera_of(*info, opened.name(TopicRole::camera_info));
  if (lacks_matrix(*info))
    recording.notes.push_back(opened.topic(TopicRole::camera_info).name +
                              ": K is zero, using P instead");
  return calibration;
}

/// Returns whether a device has the sensor: some drivers write zeros for one that it lacks.
bool is_measured(const std::vector<ImuMessage>& samples,
                 std::optional<Eigen::Vector3d> ImuMessage::*sensor) {
  return std::ranges::all_of(samples, [&](const auto& one) { return (one.*sensor).has_value(); }) &&
         std::ranges::any_of(samples, [&](const auto& one) { return !(one.*sensor)->isZero(0); });
}

Gyroscope gyroscope_of(const OpenedBag& opened) {
  Gyroscope gyroscope;
  gyroscope.file = opened.bag->file;
  AccelerationSamples forces;
  const auto& samples = opened.contents.imu;
  const bool accelerations = is_measured(samples, &ImuMessage::linear_acceleration);
  for (const ImuMessage& sample : samples) {
    if (accelerations && sample.linear_acceleration->allFinite()) {
      forces.timestamps_ns.push_back(sample.header.stamp_ns);
      forces.specific_force.push_back(*sample.linear_acceleration);
    }
    if (!sample.angular_velocity->allFinite()) {
      ++gyroscope.left_out;
      continue;
    }
    gyroscope.timestamps_ns.push_back(sample.header.stamp_ns);
    gyroscope.lines.push_back(static_cast<int>(gyroscope.lines.size()) + 1);
    gyroscope.rates_rad_s.push_back(*sample.angular_velocity);
  }
  if (gyroscope.rates_rad_s.empty())
    refuse(opened.name(opened.role_of_rates()), "no sample is finite");
  add_accelerations(forces, gyroscope);
  return gyroscope;
}

/// Returns the name of a frame for people, `unnamed` if it is empty.
std::string frame_text(const std::string& name, const char* unnamed) {
  return name.empty() ? unnamed : legible(name, 60);
}

std::string camera_frame_text(const BagContents& contents) {
  return frame_text(contents.camera_frame, "the camera");
}

void add_gyroscope(Recording& recording,
                   const OpenedBag& opened,
                   const Calibration& calibration,
                   const fs::path& folder) {
  recording.T_body_camera = calibration.T_body_camera;
  if (!opened.roles.of(opened.role_of_rates())) return;
  const auto& contents = opened.contents;
  const std::string& imu_frame = contents.imu.front().header.frame_id;
  if (!recording.T_body_camera)
    recording.T_body_camera =
        transform_between(contents.transforms, imu_frame, contents.camera_frame);
  if (!recording.T_body_camera)
    recording.notes.push_back(fmt::format(
        "no /tf_static from {} to {}: assuming that the gyroscope has the camera's axes",
        frame_text(imu_frame, "the gyroscope"),
        camera_frame_text(contents)));
  if (!is_measured(contents.imu, &ImuMessage::angular_velocity)) {
    recording.notes.push_back(opened.topic(opened.role_of_rates()).name +
                              ": not used, it has no angular velocities");
    return;
  }
  Gyroscope gyroscope = gyroscope_of(opened);
  gyroscope.R_gyro_camera = recording.T_body_camera.value_or(Pose{}).R_wc;
  gyroscope.time_offset_ns = calibration.time_offset_ns;
  if (const auto file = if_file(folder / "imu.yaml"))
    set_bias(gyroscope, read_imu_calibration(*file), "imu.yaml");
  recording.gyroscope = std::move(gyroscope);
}

PosePath path_of(const OpenedBag& opened) {
  PosePath path;
  for (const PoseMessage& one : opened.contents.truth) {
    if (!one.position.allFinite() || !one.quaternion_xyzw.allFinite()) {
      ++path.left_out;
      continue;
    }
    const auto pose = one.pose();
    if (!pose)
      refuse(opened.name(TopicRole::truth),
             "at {} ns: found a quaternion of norm {:g}, expected a unit quaternion",
             one.header.stamp_ns,
             one.quaternion_xyzw.norm());
    path.timestamps_ns.push_back(one.header.stamp_ns);
    path.poses.push_back(*pose);
  }
  if (path.poses.empty()) refuse(opened.name(TopicRole::truth), "no pose is finite");
  path.longest_gap_ns = usual_longest_gap_ns(path.timestamps_ns);
  return path;
}

void add_truth(Recording& recording, const OpenedBag& opened, const fs::path& folder) {
  if (!opened.roles.of(TopicRole::truth)) {
    recording.truth = truth_beside(folder, recording.timestamps_ns);
    return;
  }
  const auto& contents = opened.contents;
  PosePath path = path_of(opened);
  TruthMounting mounting;
  const std::string& measured = contents.truth.front().child_frame_id;
  const std::string& name = opened.topic(TopicRole::truth).name;
  if (const auto T = transform_between(contents.transforms, measured, contents.camera_frame)) {
    mounting.T_measured_camera = *T;
  } else if (!is_file(folder / "groundtruth.yaml")) {
    recording.notes.push_back(
        fmt::format("no /tf_static from the frame of {}{} to {}: assuming that it is the camera's",
                    name,
                    measured.empty() ? "" : ", " + legible(measured, 60) + ",",
                    camera_frame_text(contents)));
  }
  read_mounting_beside(folder, path, mounting);
  recording.truth = camera_truth(path, mounting, name, recording.timestamps_ns);
}

}  // namespace

std::optional<fs::path> find_bag(const fs::path& path) {
  const bool found = is_folder(path)
                         ? has_bag_metadata(path) || !files_of_kind(path, FileKind::bag).empty()
                         : kind_of(path) == FileKind::bag;
  return found ? std::optional(path) : std::nullopt;
}

Recording read_bag(const fs::path& path, const OpenOptions& options) {
  const OpenedBag opened = open_with_roles(path, options.topics, options.progress);
  const fs::path folder = folder_of(opened.bag->file);
  Recording recording;
  for (const auto* notes : {&opened.bag->notes, &opened.roles.notes, &opened.contents.notes})
    recording.notes.insert(recording.notes.end(), notes->begin(), notes->end());
  const auto found = calibration_of(opened, folder, recording);
  const Calibration calibration = found.value_or(Calibration{});
  recording.camera = calibration.camera;
  recording.timestamps_ns = opened.contents.image_times_ns;
  recording.images = images_of(opened, recording.camera, options.cache_bytes);
  if (!found) guess_camera(recording);
  take_source(recording, calibration);
  recording.image_files = opened.bag->files;
  if (options.tracks) recording.tracks = read_tracks(*options.tracks, recording.frame_count());
  add_gyroscope(recording, opened, calibration, folder);
  add_truth(recording, opened, folder);
  return recording;
}

std::shared_ptr<const FrameCache> open_bag_images(const fs::path& path,
                                                  std::size_t cache_bytes,
                                                  const TopicChoices& choices) {
  Camera of_any_size;
  return images_of(open_with_roles(path, choices, {}), of_any_size, cache_bytes);
}

}  // namespace gpo
