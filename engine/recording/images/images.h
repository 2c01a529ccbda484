// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/files/output_file.h"
#include "engine/files/text_file.h"
#include "engine/recording/images/interlacing.h"
#include "engine/recording/recording.h"

#include <string_view>

namespace gpo {

struct PacketTimes;

/// Decodes blue, green, red, 8 or 16 bits each, as the sensor stored them: an orientation in EXIF
/// has no effect. Throws InputError for a missing or partial image.
cv::Mat read_image(const fs::path& file);
/// The same from the file's bytes; `name` replaces the file in messages.
cv::Mat decode_image(std::string_view bytes, const std::string& name);

/// Returns whether a JPEG has its end marker.
bool is_whole_jpeg(std::string_view bytes);

/// Returns the image with one channel if its three are equal.
cv::Mat gray_if_gray(const cv::Mat& bgr);

/// Finds a function of OpenCV's `imgcodecs` by its mangled name; loads it at the first call. Throws
/// InputError if it is missing.
void* find_in_imgcodecs(const char* name);

/// Throws InputError if an image of this size would be too large for memory.
void check_image_size(const std::string& name, std::uint64_t width, std::uint64_t height);

/// An image as stored, and its name in messages.
struct NamedImage {
  cv::Mat image;
  std::string name;
};
using ReadImage = std::function<NamedImage(int index)>;

/// Caches at least one image, converted to 8 bits. The first determines the camera's size if the
/// calibration lacks it, and it and, if it has 16 bits, four others the number of significant bits;
/// an image that needs more is scaled by its own. Throws InputError.
std::shared_ptr<const FrameCache> cache_images(int count,
                                               const ReadImage& read,
                                               Camera& camera,
                                               std::size_t cache_bytes);

enum class FileKind { other, image, video, bag };

/// Returns a file's kind by its first bytes, or by its name if these are unknown. A video is a file
/// that libavformat opens as one. Images with a usual name are not read. Never throws.
FileKind kind_of(const fs::path& file);

/// Returns the files of a folder with a usual name of this kind; if there are none, those with its
/// first bytes. Sorted by path. Throws InputError.
std::vector<fs::path> files_of_kind(const fs::path& folder, FileKind kind);

/// Returns whether a video is shorter than its container declares by the sizes of its parts. Its
/// other numbers (frames, duration) are only hints. Throws InputError if it is unreadable.
bool ends_early(const fs::path& file);

/// Header of an image file, readable without allocating the image.
struct ImageHeader {
  std::uint64_t width = 0;   ///< [px]
  std::uint64_t height = 0;  ///< [px]
  int bits = 8;              ///< per channel; only read from TIFF, which allows more than 16
};

/// Reads the header of a PNG, JPEG, BMP, PNM, TIFF or WebP; nullopt if unknown or truncated.
std::optional<ImageHeader> read_image_header(std::string_view bytes);

inline constexpr const char* kCalibratedResolution = "the calibrated resolution";
/// Throws InputError if an image has not the camera's size; a size of 0x0 is unknown. `expected`
/// names what the size is from.
void check_size(const fs::path& file,
                cv::Size size,
                const Camera& camera,
                const char* expected = kCalibratedResolution);

/// Sets at least one file as the recording's images, as `cache_images` does.
void add_image_files(Recording& recording,
                     const std::vector<fs::path>& files,
                     std::size_t cache_bytes);

/// Returns the numbered images of a folder in the order of their numbers: 2.png before 10.png.
std::vector<fs::path> numbered_images(const fs::path& folder);
/// Returns what has the name of a numbered image but is no file, such as a broken link, with the
/// reason.
std::vector<FoundFile> unreadable_images(const fs::path& folder);

/// Numbered images of one camera and, in the same place, other sequences.
struct ImageSequence {
  std::vector<fs::path> files;      ///< in the order of their numbers; empty: none
  std::vector<FoundFile> others;    ///< the first image of each sequence of another sensor
  std::vector<FoundFile> left_out;  ///< the same of further sequences; `unreadable_images`
};

/// Finds the color or gray images in a folder or in its usual subfolders. Never returns depth,
/// masks and the like, which their names tell.
ImageSequence find_image_sequence(const fs::path& folder);

/// Adds images that were not read to the recording's files, and one note that names them.
void report_left_out(Recording& recording, const std::vector<FoundFile>& left_out);

/// Times that all file names contain, and their unit for people.
struct TimesInNames {
  std::vector<std::int64_t> times_ns;  ///< strictly ascending
  const char* unit = "";
};

/// Recognizes seconds with decimals, milli-, micro- and nanoseconds, SEC_NSEC, and hours, minutes
/// and seconds with or without a date; nullopt unless the times of all names ascend at the rate of
/// a camera. `files` is sorted by time.
std::optional<TimesInNames> times_in_names(std::vector<fs::path>& files);

/// Times of a video's frames, in units of `unit_s` and ascending.
struct VideoIndex {
  std::vector<std::int64_t> times;      ///< all frames, strictly ascending
  std::vector<std::int64_t> key_times;  ///< frames at which decoding can begin
  double unit_s = 0;
  cv::Size size;                 ///< [px] as shown, that is after the container's rotation
  double declared_count = 0;     ///< frames according to the container; 0 if unknown
  bool estimated_count = false;  ///< whether `declared_count` is the duration times the rate
  int hidden_count = 0;  ///< frames that players do not show: trimmed, or without references
  std::vector<std::int64_t> damaged;  ///< times of left out frames whose data are incomplete
  double pixel_aspect = 1;            ///< width of a pixel divided by its height, as shown
  double rate_hz = 0;                 ///< average according to the container; 0 if unknown
  int quarter_turns = 0;              ///< clockwise rotation from the stored to the shown image
  bool mirrored = false;  ///< whether players also mirror the image; the decoder does not
  /// Field order of an interlaced video, whose first fields are decoded; nullopt if progressive.
  std::optional<FieldOrder> fields = std::nullopt;
  bool complete = true;  ///< false: `times` are only the first ones
};

/// Decodes frames of a video file in any order, with the same result as decoding the whole file
/// from its beginning. Not thread-safe.
class VideoDecoder {
 public:
  /// Lists the frames by the container's index if it is complete and agrees with samples of the
  /// packets, else by reading all packets; if they lack the frames' times, decodes each frame once.
  /// Stops after about `first_frames` where packets have to be read; 0: lists all. Throws
  /// InputError.
  explicit VideoDecoder(fs::path file, const ReadProgress& progress = {}, int first_frames = 0);
  ~VideoDecoder();
  VideoDecoder(const VideoDecoder&) = delete;
  VideoDecoder& operator=(const VideoDecoder&) = delete;

