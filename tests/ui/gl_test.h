// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/context/offscreen_context.h"
#include "ui/context/vtk_window.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

namespace gpo {

/// A test that draws: any message of VTK fails it.
class DrawingTest : public testing::Test {
 protected:
  DrawingTest() : vtk_([this](const std::string& text) { messages_.push_back(text); }) {}
  void TearDown() override {
    for (const std::string& message : messages_) ADD_FAILURE() << "VTK said: " << message;
  }

 private:
  std::vector<std::string> messages_;
  VtkMessages vtk_;
};

inline bool same_bytes(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() && cv::norm(a, b, cv::NORM_INF) == 0;
}

/// Bytes are promised for Mesa's llvmpipe only.
inline bool on_llvmpipe() {
  OffscreenContext context(8, 8);
  return gl_renderer().find("llvmpipe") != std::string::npos;
}

}  // namespace gpo
