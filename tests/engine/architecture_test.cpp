// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// Who may know whom: reads the includes of the whole tree.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace gpo {
namespace {

using testing::IsEmpty;
using Names = std::vector<std::string>;

/// A folder, and the folders whose headers its own files may include beside each other's. With a
/// slash at the end: and all below it. A folder that is not here must not be.
struct Room {
  std::string folder;
  Names may_include;
};

// clang-format off
const std::vector<Room> kRooms = {
    {"engine/base/internal", {"engine/base"}},
    {"engine/base", {}},
    {"engine/geometry", {"engine/base"}},
    {"engine/window", {"engine/base", "engine/geometry"}},
    {"engine/truth", {"engine/geometry"}},
    {"engine/initializers/common", {"engine/base", "engine/geometry", "engine/window"}},
    {"engine/initializers/residuals", {"engine/geometry", "engine/initializers/common"}},
    {"engine/initializers/plane", {"engine/base", "engine/geometry", "engine/window", "engine/initializers/common", "engine/initializers/residuals"}},
    {"engine/initializers/bundle", {"engine/geometry", "engine/initializers/common", "engine/initializers/residuals"}},
    {"engine/initializers/candidates", {"engine/geometry", "engine/window", "engine/initializers/common"}},
    {"engine/initializers/certainty", {"engine/geometry", "engine/window", "engine/initializers/common", "engine/initializers/plane"}},
    {"engine/initializers", {"engine/base", "engine/geometry", "engine/window", "engine/initializers/"}},
    {"engine/inertial", {"engine/base", "engine/geometry", "engine/window", "engine/initializers/common"}},
    {"engine/evaluation", {"engine/geometry", "engine/window", "engine/truth", "engine/initializers/"}},
    {"engine/frontend/tracking", {"engine/base", "engine/geometry", "engine/window"}},
    {"engine/frontend", {"engine/base", "engine/geometry", "engine/window"}},
    {"engine", {"engine/geometry", "engine/window", "engine/initializers/common", "engine/inertial", "engine/frontend"}},
    {"engine/initialize", {"engine", "engine/base", "engine/base/internal", "engine/geometry", "engine/window", "engine/inertial", "engine/initializers", "engine/initializers/common", "engine/initializers/certainty", "engine/initializers/plane", "engine/frontend"}},
    {"engine/files", {"engine/base"}},
    {"engine/recording", {"engine/base", "engine/files", "engine/geometry", "engine/window", "engine/truth"}},
    {"engine/recording/pictures", {"engine/base", "engine/files", "engine/geometry", "engine/recording"}},
    {"engine/recording/bags/containers", {"engine/base", "engine/files"}},
    {"engine/recording/bags", {"engine/base", "engine/files", "engine/geometry", "engine/recording/pictures", "engine/recording/bags/containers"}},
    {"engine/recording/board", {"engine/base", "engine/files", "engine/geometry", "engine/recording", "engine/recording/pictures"}},
    {"engine/recording/loggers", {"engine/base", "engine/files", "engine/geometry", "engine/window", "engine/truth", "engine/recording", "engine/recording/pictures"}},
    {"engine/recording/companions", {"engine/base", "engine/files", "engine/geometry", "engine/window", "engine/truth", "engine/recording", "engine/recording/board"}},
    {"engine/recording/layouts", {"engine/base", "engine/files", "engine/geometry", "engine/window", "engine/truth", "engine/recording/"}},
    {"engine/calibration/plane", {"engine/base", "engine/geometry"}},
    {"engine/calibration/sights", {"engine/base", "engine/geometry", "engine/window", "engine/frontend/", "engine/calibration/plane"}},
    {"engine/calibration", {"engine/base", "engine/files", "engine/geometry", "engine/window", "engine/frontend", "engine/recording/", "engine/calibration/"}},
    {"engine/synthesis", {"engine/base", "engine/files", "engine/geometry", "engine/recording/"}},
    {"engine/process", {}},
    {"engine/commands", {"engine/base", "engine/files", "engine/geometry", "engine/window", "engine/initializers", "engine/initializers/common", "engine/initializers/plane", "engine/process"}},
    {"engine/results", {"engine/base", "engine/files", "engine/geometry", "engine/window", "engine/initializers", "engine/initializers/common", "engine/commands", "engine/recording/companions"}},
    {"engine/inspection/window", {"engine", "engine/initialize", "engine/initializers/common", "engine/base", "engine/geometry", "engine/window", "engine/truth", "engine/frontend/", "engine/recording/"}},
    {"engine/inspection/settings", {"engine/inertial", "engine", "engine/initialize", "engine/files", "engine/base", "engine/geometry", "engine/window", "engine/initializers/", "engine/frontend/", "engine/recording/", "engine/inspection/window"}},
    {"engine/inspection", {"engine/inertial", "engine", "engine/initialize", "engine/base", "engine/files", "engine/geometry", "engine/window", "engine/truth", "engine/initializers/", "engine/evaluation", "engine/frontend/", "engine/recording/", "engine/inspection/window", "engine/inspection/settings"}},
    {"engine/inspection/studies", {"engine/base", "engine/geometry", "engine/window", "engine/truth", "engine/initializers/", "engine/evaluation", "engine/frontend/", "engine/recording/", "engine/inspection"}},
    {"engine/inspection/report", {"engine/inertial", "engine/base", "engine/files", "engine/geometry", "engine/window", "engine/truth", "engine/initializers/", "engine/evaluation", "engine/frontend/", "engine/recording/", "engine/inspection", "engine/inspection/settings"}},
    {"engine/experiment", {"engine/base", "engine/files", "engine/geometry", "engine/window", "engine/frontend/", "engine/initializers", "engine/recording/", "engine/inspection/"}},
    {"ui/look", {"engine/geometry"}},
    {"ui/context", {"engine/", "ui/look"}},
    {"ui/views/overlay", {"engine/", "ui/look", "ui/context"}},
    {"ui/views/model", {"engine/base", "ui/look"}},
    {"ui/views/picture", {"engine/", "ui/look", "ui/context", "ui/views/overlay", "ui/views/model"}},
    {"ui/views/scene", {"engine/", "ui/look", "ui/context", "ui/views/overlay", "ui/views/model", "ui/views/picture"}},
    {"ui/views/charts", {"engine/", "ui/look", "ui/context", "ui/views/overlay", "ui/views/picture"}},
    {"ui/views/figures", {"engine/", "ui/look", "ui/context", "ui/views/overlay", "ui/views/charts"}},
    {"ui/views/compare", {"engine/", "ui/look", "ui/context", "ui/views/overlay", "ui/views/picture"}},
    {"ui/views/normals", {"engine/", "ui/look", "ui/context", "ui/views/charts", "ui/views/overlay", "ui/views/picture", "ui/views/scene"}},
    {"ui/views", {"engine/", "ui/look", "ui/context", "ui/views/"}},
    {"ui/workbench", {"engine/", "ui/look"}},
    {"ui/workbench/session", {"engine/", "ui/workbench"}},
    {"ui/workbench/work", {"engine/", "ui/workbench", "ui/workbench/session"}},
    {"ui/workbench/actions", {"engine/", "ui/look", "ui/workbench/"}},
    {"ui/panels/facts", {"engine/", "ui/look", "ui/views/", "ui/workbench"}},
    {"ui/panels", {"engine/", "ui/look", "ui/context", "ui/views/", "ui/workbench/", "ui/panels/facts"}},
    {"ui/panels/drawers", {"engine/", "ui/look", "ui/context", "ui/views/", "ui/workbench/", "ui/panels", "ui/panels/facts"}},
    {"ui/panels/timeline", {"engine/", "ui/look", "ui/context", "ui/views/", "ui/workbench/", "ui/panels", "ui/panels/facts"}},
    {"ui/panels/panes", {"engine/", "ui/look", "ui/context", "ui/views/", "ui/workbench/", "ui/panels", "ui/panels/facts", "ui/panels/drawers"}},
    {"ui/panels/frame", {"engine/", "ui/look", "ui/context", "ui/views/", "ui/workbench/", "ui/panels", "ui/panels/facts", "ui/panels/panes"}},
    {"ui", {"engine/", "ui/"}},
    {"app/terminal", {"engine/"}},
    {"app/recordings", {"engine/", "ui/", "app/terminal"}},
    {"app/methods", {"engine/", "ui/"}},
    {"app/pictures", {"engine/", "ui/"}},
    {"app/commands", {"engine/", "ui/", "app/terminal", "app/recordings", "app/methods", "app/pictures"}},
    {"app", {"engine/", "app/"}},
    {"app/python", {"engine/", "ui/", "app/recordings", "app/pictures"}},
};
// clang-format on

/// These use Eigen, Ceres and fmt, and no library of pictures, files or windows.
const Names kPure = {"engine/base/",
                     "engine/inertial/",
                     "engine/geometry/",
                     "engine/window/",
                     "engine/initializers/",
                     "engine/truth/",
                     "engine/evaluation/"};
const Names kLibrariesOfPicturesAndFiles = {"opencv2/",
                                            "yaml-cpp/",
                                            "nlohmann/",
                                            "libav",
                                            "libsw",
                                            "tinyxml2",
                                            "zlib",
                                            "bzlib",
                                            "lz4frame",
                                            "zstd",
                                            "sqlite3",
                                            "exiv2/"};
/// The engine needs no screen and no command line.
const Names kLibrariesOfWindows = {"vtk", "GL", "GLFW/", "EGL/", "imgui", "CLI/"};

constexpr int kMostLines = 400;           // of a file that fits in a head
constexpr int kMostLinesOfFunction = 60;  // that fits on a screen

struct Include {
  std::string from;  ///< a file, from the top of the tree
  std::string to;    ///< what it names
};

std::vector<Include> includes_of(const std::filesystem::path& root) {
  std::vector<Include> includes;
  for (const char* top : {"app", "engine", "ui"}) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root / top)) {
      const auto extension = entry.path().extension();
      if (extension != ".h" && extension != ".cpp") continue;
      std::ifstream file(entry.path());
      const std::string from = entry.path().lexically_relative(root).generic_string();
      for (std::string line; std::getline(file, line);) {
        if (!line.starts_with("#include ")) continue;
        const std::size_t end = line.find_last_of("\">");
        includes.push_back({from, line.substr(10, end - 10)});
      }
    }
  }
  return includes;
}

