// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// Uses the library as others do.
#include "engine/files/text_file.h"
#include "engine/geometry/pose.h"
#include "engine/inspection/inspector.h"
#include "engine/recording/images/images.h"
#include "engine/recording/layouts/open_recording.h"
#include "engine/version.h"
#include "tests/app/program.h"

#include <sstream>

#include <gmock/gmock.h>
#include <opencv2/calib3d.hpp>

namespace gpo::test {
namespace {

using testing::HasSubstr, testing::IsSubsetOf, testing::Not;

constexpr int kDeskFrames = 30;

/// Names of the libraries in a link line: ceres, opencv_core.
std::set<std::string> libraries_of(const std::string& link_line) {
  return matches_in(link_line, R"((?:/lib|\s-l)([A-Za-z0-9_+-]+?)(?:\.so[.0-9]*|\.a)?(?=\s|$))", 1);
}

std::string link_line(const fs::path& build, const std::string& target) {
  const auto commands = split(shell("ninja -C {} -t commands {}", build, target).out, '\n');
  return commands.empty() ? "" : commands.back();
}

Eigen::Vector3d vector_after(const std::string& word, const std::string& out) {
  std::istringstream rest(out.substr(out.find(word) + word.size()));
  Eigen::Vector3d v;
  rest >> v.x() >> v.y() >> v.z();
  return v;
}

/// A folder with the installed library, the examples built against it and their input.
class Installed {
 public:
  void prepare() {
    fs::copy(GPO_SOURCE_DIR "/engine/examples", folder_ / "examples");
    const Outcome installed =
        shell("for component in development library; do cmake --install '" GPO_BINARY_DIR
              "' --prefix '{}/prefix' --component $component || exit 1; done",
              folder_);
    ASSERT_EQ(installed.exit_code, 0) << installed.out << installed.err;
    const Outcome built = shell(
        "cd '{0}' && cmake -S examples -B build -G Ninja -DCMAKE_BUILD_TYPE=Debug "
        "-DCMAKE_PREFIX_PATH='{0}/prefix' "
        "-DCMAKE_CXX_FLAGS='-O1 -march=native -Wall -Wextra -Werror' && "
        "cmake --build build",
        folder_);
    ASSERT_EQ(built.exit_code, 0) << built.out << built.err;
    make_input();
  }

  void expect_examples() const {
    const std::string pose = example("tracks_to_pose tracks.csv " + camera_);
    EXPECT_THAT(pose, HasSubstr("verdict normal uncertainty"));
    const Eigen::Vector3d normal = vector_after("\nnormal ", pose);  // without the gyroscope
    EXPECT_LT(angle_deg(normal, inspection_->initialization->plane.normal), 0.3);
    const Eigen::Vector3d center = vector_after("center ", pose);
    EXPECT_LT((center - inspection_->initialization->cameras.back().p_wc).norm(), 0.02);
    EXPECT_THAT(example("live_camera_loop pictures " + camera_ + " --picture cube.png"),
                HasSubstr("ready with "));
    const cv::Mat drawn = read_image(folder_ / "cube.png");
    const cv::Mat before = read_image(folder_ / "pictures/029.png");
    ASSERT_EQ(drawn.size(), before.size());
    cv::Mat different;
    cv::absdiff(drawn, before, different);
    EXPECT_GT(cv::countNonZero(different.reshape(1) > 60), 500);  // the edges of the cube
    EXPECT_THAT(example("orb_style_initializer pictures " + camera_),
                HasSubstr("initialized by image "));
    EXPECT_THAT(example("plane_of_points"),
                HasSubstr(fmt::format("gpo {}: off by", GPO_VERSION_MAJOR)));
  }

