// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/files/text_file.h"
#include "engine/recording/companions/companion_files.h"
#include "tests/engine/recording/recording_folder.h"

#include <cmath>

namespace gpo::test {
namespace {

using testing::ElementsAre, testing::HasSubstr, testing::Pointwise;

using Numbers = std::vector<double>;

/// A lens file and the camera that its program's documentation describes.
struct LensFile {
  std::string name;    ///< in the cases
  std::string text;    ///< a smaller one
  std::string format;  ///< name of ours
  Distortion distortion;
  Numbers intrinsics;  ///< fx, fy, cx, cy, ours
  Numbers coefficients;
  bool has_body = false;
};

const std::string kMatrix4 =
    "[0.0148655429818, -0.999880929698, 0.00414029679422, -0.0216401454975, 0.999557249008, "
    "0.0149672133247, 0.025715529948, -0.064676986768, -0.0257744366974, 0.00375618835797, "
    "0.999660727178, 0.00981073058949, 0, 0, 0, 1]";
const Numbers kEurocPinhole = {458.654, 457.296, 367.215, 248.375};
const Numbers kEurocLens = {-0.28340811, 0.07395907, 0.00019359, 1.76187114e-05};
constexpr double kXi = -0.2409573942178872;
constexpr double kHalfPixel = 0.5;

std::vector<LensFile> lens_files() {
  using enum Distortion;
  const double fov = 2 * std::tan(0.9207 / 2) / 0.9207;
  const Numbers corner = {458.654, 457.296, 367.215 - kHalfPixel, 248.375 - kHalfPixel};
  return {
      {"basalt/euroc_ds_calib.json",
       R"({"value0": {"T_imu_cam": [{"px": -0.016774788924641534, "py": -0.068938940687127,
"pz": 0.005139123188382424, "qx": -0.007239825785317818, "qy": 0.007541278561558601,
"qz": 0.7017845426564943, "qw": 0.7123125505904486}], "intrinsics": [{"camera_type": "ds",
"intrinsics": {"fx": 349.7560023050409, "fy": 348.72454229977037, "cx": 365.89440762590149,
"cy": 249.32995565708704, "xi": -0.2409573942178872, "alpha": 0.566996899163044}}],
"resolution": [[752, 480]]}})",
       "Basalt",
       double_sphere,
       {349.7560023050409 / (1 + kXi),
        348.72454229977037 / (1 + kXi),
        365.89440762590149,
        249.32995565708704},
       {kXi, 0.566996899163044},
       true},
      {"camodocal-mei/camera.yaml",
       "%YAML:1.0\n---\nmodel_type: MEI\nimage_width: 752\nimage_height: 480\n"
       "mirror_parameters:\n   xi: 3.6313355285286337e+00\ndistortion_parameters:\n"
       "   k1: 6.5586e-01\n   k2: -2.8127e-01\n   p1: 1.5e-03\n   p2: 9.4e-05\n"
       "projection_parameters:\n   gamma1: 7.2e+02\n   gamma2: 7.2e+02\n   u0: 3.76e+02\n"
       "   v0: 2.41e+02\n",
       "VINS and camodocal",
       omnidirectional,
       {720 / 4.6313355285286337, 720 / 4.6313355285286337, 376, 241},
       {3.6313355285286337, 0.65586, -0.28127, 1.5e-3, 9.4e-5}},
      {"colmap/cameras.txt",
       "# Number of cameras: 1\n1 OPENCV 752 480 458.654 457.296 367.215 248.375 -0.28340811 "
       "0.07395907 0.00019359 1.76187114e-05\n",
       "COLMAP",
       radial_tangential,
       corner,
       kEurocLens},
      {"eth3d/calibration.txt",
       "458.654 457.296 367.215 248.375\n",
       "ETH3D",
       none,
       kEurocPinhole,
       {}},
      {"kalibr-ds/camchain.yaml",
       "cam0:\n  camera_model: ds\n  distortion_coeffs: []\n  distortion_model: none\n"
       "  intrinsics: [-0.24096, 0.566997, 349.756, 348.7245, 365.894, 249.33]\n"
       "  resolution: [752, 480]\n",
       "Kalibr",
       double_sphere,
       {349.756 / (1 - 0.24096), 348.7245 / (1 - 0.24096), 365.894, 249.33},
       {-0.24096, 0.566997}},
      {"kalibr-fov/camchain.yaml",
       "cam0:\n  camera_model: pinhole\n  distortion_coeffs: [0.9207]\n  distortion_model: fov\n"
       "  intrinsics: [380.1, 379.8, 367.2, 248.4]\n  resolution: [752, 480]\n",
       "Kalibr",
       field_of_view,
       {380.1 * fov, 379.8 * fov, 367.2, 248.4},
       {0.9207}},
      {"kalibr-omni/camchain.yaml",
       "cam0:\n  camera_model: omni\n  distortion_coeffs: [-0.11604, 0.45289, -0.00037, -0.00034]\n"
       "  distortion_model: radtan\n  intrinsics: [2.0443, 1002.569, 1005.495, 367.6, 248.8]\n"
       "  resolution: [752, 480]\n",
       "Kalibr",
       omnidirectional,
       {1002.569 / 3.0443, 1005.495 / 3.0443, 367.6, 248.8},
       {2.0443, -0.11604, 0.45289, -0.00037, -0.00034}},
      {"kitti/calib.txt",
       "P0: 7.070912000000e+02 0 6.018873e+02 0 0 7.070912e+02 1.831104e+02 0 0 0 1 0\n",
       "KITTI",
       none,
       {707.0912, 707.0912, 601.8873, 183.1104},
       {}},
      {"nerfstudio/transforms.json",
       R"({"camera_model": "OPENCV", "fl_x": 458.654, "fl_y": 457.296, "cx": 367.215,
"cy": 248.375, "w": 752, "h": 480, "k1": -0.28340811, "k2": 0.07395907, "p1": 0.00019359,
"p2": 1.76187114e-05, "frames": []})",
       "nerfstudio",
       radial_tangential,
       corner,
       kEurocLens},
      {"openvins/kalibr_imucam_chain.yaml",
       "%YAML:1.0\n\ncam0:\n  T_imu_cam: " + kMatrix4 +
           "\n  camera_model: pinhole\n  distortion_coeffs: [-0.28340811, 0.07395907, 0.00019359, "
           "1.76187114e-05]\n  distortion_model: radtan\n  intrinsics: [458.654, 457.296, 367.215, "
           "248.375]\n  resolution: [752, 480]\n",
       "Kalibr",
       radial_tangential,
       kEurocPinhole,
       kEurocLens,
       true},
      {"orb-slam3/EuRoC.yaml",
       "%YAML:1.0\nCamera.type: \"PinHole\"\nCamera1.fx: 458.654\nCamera1.fy: 457.296\n"
       "Camera1.cx: 367.215\nCamera1.cy: 248.375\nCamera1.k1: -0.28340811\n"
       "Camera1.k2: 0.07395907\nCamera1.p1: 0.00019359\nCamera1.p2: 1.76187114e-05\n"
       "Camera.width: 752\nCamera.height: 480\nCamera.fps: 20\nIMU.T_b_c1: !!opencv-matrix\n"
       "   rows: 4\n   cols: 4\n   dt: f\n   data: " +
           kMatrix4 + "\n",
       "ORB-SLAM",
       radial_tangential,
       kEurocPinhole,
       kEurocLens,
       true},
      {"orb-slam3-kb8/TUM-VI.yaml",
       "%YAML:1.0\nCamera.type: \"KannalaBrandt8\"\nCamera1.fx: 190.978477\nCamera1.fy: "
       "190.973307\nCamera1.cx: 254.931706\nCamera1.cy: 256.897442\nCamera1.k1: 0.003482389402\n"
       "Camera1.k2: 0.000715034845\nCamera1.k3: -0.002053236141\nCamera1.k4: 0.000202936736\n"
       "Camera.width: 512\nCamera.height: 512\n",
       "ORB-SLAM",
       equidistant,
       {190.978477, 190.973307, 254.931706, 256.897442},
       {0.003482389402, 0.000715034845, -0.002053236141, 0.000202936736}},
      {"ros2-camera-info/camera_info.yaml",
       "height: 480\nwidth: 752\ndistortion_model: plumb_bob\nd:\n- -0.28340811\n- 0.07395907\n"
       "- 0.00019359\n- 1.76187114e-05\n- 0.0\nk:\n- 458.654\n- 0.0\n- 367.215\n- 0.0\n- 457.296\n"
       "- 248.375\n- 0.0\n- 0.0\n- 1.0\nr: [1, 0, 0, 0, 1, 0, 0, 0, 1]\n",
       "OpenCV or ROS",
       radial_tangential,
       kEurocPinhole,
       {-0.28340811, 0.07395907, 0.00019359, 1.76187114e-05, 0}},
      {"vins-mono/euroc_config.yaml",
       "%YAML:1.0\nmodel_type: PINHOLE\nimage_width: 752\nimage_height: 480\n"
       "distortion_parameters:\n   k1: -2.917e-01\n   k2: 8.228e-02\n   p1: 5.333e-05\n"
       "   p2: -1.578e-04\nprojection_parameters:\n   fx: 4.616e+02\n   fy: 4.603e+02\n"
       "   cx: 3.630e+02\n   cy: 2.481e+02\nextrinsicRotation: !!opencv-matrix\n   rows: 3\n"
       "   cols: 3\n   dt: d\n   data: [0.0148655429818, -0.999880929698, 0.00414029679422, "
       "0.999557249008, 0.0149672133247, 0.025715529948, -0.0257744366974, 0.00375618835797, "
       "0.999660727178]\nextrinsicTranslation: !!opencv-matrix\n   rows: 3\n   cols: 1\n   dt: d\n"
       "   data: [-0.0216401454975, -0.064676986768, 0.00981073058949]\ntd: 0.01\n",
       "VINS and camodocal",
       radial_tangential,
       {461.6, 460.3, 363, 248.1},
       {-0.2917, 0.08228, 5.333e-05, -1.578e-04},
       true}};
}

