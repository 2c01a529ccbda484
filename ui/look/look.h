// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>

namespace gpo {

/// Colors of the window's surfaces and text, and of data drawn light on dark.
enum class Theme { dark, light };

constexpr std::uint64_t in_themes(std::uint32_t dark, std::uint32_t light) {
  return std::uint64_t{dark} << 32 | light;
}

/// Meaning of a color in views and panels, with its value in each theme. The methods' colors are in
/// `methods()`, the same in every theme. Data have Okabe and Ito's colors, which color-blind people
/// can distinguish.
// clang-format off
enum class Role : std::uint64_t {
  // Data.
  inlier = in_themes(0x1FCB93, 0x1FCB93), outlier = in_themes(0xF0503C, 0xF0503C),
  lost = in_themes(0xFFC400, 0xFFC400),  ///< tracks where they were last seen
  residual = in_themes(0xF0E442, 0xF0E442), truth = in_themes(0xA9AEB6, 0x6E757E),
  cube_base = in_themes(0x2BD67B, 0x2BD67B), cube_edge = in_themes(0xE4F3EA, 0x3B6B52),
  cube_face = in_themes(0x9FE8C4, 0x9FE8C4),
  reference = in_themes(0xF0F2F5, 0x2A2F36),  ///< the reference camera's mark
  plane = in_themes(0x8CF0FF, 0x40206A),   ///< the estimated one, unlike the cameras of any method
  normal = in_themes(0xFFC8B0, 0x5C3A00),  ///< arrow of the estimated plane
  uncertain = in_themes(0xFFF3D6, 0x7A6428),
  map_point = in_themes(0xC9D2DC, 0x5B6470),
  selected = in_themes(0xFFFFFF, 0x000000),    ///< rings around picked tracks
  pointed_at = in_themes(0x56B4E9, 0x56B4E9),  ///< rings around the item under the mouse
  rotation = in_themes(0xCC79A7, 0xCC79A7),    ///< angular rate
  axis_x = in_themes(0xEF5B50, 0xEF5B50), axis_y = in_themes(0x4CC26B, 0x4CC26B),
  axis_z = in_themes(0x4A90F0, 0x4A90F0),
  gravity = in_themes(0xFFB3E6, 0x9A2A77),  ///< up direction and horizon
  // Stages of an inspection.
  tracking = in_themes(0x56B4E9, 0x56B4E9), ransac = in_themes(0xE69F00, 0xE69F00),
  rotations = in_themes(0xCC79A7, 0xCC79A7), initialization = in_themes(0x009E73, 0x009E73),
  optimization = in_themes(0xF0E442, 0xF0E442),
  // Surfaces and text.
  scene_bottom = in_themes(0x15181D, 0xE9ECF0), scene_top = in_themes(0x262B33, 0xFAFBFC),
  background = in_themes(0x14171B, 0xF4F6F8), panel = in_themes(0x1B1F25, 0xFFFFFF),
  raised = in_themes(0x272D36, 0xE6EAEF), hovered = in_themes(0x343C48, 0xD8DEE6),
  active = in_themes(0x3F4958, 0xC6CFDA), border = in_themes(0x323944, 0xCBD2DA),
  text_dim = in_themes(0x98A2B0, 0x5A6472), text = in_themes(0xE6EAF0, 0x171B20),
  accent = in_themes(0x5AB6EA, 0x006DAA),  ///< chosen or draggable items
  good = in_themes(0x1FCB94, 0x00775A), warning = in_themes(0xE69F01, 0x925D00),
  bad = in_themes(0xF26A58, 0x900018),
};
// clang-format on

/// Returns 0xRRGGBB.
constexpr std::uint32_t color_of(Role role, Theme theme) {
  const auto colors = static_cast<std::uint64_t>(role);
  return static_cast<std::uint32_t>(theme == Theme::dark ? colors >> 32 : colors);
}

/// Colors of figures for print, on white; the same in every theme.
namespace palette {
constexpr std::uint32_t kInk = 0x1A1D21;
constexpr std::uint32_t kPaperAxis = 0x6B727C;
constexpr std::uint32_t kPaperGrid = 0xE4E7EB;
}  // namespace palette

constexpr double red(std::uint32_t rgb) { return ((rgb >> 16) & 0xFF) / 255.0; }
constexpr double green(std::uint32_t rgb) { return ((rgb >> 8) & 0xFF) / 255.0; }
constexpr double blue(std::uint32_t rgb) { return (rgb & 0xFF) / 255.0; }

/// Mixes two colors, `share` 0..1. Thin lines are dimmed this way, opaque, so that depth is right.
inline std::uint32_t mixed_rgb(std::uint32_t a, std::uint32_t b, double share) {
  const auto channel = [&](int shift) {
    const double x = (a >> shift) & 0xFF, y = (b >> shift) & 0xFF;
    return static_cast<std::uint32_t>(std::lround(x + share * (y - x))) << shift;
  };
  return channel(16) | channel(8) | channel(0);
}

/// Packs a color as Dear ImGui does (IM_COL32). `alpha` in 0..1.
inline std::uint32_t imgui_color(std::uint32_t rgb, double alpha = 1) {
  return static_cast<std::uint32_t>(alpha * 255.999) << 24 | (rgb & 0xFF) << 16 | (rgb & 0xFF00) |
         ((rgb >> 16) & 0xFF);
}

enum class Coloring { plane, residual, depth, life };

/// Direction from which the scene is seen until the user drags it.
enum class Viewpoint { oblique, top, front, side, camera };

template <class E>
struct ChoiceRow {
  E value;
  const char* key;    ///< in scripts and sessions
  const char* title;  ///< for people
  const char* tooltip;
  char keypad = 0;  ///< digit of the keypad, as in Blender; 0: none
};

// clang-format off
inline constexpr auto kColorings = std::to_array<ChoiceRow<Coloring>>({
    {Coloring::plane, "plane", "Color by plane",
     "Colors tracks and points by their plane; outliers are red crosses, lost tracks diamonds"},
    {Coloring::residual, "residual", "Color by residual",
     "Colors inliers by the RMS of their residuals of the solution over the window [px]"},
    {Coloring::depth, "depth", "Color by depth",
     "Colors tracks and points by their depth in the reference camera [plane distances]"},
    {Coloring::life, "life", "Color by life",
     "Colors tracks and points by the number of frames that see them"}});

inline constexpr auto kViewpoints = std::to_array<ChoiceRow<Viewpoint>>({
    {Viewpoint::oblique, "oblique", "From above and behind",
     "Shows the scene from behind the reference camera, above and beside it", '5'},
    {Viewpoint::top, "top", "From the top", "Shows the scene from straight above", '7'},
    {Viewpoint::front, "front", "Along the camera",
     "Looks along the plane in the direction of the reference camera: shows roll and height", '1'},
    {Viewpoint::side, "side", "From the side",
     "Looks along the plane, across the reference camera: shows pitch and height", '3'},
    {Viewpoint::camera, "camera", "Through the camera",
     "Shows the scene as the current frame's estimated camera sees it; follows the frame", '0'}});

inline constexpr const char* kThemeTooltip = "Sets the window's colors; methods and data keep theirs";
inline constexpr auto kThemes = std::to_array<ChoiceRow<Theme>>({
    {Theme::dark, "dark", "Dark theme", kThemeTooltip},
    {Theme::light, "light", "Light theme", kThemeTooltip}});
// clang-format on

constexpr const auto& choice_rows(Coloring /*any*/) { return kColorings; }
constexpr const auto& choice_rows(Viewpoint /*any*/) { return kViewpoints; }
constexpr const auto& choice_rows(Theme /*any*/) { return kThemes; }

/// Content of the views. The views read the members, all other code reads the rows below.
struct ViewToggles {
  bool tracks = true;
  bool tails = true;
  bool residuals = false;
  bool cube = true;
  bool truth = true;
  bool gravity = true;
  bool undistorted = false;
  bool legend = true;
  bool scan = false;
  bool wireframe = false;
  bool tower = false;
  bool log_histogram = false;
  int uncertainty = 1;    ///< magnification in the scene: 0 (not shown), 1, 10, 100
  int exaggeration = 1;   ///< magnification of the cube's error
  int point_size_px = 5;  ///< in the scene, at scale 1
  int live_seconds = 20;  ///< length of live images to keep [s]

