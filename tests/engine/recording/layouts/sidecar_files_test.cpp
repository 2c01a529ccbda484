// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/layouts/sidecar_files.h"

#include "tests/engine/test_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace gpo {
namespace {

using test::error_of;
using test::TestFolder;

TEST(BoardFile, OfACharucoBoardCountsSquares) {
  const TestFolder folder;
  const auto file = folder.write("board.yaml",
                                 "{pattern: charuco, squares: [8, 6], square: 0.03, marker: 0.022, "
                                 "dictionary: 5x5_100}\n");
  const Board board = read_board(file);
  EXPECT_EQ(board.columns, 7);
  EXPECT_EQ(board.rows, 5);
  EXPECT_EQ(board.square_m, 0.03);
  ASSERT_TRUE(board.markers);
  EXPECT_EQ(board.markers->side_m, 0.022);
  EXPECT_EQ(board.markers->dictionary, "DICT_5X5_100");
}

struct BadBoard {
  std::string text;
  std::string message;
};

class BadBoardFile : public testing::TestWithParam<BadBoard> {};

TEST_P(BadBoardFile, IsRefusedInOneLine) {
  const TestFolder folder;
  const auto file = folder.write("board.yaml", GetParam().text);
  EXPECT_EQ(error_of([&] {
              read_board(file);
            }).substr(0, file.string().size() + GetParam().message.size()),
            file.string() + GetParam().message);
}

INSTANTIATE_TEST_SUITE_P(
    All,
    BadBoardFile,
    testing::Values(
        BadBoard{"pattern: circles\n",
                 ":1: key `pattern`: found \"circles\", expected chessboard or charuco"},
        BadBoard{"pattern: charuco\ncolumns: 9\nrows: 6\nsquare: 0.02\n",
                 ": key `squares`: found nothing, expected 2 counts of squares (x, y), 3 to 100"},
        BadBoard{"pattern: charuco\nsquares: [8, 2]\n",
                 ":2: key `squares`: found 2, expected 2 counts of squares (x, y), 3 to 100 each"},
        BadBoard{"pattern: charuco\nsquares: [8]\n",
                 ":2: key `squares`: found 1 numbers, expected 2 counts of squares (x, y)"},
        BadBoard{"pattern: charuco\nsquares: [8, 6]\nsquare: 0.03\n",
                 ": key `marker`: found nothing, expected the side of a marker in meters"},
        BadBoard{"pattern: charuco\nsquares: [8, 6]\nsquare: 0.03\nmarker: 0.03\n",
                 ":4: key `marker`: found 0.03, expected less than the square's side, 0.03"},
        BadBoard{"pattern: charuco\nsquares: [8, 6]\nsquare: 0.03\nmarker: -1\n",
                 ":4: key `marker`: found -1, expected the side of a marker in meters, > 0"},
        BadBoard{"pattern: charuco\nsquares: [8, 6]\nsquare: 0.03\nmarker: 0.02\n"
                 "dictionary: DICT_5X5_99\n",
                 ":5: key `dictionary`: found \"DICT_5X5_99\", expected one of DICT_4X4_50, "},
        BadBoard{"pattern: charuco\nsquares: [12, 9]\nsquare: 0.03\nmarker: 0.02\n"
                 "dictionary: DICT_4X4_50\n",
                 ":5: key `dictionary`: found DICT_4X4_50 with 50 markers, expected one with 54, "
                 "as many as the board has"}));

}  // namespace
}  // namespace gpo