  void expect_core_links_only_ceres() const {
    write_file(folder_ / "ceres/CMakeLists.txt",
               "cmake_minimum_required(VERSION 3.22)\nproject(only C CXX)\n"
               "find_package(Ceres REQUIRED)\nfind_package(Threads REQUIRED)\n"
               "add_executable(only only.cpp)\n"
               "target_link_libraries(only PRIVATE Ceres::ceres Threads::Threads)\n");
    write_file(folder_ / "ceres/only.cpp", "int main() {}\n");
    const Outcome configured = shell("cd '{}' && cmake -S ceres -B ceres/build -G Ninja", folder_);
    ASSERT_EQ(configured.exit_code, 0) << configured.err;
    const auto of_ceres = libraries_of(link_line(folder_ / "ceres/build", "only"));
    auto of_core = libraries_of(link_line(folder_ / "build", "plane_of_points"));
    EXPECT_THAT(of_ceres, testing::Contains("ceres"));
    EXPECT_EQ(of_core.erase("gpo_core"), 1U);
    EXPECT_THAT(of_core, IsSubsetOf(of_ceres));
    const std::string needed =
        shell("objdump -p '{}/build/plane_of_points' | grep NEEDED", folder_).out;
    // Debian 12 has Ceres as a static library, whose logging is not.
    EXPECT_THAT(needed, testing::AnyOf(HasSubstr("libceres"), HasSubstr("libglog")));
    for (const char* other :
         {"opencv", "opengv", "fmt", "yaml", "avformat", "sqlite", "exiv2", "tinyxml"})
      EXPECT_THAT(needed, Not(HasSubstr(other)));
  }

  void expect_consistent_includes() const {
    int headers = 0;
    for (const auto& entry : fs::recursive_directory_iterator(folder_ / "prefix/include")) {
      if (entry.path().extension() != ".h") continue;
      ++headers;
      for (const std::string& line : split(read_file(entry.path()), '\n')) {
        EXPECT_THAT(line, Not(testing::StartsWith("#include \"engine/"))) << entry.path();
        if (!line.starts_with("#include \"gpo/")) continue;
        const std::string name = line.substr(10, line.rfind('"') - 10);
        EXPECT_TRUE(fs::exists(folder_ / "prefix/include" / name)) << entry.path() << ": " << line;
      }
    }
    EXPECT_LE(headers, 52);
  }

  void expect_stable_headers_compile_alone() const {
    for (const char* name : {"geometry", "solvers", "result", "initialize", "live"}) {
      const Outcome compiled = shell(
          "cd '{0}' && echo '#include <gpo/{1}.h>' >{1}.cpp && g++ -std=c++20 -fsyntax-only "
          "{1}.cpp "
          "$(PKG_CONFIG_PATH=$(dirname $(find $PWD/prefix -name gpo.pc)) pkg-config --cflags gpo)",
          folder_,
          name);
      EXPECT_EQ(compiled.exit_code, 0) << name << compiled.err;
    }
  }

  void expect_other_versions_refused() const {
    const auto configured = [&](const std::string& wanted) {
      write_file(folder_ / "wants/CMakeLists.txt",
                 "cmake_minimum_required(VERSION 3.22)\nproject(wants C CXX)\nfind_package(" +
                     wanted + ")\n");
      return shell(
          "cd '{0}' && rm -rf wants/build && cmake -S wants -B wants/build "
          "-DCMAKE_PREFIX_PATH='{0}/prefix'",
          folder_);
    };
    EXPECT_EQ(configured("gpo 1 REQUIRED COMPONENTS core").exit_code, 0);
    EXPECT_NE(configured("gpo 2 REQUIRED COMPONENTS core").exit_code, 0);
    const Outcome unknown = configured("gpo 1 REQUIRED COMPONENTS core window");
    EXPECT_NE(unknown.exit_code, 0);
    EXPECT_THAT(unknown.err, HasSubstr("window"));
  }