  bool operator==(const ViewToggles&) const = default;
};

struct ViewToggle {
  const char* key;    ///< in scripts and sessions
  const char* title;  ///< for people
  char letter;        ///< on the keyboard; 0: none
  bool ViewToggles::*shown;
  const char* tooltip;       ///< one sentence
  const char* submenu = "";  ///< in the menu View; empty: the menu itself
  bool in_scene = false;     ///< changes the shapes of the scene, which are cached
};

inline constexpr const char* kCubeMenu = "Cube style";

// clang-format off
inline constexpr auto kViewToggles = std::to_array<ViewToggle>({
    {"tracks", "Tracks", 0, &ViewToggles::tracks, 
     "Shows inliers as circles, outliers as crosses, lost tracks as diamonds where last seen"},
    {"tails", "Tails", 'T', &ViewToggles::tails, "Shows each track's path over the last frames"},
    {"residuals", "Residual vectors", 'E', &ViewToggles::residuals,
     "Shows residuals of the solution, from observed to predicted position, enlarged"},
    {"cube", "Cube", 'B', &ViewToggles::cube, "Shows a cube on each estimated plane", "", true},
    {"wireframe", "Wireframe cube", 0, &ViewToggles::wireframe,
     "Shows only the cube's edges, without faces and shadow", kCubeMenu},
    {"tower", "Tower", 0, &ViewToggles::tower,
     "Shows a tower of five cubes: small tilts are easier to see", kCubeMenu},
    {"truth", "Ground truth", 'G', &ViewToggles::truth,
     "Shows the true cameras, plane and cube in gray, if known", "", true},
    {"gravity", "Gravity", 0, &ViewToggles::gravity,
     "Shows the up direction in the scene and the horizon in the image, from the accelerometer"},
    {"undistorted", "Undistort", 'K', &ViewToggles::undistorted,
     "Shows the image as a pinhole camera with the same K sees it"},
    {"legend", "Legends", 0, &ViewToggles::legend,
     "Explains the signs and colors of image and scene"},
    {"scan", "Scan for a start", 0, &ViewToggles::scan,
     "Initializes from frames all over the recording, in the background, and shows above the time "
     "line where it succeeds; click to start there"},
    {"log_histogram", "Logarithmic histogram", 0, &ViewToggles::log_histogram,
     "Shows the histogram of the residuals with a logarithmic axis, for rare large ones", "Colors and sizes"}});
// clang-format on

struct ViewNumber {
  const char* key;     ///< in sessions
  const char* action;  ///< in scripts
  const char* title;   ///< for people
  char letter;         ///< on the keyboard; 0: none
  int ViewToggles::*value;
  const char* tooltip;       ///< one sentence
  const char* submenu;       ///< in the menu View; empty: the menu itself
  const char* arguments;     ///< same as `Action::arguments`
  std::array<int, 4> steps;  ///< the action without an argument goes to the next one
  int least, most;           ///< in sessions, and in scripts if there are no steps
  std::string (*text)(int);  ///< formats the value for people
  int off;                   ///< the menu's check mark is set for larger values
  bool in_scene = false;     ///< changes the shapes of the scene, which are cached

