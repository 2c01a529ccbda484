// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tests/engine/recording/recording_folder.h"

#include <Eigen/Geometry>
#include <fmt/format.h>

namespace gpo::test {
namespace {

using testing::Contains, testing::ElementsAre, testing::HasSubstr, testing::IsNan;

/// Camera axes in body axes: x -> y, y -> z, z -> x.
const char* const kTbsCamera = "T_BS: [0, 0, 1, 0.1, 1, 0, 0, 0.2, 0, 1, 0, 0.3, 0, 0, 0, 1]\n";
const std::string kTbsImu = "T_BS: [0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]\n";

/// A small recording: 4 images at 10 Hz, gyroscope at 20 Hz.
class EurocReader : public RecordingFolder {
 protected:
  EurocReader() {
    folder.write("mav0/cam0/sensor.yaml", std::string(kCameraYaml) + kTbsCamera);
    std::string list = "#timestamp [ns],filename\n";
    for (int i = 0; i < 4; ++i) {
      list += fmt::format("{},{}.png\n", 1403636579000000001 + i * 100000000LL, i);
      folder.write(fmt::format("mav0/cam0/data/{}.png", i),
                   cv::Mat(48, 64, CV_8UC1, cv::Scalar(i)));
    }
    folder.write("mav0/cam0/data.csv", list);
    folder.write("mav0/imu0/sensor.yaml", kTbsImu);
    std::string imu =
        "#timestamp [ns],w_RS_S_x [rad s^-1],w_RS_S_y [rad s^-1],w_RS_S_z [rad s^-1]\n";
    for (int i = 0; i < 8; ++i)
      imu += std::to_string(1403636579000000001 + i * 50000000LL) + ",0.1,0.2,0.3\n";
    folder.write("mav0/imu0/data.csv", imu);
  }