const std::vector<Include>& tree() {
  static const std::vector<Include> includes = includes_of(GPO_SOURCE_DIR);
  return includes;
}

std::string folder_of(const std::string& file) {
  return std::filesystem::path(file).parent_path().generic_string();
}

bool is_ours(const std::string& file) {
  return file.starts_with("engine/") || file.starts_with("ui/") || file.starts_with("app/");
}

bool covers(const std::string& allowed, const std::string& folder) {
  return allowed.ends_with('/') ? (folder + "/").starts_with(allowed) : folder == allowed;
}

bool may_include(const std::vector<Room>& rooms, const std::string& from, const std::string& to) {
  if (from == to) return true;
  const auto room = std::ranges::find(rooms, from, &Room::folder);
  return room != rooms.end() && std::ranges::any_of(room->may_include, [&](const auto& allowed) {
           return covers(allowed, to);
         });
}

Names forbidden(const std::vector<Include>& includes, const std::vector<Room>& rooms) {
  Names found;
  for (const auto& [from, to] : includes) {
    if (is_ours(to) && !may_include(rooms, folder_of(from), folder_of(to)))
      found.push_back(fmt::format("{} includes {}", from, to));
  }
  return found;
}

/// The file without .h or .cpp: what one header promises, its source keeps.
std::string unit_of(const std::string& file) { return file.substr(0, file.rfind('.')); }

