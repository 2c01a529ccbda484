// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/recording/bags/messages.h"
#include "engine/recording/recording.h"

#include <chrono>

namespace gpo {

struct Calibration;

struct OpenOptions {
  std::optional<fs::path> tracks;  ///< replaces the built-in tracker
  std::size_t cache_bytes = FrameCache::kDefaultByteLimit;
  fs::path cache_folder{};  ///< for detections in images; empty: do not cache
  TopicChoices topics{};    ///< for a bag
  ReadProgress progress{};  ///< while a video or a bag is indexed
  int first_frames = 0;  ///< stops there in a long video without an index or other files; 0: never
};

/// One way in which recordings are stored.
struct Layout {
  const char* title = "";     ///< for people: "EuRoC"
  const char* expected = "";  ///< item of the list of layouts: "cam0/data.csv (EuRoC)"
  const char* file = "";      ///< name of a file that may be opened in place of its folder
  /// Returns the argument of `read` if the path (a folder or a file) has this layout.
  std::optional<fs::path> (*find)(const fs::path& path);
  /// Throws InputError. With tracks, images may be missing.
  Recording (*read)(const fs::path& found, const OpenOptions& options);
  /// Returns whether there are no images, so that tracks beside it are used. null: never.
  bool (*lacks_images)(const fs::path& found) = nullptr;
  bool has_topics = false;
  bool tracks_alone = false;  ///< a folder with tracks and no other layout
};

/// All layouts in the order of their precedence.
std::span<const Layout> layouts();

/// Summary of a folder or a file from its list of frames, without decoding or computing anything.
struct PathProbe {
  std::string layout;  ///< "EuRoC"; empty: no recording
  int frames = 0;      ///< 0: unreadable, or it takes too long to count them
  double seconds = 0;
};

/// Reads no more of a video or a bag than `time_limit` allows. Reports no error.
PathProbe probe_path(const fs::path& path, std::chrono::milliseconds time_limit);

// The layouts' readers and their finders. All throw InputError.

/// Returns the folder that contains cam0: this one, or mav0 in it.
std::optional<fs::path> find_euroc(const fs::path& folder);
/// Reads EuRoC / ASL from the folder of cam0. With tracks, images may be missing; one drops all.
Recording read_euroc(const fs::path& folder, const OpenOptions& options);
bool euroc_lacks_images(const fs::path& folder);

std::optional<fs::path> find_tum(const fs::path& folder);
/// Reads rgb.txt and its images, groundtruth.txt (camera poses) and a calibration. No depth.
Recording read_tum(const fs::path& folder, const OpenOptions& options);

std::optional<fs::path> find_images(const fs::path& path);
/// Reads a video or numbered images and what is beside it: calibration, gyro.csv, time stamps and
/// groundtruth.txt. Images are optional with tracks; a missing calibration is guessed without.
Recording read_images(const fs::path& path, const OpenOptions& options);
/// Opens only the images of any layout, of any size, without a calibration.
std::shared_ptr<const FrameCache> open_images(const fs::path& path,
                                              std::size_t cache_bytes,
                                              const TopicChoices& topics = {});

std::optional<fs::path> find_bag(const fs::path& path);
/// Reads a ROS bag and beside it camera.yaml, imu.yaml, groundtruth.txt and groundtruth.yaml.
Recording read_bag(const fs::path& path, const OpenOptions& options);
std::shared_ptr<const FrameCache> open_bag_images(const fs::path& path,
                                                  std::size_t cache_bytes,
                                                  const TopicChoices& choices);

/// Reads `frame,track,x,y` [raw px], sorted by frame, then track. Frames are below `frame_count`.
std::vector<TrackObservation> read_tracks(const fs::path& file, std::optional<int> frame_count);

/// Reads the poses of a data set's images into the recording's truth, if it has none: those of
/// KITTI odometry, 7-Scenes, Replica, a COLMAP project or nerfstudio. Files that cannot be read are
/// reported with the reason.
void add_data_set_truth(Recording& recording, const fs::path& folder);

/// Opens any layout. Checks that all images exist, but decodes only the first. Throws InputError.
std::shared_ptr<const Recording> open_recording(const fs::path& path,
                                                const OpenOptions& options = {});

/// Returns whether the recording was read from this file.
bool is_read_from(const Recording& recording, const fs::path& file);
/// Throws InputError if the recording was read from this file, so that it would be lost.
void check_not_overwritten(const Recording& recording, const fs::path& output);

/// An interval without varying rates and image motion, in which the mean rate is the bias.
struct StationaryInterval {
  std::int64_t first_ns = 0;  ///< camera's clock
  std::int64_t last_ns = 0;
  Eigen::Vector3d mean_rad_s = Eigen::Vector3d::Zero();  ///< the gyroscope's axes
  double sigma_rad_s = 0;  ///< each axis: gyroscope noise and undetected image motion
};

/// Finds the longest stationary interval of at least 0.75 s; nullopt if there is none. Uses images
/// (or tracks) only if the gyroscope seems stationary. Throws InputError if an image is unreadable.
std::optional<StationaryInterval> find_stationary_interval(const Recording& recording);

/// A camera's field of view as stored in an image or a video.
struct FieldOfView {
  double focal_diagonals = 0;  ///< focal length [diagonals of the image]
  bool fisheye = false;        ///< equidistant: distances in the image are proportional to angles
  std::string source;          ///< for people: "EXIF: 26 mm equivalent"
};

/// nullopt if it is missing, unreadable or implausible: outside of 10 to 170 deg or 5 to 500 mm.
std::optional<FieldOfView> stored_view(const fs::path& file);

/// Returns the clockwise quarter turns that the first file's EXIF asks for, without its mirroring;
/// 0 if that file is no image.
int quarter_turns_of_exif(std::span<const fs::path> image_files);

/// From EXIF: the 35 mm equivalent focal length, or the real one and the sensor's pixel size.
std::optional<FieldOfView> view_of_exif(const fs::path& image);

/// By the 35 mm equivalent focal length, which need not include the crop of the stabilization.
std::optional<FieldOfView> view_of_metadata(const fs::path& video);

/// From a GoPro's settings (`gopro_settings`): the diagonal angle (ZFOV) of a fisheye, or of a
/// pinhole if the camera has linearized its images (VFOV).
std::optional<FieldOfView> view_of_gpmf(std::string_view settings);

/// Replaces a recording's camera, with a note unless it is from a file. `detail` is for people.
void set_camera(Recording& recording,
                const Camera& camera,
                CameraSource source,
                const std::string& detail);

/// Keeps a guess or a self-calibrated camera as what its file says it is.
void take_source(Recording& recording, const Calibration& calibration);

/// Throws InputError if neither images nor the calibration state the size of the images.
void check_image_size(const Recording& recording, const fs::path& calibration_file);

/// Guesses a camera from the known size of the images and their stored field of view, or the usual
/// one (kUsualView_deg). `pixel_aspect`: width of a pixel divided by its height.
void guess_camera(Recording& recording,
                  const std::optional<FieldOfView>& view = {},
                  double pixel_aspect = 1);

}  // namespace gpo