void expect_lens(const Calibration& found, const LensFile& expected) {
  SCOPED_TRACE(expected.name);
  const Camera& camera = found.camera;
  EXPECT_EQ(found.format, expected.format);
  EXPECT_EQ(camera.distortion, expected.distortion);
  EXPECT_THAT((Numbers{camera.fx, camera.fy, camera.cx, camera.cy}),
              Pointwise(testing::DoubleNear(1e-10), expected.intrinsics));
  EXPECT_THAT(camera.coefficients, Pointwise(testing::DoubleEq(), expected.coefficients));
  ASSERT_EQ(found.T_body_camera.has_value(), expected.has_body);
  if (!expected.has_body) return;
  // The camera's x is the body's y in all of them, which are EuRoC's.
  EXPECT_GT(found.T_body_camera->R_wc(1, 0), 0.99);
  EXPECT_NEAR(found.T_body_camera->p_wc.y(), -0.067, 0.003);
}

TEST(LensFormats, ReadAllFilesOfOtherPrograms) {
  for (const LensFile& one : lens_files()) {
    const TestFolder folder;
    const auto file = folder.write(std::filesystem::path(one.name).filename().string(), one.text);
    expect_lens(read_calibration(file), one);
    EXPECT_EQ(search_calibration({folder.path()}).file, file);
  }
}

