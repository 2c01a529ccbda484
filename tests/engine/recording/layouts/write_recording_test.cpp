// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/layouts/write_recording.h"

#include "engine/base/error.h"
#include "engine/files/text_file.h"
#include "engine/truth/truth.h"
#include "engine/window/gyroscope.h"
#include "tests/engine/recording/bags/small_bag.h"
#include "tests/engine/recording/recording_folder.h"

namespace gpo::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// Expects what both formats store exactly, and rotations up to rounding.
void expect_same(const Recording& read, const Recording& written) {
  EXPECT_EQ(read.timestamps_ns, written.timestamps_ns);
  EXPECT_EQ(read.camera, written.camera);
  for (int i = 0; i < written.frame_count(); ++i)
    EXPECT_EQ(cv::norm(read.images->bgr(i), written.images->bgr(i), cv::NORM_INF), 0);
  ASSERT_TRUE(read.gyroscope);
  const Gyroscope &one = *read.gyroscope, &other = *written.gyroscope;
  EXPECT_EQ(one.rates_rad_s, other.rates_rad_s);
  EXPECT_EQ(one.accelerations_m_s2, other.accelerations_m_s2);
  EXPECT_EQ(one.bias_rad_s, other.bias_rad_s);
  EXPECT_TRUE(one.R_gyro_camera.isApprox(other.R_gyro_camera, 1e-14));
}

/// A covariance whose parameters are all correlated.
Eigen::MatrixXd lens_covariance_for(const Camera& camera) {
  const auto size = static_cast<Eigen::Index>(4 + camera.coefficients.size());
  const Eigen::VectorXd sigmas = Eigen::VectorXd::LinSpaced(size, 1.0 / 3, 1e-3);
  return 0.5 * sigmas * sigmas.transpose() + 0.5 * Eigen::MatrixXd(sigmas.cwiseAbs2().asDiagonal());
}

class BagWriting : public RecordingFolder {
 protected:
  fs::path small_bag() const { return write_small_bag(folder.path() / "small.bag", ros1_writer); }
};

class WrittenBag : public BagWriting, public testing::WithParamInterface<RecordingFormat> {};
INSTANTIATE_TEST_SUITE_P(Formats,
                         WrittenBag,
                         testing::Values(RecordingFormat::rosbag, RecordingFormat::mcap),
                         [](const auto& info) { return std::string(to_string(info.param)); });

TEST_P(WrittenBag, OpensAsTheSameRecording) {
  folder.write("plane.yaml", "normal: [0, 0, 1]\ndistance: 0.5\n");
  Recording changed = *open_recording(small_bag());
  set_lens_covariance(changed.camera, lens_covariance_for(changed.camera));
  changed.gyroscope->bias_rad_s = {0.01, 0.02, 0.03};
  changed.gyroscope->time_offset_ns = 1'234'567;
  changed.truth->poses[3].reset();
  const fs::path file =
      folder.path() / "written" / (GetParam() == RecordingFormat::mcap ? "new.mcap" : "new.bag");
  write_recording(changed, changed.truth, GetParam(), file);
  const auto written = open_recording(file);
  expect_same(*written, changed);
  EXPECT_EQ(written->plane->distance, 0.5);
  EXPECT_EQ(written->gyroscope->timestamps_ns[4], changed.gyroscope->timestamps_ns[4] - 1'234'567);
  EXPECT_FALSE(written->truth->poses[3]);
  EXPECT_LT((written->truth->poses[4]->p_wc - changed.truth->poses[4]->p_wc).norm(), 1e-14);
  EXPECT_THAT(error_of([&] { write_recording(changed, changed.truth, GetParam(), file); }),
              HasSubstr("already exists; choose a new file"));
}

TEST_P(WrittenBag, CannotStoreTimesFarInTheFuture) {
  Recording changed = *open_recording(small_bag());
  changed.timestamps_ns.back() = 5'000'000'000'000'000'000;
  const bool mcap = GetParam() == RecordingFormat::mcap;
  const fs::path file = folder.path() / (mcap ? "new.mcap" : "new.bag");
  EXPECT_THAT(error_of([&] { write_recording(changed, changed.truth, GetParam(), file); }),
              HasSubstr(mcap ? "is too late for a bag, which ends in 2038" : "ends in 2106"));
  EXPECT_FALSE(fs::exists(file));
}

