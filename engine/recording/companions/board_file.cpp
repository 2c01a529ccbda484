// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/board/board.h"
#include "engine/recording/companions/companion_files.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace gpo {
namespace {

constexpr const char* kCorners = "a number of inner corners";
constexpr const char* kTags = "a number of tags";

int whole_number(const YamlEntry& entry, int least, int most, const std::string& meaning) {
  const std::string expected = fmt::format("{}, {} to {}", meaning, least, most);
  const std::int64_t number = integer(entry, expected);
  if (number < least || number > most) yaml_fail(entry, expected);
  return static_cast<int>(number);
}

int corner_count(const YamlEntry& root, const std::string& key) {
  return whole_number(at(root, key, kCorners), 3, 100, kCorners);
}

int tag_count(const YamlEntry& root, const std::string& key) {
  return whole_number(at(root, key, kTags), 1, 50, kTags);
}

double length_m(const YamlEntry& root, const std::string& key, const std::string& expected) {
  const auto entry = at(root, key, expected);
  const double length = number(entry, expected);
  if (length <= 0) yaml_fail(entry, text(entry, ""), fmt::format("{}, > 0", expected));
  return length;
}

double square_side(const YamlEntry& root) {
  return length_m(root, "square", "the side of a square in meters");
}

Board chessboard(const YamlEntry& root) {
  return {corner_count(root, "columns"), corner_count(root, "rows"), square_side(root)};
}

/// `squares` is the number of squares, as in OpenCV's CharucoBoard.
Board charuco_board(const YamlEntry& root) {
  const std::string expected = "2 counts of squares (x, y), 3 to 100 each";
  const auto squares = at(root, "squares", expected);
  const auto counts = numbers(squares, 2, expected);
  for (const double count : counts)
    if (count < 3 || count > 100 || count != std::floor(count))
      yaml_fail(squares, fmt::format("{:g}", count), expected);
  Board board{static_cast<int>(counts[0]) - 1, static_cast<int>(counts[1]) - 1, square_side(root)};
  const double marker = length_m(root, "marker", "the side of a marker in meters");
  if (marker >= board.square_m)
    yaml_fail(at(root, "marker", ""),
              fmt::format("{:g}", marker),
              fmt::format("less than the square's side, {:g}", board.square_m));
  const auto dictionary = at(root, "dictionary", "one of " + dictionary_names());
  const auto name = dictionary_name(text(dictionary, "a name"));
  if (!name) yaml_fail(dictionary, "one of " + dictionary_names());
  board.markers = BoardMarkers{marker, *name};
  if (marker_count(board) > dictionary_size(*name))
    yaml_fail(dictionary,
              fmt::format("{} with {} markers", *name, dictionary_size(*name)),
              fmt::format("at least {}, one for each marker of the board", marker_count(board)));
  return board;
}

/// Reads the width of a tag's black border; Kalibr's is twice as wide as others.
int tag_border(const YamlEntry& root, int otherwise) {
  const auto entry = find(root, "tagBorder");
  return entry ? whole_number(*entry, 1, 2, "a number of bits") : otherwise;
}

Board april_grid(const YamlEntry& root) {
  Board board{2 * tag_count(root, "tagCols"), 2 * tag_count(root, "tagRows"), 0};
  board.square_m = length_m(root, "tagSize", "the side of a tag in meters");
  const auto spacing = at(root, "tagSpacing", "the gap between tags divided by their side");
  const double ratio = number(spacing);
  if (ratio <= 0 || ratio > 1)
    yaml_fail(
        spacing, fmt::format("{:g}", ratio), "the gap between tags divided by their side, 0 to 1");
  board.tags = BoardTags{ratio, tag_border(root, 2), {}};
  const int count = board.columns * board.rows / 4;
  if (count > april_tag_count())
    yaml_fail(at(root, "tagCols", ""),
              fmt::format("{} tags", count),
              fmt::format("at most {}", april_tag_count()));
  return board;
}

Board april_tag(const YamlEntry& root) {
  Board board{2, 2, length_m(root, "tagSize", "the side of the tag in meters")};
  const auto id = find(root, "id");
  const int number =
      id ? whole_number(*id, 0, april_tag_count() - 1, "a tag's number") : BoardTags::kAnyTag;
  board.tags = BoardTags{0, tag_border(root, 1), number};
  return board;
}

using Pattern = std::pair<const char*, Board (*)(const YamlEntry& root)>;
constexpr std::array<Pattern, 4> kPatterns = {{{"chessboard", chessboard},
                                               {"charuco", charuco_board},
                                               {"aprilgrid", april_grid},
                                               {"apriltag", april_tag}}};
constexpr const char* kPatternNames = "chessboard, charuco, aprilgrid or apriltag";

}  // namespace

Board read_board(const fs::path& file) {
  const auto root = load_yaml(file);
  const auto kalibr = find(root, "target_type");
  const auto pattern = kalibr ? *kalibr : at(root, "pattern", kPatternNames);
  const std::string name = text(pattern, kPatternNames);
  const auto known = std::ranges::find(kPatterns, name, &Pattern::first);
  if (known == kPatterns.end()) yaml_fail(pattern, kPatternNames);
  return known->second(root);
}

std::string board_yaml(const Board& board) {
  const int columns = board.columns, rows = board.rows;
  const double side = board.square_m;
  if (board.tags && board.tags->alone) {
    const int id = *board.tags->alone;
    return fmt::format("# Meters.\npattern: apriltag\ntagSize: {}\ntagBorder: {}\n{}",
                       side,
                       board.tags->border,
                       id == BoardTags::kAnyTag ? "" : fmt::format("id: {}\n", id));
  }
  if (board.tags)
    return fmt::format(
        "# Kalibr's keys, meters.\npattern: aprilgrid\ntagCols: {}\ntagRows: {}\ntagSize: {}\n"
        "tagSpacing: {}\ntagBorder: {}\n",
        columns / 2,
        rows / 2,
        side,
        board.tags->spacing,
        board.tags->border);
  const auto& markers = board.markers;
  if (!markers)
    return fmt::format(
        "# Inner corners, meters.\npattern: chessboard\ncolumns: {}\nrows: {}\nsquare: {}\n",
        columns,
        rows,
        side);
  return fmt::format(
      "# Squares along x and y; meters.\npattern: charuco\nsquares: [{}, {}]\nsquare: {}\n"
      "marker: {}\ndictionary: {}\n",
      columns + 1,
      rows + 1,
      side,
      markers->side_m,
      markers->dictionary);
}

}  // namespace gpo
