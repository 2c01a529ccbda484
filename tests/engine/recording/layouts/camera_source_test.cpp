// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause

#include "engine/files/byte_cursor.h"
#include "engine/files/image_codec.h"
#include "engine/recording/layouts/open_recording.h"
#include "engine/recording/loggers/logs.h"
#include "tests/engine/recording/images/made_video.h"
#include "tests/engine/test_folder.h"

#include <bit>
#include <cmath>
#include <limits>

#include <gmock/gmock.h>

namespace gpo::test {
namespace {

using testing::HasSubstr;

const double kFilm_mm = std::hypot(36, 24);
const std::string kEquivalent = "com.apple.quicktime.camera.focal_length.35mm_equivalent";

/// An EXIF tag; the types 3, 4 and 5 are integers of two and four bytes and fractions.
struct Tag {
  int number = 0, type = 0;
  std::int64_t value = 0;
  std::int64_t denominator = 1;
};

/// Returns a JPEG's segment APP1 with a TIFF directory of these tags, behind one that points to it.
std::string exif_segment(const std::vector<Tag>& tags) {
  const std::int64_t first = 8, directory = first + 2 + 12 + 4;
  const auto count = static_cast<std::int64_t>(tags.size());
  std::int64_t fractions = directory + 2 + 12 * count + 4;
  std::string entries, behind;
  for (const Tag& tag : tags) {
    entries += big_endian({tag.number, tag.type}, 2) + big_endian({1}, 4);
    if (tag.type == 3) entries += big_endian({tag.value, 0}, 2);
    if (tag.type == 4) entries += big_endian({tag.value}, 4);
    if (tag.type != 5) continue;
    entries += big_endian({fractions}, 4);
    behind += big_endian({tag.value, tag.denominator}, 4);
    fractions += 8;
  }
  const std::string end = big_endian({0}, 4);
  const std::string tiff = std::string("MM\0*", 4) + big_endian({first}, 4) + big_endian({1}, 2) +
                           big_endian({0x8769, 4}, 2) + big_endian({1, directory}, 4) + end +
                           big_endian({count}, 2) + entries + end + behind;
  const std::string content = std::string("Exif\0\0", 6) + tiff;
  return "\xFF\xE1" + big_endian({std::ssize(content) + 2}, 2) + content;
}

class StoredViews : public testing::Test {
 protected:
  std::filesystem::path image(const std::string& segment) const {
    const std::string bytes = encode_jpeg(cv::Mat(48, 64, CV_8UC3, cv::Scalar::all(90)), 95);
    return folder.write("1.jpg", bytes.substr(0, 2) + segment + bytes.substr(2));
  }
  std::optional<FieldOfView> of_exif(const std::vector<Tag>& tags) const {
    return stored_view(image(exif_segment(tags)));
  }
  std::filesystem::path video(const std::map<std::string, std::string>& metadata,
                              const std::string& name = "a.mov") const {
    const std::vector<cv::Mat> images(3, cv::Mat(48, 64, CV_8UC3, cv::Scalar::all(90)));
    make_video(folder.path() / name, images, {.metadata = metadata});
    return folder.path() / name;
  }