TEST_P(WrittenBag, OpensWithoutSamplesThatAreNotFinite) {
  Recording changed = *open_recording(small_bag());
  Gyroscope& gyroscope = *changed.gyroscope;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  gyroscope.rates_rad_s[2].x() = nan;
  const Eigen::Vector3d between =
      (gyroscope.accelerations_m_s2[3] + gyroscope.accelerations_m_s2[5]) / 2;
  gyroscope.accelerations_m_s2[4].z() = nan;
  const fs::path file =
      folder.path() / "written" / (GetParam() == RecordingFormat::mcap ? "new.mcap" : "new.bag");
  write_recording(changed, changed.truth, GetParam(), file);
  const auto written = open_recording(file);
  ASSERT_EQ(written->gyroscope->rates_rad_s.size(), gyroscope.rates_rad_s.size() - 1);
  EXPECT_EQ(written->gyroscope->left_out, 1);
  EXPECT_EQ(written->gyroscope->accelerations_m_s2[2], gyroscope.accelerations_m_s2[3]);
  EXPECT_LT((written->gyroscope->accelerations_m_s2[3] - between).norm(), 1e-12);
}

TEST_F(BagWriting, RefusesForeignFilesBesideAWrittenBag) {
  const auto recording = open_recording(small_bag());
  const auto error = [&](const char* name) {
    return error_of([&] {
      write_recording(*recording, recording->truth, RecordingFormat::mcap, folder.path() / name);
    });
  };
  EXPECT_THAT(error("new.bag"), HasSubstr("wrong extension, expected .mcap"));
  folder.write("board.yaml", "pattern: chessboard\n");
  EXPECT_THAT(error("new.mcap"), HasSubstr("board.yaml: belongs to another recording"));
  EXPECT_FALSE(fs::exists(folder.path() / "new.mcap"));
}

TEST_F(BagWriting, RefusesSidecarsThatWouldChangeOtherRecordings) {
  Recording guessed = *open_recording(small_bag());
  fs::remove(folder.path() / "small.bag");
  guessed.camera_source = CameraSource::guess;
  guessed.path = folder.path() / "source.mp4";
  folder.write("source.mp4", "");
  const auto write = [&] {
    write_recording(guessed, {}, RecordingFormat::mcap, folder.path() / "new.mcap");
  };
  for (const char* other : {"other.mp4", "0001.png", "mav0/cam0/data.csv"}) {
    folder.write(other, "");
    EXPECT_THAT(error_of(write), HasSubstr("would be read with the camera.yaml of the new bag"))
        << other;
    EXPECT_FALSE(is_file(folder.path() / "camera.yaml"));
    fs::remove_all(folder.path() / *fs::path(other).begin());
  }
  write();
  EXPECT_TRUE(is_file(folder.path() / "camera.yaml"));
}

TEST_F(BagWriting, RemovesSidecarsIfTheBagCannotBeRenamed) {
  Recording guessed = *open_recording(small_bag());
  guessed.camera_source = CameraSource::guess;
  const fs::path out = folder.path() / "out";
  fs::create_directory(out);
  EXPECT_THAT(error_of([&] {
                write_recording(
                    guessed, guessed.truth, RecordingFormat::mcap, out / "new.mcap", [&](int, int) {
                      fs::create_directories(out / "new.mcap" / "in");
                    });
              }),
              HasSubstr("cannot be written"));
  EXPECT_EQ(std::distance(fs::directory_iterator(out), {}), 1) << "only the folder new.mcap";
}

/// Returns a complete recording with numbers that need all digits.
Recording everything() {
  Recording recording;
  recording.camera = {
      64, 48, 60.1, 61.7, 31.3, 23.9, Distortion::equidistant, {0.1, -1e-3, 0, 1e-7}};
  set_lens_covariance(recording.camera, lens_covariance_for(recording.camera));
  recording.camera.readout = Readout{0.02, 1.0 / 3000};
  recording.camera.readout_direction = ReadoutDirection::down;
  recording.T_body_camera =
      Pose{Eigen::AngleAxisd(2.1, Eigen::Vector3d(1, 2, -3).normalized()).matrix(),
           {0.1, -0.2, 1.0 / 3}};
  recording.timestamps_ns = {
      1403636579000000001, 1403636579033333334, 1403636579066666668, 1403636579100000001};
  recording.images = std::make_shared<const FrameCache>(4, [](int i) {
    cv::Mat image(48, 64, CV_8UC3, cv::Scalar(10 * i, 20, i == 2 ? 20 : 70));
    if (i == 3) image.setTo(cv::Scalar::all(99));
    return image;
  });
  Gyroscope gyroscope;
  for (int i = 0; i < 30; ++i) {
    gyroscope.timestamps_ns.push_back(1403636578999999999 + i * 5000000LL);
    gyroscope.rates_rad_s.emplace_back(0.1 / 3, -0.2 * i, 1e-9);
    gyroscope.accelerations_m_s2.emplace_back(0, 9.81 / 7, i);
  }
  gyroscope.R_gyro_camera = Eigen::AngleAxisd(-1, Eigen::Vector3d::UnitY()).matrix();
  gyroscope.time_offset_ns = -2345678;
  gyroscope.bias_rad_s = {0.001, 1.0 / 3000, -0.002};
  gyroscope.bias_sigma_rad_s = 0.0123;
  gyroscope.noise_density = 1.0 / 7000;
  recording.gyroscope = gyroscope;
  recording.plane = Plane{Eigen::Vector3d(1, 2, 3).normalized(), 0.7};
  recording.board = Board{9, 6, 0.025};
  return recording;
}