 private:
  /// Writes tracks and images of the desk without distortion, as the examples expect.
  void make_input() {
    const auto recording = open_recording(desk());
    Settings settings;
    settings.frames = kDeskFrames;
    inspection_ = Inspector(recording).inspect(settings);
    const Camera& c = recording->camera;
    std::string csv = "frame,track,x,y\n";
    for (int i = 0; i < kDeskFrames; ++i) {
      const auto& points = inspection_->window->points_px[i];
      for (Eigen::Index j = 0; j < points.cols(); ++j)
        if (points.col(j).allFinite())
          csv += fmt::format(
              "{},{},{:.6f},{:.6f}\n", i, inspection_->tracks->ids[j], points(0, j), points(1, j));
    }
    write_file(folder_ / "tracks.csv", csv);
    const cv::Matx33d K(c.fx, 0, c.cx, 0, c.fy, c.cy, 0, 0, 1);
    fs::create_directories(folder_ / "pictures");
    for (int i = 0; i < kDeskFrames; ++i) {
      cv::Mat straight;
      cv::undistort(recording->images->bgr(i), straight, K, c.coefficients);
      write_image(folder_ / fmt::format("pictures/{:03}.png", i), straight);
    }
    camera_ = fmt::format("{} {} {} {}", c.fx, c.fy, c.cx, c.cy);
  }

  std::string example(const std::string& line) const {
    const Outcome outcome = shell("cd '{}' && build/{}", folder_, line);
    EXPECT_EQ(outcome.exit_code, 0) << line << outcome.out << outcome.err;
    return outcome.out;
  }

  fs::path folder_ = fresh_folder();
  std::string camera_;
  std::shared_ptr<const Inspection> inspection_;
};

// One test, because installing and building takes long.
TEST(Library, ExamplesBuildAndRunAgainstTheInstallation) {
  Installed library;
  library.prepare();
  if (HasFatalFailure()) return;
  library.expect_examples();
  library.expect_core_links_only_ceres();
  library.expect_consistent_includes();
  library.expect_stable_headers_compile_alone();
  library.expect_other_versions_refused();
}

// Only configures, because the sources are the same as those of the installation.
TEST(Library, KeepsSettingsOfItsParentAsSubdirectory) {
  const fs::path folder = fresh_folder();
  write_file(folder / "main.cpp", "#include <gpo/version.h>\nint main() {}\n");
  write_file(folder / "CMakeLists.txt",
             fmt::format(R"(cmake_minimum_required(VERSION 3.22)
project(parent C CXX)
set(GPO_COMPONENTS core CACHE STRING "")
add_subdirectory({} gpo)
foreach(mine CMAKE_CXX_STANDARD CMAKE_CXX_COMPILER_LAUNCHER CMAKE_EXPORT_COMPILE_COMMANDS CMAKE_CXX_FLAGS)
  message("${{mine}}=<${{${{mine}}}}>")
endforeach()
get_directory_property(options COMPILE_OPTIONS)
message("options=<${{options}}>")
add_executable(parent main.cpp)
target_link_libraries(parent PRIVATE gpo::core)
)",
                         GPO_SOURCE_DIR));
  const Outcome outcome = shell(
      "env -u CXXFLAGS cmake -S '{0}' -B '{0}/build' -G Ninja "
      "-DCMAKE_DISABLE_FIND_PACKAGE_OpenCV=ON -DCMAKE_DISABLE_FIND_PACKAGE_GTest=ON",
      folder);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  for (const std::string& mine :
       split("CMAKE_CXX_STANDARD CMAKE_CXX_COMPILER_LAUNCHER CMAKE_EXPORT_COMPILE_COMMANDS "
             "CMAKE_CXX_FLAGS options",
             ' '))
    EXPECT_THAT(outcome.err, HasSubstr(mine + "=<>"));
  const std::string all = shell("ninja -C '{}/build' -t query all", folder).out;
  EXPECT_THAT(all, HasSubstr("parent"));
  EXPECT_THAT(all, Not(HasSubstr("gpo_")));  // no unused target
  EXPECT_THAT(link_line(folder / "build", "parent"), HasSubstr("libgpo_core.a"));
}

}  // namespace
}  // namespace gpo::test