Names mutual_units(const std::vector<Include>& includes) {
  std::map<std::string, std::set<std::string>> knows;
  for (const auto& [from, to] : includes) {
    if (unit_of(from) != unit_of(to)) knows[unit_of(from)].insert(unit_of(to));
  }
  Names found;
  for (const auto& [unit, known] : knows) {
    for (const std::string& other : known) {
      const auto back = knows.find(other);
      if (unit < other && back != knows.end() && back->second.contains(unit))
        found.push_back(fmt::format("{} and {}", unit, other));
    }
  }
  return found;
}

Names using_libraries(const std::vector<Include>& includes,
                      const Names& folders,
                      const Names& libraries) {
  const auto begins_one = [](const std::string& name, const Names& of) {
    return std::ranges::any_of(of, [&](const auto& one) { return name.starts_with(one); });
  };
  Names found;
  for (const auto& [from, to] : includes) {
    if (begins_one(from, folders) && begins_one(to, libraries))
      found.push_back(fmt::format("{} includes {}", from, to));
  }
  return found;
}

TEST(Architecture, NobodyKnowsWhomItMayNot) {
  EXPECT_GT(tree().size(), 1000U);
  EXPECT_THAT(forbidden(tree(), kRooms), IsEmpty());
}

TEST(Architecture, NoTwoRoomsMayKnowEachOther) {
  Names found;
  for (const Room& a : kRooms) {
    for (const Room& b : kRooms) {
      if (a.folder < b.folder && may_include(kRooms, a.folder, b.folder) &&
          may_include(kRooms, b.folder, a.folder))
        found.push_back(fmt::format("{} and {}", a.folder, b.folder));
    }
  }
  EXPECT_THAT(found, IsEmpty());
}

TEST(Architecture, NoTwoFilesKnowEachOther) { EXPECT_THAT(mutual_units(tree()), IsEmpty()); }

TEST(Architecture, TheMathematicsUseEigenAndCeresOnly) {
  EXPECT_THAT(using_libraries(tree(), kPure, kLibrariesOfPicturesAndFiles), IsEmpty());
}

