// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// Compares the includes of the whole tree with the layers that CMake declares.
#include "engine/files/text_file.h"

#include <algorithm>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>

#include <fmt/format.h>
#include <gmock/gmock.h>

namespace gpo {
namespace {

using testing::IsEmpty;
using Names = std::vector<std::string>;

/// The targets of CMake. A source may include the headers of its own target and of all targets that
/// this links, directly or through others.
struct Layers {
  std::map<std::string, std::string> target_of;  ///< by folder or file
  std::map<std::string, std::set<std::string>> links;
};

/// Reads lines "files TARGET PATH" and "links TARGET OTHER", as CMake writes them to layers.txt.
Layers read_layers(std::istream& lines) {
  Layers layers;
  for (std::string kind, target, value; lines >> kind >> target >> value;) {
    if (kind == "files")
      layers.target_of[value] = target;
    else
      layers.links[target].insert(value);
  }
  return layers;
}

/// Folders that use Eigen, Ceres and fmt, and no library of images, files or windows.
const Names kPure = split(
    "engine/base/,engine/inertial/,engine/geometry/,engine/window/,engine/methods/,engine/truth/,"
    "engine/evaluation/,engine/diagnosis/",
    ',');
const Names kLibrariesOfImagesAndFiles = split(
    "opencv2/,yaml-cpp/,nlohmann/,libav,libsw,tinyxml2,zlib,bzlib,lz4frame,zstd,sqlite3,exiv2/",
    ',');
/// Libraries that the engine must not use.
const Names kLibrariesOfWindows = {"vtk", "GL", "GLFW/", "EGL/", "imgui", "CLI/"};

constexpr int kMostLinesOfFunction = 60;  // one screen

struct Include {
  std::string from;  ///< a file, from the top of the tree
  std::string to;    ///< text between the quotes or brackets
};

const std::map<std::string, Names>& lines_of_tree() {
  static const auto lines_of_files = [] {
    std::map<std::string, Names> all;
    const std::filesystem::path root(GPO_SOURCE_DIR);
    for (const char* top : {"app", "engine", "ui", "tests"})
      for (const auto& entry : std::filesystem::recursive_directory_iterator(root / top)) {
        const auto extension = entry.path().extension();
        if (extension != ".h" && extension != ".cpp") continue;
        std::ifstream file(entry.path());
        Names& lines = all[entry.path().lexically_relative(root)];
        for (std::string line; std::getline(file, line);) lines.push_back(line);
      }
    return all;
  }();
  return lines_of_files;
}

bool is_ours(const std::string& file) {
  return file.starts_with("engine/") || file.starts_with("ui/") || file.starts_with("app/");
}

std::vector<Include> tree() {
  std::vector<Include> includes;
  for (const auto& [file, lines] : lines_of_tree())
    for (const std::string& line : lines)
      if (is_ours(file) && line.starts_with("#include "))
        includes.push_back({file, line.substr(10, line.find_last_of("\">") - 10)});
  return includes;
}

std::string folder_of(const std::string& file) {
  return std::filesystem::path(file).parent_path().generic_string();
}

/// Returns the target of the innermost folder that has one; empty if none does.
std::string target_of(const Layers& layers, std::string path) {
  for (; !path.empty(); path = folder_of(path)) {
    if (const auto found = layers.target_of.find(path); found != layers.target_of.end())
      return found->second;
  }
  return "";
}

bool may_include(const Layers& layers, const std::string& from, const std::string& to) {
  if (from == to) return true;
  const auto links = layers.links.find(from);
  return links != layers.links.end() && std::ranges::any_of(links->second, [&](const auto& link) {
           return may_include(layers, link, to);
         });
}

Names forbidden(const std::vector<Include>& includes, const Layers& layers) {
  Names found;
  for (const auto& [from, to] : includes) {
    if (!is_ours(to)) continue;
    const std::string target = target_of(layers, to);
    if (target.empty() || !may_include(layers, target_of(layers, from), target))
      found.push_back(fmt::format("{} includes {}", from, to));
  }
  return found;
}

/// Returns the folders on a cycle of includes or on a path to one, by repeatedly removing folders
/// that include none of the remaining ones.
std::set<std::string> mutual_folders(const std::vector<Include>& includes) {
  std::map<std::string, std::set<std::string>> remaining;
  for (const auto& [from, to] : includes)
    if (is_ours(to) && folder_of(from) != folder_of(to))
      remaining[folder_of(from)].insert(folder_of(to));
  const auto ends = [&](const auto& folder) {
    return std::ranges::none_of(folder.second, [&](auto& to) { return remaining.contains(to); });
  };
  while (std::erase_if(remaining, ends) > 0) {
  }
  std::set<std::string> folders;
  for (const auto& [folder, included] : remaining) folders.insert(folder);
  return folders;
}

std::string unit_of(const std::string& file) { return file.substr(0, file.rfind('.')); }

Names mutual_units(const std::vector<Include>& includes) {
  std::map<std::string, std::set<std::string>> included;
  for (const auto& [from, to] : includes)
    if (unit_of(from) != unit_of(to)) included[unit_of(from)].insert(unit_of(to));
  Names found;
  for (const auto& [unit, others] : included)
    for (const std::string& other : others)
      if (unit < other && included.contains(other) && included.at(other).contains(unit))
        found.push_back(fmt::format("{} and {}", unit, other));
  return found;
}

Names using_libraries(const std::vector<Include>& includes,
                      const Names& folders,
                      const Names& libraries) {
  const auto begins_one = [](const std::string& name, const Names& of) {
    return std::ranges::any_of(of, [&](const auto& one) { return name.starts_with(one); });
  };
  Names found;
  for (const auto& [from, to] : includes)
    if (begins_one(from, folders) && begins_one(to, libraries))
      found.push_back(fmt::format("{} includes {}", from, to));
  return found;
}

TEST(Architecture, SourcesIncludeOnlyWhatTheirTargetLinks) {
  std::ifstream file(GPO_LAYERS);
  const Layers layers = read_layers(file);
  ASSERT_GT(layers.target_of.size(), 10U);
  std::vector<Include> includes = tree();
  EXPECT_GT(includes.size(), 1000U);
  // Without GPO_UI only the engine has targets.
  std::erase_if(includes, [&](const Include& include) {
    return !include.from.starts_with("engine/") && !layers.target_of.contains("ui");
  });
  EXPECT_THAT(forbidden(includes, layers), IsEmpty());
}

TEST(Architecture, NoTwoFoldersIncludeEachOther) { EXPECT_THAT(mutual_folders(tree()), IsEmpty()); }

TEST(Architecture, NoTwoFilesIncludeEachOther) { EXPECT_THAT(mutual_units(tree()), IsEmpty()); }

TEST(Architecture, MathematicsUsesOnlyEigenAndCeres) {
  EXPECT_THAT(using_libraries(tree(), kPure, kLibrariesOfImagesAndFiles), IsEmpty());
}

TEST(Architecture, EngineUsesNoWindowLibraries) {
  EXPECT_THAT(using_libraries(tree(), {"engine/"}, kLibrariesOfWindows), IsEmpty());
}

/// Returns the length of the longest function: from an unindented line to an unindented brace.
int longest_function(const Names& lines) {
  int longest = 0, head = 0;
  for (int i = 0; i < static_cast<int>(lines.size()); ++i) {
    if (lines[i] == "}") longest = std::max(longest, i - head + 1);
    if (!lines[i].empty() && std::string(" }/#)").find(lines[i][0]) == std::string::npos) head = i;
  }
  return longest;
}

TEST(Architecture, FunctionsAreShort) {
  std::set<std::string> long_functions;
  for (const auto& [file, lines] : lines_of_tree())
    if (longest_function(lines) > kMostLinesOfFunction) long_functions.insert(file);
  // Loops that the compiler must optimize as a whole.
  EXPECT_THAT(long_functions,
              testing::ElementsAre("engine/methods/plane/plane_kernel.cpp",
                                   "engine/tracking/patch_sums.cpp"));
}

/// Returns the type that a line of a header begins to define at namespace level; empty if none.
std::string type_defined_in(const std::string& line) {
  static const std::regex kDefinition(R"((?:struct|class|enum class) (\w+)[^<;]*\{.*)");
  std::smatch parts;
  return std::regex_match(line, parts, kDefinition) ? parts[1].str() : "";
}

// The linker silently takes one of two definitions for the other.
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

TEST(Architecture, FindsIncludesAgainstTheLayers) {
  std::istringstream lines(
      "files gpo_base engine/base\nfiles gpo_geometry engine/geometry\n"
      "files gpo_window engine/window\nfiles gpo_window engine/window.h\n"
      "links gpo_geometry gpo_base\nlinks gpo_window gpo_geometry\n");
  const std::vector<Include> includes = {
      {"engine/geometry/plane.cpp", "engine/window/window.h"},
      {"engine/window/window.h", "engine/geometry/fits/pose.h"},
      {"engine/window/window.h", "engine/base/error.h"},
      {"engine/window.h", "engine/window/window.h"},
      {"engine/somewhere/new.cpp", "engine/base/error.h"},
      {"engine/base/error.cpp", "engine/elsewhere/new.h"},
      {"engine/geometry/pose.cpp", "opencv2/core.hpp"},
      {"engine/geometry/a.h", "engine/geometry/b.h"},
      {"engine/geometry/b.cpp", "engine/geometry/a.h"},
      {"engine/geometry/plane.cpp", "engine/geometry/plane.h"},
  };
  EXPECT_THAT(forbidden(includes, read_layers(lines)),
              testing::ElementsAre("engine/geometry/plane.cpp includes engine/window/window.h",
                                   "engine/somewhere/new.cpp includes engine/base/error.h",
                                   "engine/base/error.cpp includes engine/elsewhere/new.h"));
  EXPECT_THAT(mutual_folders({{"engine/a/1.h", "engine/b/1.h"},
                              {"engine/b/2.h", "engine/c/1.h"},
                              {"engine/c/2.h", "engine/a/2.h"},
                              {"engine/d/1.h", "engine/c/2.h"},
                              {"engine/c/2.h", "engine/e/2.h"}}),
              testing::ElementsAre("engine/a", "engine/b", "engine/c", "engine/d"));
  EXPECT_THAT(mutual_units(includes),
              testing::ElementsAre("engine/geometry/a and engine/geometry/b"));
  EXPECT_THAT(using_libraries(includes, kPure, kLibrariesOfImagesAndFiles),
              testing::ElementsAre("engine/geometry/pose.cpp includes opencv2/core.hpp"));
  EXPECT_EQ(type_defined_in("class PlaneProblem {"), "PlaneProblem");
  EXPECT_EQ(type_defined_in("enum class Loss { squared, huber };"), "Loss");
  EXPECT_EQ(type_defined_in("struct ChoiceKeys<Loss> {"), "");
  EXPECT_EQ(type_defined_in("struct Window;"), "");
}

}  // namespace
}  // namespace gpo