  const VideoIndex& index() const { return index_; }
  /// CV_8UC3. Throws InputError.
  cv::Mat decode(int frame);

  /// Number of frames before the requested one that are kept when stepping backward.
  static constexpr int kKept = 12;

 private:
  struct Input;
  enum class State {
    begin,    ///< the first one, after opening the file
    seeking,  ///< one near a key frame, unknown until it is decoded
    decoding  ///< the one after `last_`
  };
  enum class Numbering { by_time, by_count };

  bool index_packets(const ReadProgress& progress, int first_frames);
  PacketTimes read_packets(const ReadProgress& progress, int first_frames);
  void count_frames(const ReadProgress& progress);
  void drop_undecodable();
  void find_fields();
  int next_frame();
  int go_to(int frame);
  void restart();

  fs::path file_;
  std::unique_ptr<Input> input_;
  VideoIndex index_;
  Numbering numbering_ = Numbering::by_time;
  State state_ = State::begin;
  int last_ = 0;  ///< the frame that was decoded last
  std::map<int, cv::Mat> kept_;
};

struct VideoFile {
  std::vector<std::int64_t> timestamps_ns;  ///< all frames, strictly ascending, the first is 0
  std::shared_ptr<const FrameCache> images;
  double first_frame_s = 0;        ///< according to the container
  int quarter_turns = 0;           ///< clockwise rotation from the stored to the shown images
  double pixel_aspect = 1;         ///< width of a pixel divided by its height
  std::string first_field;         ///< see `Recording::first_field`
  std::vector<std::string> notes;  ///< see `Recording::notes`
  bool complete = true;            ///< false: only the first frames
};

/// Opens a video without decoding it, or its `first_frames` (see `VideoDecoder`); its times are the
/// container's presentation times. Sets the camera's size and, for a rotated video, the direction
/// of the readout if the calibration lacks them. Throws InputError if the video is unreadable,
/// truncated, or of another size than the camera.
VideoFile open_video(const fs::path& file,
                     Camera& camera,
                     std::size_t cache_bytes,
                     const ReadProgress& progress = {},
                     int first_frames = 0);

/// Writes an MP4 (MPEG-4 part 2) image by image. No partial file remains on failure.
class VideoEncoder {
 public:
  /// `size` must be even. Throws InputError if the file or FFmpeg's encoder cannot be opened.
  VideoEncoder(fs::path file, double rate_hz, cv::Size size);
  ~VideoEncoder();
  VideoEncoder(const VideoEncoder&) = delete;
  VideoEncoder& operator=(const VideoEncoder&) = delete;

  /// Adds an image, CV_8UC3 (BGR) of the given size. Throws InputError.
  void add(const cv::Mat& image);
  /// Completes the file. Throws InputError if it cannot be written or has no image.
  void finish();

  const fs::path& file() const { return file_; }

 private:
  struct Output;
  void check(int result) const;
  void drain();

  fs::path file_;
  AtomicFile unfinished_;
  cv::Size size_;
  int count_ = 0;
  std::unique_ptr<Output> output_;
};

/// Rounds up to an even size, as the encoder requires.
cv::Size even_size(cv::Size size);

}  // namespace gpo