std::filesystem::path case_folder(const char* name) {
  return std::filesystem::path(GPO_SOURCE_DIR) / "../shared/data/cases" / name;
}

TEST(LensFormats, ReadTheFilesOfTheCases) {
  const auto folder = case_folder("camera-files-of-slam-systems");
  if (!is_folder(folder)) GTEST_SKIP() << folder << " is missing";
  for (const LensFile& one : lens_files()) expect_lens(read_calibration(folder / one.name), one);
}

TEST(LensFormats, ReadTimeOffsetsReadoutAndRate) {
  const TestFolder folder;
  const auto read = [&](const std::string& text) {
    return read_calibration(folder.write("camera.yaml", text));
  };
  const std::string vins = lens_files().back().text;
  EXPECT_EQ(read(vins).time_offset_ns, 10'000'000);
  EXPECT_FALSE(read(vins).camera.readout);
  const auto rolling = read(vins + "rolling_shutter: 1\nrolling_shutter_tr: 0.033\n");
  EXPECT_DOUBLE_EQ(rolling.camera.readout.value().seconds, 0.033);
  EXPECT_EQ(read(lens_files()[10].text).rate_hz, 20);
}

TEST(LensFormats, FollowVinsFusionToItsCamera) {
  const TestFolder folder;
  folder.write("cam0_mei.yaml", lens_files()[1].text);
  const auto file = folder.write("euroc_config.yaml",
                                 "%YAML:1.0\ncam0_calib: \"cam0_mei.yaml\"\nbody_T_cam0: "
                                 "!!opencv-matrix\n   rows: 4\n   cols: 4\n   dt: d\n   data: " +
                                     kMatrix4 + "\ntd: -0.002\n");
  const Calibration found = read_calibration(file);
  EXPECT_EQ(found.camera.distortion, Distortion::omnidirectional);
  EXPECT_EQ(found.time_offset_ns, -2'000'000);
  ASSERT_TRUE(found.T_body_camera);
  EXPECT_GT(found.T_body_camera->R_wc(1, 0), 0.99);
}