  bool has_steps() const { return steps[0] != steps[1]; }
};

// clang-format off
inline constexpr auto kViewNumbers = std::to_array<ViewNumber>({
    {"uncertainty", "uncertainty", "Uncertainty", 'U', &ViewToggles::uncertainty,
     "Shows the 95 % regions of camera centers and normal in the scene. Press again for 10x, 100x, off",
     "", "", {0, 1, 10, 100}, 0, 100,
     [](int times) { return times > 1 ? "\u00d7" + std::to_string(times) : times == 1 ? "on" : "off"; }, 0, true},
    {"exaggeration", "exaggerate", "Exaggerate the cube's error", 'D', &ViewToggles::exaggeration,
     "Enlarges the cube's image error, from the true cube or else the first column's. Press again for "
     "5x, 20x, 100x, off",
     kCubeMenu, "[1|5|20|100]", {1, 5, 20, 100}, 1, 100,
     [](int times) { return times > 1 ? std::to_string(times) + "\u00d7" : "off"; }, 1},
    {"point_size_px", "point-size", "Size of points", 0, &ViewToggles::point_size_px,
     "Sets the size of the scene's points [px]", "Colors and sizes", "1..20", {}, 1, 20,
     [](int size) { return std::to_string(size) + " px"; }, 20, true},
    {"live_seconds", "live-seconds", "Seconds of live images", 0, &ViewToggles::live_seconds,
     "Sets how much of a camera or a stream is kept, from the next source on [s]", "", "1..600", {}, 1, 600,
     [](int seconds) { return std::to_string(seconds) + " s"; }, 600}});
// clang-format on

/// Formats with three significant digits, but at most `most` decimals.
std::string number_text(double value, int most);

std::string two_decimals(const std::optional<double>& value);  ///< "0.25"; a dash if unknown.

std::string length_text(double meters);  ///< "4.1 mm", "1.20 m".
std::string angle_text(double degrees);  ///< "0.31°".
std::string sigma_text(double degrees);  ///< "±0.31°", "undetermined" above 90°.
std::string milliseconds_text(double milliseconds);

/// Formats `value` - `reference`, both in the unit of `text`: "+0.12°", "-1.3 mm", "±0".
std::string difference_text(double value, double reference, std::string (*text)(double));

/// "0.912 ±0.004": two significant digits of the standard deviation, at most six decimals.
std::string uncertain_text(double value, double sigma);

}  // namespace gpo