  void write_truth(const std::string& rows) const {
    folder.write("mav0/state_groundtruth_estimate0/data.csv",
                 "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], "
                 "q_RS_y [], q_RS_z []\n" +
                     rows);
  }
};

TEST_F(EurocReader, OpensWithAndWithoutMav0) {
  for (const auto& path : {folder.path(), folder.path() / "mav0", folder.path() / ""}) {
    const auto recording = open_recording(path);
    EXPECT_EQ(recording->layout, "EuRoC");
    EXPECT_EQ(recording->frame_count(), 4);
    EXPECT_EQ(recording->timestamps_ns[1], 1403636579100000001);
    EXPECT_EQ(recording->images->bgr(2).at<cv::Vec3b>(0, 0)[0], 2);
    EXPECT_EQ(recording->path, path);
  }
  EXPECT_EQ(open_recording(folder.path() / "")->name, folder.path().filename());
}

TEST_F(EurocReader, RotatesTheGyroscopesAxes) {
  const auto recording = open();
  ASSERT_TRUE(recording->gyroscope);
  const Gyroscope& gyroscope = *recording->gyroscope;
  EXPECT_EQ(gyroscope.timestamps_ns.size(), 8U);
  EXPECT_EQ(gyroscope.lines.front(), 2);
  EXPECT_EQ(gyroscope.rates_rad_s[3], Eigen::Vector3d(0.1, 0.2, 0.3));
  // The camera's z is the body's x, which is the gyroscope's -y.
  EXPECT_TRUE(
      (gyroscope.R_gyro_camera * Eigen::Vector3d::UnitZ()).isApprox(-Eigen::Vector3d::UnitY()));
  EXPECT_EQ(gyroscope.bias_source, "none: zero");
}

TEST_F(EurocReader, PrefersTheBiasOfTheSensorFile) {
  folder.write("mav0/state_groundtruth_estimate0/data.csv",
               "#t,px,py,pz,qw,qx,qy,qz,vx,vy,vz,bwx,bwy,bwz,bax,bay,baz\n"
               "1403636579000000001,0,0,0,1,0,0,0,0,0,0,0.01,0.02,0.03,0,0,0\n"
               "1403636579100000001,0,0,0,1,0,0,0,0,0,0,0.03,0.04,0.05,0,0,0\n");
  const auto of_truth = open()->gyroscope.value();
  EXPECT_TRUE(of_truth.bias_rad_s.isApprox(Eigen::Vector3d(0.02, 0.03, 0.04), 1e-12));
  EXPECT_THAT(of_truth.bias_source, HasSubstr("ground truth"));
  folder.write("mav0/imu0/sensor.yaml", kTbsImu + "gyroscope_bias: [0.001, 0.002, 0.003]\n");
  const auto of_file = open()->gyroscope.value();
  EXPECT_EQ(of_file.bias_rad_s, Eigen::Vector3d(0.001, 0.002, 0.003));
  EXPECT_EQ(of_file.bias_source, "imu0/sensor.yaml");
}

TEST_F(EurocReader, InterpolatesTheCamerasTruth) {
  // The body rotates by 0.2 rad about its z while it moves; frame 1 is half-way between the
  // samples.
  write_truth(
      "1403636579050000001,1,2,3,1,0,0,0\n"
      "1403636579150000001,2,2,3,0.99500416527,0,0,0.09983341664\n");
  const auto recording = open();
  ASSERT_TRUE(recording->truth);
  const auto& poses = recording->truth->poses;
  ASSERT_EQ(poses.size(), 4U);
  EXPECT_FALSE(poses[0]);
  EXPECT_FALSE(poses[2]);
  ASSERT_TRUE(poses[1]);
  const Eigen::Matrix3d R_wb = Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitZ()).matrix();
  EXPECT_TRUE(poses[1]->p_wc.isApprox(
      Eigen::Vector3d(1.5, 2, 3) + R_wb * Eigen::Vector3d(.1, .2, .3), 1e-9));
  EXPECT_TRUE((poses[1]->R_wc * Eigen::Vector3d::UnitZ()).isApprox(R_wb.col(0), 1e-9));
}

TEST_F(EurocReader, ExtrapolatesATruthOfRoundedTimesToTheFirstAndLastFrame) {
  const auto pose_of_first = [&](std::int64_t late_ns) {
    write_truth(fmt::format("{},1,0,0,1,0,0,0\n{},2,0,0,1,0,0,0\n{},3,0,0,1,0,0,0\n",
                            1403636579000000001 + late_ns,
                            1403636579010000001 + late_ns,
                            1403636579020000001 + late_ns));
    const auto truth = open()->truth;
    return truth ? truth->poses[0] : std::nullopt;
  };
  const auto pose = pose_of_first(400'000);
  ASSERT_TRUE(pose);
  EXPECT_NEAR(pose->p_wc.x(), 1 - 0.04 + 0.1, 1e-9);
  EXPECT_TRUE(pose_of_first(-20'400'000));
  EXPECT_FALSE(pose_of_first(1'100'000));
  EXPECT_FALSE(pose_of_first(-21'100'000));
}

TEST_F(EurocReader, DoesNotUseATruthThatCoversNoFrame) {
  write_truth("0,1,0,0,1,0,0,0\n10000000,2,0,0,1,0,0,0\n");
  const auto recording = open();
  EXPECT_FALSE(recording->truth);
  EXPECT_THAT(recording->notes,
              Contains("the ground truth covers no frame, and is not used: "
                       "state_groundtruth_estimate0/data.csv"));
}

TEST_F(EurocReader, DoesNotInterpolateOverAGapInTheTruth) {
  std::string rows;
  for (const int ms : {-40, -30, -20, -10, 0, 10, 20, 30, 90, 110, 120, 230, 240})
    rows += std::to_string(1403636579000000001 + ms * 1000000LL) + ",0,0,0,1,0,0,0\n";
  write_truth(rows);
  const auto recording = open();
  const auto& poses = recording->truth->poses;
  EXPECT_TRUE(poses[0]);   // a sample
  EXPECT_TRUE(poses[1]);   // between 90 and 110 ms
  EXPECT_FALSE(poses[2]);  // between 120 and 230 ms
  EXPECT_FALSE(poses[3]);  // after the end
}

TEST_F(EurocReader, LeavesOutPosesThatWereNotMeasured) {
  std::string rows;
  for (const int ms : {0, 50, 100, 150, 200})
    rows += fmt::format("{},{},0,0,1,0,0,0\n",
                        1403636579000000001 + ms * 1000000LL,
                        ms == 50 || ms == 200 ? "nan" : "1");
  write_truth(rows);
  const auto recording = open();
  EXPECT_TRUE(recording->truth->poses[1]);
  EXPECT_FALSE(recording->truth->poses[2]);
  EXPECT_THAT(recording->notes,
              Contains("state_groundtruth_estimate0/data.csv: 2 poses left out: not finite, or "
                       "with the time of the one before"));
}

TEST_F(EurocReader, InterpolatesAccelerationsExceptInLongGaps) {
  std::string imu =
      "#timestamp [ns],w_x [rad s^-1],w_y [rad s^-1],w_z [rad s^-1],a_x [m s^-2],a_y [m s^-2],a_z "
      "[m s^-2]\n";
  for (int i = 0; i < 8; ++i)
    imu += fmt::format("{},{},0,0,{},0,9.8\n",
                       1403636579000000001 + i * 50'000'000LL,
                       i == 3 ? "nan" : "0.1",
                       i == 1 || i == 4 || i == 5 ? "-nan" : std::to_string(i));
  imu += imu.substr(imu.rfind('\n', imu.size() - 2) + 1);  // the last sample twice
  folder.write("mav0/imu0/data.csv", imu);
  const auto recording = open();
  const Gyroscope& gyroscope = *recording->gyroscope;
  EXPECT_EQ(gyroscope.rates_rad_s.size(), 7U);
  EXPECT_THAT(
      recording->notes,
      Contains(
          "imu0/data.csv: 2 samples left out: not finite, or with the time of the one before"));
  std::vector<double> x;
  for (const Eigen::Vector3d& force : gyroscope.accelerations_m_s2) x.push_back(force.x());
  EXPECT_THAT(x, ElementsAre(0, 1, 2, IsNan(), IsNan(), 6, 7));
}

TEST_F(EurocReader, ReadsTumVisMocapFolder) {
  folder.write("mav0/mocap0/data.csv", "1403636579000000001,1,2,3,0,1,0,0\n");
  const auto recording = open();
  EXPECT_EQ(recording->truth->source, "mocap0/data.csv");
  EXPECT_TRUE(recording->truth->poses[0]);
}

TEST_F(EurocReader, NotesWhatIsMissing) {
  EXPECT_THAT(open()->notes, ElementsAre("no ground truth: no metrics"));
  std::filesystem::remove_all(folder.path() / "mav0/imu0");
  EXPECT_THAT(
      open()->notes,
      ElementsAre("no gyroscope: rotations from the images alone", "no ground truth: no metrics"));
}

TEST_F(EurocReader, ReadsBoardAndPlaneFromEitherLevel) {
  folder.write("board.yaml", "{pattern: chessboard, columns: 9, rows: 6, square: 0.025}\n");
  folder.write("mav0/plane.yaml", "normal: [0, 0.6, 0.8]\ndistance: 1.5\n");
  write_truth("1403636579000000001,1,2,3,1,0,0,0\n");
  const auto recording = open();
  ASSERT_TRUE(recording->board);
  EXPECT_EQ(text_of(*recording->board), text_of(Board{9, 6, 0.025}));
  ASSERT_TRUE(recording->plane);
  EXPECT_TRUE(recording->plane->normal.isApprox(Eigen::Vector3d(0, 0.6, 0.8)));
  EXPECT_EQ(recording->plane->distance, 1.5);
  EXPECT_TRUE(recording->notes.empty());
}

TEST_F(EurocReader, NamesAMissingImageAndItsLine) {
  std::filesystem::remove(folder.path() / "mav0/cam0/data/2.png");
  EXPECT_EQ(error(),
            file("mav0/cam0/data.csv") + ":4: found a missing image, expected the file " +
                file("mav0/cam0/data/2.png"));
}

TEST_F(EurocReader, NamesMissingFiles) {
  std::filesystem::remove(folder.path() / "mav0/cam0/data.csv");
  for (int i = 3; i > 0; --i)
    std::filesystem::rename(folder.path() / fmt::format("mav0/cam0/data/{}.png", i),
                            folder.path() / fmt::format("mav0/cam0/data/{}000000.png", i));
  EXPECT_THAT(open()->timestamps_ns, ElementsAre(0, 1000000, 2000000, 3000000));  // from the names
  folder.write("mav0/cam0/data/cat7.png", cv::Mat(48, 64, CV_8UC1));
  EXPECT_THAT(
      error(),
      HasSubstr("cat7.png: cam0/data.csv is missing, so that the name must be a time stamp"));
  std::filesystem::remove_all(folder.path() / "mav0/cam0/data");
  EXPECT_EQ(error(), file("mav0/cam0/data.csv") + ": no such file");
  std::filesystem::remove(folder.path() / "mav0/cam0/sensor.yaml");
  EXPECT_THAT(error(), HasSubstr(": no such file"));
  EXPECT_EQ(error_of([] { open_recording("nowhere"); }), "nowhere: no such file or folder");
}

TEST_F(EurocReader, NamesBackwardTimes) {
  folder.write("mav0/imu0/data.csv", "20,0,0,0\n30,0,0,0\n25,0,0,0\n");
  EXPECT_THAT(error(), HasSubstr("imu0/data.csv:3: found time stamp 25, earlier than"));
  folder.write("mav0/cam0/data.csv", "20,0.png\n20,1.png\n");
  EXPECT_THAT(error(), HasSubstr("cam0/data.csv:2: found time stamp 20, equal to"));
}

TEST_F(EurocReader, AsksForTheUnitOfTimesThatAreNoNanoseconds) {
  const auto images = [&](const char* form) {
    std::string list;
    for (int i = 0; i < 4; ++i) list += fmt::format(fmt::runtime(form), 33 * (i + 1), i);
    folder.write("mav0/cam0/data.csv", list);
    return error();
  };
  EXPECT_EQ(images("1403636579{:03d},{}.png\n"),
            file("mav0/cam0/data.csv") +
                ": found time stamps 33 apart, which in nanoseconds are 3.03e+07 Hz. Expected "
                "nanoseconds; are its time stamps in milliseconds?");
  EXPECT_THAT(images("1403636579{:03d}333,{}.png\n"),
              HasSubstr("are its time stamps in microseconds?"));
  EXPECT_THAT(images("1403636579.{:03d},{}.png\n"),
              HasSubstr("data.csv:2: found time stamp 1403636579.066, in seconds, expected "
                        "nanoseconds"));
}

TEST_F(EurocReader, AsksForTheUnitOfTheGyroscopesTimes) {
  folder.write("mav0/imu0/data.csv", "1403636579000000,0,0,0\n1403636579005000,0,0,0\n");
  EXPECT_EQ(error(),
            file("mav0/imu0/data.csv") +
                ": found time stamps 5000 apart, which in nanoseconds are 2e+05 Hz. Expected "
                "nanoseconds; are its time stamps in microseconds?");
}

TEST_F(EurocReader, NamesBadTruth) {
  write_truth("1403636579000000001,1,2,3,0.9,0,0,0\n");
  EXPECT_THAT(error(), HasSubstr("data.csv:2: found a quaternion of norm 0.9"));
  write_truth("1403636579000000001,1,2,nan,1,0,0,0\n");
  EXPECT_THAT(error(), HasSubstr("data.csv:2: found no row of finite numbers, expected some"));
  write_truth("1403636579000000001,1,2,far,1,0,0,0\n");
  EXPECT_THAT(error(), HasSubstr("data.csv:2: found \"far\", expected a finite number"));
  write_truth("1403636579000000001,1,2,3,1,0,0\n");
  EXPECT_THAT(error(), HasSubstr("data.csv:2: found 7 columns, expected at least 8"));
}

TEST_F(EurocReader, NamesAnImageOfAnotherSize) {
  folder.write("mav0/cam0/data/0.png", cv::Mat(40, 64, CV_8UC1, cv::Scalar(0)));
  EXPECT_EQ(error(),
            file("mav0/cam0/data/0.png") +
                ": found an image of 64x40, expected the calibrated resolution 64x48");
}

TEST_F(EurocReader, ReadsBiasUncertaintyAndNoise) {
  const auto with = [&](const std::string& line) {
    folder.write("mav0/imu0/sensor.yaml", kTbsImu + line + "\n");
    return *open()->gyroscope;
  };
  EXPECT_EQ(open()->gyroscope->bias_sigma_rad_s, 0.1);
  EXPECT_EQ(with("gyroscope_bias_sigma: 0.002").bias_sigma_rad_s, 0.002);
  EXPECT_EQ(with("gyroscope_noise_density: 1.7e-4").noise_density, 1.7e-4);
  EXPECT_EQ(with("gyroscope_noise_density: 0.0").noise_density, Gyroscope{}.noise_density);
}

TEST_F(EurocReader, NamesBadBiasUncertaintyAndNoise) {
  const auto expect = [&](const std::string& key, const std::string& value, const char* expected) {
    folder.write("mav0/imu0/sensor.yaml", kTbsImu + key + ": " + value + "\n");
    EXPECT_THAT(error(), HasSubstr("sensor.yaml:2: key `" + key + "`: found")) << value;
    EXPECT_THAT(error(), HasSubstr(expected)) << value;
  };
  expect("gyroscope_bias", "[0.1, 0.2]", "found 2 numbers, expected 3");
  for (const char* bad : {"0", "-0.01", "small", "nan", "[0.1, 0.1, 0.1]"})
    expect("gyroscope_bias_sigma", bad, "expected a positive number in rad/s");
  for (const char* bad : {"-0.01", "small", "nan"})
    expect("gyroscope_noise_density", bad, "expected a number >= 0");
}

/// Returns noise, so that every byte of the file matters.
cv::Mat noise() {
  cv::Mat image(48, 64, CV_8UC3);
  cv::RNG(7).fill(image, cv::RNG::UNIFORM, 0, 256);
  return image;
}

TEST_F(EurocReader, RefusesTruncatedImagesAndReturnsNoPartialOnes) {
  for (const std::string image : {"p.png", "p.jpg", "p.ppm", "p.bmp", "p.webp"}) {
    const std::string name = "mav0/cam0/data/" + image;
    folder.write("mav0/cam0/data.csv", "0,0.png\n20000000," + image + "\n");
    folder.write(name, noise());
    EXPECT_EQ(open()->images->bgr(1).size(), cv::Size(64, 48));
    for (const double part : {0.0, 0.1, 0.5, 0.9, 0.995}) {
      folder.write(name, noise());
      folder.cut(name, part);
      const auto recording = open();
      testing::internal::CaptureStderr();
      EXPECT_THAT(error_of([&] { recording->images->bgr(1); }),
                  testing::StartsWith(file(name) + ": the image is truncated or broken"))
          << part;
      EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    }
  }
}

TEST_F(EurocReader, DecodesAJpegWithBytesAfterItsEnd) {
  folder.write("mav0/cam0/data.csv", "10,0.jpg\n");
  folder.write("mav0/cam0/data/0.jpg", noise());
  folder.write("mav0/cam0/data/0.jpg", folder.read("mav0/cam0/data/0.jpg") + "trailer");
  EXPECT_EQ(open()->images->bgr(0).size(), cv::Size(64, 48));
}

TEST_F(EurocReader, UsesTracksBesideImagesOnlyIfRequested) {
  folder.write("tracks.csv", "frame,track,x,y\n0,1,2,3\n");
  EXPECT_TRUE(open()->tracks.empty());
  // Opening tracks.csv itself opens its folder with these tracks.
  for (const auto& recording :
       {open_recording(folder.path(), {.tracks = folder.path() / "tracks.csv"}),
        open_recording(folder.path() / "tracks.csv")}) {
    EXPECT_EQ(recording->tracks.size(), 1U);
    EXPECT_EQ(recording->layout, "EuRoC");
    EXPECT_EQ(recording->name, folder.path().filename());
    EXPECT_TRUE(recording->images);
  }
}

TEST_F(EurocReader, UsesTracksIfThereAreNoImages) {
  folder.write("tracks.csv", "frame,track,x,y\n3,1,2,3\n0,5,1.5,2\n0,1,2.25,3\n");
  std::filesystem::remove_all(folder.path() / "mav0/cam0/data");
  const auto recording = open();
  EXPECT_EQ(recording->layout, "tracks");
  EXPECT_EQ(recording->images, nullptr);
  ASSERT_EQ(recording->tracks.size(), 3U);
  EXPECT_EQ(recording->tracks[0].track, 1);
  EXPECT_EQ(recording->tracks[0].raw_px, Eigen::Vector2d(2.25, 3));
  EXPECT_EQ(recording->tracks[2].frame, 3);
  EXPECT_THAT(recording->notes, Contains("no images: tracks are drawn on a plain background"));
}

TEST_F(EurocReader, NamesBadTracks) {
  std::filesystem::remove_all(folder.path() / "mav0/cam0/data");
  const auto tracks = [&](const char* rows) {
    folder.write("tracks.csv", std::string("frame,track,x,y\n") + rows);
    return error();
  };
  const std::string name = file("tracks.csv");
  EXPECT_EQ(tracks("0,1,2,3\n4,1,2,3\n"),
            name + ":3: found frame 4, expected 0 to 3, the frames of the recording");
  EXPECT_THAT(tracks("-1,1,2,3\n"), HasSubstr(":2: found frame -1, expected 0 to 3"));
  EXPECT_EQ(
      tracks("0,1,2,3\n0,2,2,3\n0,1,5,5\n"),
      name +
          ":4: found track 1 a second time in frame 0, expected one row for each frame and track");
  EXPECT_THAT(tracks("0,1,2,nan\n"), HasSubstr(":2: found \"nan\", expected a finite number"));
  EXPECT_THAT(tracks("0,a,2,3\n"), HasSubstr(":2: found \"a\", expected an integer"));
  EXPECT_THAT(tracks("0,1,2\n"),
              HasSubstr(":2: found 3 columns, expected at least 4 (frame,track,x,y)"));
}

}  // namespace
}  // namespace gpo::test
