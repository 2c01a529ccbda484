// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/companions/companion_files.h"
#include "tests/engine/recording/refusals.h"

#include <gmock/gmock.h>

namespace gpo {
namespace {

using test::TestFolder;

TEST(BoardFile, CountsSquaresOfACharucoBoard) {
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

TEST(BoardFile, NamesLineAndKeyOfErrors) {
  const std::vector<test::Refusal> refusals = {
      {"pattern: circles\n",
       ":1: key `pattern`: found \"circles\", expected chessboard, charuco, aprilgrid or "
       "apriltag"},
      {"pattern: chessboard\ncolumns: 9.5\nrows: 6\nsquare: 0.02\n",
       ":2: key `columns`: found \"9.5\", expected a number of inner corners..."},
      {"pattern: chessboard\ncolumns: 9\nrows: 2\nsquare: 0.02\n",
       ":3: key `rows`: found \"2\", expected a number of inner corners, 3 to 100"},
      {"pattern: chessboard\ncolumns: 9\nrows: 6\n",
       ": key `square`: found no value, expected the side of a square in meters"},
      {"pattern: chessboard\ncolumns: 9\nrows: 6\nsquare: -1\n",
       ":4: key `square`: found -1, expected the side of a square in meters, > 0"},
      {"pattern: charuco\ncolumns: 9\nrows: 6\nsquare: 0.02\n",
       ": key `squares`: found no value, expected 2 counts of squares (x, y), 3 to 100..."},
      {"pattern: charuco\nsquares: [8, 2]\n",
       ":2: key `squares`: found 2, expected 2 counts of squares (x, y), 3 to 100 each"},
      {"pattern: charuco\nsquares: [8]\n",
       ":2: key `squares`: found 1 numbers, expected 2 counts of squares (x, y)..."},
      {"pattern: charuco\nsquares: [8, 6]\nsquare: 0.03\n",
       ": key `marker`: found no value, expected the side of a marker in meters"},
      {"pattern: charuco\nsquares: [8, 6]\nsquare: 0.03\nmarker: 0.03\n",
       ":4: key `marker`: found 0.03, expected less than the square's side, 0.03"},
      {"pattern: charuco\nsquares: [8, 6]\nsquare: 0.03\nmarker: -1\n",
       ":4: key `marker`: found -1, expected the side of a marker in meters, > 0"},
      {"pattern: charuco\nsquares: [8, 6]\nsquare: 0.03\nmarker: 0.02\n"
       "dictionary: DICT_5X5_99\n",
       ":5: key `dictionary`: found \"DICT_5X5_99\", expected one of DICT_4X4_50, ..."},
      {"pattern: charuco\nsquares: [12, 9]\nsquare: 0.03\nmarker: 0.02\n"
       "dictionary: DICT_4X4_50\n",
       ":5: key `dictionary`: found DICT_4X4_50 with 50 markers, expected at least "
       "54, one for each marker of the board"},
      {"pattern: aprilgrid\ntagCols: 6\ntagRows: 0\n",
       ":3: key `tagRows`: found \"0\", expected a count of tags, 1 to 50"},
      {"pattern: aprilgrid\ntagCols: 6\ntagRows: 6\ntagSize: 0\n",
       ":4: key `tagSize`: found 0, expected the side of a tag in meters, > 0"},
      {"pattern: aprilgrid\ntagCols: 6\ntagRows: 6\ntagSize: 0.1\ntagSpacing: 30\n",
       ":5: key `tagSpacing`: found 30, expected the gap between tags over their side, 0 "
       "to 1"},
      {"pattern: aprilgrid\ntagCols: 25\ntagRows: 24\ntagSize: 1\ntagSpacing: 0.3\n",
       ":2: key `tagCols`: found 600 tags, expected at most 587"},
      {"pattern: aprilgrid\ntagCols: 2\ntagRows: 2\ntagSize: 1\ntagSpacing: 0.3\n"
       "tagBorder: 3\n",
       ":6: key `tagBorder`: found \"3\", expected a number of bits, 1 to 2"},
      {"pattern: apriltag\ntagSize: 0.1\nid: 587\n",
       ":3: key `id`: found \"587\", expected a tag's number, 0 to 586"}};
  test::expect_refusals("board.yaml", refusals, [](const auto& file) { read_board(file); });
}

TEST(PlaneFile, NamesLineAndKeyOfErrors) {
  const std::vector<test::Refusal> refusals = {
      {"normal: [0, 0, 2]\ndistance: 1\n",
       ":1: key `normal`: found length 2.000000, expected a unit vector"},
      {"normal: [0, 0, 1]\ndistance: far\n",
       ":2: key `distance`: found \"far\", expected a finite number"},
      {"normal: [0, 1]\ndistance: 1\n", ":1: key `normal`: found 2 numbers, expected 3..."}};
  test::expect_refusals("plane.yaml", refusals, [](const auto& file) { read_plane(file); });
}

TEST(BoardFile, ReadsAndWritesKalibrsKeys) {
  const TestFolder folder;
  const Board grid = read_board(folder.write("april_6x7.yaml",
                                             "target_type: 'aprilgrid'\ntagCols: 6\ntagRows: 7\n"
                                             "tagSize: 0.088\ntagSpacing: 0.3\n"));
  EXPECT_EQ(grid.columns, 12);
  EXPECT_EQ(grid.rows, 14);
  EXPECT_EQ(grid.square_m, 0.088);
  ASSERT_TRUE(grid.tags);
  EXPECT_EQ(grid.tags->spacing, 0.3);
  EXPECT_EQ(grid.tags->border, 2);
  EXPECT_FALSE(grid.tags->alone);
  const Board tag =
      read_board(folder.write("tag.yaml", "{pattern: apriltag, tagSize: 0.1, id: 3}"));
  EXPECT_EQ(tag.columns, 2);
  EXPECT_EQ(tag.tags->border, 1);
  EXPECT_EQ(tag.tags->alone, 3);
  for (const Board& board : {grid, tag}) {
    const Board again = read_board(folder.write("board.yaml", board_yaml(board)));
    EXPECT_EQ(text_of(again), text_of(board));
    EXPECT_EQ(again.tags->alone, board.tags->alone);
  }
}

}  // namespace
}  // namespace gpo