GroundTruth truth_with_a_gap() {
  GroundTruth truth{"made", {}};
  for (int i = 0; i < 4; ++i)
    truth.poses.push_back(
        Pose{Eigen::AngleAxisd(0.3 * i, Eigen::Vector3d::UnitX()).matrix(), {0.1 * i, 1.0 / 7, 0}});
  truth.poses[1].reset();
  return truth;
}

class EurocWriter : public RecordingFolder {
 protected:
  void write(const Recording& recording, const std::optional<GroundTruth>& truth = {}) const {
    write_recording(recording, truth, RecordingFormat::euroc, folder.path() / "out");
  }
};

TEST_F(EurocWriter, WritesARecordingThatOpensAsTheSame) {
  const Recording recording = everything();
  const GroundTruth truth = truth_with_a_gap();
  write(recording, truth);
  const auto read = open_recording(folder.path() / "out");
  EXPECT_EQ(read->layout, "EuRoC");
  expect_same(*read, recording);
  EXPECT_TRUE(read->T_body_camera->R_wc.isApprox(recording.T_body_camera->R_wc, 1e-14));
  EXPECT_EQ(read->gyroscope->timestamps_ns, recording.gyroscope->timestamps_ns);
  EXPECT_EQ(read->gyroscope->time_offset_ns, recording.gyroscope->time_offset_ns);
  EXPECT_EQ(read->gyroscope->bias_sigma_rad_s, recording.gyroscope->bias_sigma_rad_s);
  EXPECT_EQ(read->gyroscope->noise_density, recording.gyroscope->noise_density);
  ASSERT_TRUE(read->truth);
  for (int i = 0; i < 4; ++i) {
    ASSERT_EQ(read->truth->poses[i].has_value(), truth.poses[i].has_value()) << i;
    if (!truth.poses[i]) continue;
    EXPECT_TRUE(read->truth->poses[i]->R_wc.isApprox(truth.poses[i]->R_wc, 1e-13));
    EXPECT_LT((read->truth->poses[i]->p_wc - truth.poses[i]->p_wc).norm(), 1e-13);
  }
  EXPECT_TRUE(read->plane->normal.isApprox(recording.plane->normal, 1e-14));
  EXPECT_EQ(read->board->columns, 9);
}

TEST_F(EurocWriter, KeepsTracksWithoutImages) {
  Recording recording = everything();
  recording.images = nullptr;
  recording.tracks = {{0, 7, {1.0 / 3, 2}}, {2, 7, {4, 5}}, {3, 9, {6, 7}}};
  write(recording);
  const auto read = open_recording(folder.path() / "out");
  EXPECT_EQ(read->layout, "tracks");
  EXPECT_FALSE(read->truth);
  ASSERT_EQ(read->tracks.size(), 3U);
  EXPECT_EQ(read->tracks[0].raw_px.x(), 1.0 / 3);
  EXPECT_EQ(read->tracks[2].track, 9);
}

struct MissingPart {
  const char* name;
  void (*remove)(Recording& recording);
};

class WrittenWithout : public test::RecordingFolder,
                       public testing::WithParamInterface<MissingPart> {};