TEST(LensFormats, ReadAllOfColmapsModels) {
  using enum Distortion;
  const TestFolder folder;
  const auto read = [&](const std::string& line) {
    return read_calibration(folder.write("cameras.txt", "1 " + line + "\n")).camera;
  };
  EXPECT_EQ(read("SIMPLE_PINHOLE 640 480 500 320 240").fy, 500);
  EXPECT_EQ(read("PINHOLE 640 480 500 501 320 240").cx, 319.5);
  EXPECT_THAT(read("SIMPLE_RADIAL 640 480 500 320 240 0.1").coefficients,
              ElementsAre(0.1, 0, 0, 0));
  EXPECT_THAT(read("RADIAL 640 480 500 320 240 0.1 0.2").coefficients, ElementsAre(0.1, 0.2, 0, 0));
  const Camera full = read("FULL_OPENCV 640 480 500 501 320 240 1 2 3 4 5 6 7 8");
  EXPECT_THAT(full.coefficients, ElementsAre(1, 2, 3, 4, 5, 6, 7, 8));
  EXPECT_EQ(read("OPENCV_FISHEYE 640 480 500 501 320 240 1 2 3 4").distortion, equidistant);
  EXPECT_EQ(read("RADIAL_FISHEYE 640 480 500 320 240 0.1 0.2").distortion, equidistant);
  const Camera fov = read("FOV 640 480 500 501 320 240 0.9");
  EXPECT_DOUBLE_EQ(fov.fx, 500 * 2 * std::tan(0.45) / 0.9);
  const Camera prism = read("THIN_PRISM_FISHEYE 640 480 500 501 320 240 .1 .2 .3 .4 .5 .6 .7 .8");
  EXPECT_EQ(prism.distortion, thin_prism_fisheye);
  EXPECT_THAT(prism.coefficients, ElementsAre(.1, .2, .3, .4, .5, .6, .7, .8));
}

TEST(LensFormats, BlameTheKeyThatIsMissing) {
  const auto without = [](std::size_t index, const std::string& key) {
    std::string text = lens_files()[index].text;
    const auto found = text.find(key);
    return text.replace(found, key.size(), "other");
  };
  const TestFolder folder;
  const auto error = [&](const char* name, const std::string& text) {
    return error_of([&] { read_calibration(folder.write(name, text)); });
  };
  EXPECT_THAT(error("a.yaml", without(10, "Camera1.fx")),
              HasSubstr("a.yaml: key `Camera1.fx`: found no value, expected a number"));
  EXPECT_THAT(error("a.yaml", without(1, "xi")),
              HasSubstr("key `mirror_parameters.xi`: found no value"));
  EXPECT_THAT(error("a.json", without(0, "alpha")),
              HasSubstr("key `value0.intrinsics.0.intrinsics.alpha`: found no value"));
  EXPECT_THAT(error("a.yaml", without(6, "intrinsics")), HasSubstr("key `cam0.intrinsics`"));
  EXPECT_THAT(error("a.yaml", "speed: 3\n"), HasSubstr("found no key of a known lens file"));
  EXPECT_THAT(error("cameras.txt", "1 SPHERE 640 480 1 2 3 4 5\n"),
              HasSubstr("cameras.txt: found the camera model SPHERE"));
  EXPECT_THAT(error("cameras.txt", "1 PINHOLE 640 480 1 2 3\n"),
              HasSubstr("found 5 numbers, expected 6 for PINHOLE"));
  EXPECT_THAT(error("cameras.txt", "1 PINHOLE 9 9 1 2 3 4\n2 PINHOLE 9 9 1 2 3 4\n"),
              HasSubstr("found 2 cameras, expected one camera for all images"));
}

