// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "app/commands.h"
#include "engine/error.h"
#include "engine/output_file.h"
#include "ui/views/picture_compare.h"
#include "ui/views/snapshot.h"
#include "ui/workbench_window.h"

#include <cstdio>

#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>

namespace gpo {
namespace {

namespace fs = std::filesystem;

std::optional<cv::Size> parse_size(const std::optional<std::string>& text) {
  if (!text) return std::nullopt;
  int width = 0;
  int height = 0;
  char rest = 0;
  const int read = std::sscanf(text->c_str(), "%dx%d%c", &width, &height, &rest);
  constexpr int kLeast = 16;
  constexpr int kMost = 8192;
  if (read != 2 || width < kLeast || height < kLeast || width > kMost || height > kMost) {
    throw InputError(
        fmt::format("--size: '{}', expected WIDTHxHEIGHT of {} to {} pixels, e.g. 1280x720",
                    *text,
                    kLeast,
                    kMost));
  }
  return cv::Size(width, height);
}

cv::Mat draw(const std::shared_ptr<const Inspection>& inspection,
             const std::string& view,
             int frame,
             const std::optional<cv::Size>& size) {
  if (view == "image") return snapshot_image(*inspection, frame, size);
  if (view == "scene") return snapshot_scene(*inspection, frame, size.value_or(cv::Size(960, 720)));
  return snapshot_window(inspection, frame, size.value_or(cv::Size(1280, 720)));
}

cv::Mat read_baseline(const fs::path& file) {
  cv::Mat picture = cv::imread(file.string(), cv::IMREAD_COLOR);
  if (picture.empty()) {
    throw InputError(
        fmt::format("--baseline: {} is not a picture that can be read", file.string()));
  }
  return picture;
}

void write_picture(const fs::path& file, const cv::Mat& picture) {
  std::vector<unsigned char> bytes;
  cv::imencode(".png", picture, bytes);
  write_file(file, std::string(bytes.begin(), bytes.end()));
}

int compare(const cv::Mat& picture, const cv::Mat& baseline, const SnapshotArguments& arguments) {
  const PictureComparison comparison = compare_pictures(picture, baseline, arguments.tolerance);
  fmt::print("pixels that differ by more than");
  for (std::size_t k = 0; k < PictureComparison::kSweep.size(); ++k) {
    fmt::print(" {}: {}{}", PictureComparison::kSweep[k], comparison.beyond[k], k < 3 ? "," : "\n");
  }
  if (comparison.equal) return kDone;
  const fs::path diff_file = fs::path(arguments.output).replace_extension(".diff.png");
  if (!comparison.difference.empty()) write_picture(diff_file, comparison.difference);
  fmt::print("differs from {}: {}; see {} and {}\n",
             arguments.baseline->string(),
             comparison.reason,
             arguments.output.string(),
             diff_file.string());
  return kFailed;
}

}  // namespace

int snapshot_command(const SnapshotArguments& arguments) {
  const auto size = parse_size(arguments.size);
  if (arguments.output.extension() != ".png") {
    throw InputError(fmt::format("--output: '{}', expected a file name that ends in .png",
                                 arguments.output.string()));
  }
  check_writable(arguments.output);
  const cv::Mat baseline = arguments.baseline ? read_baseline(*arguments.baseline) : cv::Mat();
  const auto inspection = inspect(arguments.inspect);
  const Settings& settings = inspection->settings;
  const int frame = arguments.frame.value_or(settings.start + settings.frames - 1);
  if (frame < 0 || frame >= inspection->recording->frame_count()) {
    throw InputError(fmt::format("--frame: {} is not in the recording, which has frames 0 to {}",
                                 frame,
                                 inspection->recording->frame_count() - 1));
  }
  const cv::Mat picture = draw(inspection, arguments.view, frame, size);
  write_picture(arguments.output, picture);
  if (!inspection->initialization->ok) {
    fmt::print(stderr,
               "{}: initialization failed: {}\n",
               settings.method,
               inspection->initialization->reason);
    return kFailed;
  }
  fmt::print("{}: {}x{}\n", arguments.output.string(), picture.cols, picture.rows);
  return arguments.baseline ? compare(picture, baseline, arguments) : kDone;
}

}  // namespace gpo
