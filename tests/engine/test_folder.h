// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/error.h"
#include "engine/files/output_file.h"
#include "tests/engine/opencv_images.h"

#include <filesystem>
#include <fstream>
#include <functional>
#include <string>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

namespace gpo::test {

/// An empty folder of the running test, removed at the end.
class TestFolder {
 public:
  TestFolder() {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    path_ = std::filesystem::path(GPO_TEST_OUTPUT_DIR) /
            (std::string(test->test_suite_name()) + "." + test->name());
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ~TestFolder() { std::filesystem::remove_all(path_); }
  TestFolder(const TestFolder&) = delete;
  TestFolder& operator=(const TestFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

  std::filesystem::path write(const std::string& name, const std::string& content) const {
    std::filesystem::create_directories((path_ / name).parent_path());
    std::ofstream(path_ / name, std::ios::binary) << content;
    return path_ / name;
  }
  std::filesystem::path write(const std::string& name, const cv::Mat& image) const {
    std::filesystem::create_directories((path_ / name).parent_path());
    if (name.ends_with(".png"))
      write_image(path_ / name, image);
    else
      EXPECT_TRUE(imwrite((path_ / name).string(), image, {}));
    return path_ / name;
  }
  std::string read(const std::string& name) const {
    std::ifstream stream(path_ / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  }
  /// Truncates a file to its first part.
  void cut(const std::string& name, double part) const {
    const std::string content = read(name);
    write(name, content.substr(0, static_cast<std::size_t>(part * double(content.size()))));
  }

 private:
  std::filesystem::path path_;
};

/// Returns the message of the InputError that `action` throws, which must be one line.
inline std::string error_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const InputError& error) {
    std::string message = error.what();
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    return message;
  }
  return "no error";
}

inline const char* const kCameraYaml = R"(resolution: [64, 48]
camera_model: pinhole
intrinsics: [60, 61, 31, 23]
distortion_model: none
distortion_coefficients: []
)";

}  // namespace gpo::test