TEST(LensFormats, ReadDistortionsUnderTheirUsualKeys) {
  const TestFolder folder;
  const std::string pinhole =
      R"({"camera_matrix": [[500, 0, 320], [0, 500, 240], [0, 0, 1]], "KEY": [0.1, -0.2, 0, 0]})";
  const std::string inside =
      R"({"camera": {"fx": 500, "fy": 500, "cx": 320, "cy": 240, "KEY": [0.1, -0.2, 0, 0]}})";
  for (const char* key : {"distortion_coefficients",
                          "Distortion_Coefficients",
                          "dist_coeffs",
                          "dist_coeff",
                          "dist_coefs",
                          "distCoef",
                          "distortion_coefficient",
                          "distortion_vector",
                          "distortion",
                          "coeffs",
                          "D"})
    for (std::string text : {pinhole, inside}) {
      text.replace(text.find("KEY"), 3, key);
      const Camera camera = read_calibration(folder.write("calibration.json", text)).camera;
      EXPECT_EQ(camera.distortion, Distortion::radial_tangential) << text;
      EXPECT_THAT(camera.coefficients, ElementsAre(0.1, -0.2, 0, 0)) << text;
    }
}

TEST(LensFormats, ReadOrbSlamsPinholeWithoutDistortion) {
  const TestFolder folder;
  for (const char* prefix : {"Camera1.", "Camera."}) {
    std::string text = "Camera.type: \"PinHole\"\n";
    for (const char* line : {"fx: 500\n", "fy: 501\n", "cx: 320\n", "cy: 240\n"})
      text += std::string(prefix) + line;
    const auto file = folder.write("settings.yaml", text);
    EXPECT_EQ(read_calibration(file).camera.distortion, Distortion::none);
    EXPECT_EQ(read_calibration(file).camera.fy, 501);
    folder.write("settings.yaml", text + prefix + "k2: 0.1\n");
    EXPECT_THAT(error_of([&] { read_calibration(file); }),
                HasSubstr(std::string("key `") + prefix + "k1`: found no value"));
  }
}

TEST(LensFormats, RefuseADistortionUnderAnUnknownKey) {
  const TestFolder folder;
  const auto error = [&](const std::string& text) {
    return error_of([&] { read_calibration(folder.write("calibration.yaml", text)); });
  };
  const std::string opencv = "camera_matrix: [500, 0, 320, 0, 500, 240, 0, 0, 1]\n";
  const std::string euroc =
      "resolution: [640, 480]\nintrinsics: [500, 500, 320, 240]\ndistortion_model: none\n";
  const std::string nice = "camera: {fx: 500, fy: 500, cx: 320, cy: 240, my_dist: [0.1, 0.2]}\n";
  const std::string kitti = "P0: 700 0 600 0 0 700 180 0 0 0 1 0\n";
  const std::string kUnread =
      "`: found a distortion that is not read, expected the key "
      "`distortion_coefficients` or the keys of the file's format";
  EXPECT_THAT(error(opencv + "Distortion_K: [0.1, 0.2]\n"),
              HasSubstr("calibration.yaml:2: key `Distortion_K" + kUnread));
  EXPECT_THAT(error(opencv + "k1: 0.1\n"), HasSubstr("key `k1" + kUnread));
  EXPECT_THAT(error(opencv + "D: [0.1, 0, 0, 0]\nradial_coefs: [0.1]\n"),
              HasSubstr("key `radial_coefs" + kUnread));
  EXPECT_THAT(error(opencv + "distortion_model: plumb_bob\n"),
              HasSubstr("key `distortion_coefficients`: found no value"));
  EXPECT_THAT(error(nice), HasSubstr("key `camera.my_dist" + kUnread));
  const std::string nerfstudio = "fl_x: 500\ncx: 320\ncy: 240\nw: 640\nh: 480\nk1: 0.1\n";
  for (const std::string& text : {euroc, kitti, nerfstudio + "k4: 0\n"})
    EXPECT_EQ(error(text), "no error");
  EXPECT_THAT(error(nerfstudio + "k4: 0.1\n"), HasSubstr("key `k4" + kUnread));
  EXPECT_THAT(error(nerfstudio + "camera_model: OPENCV_FISHEYE\np1: 0.1\n"),
              HasSubstr("key `p1" + kUnread));
  EXPECT_THAT(error(euroc + "lens_coef: [0.1]\n"), HasSubstr("key `lens_coef" + kUnread));
  EXPECT_THAT(error(kitti + "distortion_0: 0.1 0.2\n"), HasSubstr("key `distortion_0" + kUnread));
  for (const std::size_t program : {1, 10, 13})
    EXPECT_THAT(error(lens_files()[program].text + "dist_terms: [0.1]\n"),
                HasSubstr("key `dist_terms" + kUnread))
        << lens_files()[program].name;
  EXPECT_EQ(error(opencv + "distCoef5: [0, 0.0, 0]\nmin_dist: 30\ndistance: 2\nD: []\n"),
            "no error");
}

}  // namespace
}  // namespace gpo::test
