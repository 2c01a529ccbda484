// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/calibration/calibrate.h"
#include "tests/engine/recording/board/rendered_board.h"

#include <gmock/gmock.h>
#include <opencv2/imgproc.hpp>

namespace gpo::test {
namespace {

using testing::HasSubstr;

TEST(CalibrationViews, NameTheCountsOfTheChessboardThatIsThere) {
  const Camera camera{320, 240, 300, 300, 160, 120, Distortion::none, {}};
  const FrameCache images(4, [&](int index) {
    cv::Mat image;
    const cv::Mat gray =
        render_board(kChessboard, camera, looking_at(kChessboard, 0.35, 3.0 * index, 5));
    cv::cvtColor(gray, image, cv::COLOR_GRAY2BGR);
    return image;
  });
  const Board squares{10, 7, 0.025};
  const BoardSearch search = find_calibration_views(images, squares, 10);
  EXPECT_THAT(calibrate_camera(search, squares).reason,
              HasSubstr("found the board in 0 of 4 images; at least 8 are needed. The images show "
                        "a chessboard of 9x6 inner corners; use --board 9x6"));
}

}  // namespace
}  // namespace gpo::test
