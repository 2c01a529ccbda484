// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/recording/recording.h"

#include <array>
#include <cmath>
#include <cstdint>

namespace gpo::test {

/// First codes of the family 36h11 from AprilTag and Kalibr, independent of OpenCV: white bits are
/// 1, row by row from the top left, the highest bit first.
inline constexpr std::array<std::uint64_t, 12> kTag36h11 = {0xd5d628584,
                                                            0xd97f18b49,
                                                            0xdd280910e,
                                                            0xe479e9c98,
                                                            0xebcbca822,
                                                            0xf31dab3ac,
                                                            0x056a5d085,
                                                            0x10652e1d4,
                                                            0x22b1dfead,
                                                            0x265ad0472,
                                                            0x34fe91b86,
                                                            0x3ff962cd5};

/// Gray of a board of tags at a point [m], relative to the top left corner of its top left tag, as
/// Kalibr draws it: number 0 at the bottom left, white paper around, and black squares between the
/// corners if `squares`.
inline double tag_gray(const Board& board, double x, double y, bool squares = true) {
  constexpr double kBlack = 25, kWhite = 230;
  const double pitch = 1 + board.tags->spacing;  // in sides of a tag
  const int columns = board.columns / 2, rows = board.rows / 2;
  const double u = x / board.square_m, v = y / board.square_m;
  const double margin = std::max(0.3, board.tags->spacing);
  if (u < -margin || v < -margin || u > pitch * columns - pitch + 1 + margin ||
      v > pitch * rows - pitch + 1 + margin)
    return 110;
  const int column = static_cast<int>(std::floor(u / pitch));
  const int row = static_cast<int>(std::floor(v / pitch));
  const double du = u - pitch * column, dv = v - pitch * row;  // from the tag's corner
  if (du >= 1 && dv >= 1) return squares ? kBlack : kWhite;    // between four tags
  if (column < 0 || row < 0 || column >= columns || row >= rows || du >= 1 || dv >= 1)
    return kWhite;
  const int bits = 6 + 2 * board.tags->border;
  const int i = static_cast<int>(dv * bits) - board.tags->border;
  const int j = static_cast<int>(du * bits) - board.tags->border;
  if (i < 0 || j < 0 || i >= 6 || j >= 6) return kBlack;
  const int id = columns * (rows - 1 - row) + column;
  const std::uint64_t code = kTag36h11.at(board.tags->alone.value_or(id));
  return (code >> (35 - (6 * i + j)) & 1) != 0 ? kWhite : kBlack;
}

}  // namespace gpo::test