INSTANTIATE_TEST_SUITE_P(
    Parts,
    WrittenWithout,
    testing::Values(
        MissingPart{"gyroscope", [](Recording& r) { r.gyroscope.reset(); }},
        MissingPart{"accelerations", [](Recording& r) { r.gyroscope->accelerations_m_s2.clear(); }},
        MissingPart{"extrinsics",
                    [](Recording& r) {
                      r.T_body_camera.reset();
                      r.gyroscope->R_gyro_camera.setIdentity();
                    }},
        MissingPart{"clock_offset", [](Recording& r) { r.gyroscope->time_offset_ns = 0; }},
        MissingPart{"bias", [](Recording& r) { r.gyroscope->bias_rad_s.setZero(); }},
        MissingPart{"truth", [](Recording& r) { r.truth.reset(); }},
        MissingPart{"upright_truth", [](Recording& r) { r.truth->upright = false; }},
        MissingPart{"readout",
                    [](Recording& r) {
                      r.camera.readout.reset();
                      r.camera.readout_direction.reset();
                    }},
        MissingPart{"distortion",
                    [](Recording& r) {
                      r.camera.distortion = Distortion::none;
                      r.camera.coefficients = r.camera.sigmas = r.camera.covariance = {};
                    }},
        MissingPart{"calibration", [](Recording& r) { r.camera_source = CameraSource::guess; }},
        MissingPart{"board_of_calibration",
                    [](Recording& r) { r.camera_source = CameraSource::self_calibrated; }},
        MissingPart{"all_but_the_lens",
                    [](Recording& r) {
                      r.camera.sigmas = r.camera.covariance = {};
                      r.camera.readout.reset();
                      r.camera.readout_direction.reset();
                    }},
        MissingPart{"lens_uncertainty",
                    [](Recording& r) { r.camera.sigmas = r.camera.covariance = {}; }},
        MissingPart{"plane",
                    [](Recording& r) {
                      r.plane.reset();
                      r.board.reset();  // is the plane, too
                    }},
        MissingPart{"board", [](Recording& r) { r.board.reset(); }}),
    [](const auto& info) { return info.param.name; });

void expect_same_parts(const Recording& read, const Recording& written) {
  EXPECT_EQ(read.camera, written.camera);
  EXPECT_EQ(read.camera_source, written.camera_source);
  EXPECT_EQ(read.plane.has_value(), written.plane.has_value());
  EXPECT_EQ(read.board.has_value(), written.board.has_value());
  ASSERT_EQ(read.truth.has_value(), written.truth.has_value());
  if (read.truth) {
    EXPECT_EQ(read.truth->upright, written.truth->upright);
    EXPECT_THAT(read.truth->source, testing::EndsWith(", originally made"));
    EXPECT_FALSE(read.truth->poses[1]);
  }
  ASSERT_EQ(read.gyroscope.has_value(), written.gyroscope.has_value());
  if (!read.gyroscope) return;
  EXPECT_EQ(read.T_body_camera.has_value(), written.T_body_camera.has_value());
  const Gyroscope &one = *read.gyroscope, &other = *written.gyroscope;
  EXPECT_EQ(one.rates_rad_s, other.rates_rad_s);
  EXPECT_EQ(one.accelerations_m_s2, other.accelerations_m_s2);
  EXPECT_EQ(one.bias_rad_s, other.bias_rad_s);
  EXPECT_EQ(one.bias_sigma_rad_s, other.bias_sigma_rad_s);
  EXPECT_EQ(one.noise_density, other.noise_density);
  EXPECT_EQ(one.timestamps_ns[7] - one.time_offset_ns,
            other.timestamps_ns[7] - other.time_offset_ns);
}

TEST_P(WrittenWithout, StaysWithoutInEveryFormat) {
  Recording recording = everything();
  recording.truth = truth_with_a_gap();
  recording.truth->upright = true;
  GetParam().remove(recording);
  for (const auto& [format, name] : {std::pair(RecordingFormat::euroc, "euroc"),
                                     std::pair(RecordingFormat::rosbag, "bag/a.bag"),
                                     std::pair(RecordingFormat::mcap, "mcap/a.mcap")}) {
    SCOPED_TRACE(name);
    write_recording(recording, recording.truth, format, folder.path() / name);
    const auto read = open_recording(folder.path() / name);
    expect_same_parts(*read, recording);
    const std::string again = "again/" + std::string(name);
    write_recording(*read, read->truth, format, folder.path() / again);
    expect_same_parts(*open_recording(folder.path() / again), recording);
  }
}

TEST_F(EurocWriter, LeavesNoFilesAfterAFailure) {
  Recording recording = everything();
  recording.images = std::make_shared<const FrameCache>(4, [](int i) -> cv::Mat {
    if (i == 2) throw InputError("frame 2 is broken");
    return {48, 64, CV_8UC3, cv::Scalar::all(i)};
  });
  EXPECT_EQ(error_of([&] { write(recording); }), "frame 2 is broken");
  EXPECT_TRUE(fs::is_empty(folder.path()));
  folder.write("out/file", "");
  EXPECT_THAT(error_of([&] { write(everything()); }),
              HasSubstr("out: is not empty; choose a new or empty folder"));
}

}  // namespace
}  // namespace gpo::test