  TestFolder folder;
};

constexpr int kFocalLength = 0x920A, kEquivalentTag = 0xA405, kFocalPlaneX = 0xA20E,
              kFocalPlaneUnit = 0xA210, kWidth = 0xA002, kHeight = 0xA003;

TEST_F(StoredViews, ReadsTheEquivalentFocalLengthFromExif) {
  const auto view = of_exif({{kFocalLength, 5, 425, 100}, {kEquivalentTag, 3, 26}});
  ASSERT_TRUE(view);
  EXPECT_NEAR(view->focal_diagonals, 26 / kFilm_mm, 1e-12);
  EXPECT_FALSE(view->fisheye);
  EXPECT_EQ(view->source, "EXIF (26 mm equivalent)");
  const auto recording = open_recording(folder.path());
  EXPECT_EQ(recording->camera_source, CameraSource::guess);
  EXPECT_NEAR(recording->camera.fx, 26 / kFilm_mm * 80, 1e-9);
  EXPECT_EQ(recording->camera.fx, recording->camera.fy);
  EXPECT_THAT(recording->notes,
              testing::Contains("no calibration: field of view from EXIF (26 mm "
                                "equivalent); run `calibrate`"));
}

TEST_F(StoredViews, ReadsFocalLengthAndSensorFromExif) {
  // 1000 pixels per centimeter on a sensor of 36 x 24 mm.
  const std::vector<Tag> sensor = {{kFocalLength, 5, 50, 1},
                                   {kWidth, 4, 3600},
                                   {kHeight, 4, 2400},
                                   {kFocalPlaneX, 5, 1000, 1},
                                   {kFocalPlaneUnit, 3, 3}};
  const auto view = of_exif(sensor);
  ASSERT_TRUE(view);
  EXPECT_NEAR(view->focal_diagonals, 50 / kFilm_mm, 1e-6);
  EXPECT_EQ(view->source, "EXIF (50 mm on a sensor of 43.3 mm)");
  std::vector<Tag> in_inches(sensor.begin(), sensor.end() - 2);
  in_inches.push_back({kFocalPlaneX, 5, 2540, 1});  // inches by default
  EXPECT_NEAR(of_exif(in_inches).value().focal_diagonals, 50 / kFilm_mm, 1e-6);
  std::vector<Tag> unknown = sensor;
  unknown.push_back({kEquivalentTag, 3, 0});  // 0 means unknown
  EXPECT_TRUE(of_exif(unknown));
}

TEST_F(StoredViews, IgnoresImplausibleExif) {
  for (const int mm : {0, 4, 501, 65535}) EXPECT_FALSE(of_exif({{kEquivalentTag, 3, mm}})) << mm;
  EXPECT_FALSE(of_exif({{kFocalLength, 5, 50, 1}}));
  const auto of_sensor = [&](Tag focal, Tag resolution, int unit) {
    return of_exif(
        {focal, {kWidth, 4, 3600}, {kHeight, 4, 2400}, resolution, {kFocalPlaneUnit, 3, unit}});
  };
  const Tag focal{kFocalLength, 5, 50, 1}, resolution{kFocalPlaneX, 5, 1000, 1};
  EXPECT_TRUE(of_sensor(focal, resolution, 3));
  EXPECT_FALSE(of_sensor({kFocalLength, 5, 50, 0}, resolution, 3));
  EXPECT_FALSE(of_sensor({kFocalLength, 5, 1, 1000}, resolution, 3));
  EXPECT_FALSE(of_sensor({kFocalLength, 5, 50'000, 1}, resolution, 3));
  EXPECT_FALSE(of_sensor(focal, {kFocalPlaneX, 5, 0, 1}, 3));
  EXPECT_FALSE(of_sensor(focal, {kFocalPlaneX, 5, 0, 0}, 3));
  EXPECT_FALSE(of_sensor(focal, resolution, 1));
  EXPECT_FALSE(of_sensor(focal, resolution, 77));
}

TEST_F(StoredViews, IgnoresBrokenExif) {
  const std::string good = exif_segment({{kFocalLength, 5, 425, 100}, {kEquivalentTag, 3, 26}});
  ASSERT_TRUE(stored_view(image(good)));
  for (std::size_t at = 4; at < good.size(); ++at)
    for (const char byte : {'\x00', '\x7F', '\xFF'}) {
      std::string bad = good;
      bad[at] = byte;
      const auto view = stored_view(image(bad));
      if (!view) continue;
      EXPECT_TRUE(view->focal_diagonals > 0.04 && view->focal_diagonals < 5.8) << at;
    }
  EXPECT_FALSE(stored_view(folder.write("2.jpg", "no picture")));
  EXPECT_FALSE(stored_view(folder.path() / "absent.jpg"));
}

TEST_F(StoredViews, ReadsTheEquivalentFocalLengthFromAVideo) {
  for (const char* name : {"a.mov", "a.mp4", "a.mkv"}) {
    const auto view = stored_view(video({{kEquivalent, "27"}}, name));
    ASSERT_TRUE(view) << name;
    EXPECT_NEAR(view->focal_diagonals, 27 / kFilm_mm, 1e-12);
    EXPECT_THAT(view->source, testing::StartsWith("the video's metadata (27 mm equivalent"));
  }
  EXPECT_TRUE(stored_view(video({{kEquivalent, "50.00mm"}})));
  for (const char* text : {"", "mm", "wide", "-26", "4.9", "501 mm", "nan", "1e999"})
    EXPECT_FALSE(stored_view(video({{kEquivalent, text}}))) << text;
  EXPECT_FALSE(stored_view(video({{"com.apple.quicktime.model", "iPhone"}})));
  EXPECT_FALSE(stored_view(folder.write("b.mov", "no video")));
}

TEST_F(StoredViews, ExifIsReadOfTiffAndWebpButOfNoOtherRiffFile) {
  constexpr std::size_t kBeforeTiff = 10;
  const std::string tiff = exif_segment({{kEquivalentTag, 3, 26}}).substr(kBeforeTiff);
  const auto chunk = [](const std::string& kind, const std::string& content) {
    const std::string size = big_endian({std::ssize(content)}, 4);
    return kind + std::string(size.rbegin(), size.rend()) + content;
  };
  const auto riff = [&](const std::string& kind, const std::string& extended) {
    return chunk("RIFF",
                 kind + chunk(extended, "\x08" + std::string(9, '\0')) + chunk("EXIF", tiff));
  };
  EXPECT_TRUE(stored_view(folder.write("1.tif", tiff)));
  EXPECT_TRUE(stored_view(folder.write("1.webp", riff("WEBP", "VP8X"))));
  EXPECT_FALSE(stored_view(folder.write("2.webp", riff("AVI ", "LIST"))));
}

TEST_F(StoredViews, OrientationInExifTurnsWhatIsShown) {
  const auto turns = [&](int orientation) {
    const std::string tiff = std::string("MM\0*", 4) + big_endian({8}, 4) + big_endian({1}, 2) +
                             big_endian({0x112, 3}, 2) + big_endian({1}, 4) +
                             big_endian({orientation, 0}, 2) + big_endian({0}, 4);
    const std::string content = std::string("Exif\0\0", 6) + tiff;
    const std::vector files = {
        image("\xFF\xE1" + big_endian({std::ssize(content) + 2}, 2) + content)};
    return quarter_turns_of_exif(files);
  };
  for (const auto& [orientation, expected] :
       {std::pair{1, 0}, {3, 2}, {6, 1}, {8, 3}, {2, 0}, {4, 2}, {5, 1}, {7, 3}, {0, 0}, {9, 0}})
    EXPECT_EQ(turns(orientation), expected) << orientation;
  EXPECT_EQ(quarter_turns_of_exif({}), 0);
  EXPECT_EQ(quarter_turns_of_exif(std::vector{video({})}), 0);
}

std::string box(const std::string& kind, const std::string& content) {
  return big_endian({std::ssize(content) + 8}, 4) + kind + content;
}

/// Returns a box `meta` with two keys according to QuickTime's documentation.
std::string meta_of(int type, const std::string& value) {
  const std::string none = big_endian({0}, 4);
  const auto item = [&](int place, int of_type, const std::string& data) {
    return box(big_endian({place}, 4), box("data", big_endian({of_type, 0}, 4) + data));
  };
  return box("hdlr", none + none + "mdta" + none + none + none) +
         box("keys",
             none + big_endian({2}, 4) + box("mdta", "com.apple.quicktime.camera.lens_model") +
                 box("mdta", kEquivalent)) +
         box("ilst", item(1, 1, "back camera 6.86mm") + item(2, type, value));
}

TEST(MovieMetadata, ReadsTextsAndNumbers) {
  const auto value = [](int type, const std::string& bytes) {
    return metadata_value(meta_of(type, bytes), kEquivalent).value_or("none");
  };
  EXPECT_EQ(value(1, "50.00mm"), "50.00mm");
  EXPECT_EQ(value(21, big_endian({26}, 4)), "26");
  EXPECT_EQ(value(21, big_endian({-2}, 2)), "-2");
  EXPECT_EQ(value(21, big_endian({-2}, 8)), "-2");
  EXPECT_EQ(value(22, big_endian({255}, 1)), "255");
  EXPECT_EQ(value(23, big_endian({std::bit_cast<std::int32_t>(26.5F)}, 4)), "26.5");
  EXPECT_EQ(value(24, big_endian({std::bit_cast<std::int64_t>(13.25)}, 8)), "13.25");
  EXPECT_EQ(value(23, "abc"), "none");
  EXPECT_EQ(value(21, ""), "none");
  EXPECT_EQ(value(13, "a picture"), "none");
  const std::string meta = meta_of(1, "26");
  EXPECT_EQ(metadata_value(meta, "com.apple.quicktime.camera.lens_model"), "back camera 6.86mm");
  EXPECT_EQ(metadata_value(std::string(4, '\0') + meta, kEquivalent), "26");  // MPEG-4
  EXPECT_FALSE(metadata_value(meta, "com.apple.quicktime.model"));
  for (std::size_t length = 0; length < meta.size(); ++length)
    EXPECT_FALSE(metadata_value(meta.substr(0, length), kEquivalent)) << length;
}

TEST_F(StoredViews, ReadsMetadataOfAVideosTrack) {
  const auto file = video({});
  std::string bytes = folder.read("a.mov");
  // FFmpeg puts `moov` at the end, so that a larger track in it moves no data.
  const std::size_t movie = bytes.rfind("moov") - 4, track = bytes.find("trak", movie) - 4;
  ASSERT_GT(movie, bytes.find("mdat"));
  const std::string added = box("meta", meta_of(21, big_endian({26}, 4)));
  bytes.insert(track + gpo::big_endian(bytes, track, 4), added);
  for (const std::size_t at : {track, movie}) {
    const auto size = static_cast<std::int64_t>(gpo::big_endian(bytes, at, 4));
    bytes.replace(at, 4, big_endian({size + std::ssize(added)}, 4));
  }
  folder.write("a.mov", bytes);
  const auto view = stored_view(file);
  ASSERT_TRUE(view);
  EXPECT_NEAR(view->focal_diagonals, 26 / kFilm_mm, 1e-12);
  const auto recording = open_recording(file);
  EXPECT_EQ(recording->frame_count(), 3);
  EXPECT_NEAR(recording->camera.fx, 26 / kFilm_mm * 80, 1e-9);
}

std::string settings(float diagonal_deg, const std::string& style) {
  const std::string angle = big_endian({std::bit_cast<std::int32_t>(diagonal_deg)}, 4);
  return gpmf_item("DEVC", '\0', 1, gpmf_item("DVNM", 'c', 1, "Global Settings")) +
         gpmf_item(
             "DEVC", '\0', 1, gpmf_item("VFOV", 'c', 1, style) + gpmf_item("ZFOV", 'f', 4, angle));
}

TEST(GoProSettings, ReadsTheDiagonalAngle) {
  const auto linear = view_of_gpmf(settings(90, "L"));
  ASSERT_TRUE(linear);
  EXPECT_NEAR(linear->focal_diagonals, 0.5, 1e-12);
  EXPECT_FALSE(linear->fisheye);
  const auto wide = view_of_gpmf(settings(137.4F, "W"));
  ASSERT_TRUE(wide);
  EXPECT_TRUE(wide->fisheye);
  EXPECT_EQ(wide->source, "the GoPro's settings (137 deg diagonal, fisheye)");
  for (const float absurd : {0.F, -90.F, 9.F, 171.F, 1e30F})
    EXPECT_FALSE(view_of_gpmf(settings(absurd, "W"))) << absurd;
  EXPECT_FALSE(view_of_gpmf(settings(std::numeric_limits<float>::quiet_NaN(), "W")));
  const std::string good = settings(120, "W");
  for (std::size_t length = 0; length < good.size(); ++length)
    EXPECT_FALSE(view_of_gpmf(good.substr(0, length))) << length;
}

TEST_F(StoredViews, ReadsAGoProsFisheye) {
  const auto file = video({}, "GX010001.mp4");
  std::string bytes = folder.read("GX010001.mp4");
  // Insert it before the data that FFmpeg adds to the movie, the last box of the file.
  const std::string added = box("udta", box("GPMF", settings(120, "W")));
  const std::size_t movie = bytes.rfind("moov") - 4;
  bytes.insert(bytes.find("udta", movie) - 4, added);
  bytes.replace(movie, 4, big_endian({std::ssize(bytes) - static_cast<std::ptrdiff_t>(movie)}, 4));
  folder.write("GX010001.mp4", bytes);
  const auto recording = open_recording(file);
  const Camera& camera = recording->camera;
  EXPECT_EQ(recording->camera_source, CameraSource::guess);
  EXPECT_THAT(recording->notes.at(0), HasSubstr("120 deg diagonal, fisheye"));
  // The corner is at half the diagonal angle from the axis.
  const double half_rad = radians(60);
  const Eigen::Vector2d corner =
      project(camera, {0.8 * std::sin(half_rad), 0.6 * std::sin(half_rad), std::cos(half_rad)});
  EXPECT_LT((corner - Eigen::Vector2d(camera.cx + 32, camera.cy + 24)).norm(), 1e-9);
}

TEST(RealGoPro, HasNoAngleInAModelOf2016) {
  const auto file = std::filesystem::path(GPO_SHARED_DIR) / "data/gopro/karma.mp4";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no recordings in " << GPO_SHARED_DIR;
  EXPECT_FALSE(stored_view(file));
  EXPECT_THAT(open_recording(file)->notes.at(0),
              HasSubstr("assuming a 70 deg diagonal field of view"));
}

}  // namespace
}  // namespace gpo::test
