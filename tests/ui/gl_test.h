// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/files/output_file.h"
#include "ui/context/opengl.h"
#include "ui/context/vtk_window.h"

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include <GL/glew.h>
#include <gtest/gtest.h>
#include <imgui.h>
#include <opencv2/core.hpp>

namespace gpo {

/// A test that draws; any message of VTK fails it.
class DrawingTest : public testing::Test {
 protected:
  void TearDown() override { EXPECT_EQ(vtk_.text(), ""); }

 private:
  const VtkMessages vtk_;
};

inline bool same_bytes(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() && cv::norm(a, b, cv::NORM_INF) == 0;
}

/// Saves an image for inspection by people, or for the test that set GPO_TEST_KEEP for a process.
inline void keep(const std::string& name, const cv::Mat& image) {
  const char* other = std::getenv("GPO_TEST_KEEP");
  const std::filesystem::path folder = other != nullptr ? other : GPO_TEST_OUTPUT_DIR;
  std::filesystem::create_directories(folder);
  write_image(folder / (name + ".png"), image);
}

inline int count_pixels(const cv::Mat& image, std::uint32_t rgb, int tolerance = 6) {
  const cv::Vec3i wanted(rgb & 0xFF, rgb >> 8 & 0xFF, rgb >> 16);
  int pixels = 0;
  for (const cv::Vec3b& bgr : cv::Mat_<cv::Vec3b>(image))
    pixels += cv::norm(cv::Vec3i(bgr) - wanted, cv::NORM_INF) <= tolerance ? 1 : 0;
  return pixels;
}

/// Returns whether OpenGL is Mesa's llvmpipe, for which alone bytes are reproducible.
inline bool on_llvmpipe() {
  OffscreenContext context(8, 8);
  const auto* renderer = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  return std::string(renderer).find("llvmpipe") != std::string::npos;
}

namespace test {

/// Holds or releases Control and Shift from the next frame on.
inline void hold(bool control, bool shift, bool alt = false) {
  ImGuiIO& io = ImGui::GetIO();
#if IMGUI_VERSION_NUM < 18700
  io.KeyCtrl = control;
  io.KeyShift = shift;
  io.KeyAlt = alt;
#else
  io.AddKeyEvent(ImGuiMod_Ctrl, control);
  io.AddKeyEvent(ImGuiMod_Shift, shift);
  io.AddKeyEvent(ImGuiMod_Alt, alt);
#endif
}

}  // namespace test
}  // namespace gpo
