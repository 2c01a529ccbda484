// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/error.h"
#include "engine/recording/layouts/write_recording.h"
#include "engine/truth/truth.h"
#include "engine/window/gyroscope.h"
#include "tests/engine/recording/bags/small_bag.h"
#include "tests/engine/recording/recording_folder.h"

namespace gpo::test {
namespace {

namespace fs = std::filesystem;
using testing::Contains, testing::ElementsAre, testing::HasSubstr, testing::Not;

std::shared_ptr<const Recording> open_with(const fs::path& path,
                                           TopicRole role,
                                           const std::string& topic) {
  return open_recording(path, {.tracks = {}, .topics = {{role, topic}}});
}

std::string error_with(const fs::path& path, TopicRole role, const std::string& topic) {
  return error_of([&] { open_with(path, role, topic); });
}

/// Writes a bag with different images on several topics.
fs::path images_on(const TestFolder& folder, const std::vector<std::string>& names) {
  std::vector<BagTopic> topics;
  for (const std::string& name : names) topics.push_back({name, "sensor_msgs/Image"});
  const fs::path file = folder.path() / "pictures.mcap";
  const BagWriter writer = mcap_writer(file, topics);
  for (int i = 0; i < 3; ++i)
    for (std::size_t topic = 0; topic < names.size(); ++topic) {
      const std::string pixels(64 * 48, static_cast<char>(10 * topic + i));
      writer.write(static_cast<int>(topic),
                   kStart_ns,
                   image_bytes(image_of(2 - i, pixels, 64, 48), writer.encoding));
    }
  writer.finish();
  return file;
}

class BagReader : public RecordingFolder {
 protected:
  fs::path small_bag() const { return write_small_bag(folder.path() / "small.bag", ros1_writer); }
};

TEST_F(BagReader, ReadsACompleteRecording) {
  const auto recording = open_recording(small_bag());
  EXPECT_EQ(recording->layout, "ROS bag");
  EXPECT_EQ(recording->name, "small.bag");
  ASSERT_EQ(recording->frame_count(), 20);
  EXPECT_EQ(recording->timestamps_ns[7], kStart_ns + 7 * kPeriod_ns);
  EXPECT_EQ(recording->camera, small_camera());
  const std::string pixels = pixels_of(7, 64, 48);
  EXPECT_EQ(recording->images->bgr(7).at<cv::Vec3b>(0, 1)[0], static_cast<uchar>(pixels[1]));
  ASSERT_TRUE(recording->gyroscope);
  EXPECT_EQ(recording->gyroscope->rates_rad_s[7], Eigen::Vector3d(0.1 * 7, 0.2, 0.3));
  // The camera is rotated by 2 atan(0.6 / 0.8) about z.
  ASSERT_TRUE(recording->T_body_camera);
  EXPECT_LT((recording->gyroscope->R_gyro_camera.col(0) - Eigen::Vector3d(0.28, 0.96, 0)).norm(),
            1e-12);
  EXPECT_EQ(recording->T_body_camera->p_wc, Eigen::Vector3d(0.1, 0.2, 0.3));
  ASSERT_TRUE(recording->truth && recording->truth->poses[7]);
  EXPECT_LT((recording->truth->poses[7]->p_wc - Eigen::Vector3d(4.6, 2.2, 3.3)).norm(), 1e-12);
  EXPECT_THAT(recording->notes, ElementsAre("no plane.yaml: no plane errors"));
}

/// Writes a bag with samples of an IMU's sensors.
fs::path bag_of_imu(const TestFolder& folder, const ImuMessage& sample) {
  const fs::path file = folder.path() / "imu.mcap";
  const BagWriter writer =
      mcap_writer(file, {{"/image", "sensor_msgs/Image"}, {"/imu", "sensor_msgs/Imu"}});
  for (int i = 0; i < 3; ++i) {
    const std::string pixels = test::pixels_of(i, 64, 48);
    writer.write(0, kStart_ns, image_bytes(test::image_of(i, pixels, 64, 48), writer.encoding));
    ImuMessage now = sample;
    now.header.stamp_ns = kStart_ns + i * kPeriod_ns;
    writer.write(1, kStart_ns, imu_bytes(now, writer.encoding));
  }
  writer.finish();
  return file;
}

TEST_F(BagReader, CanBeStoppedByItsProgress) {
  const ReadProgress stop = [](double share) {
    EXPECT_GE(share, 0);
    EXPECT_LE(share, 1);
    throw InputError("stopped");
  };
  for (const auto& open : {ros1_writer, mcap_writer}) {
    const fs::path bag = test::write_small_bag(folder.path() / "small.bag", open);
    EXPECT_EQ(error_of([&] { open_recording(bag, {.tracks = {}, .progress = stop}); }), "stopped");
    EXPECT_EQ(probe_path(bag, std::chrono::milliseconds(-1)).frames, 0);
    EXPECT_EQ(probe_path(bag, std::chrono::milliseconds(-1)).layout, "ROS bag");
    EXPECT_EQ(probe_path(bag, std::chrono::hours(1)).frames, 20);
  }
}

TEST_F(BagReader, TakesZerosOfAnAbsentAccelerometerForAbsent) {
  const Eigen::Vector3d rate(0.1, 0, 0), zero(0, 0, 0);
  const auto recording = open_recording(bag_of_imu(folder, {{}, rate, zero}));
  ASSERT_TRUE(recording->gyroscope);
  EXPECT_EQ(recording->gyroscope->rates_rad_s[2], rate);
  EXPECT_TRUE(recording->gyroscope->accelerations_m_s2.empty());
}

TEST_F(BagReader, DoesNotUseAnAccelerometerAsAGyroscope) {
  const auto recording =
      open_recording(bag_of_imu(folder, {{}, std::nullopt, Eigen::Vector3d(0, 0, 9.8)}));
  EXPECT_FALSE(recording->gyroscope);
  EXPECT_THAT(recording->notes, Contains("/imu: not used, it has no angular velocities"));
}

TEST_F(BagReader, ReadsTheChosenCamera) {
  folder.write("camera.yaml", kCameraYaml);
  const fs::path file = images_on(folder, {"/cam1/depth", "/cam1/image", "/cam0/image"});
  const auto first = open_recording(file);
  EXPECT_EQ(int(first->images->bgr(0).at<cv::Vec3b>(0, 0)[0]), 22);
  EXPECT_THAT(first->notes,
              Contains("3 topics with images: using /cam0/image; choose another with --topic "
                       "image=/cam1/depth"));
  const auto second = open_with(file, TopicRole::image, "/cam1/image");
  EXPECT_EQ(int(second->images->bgr(0).at<cv::Vec3b>(0, 0)[0]), 12);
  EXPECT_THAT(second->notes, Not(Contains(HasSubstr("topics with images"))));
  EXPECT_THAT(error_with(file, TopicRole::imu, "/cam1/image"),
              HasSubstr("--topic: found 3 messages of sensor_msgs/Image in /cam1/image, expected "
                        "sensor_msgs/Imu"));
  EXPECT_THAT(error_with(file, TopicRole::image, "/cam2"),
              HasSubstr("--topic: found no topic /cam2 among /cam0/image (sensor_msgs/Image, 3)"));
}

TEST(TopicChoices, AreParsed) {
  EXPECT_EQ(parse_topic_choices({"image=/a=b", "imu=/c"}),
            (TopicChoices{{TopicRole::image, "/a=b"}, {TopicRole::imu, "/c"}}));
  const auto error = [](const std::vector<std::string>& texts) {
    return error_of([&] { parse_topic_choices(texts); });
  };
  EXPECT_THAT(error({"/cam0"}), HasSubstr("topic: found '/cam0', expected ROLE=NAME"));
  EXPECT_THAT(
      error({"picture=/cam0"}),
      HasSubstr("expected one of image, camera_info, imu, truth, gyroscope, accelerometer"));
  EXPECT_THAT(error({"imu=/a", "imu=/b"}), HasSubstr("topic: found imu twice"));
}

TEST_F(BagReader, SortsImagesByTheirTimeStamps) {
  folder.write("camera.yaml", kCameraYaml);
  const auto recording = open_recording(images_on(folder, {"/image"}));
  EXPECT_THAT(recording->timestamps_ns,
              ElementsAre(kStart_ns, kStart_ns + kPeriod_ns, kStart_ns + 2 * kPeriod_ns));
  EXPECT_EQ(int(recording->images->bgr(0).at<cv::Vec3b>(0, 0)[0]), 2);
  EXPECT_EQ(int(recording->images->bgr(2).at<cv::Vec3b>(0, 0)[0]), 0);
}

TEST_F(BagReader, GuessesTheCameraWithoutCalibration) {
  const fs::path file = images_on(folder, {"/image"});
  const auto recording = open_recording(file);
  EXPECT_EQ(recording->camera_source, CameraSource::guess);
  EXPECT_GT(recording->camera.fx, 0);
  EXPECT_EQ(open_bag_images(file, 1 << 20, {})->count(), 3);
}

TEST_F(BagReader, PrefersACameraYamlBesideTheBag) {
  const fs::path file = small_bag();
  folder.write("camera.yaml", kCameraYaml);
  const auto recording = open_recording(file);
  EXPECT_EQ(recording->camera.fx, 60);
  EXPECT_THAT(recording->notes, Contains("using camera.yaml instead of /cam0/camera_info"));
}

TEST_F(BagReader, OpensAFolderWithOneBag) {
  small_bag();
  EXPECT_EQ(open()->frame_count(), 20);
  write_small_bag(folder.path() / "small.mcap", mcap_writer);
  EXPECT_THAT(error(),
              HasSubstr("found 2 bags (small.bag, small.mcap), expected one; name the file"));
}

TEST_F(BagReader, RefusesTopicsForOtherLayouts) {
  folder.write("camera.yaml", kCameraYaml);
  folder.write("1.png", cv::Mat(48, 64, CV_8UC1, cv::Scalar(7)));
  EXPECT_THAT(error_with(folder.path(), TopicRole::imu, "/imu"),
              HasSubstr("found the layout pictures without topics, expected a bag for --topic"));
}

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

class WrittenBag : public BagReader, public testing::WithParamInterface<RecordingFormat> {};
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

TEST_F(BagReader, RefusesForeignFilesBesideAWrittenBag) {
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

/// Returns a complete recording with numbers that need all digits.
Recording everything() {
  Recording recording;
  recording.camera = {
      64, 48, 60.1, 61.7, 31.3, 23.9, Distortion::equidistant, {0.1, -1e-3, 0, 1e-7}};
  set_lens_covariance(recording.camera, lens_covariance_for(recording.camera));
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
    testing::Values(MissingPart{"gyroscope", [](Recording& r) { r.gyroscope.reset(); }},
                    MissingPart{"accelerations",
                                [](Recording& r) { r.gyroscope->accelerations_m_s2.clear(); }},
                    MissingPart{"extrinsics", [](Recording& r) { r.T_body_camera.reset(); }},
                    MissingPart{"lens_uncertainty",
                                [](Recording& r) { r.camera.sigmas = r.camera.covariance = {}; }},
                    MissingPart{"plane",
                                [](Recording& r) {
                                  r.plane.reset();
                                  r.board.reset();  // is the plane, too
                                }},
                    MissingPart{"board", [](Recording& r) { r.board.reset(); }}),
    [](const auto& info) { return info.param.name; });

TEST_P(WrittenWithout, StaysWithoutInEveryFormat) {
  Recording recording = everything();
  GetParam().remove(recording);
  for (const auto& [format, name] : {std::pair(RecordingFormat::euroc, "euroc"),
                                     std::pair(RecordingFormat::rosbag, "bag/a.bag"),
                                     std::pair(RecordingFormat::mcap, "mcap/a.mcap")}) {
    SCOPED_TRACE(name);
    write_recording(recording, {}, format, folder.path() / name);
    const auto read = open_recording(folder.path() / name);
    ASSERT_EQ(read->gyroscope.has_value(), recording.gyroscope.has_value());
    if (read->gyroscope) {
      EXPECT_EQ(read->gyroscope->accelerations_m_s2, recording.gyroscope->accelerations_m_s2);
    }
    EXPECT_EQ(read->camera.sigmas, recording.camera.sigmas);
    EXPECT_EQ(read->plane.has_value(), recording.plane.has_value());
    EXPECT_EQ(read->board.has_value(), recording.board.has_value());
    EXPECT_FALSE(read->truth);
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