TEST(Architecture, TheEngineNeedsNoScreen) {
  EXPECT_THAT(using_libraries(tree(), {"engine/"}, kLibrariesOfWindows), IsEmpty());
}

/// The lines of each source.
std::map<std::string, Names> lines_of_tree() {
  std::map<std::string, Names> all;
  const std::filesystem::path root(GPO_SOURCE_DIR);
  for (const char* top : {"app", "engine", "ui", "tests"}) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root / top)) {
      const auto extension = entry.path().extension();
      if (extension != ".h" && extension != ".cpp") continue;
      std::ifstream file(entry.path());
      Names& lines = all[entry.path().lexically_relative(root)];
      for (std::string line; std::getline(file, line);) lines.push_back(line);
    }
  }
  return all;
}

/// The longest function: from the last line that is not indented to a brace that is not, either.
int longest_function(const Names& lines) {
  int longest = 0, head = 0;
  for (int i = 0; i < static_cast<int>(lines.size()); ++i) {
    if (lines[i] == "}") longest = std::max(longest, i - head + 1);
    if (!lines[i].empty() && std::string(" }/#)").find(lines[i][0]) == std::string::npos) head = i;
  }
  return longest;
}

TEST(Architecture, NoFileIsTooLongToRead) {
  std::map<std::string, std::size_t> long_ones;
  for (const auto& [file, lines] : lines_of_tree())
    if (lines.size() > kMostLines) long_ones[file] = lines.size();
  EXPECT_THAT(long_ones, IsEmpty());
}

TEST(Architecture, NoFunctionIsTooLongForAScreen) {
  std::set<std::string> long_ones;
  for (const auto& [file, lines] : lines_of_tree())
    if (longest_function(lines) > kMostLinesOfFunction) long_ones.insert(file);
  // Two loops that the compiler is to see as a whole, and a table.
  EXPECT_THAT(long_ones,
              testing::ElementsAre("engine/frontend/tracking/look_kernel.cpp",
                                   "engine/initializers/plane/plane_kernel.cpp",
                                   "tests/app/layouts_test.cpp"));
}

/// The type that a line of a header begins to define at the level of its namespace; empty: none.
std::string type_defined_in(const std::string& line) {
  static const std::regex kDefinition(R"((?:struct|class|enum class) (\w+)[^<;]*\{.*)");
  std::smatch parts;
  return std::regex_match(line, parts, kDefinition) ? parts[1].str() : "";
}

// The linker takes one of two definitions for the other, and says nothing.
TEST(Architecture, NoTypeIsDefinedTwice) {
  std::map<std::string, Names> definitions;
  for (const auto& [file, lines] : lines_of_tree()) {
    if (!is_ours(file) || !file.ends_with(".h")) continue;
    for (const std::string& line : lines) definitions[type_defined_in(line)].push_back(file);
  }
  definitions.erase("");
  EXPECT_GT(definitions.size(), 500U);
  std::erase_if(definitions, [](const auto& type) { return type.second.size() == 1; });
  EXPECT_THAT(definitions, IsEmpty());
}

// What the tests above would say of a tree that is not in order.
TEST(Architecture, AnArrowThatIsNotInTheTableIsTold) {
  const std::vector<Include> includes = {
      {"engine/geometry/plane.cpp", "engine/window/window.h"},
      {"engine/window/window.h", "engine/geometry/pose.h"},
      {"engine/somewhere/new.cpp", "engine/base/error.h"},
      {"engine/geometry/pose.cpp", "opencv2/core.hpp"},
      {"engine/geometry/a.h", "engine/geometry/b.h"},
      {"engine/geometry/b.cpp", "engine/geometry/a.h"},
      {"engine/geometry/plane.cpp", "engine/geometry/plane.h"},
  };
  EXPECT_THAT(forbidden(includes, kRooms),
              testing::ElementsAre("engine/geometry/plane.cpp includes engine/window/window.h",
                                   "engine/somewhere/new.cpp includes engine/base/error.h"));
  EXPECT_THAT(mutual_units(includes),
              testing::ElementsAre("engine/geometry/a and engine/geometry/b"));
  EXPECT_THAT(using_libraries(includes, kPure, kLibrariesOfPicturesAndFiles),
              testing::ElementsAre("engine/geometry/pose.cpp includes opencv2/core.hpp"));
  EXPECT_EQ(type_defined_in("class PlaneProblem {"), "PlaneProblem");
  EXPECT_EQ(type_defined_in("enum class Loss { squared, huber };"), "Loss");
  EXPECT_EQ(type_defined_in("struct ChoiceKeys<Loss> {"), "");
  EXPECT_EQ(type_defined_in("struct Window;"), "");
}

}  // namespace
}  // namespace gpo
