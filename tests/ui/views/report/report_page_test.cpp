// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/error.h"
#include "engine/methods/methods.h"
#include "tests/ui/made_inspection.h"
#include "ui/views/image/image_geometry.h"
#include "ui/views/report/report.h"

#include <set>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace gpo {
namespace {

using testing::AllOf, testing::HasSubstr, testing::Not;

ReportSection made_section(const std::string& name, const MadeOptions& options = {}) {
  auto inspection = std::make_shared<Inspection>(made_inspection(options));
  auto recording = std::make_shared<Recording>(*inspection->recording);
  recording->name = name;
  inspection->recording = recording;
  return {.inspection = inspection};
}

/// Returns an image that compresses badly.
cv::Mat noise_image() {
  cv::Mat image(960, 1280, CV_8UC3);
  cv::RNG(1).fill(image, cv::RNG::UNIFORM, 0, 256);
  return image;
}

TEST(HtmlText, EscapesMarkupAndReplacesInvalidUtf8) {
  EXPECT_EQ(html_text("<b>\"Tom's\" & \xC3\xA4</b>"),
            "&lt;b&gt;&quot;Tom&#39;s&quot; &amp; \xC3\xA4&lt;/b&gt;");
  EXPECT_EQ(html_text("a\xFFz"), "a\xEF\xBF\xBDz");
}

TEST(DataUri, EncodesEveryLength) {
  EXPECT_EQ(data_uri("text/plain", ""), "data:text/plain;base64,");
  EXPECT_EQ(data_uri("text/plain", "M"), "data:text/plain;base64,TQ==");
  EXPECT_EQ(data_uri("text/plain", "Ma"), "data:text/plain;base64,TWE=");
  EXPECT_EQ(data_uri("text/plain", "Man\xFF"), "data:text/plain;base64,TWFu/w==");
}

TEST(ScriptJson, CannotEndTheScript) {
  const std::string text = script_json({{"name", "</script><!--"}});
  EXPECT_THAT(text, Not(HasSubstr("<")));
  EXPECT_EQ(nlohmann::json::parse(text)["name"], "</script><!--");
}

TEST(HtmlTable, DropsEmptyColumns) {
  EXPECT_EQ(
      html_table({"a", "b", "c"}, {{{"1"}, {}, {"<", "number"}}}),
      "<div class=\"wide\"><table><thead><tr><th>a</th><th class=\"number\">c</th></tr></thead>\n"
      "<tbody>\n<tr><th>1</th><td class=\"number\">&lt;</td></tr>\n</tbody></table></div>\n");
}

TEST(ReportPage, EscapesNamesEverywhere) {
  const std::string name = "</script><script>alert('x')</script>\"onload=\"y";
  ReportSection section = made_section(name);
  section.frames.push_back(
      {section.inspection->window->start, cv::Mat(48, 64, CV_8UC3, cv::Scalar())});
  section.found = section.command = name;
  const std::string page = report_page({.sections = {section, section}, .program = name});
  EXPECT_THAT(page, AllOf(Not(HasSubstr("alert('x')")), Not(HasSubstr("\"onload"))));
  EXPECT_THAT(page, HasSubstr("&lt;/script&gt;&lt;script&gt;alert(&#39;x&#39;)"));
}

TEST(ReportPage, ShrinksImagesToTheLargestSize) {
  ReportSection section = made_section("noise");
  const int start = section.inspection->window->start;
  for (int k = 0; k < 5; ++k) section.frames.push_back({start + k, noise_image()});
  const std::string page = report_page({.sections = {section}, .program = "1"});
  EXPECT_LE(page.size(), kMostReportBytes);
  EXPECT_GT(page.size(), kMostReportBytes / 5) << "smaller than it had to be";
}

TEST(ReportPage, RefusesMoreThanTheLargestSize) {
  ReportSection section = made_section("long");
  section.found = std::string(kMostReportBytes, 'x');
  try {
    report_page({.sections = {section}, .program = "1"});
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(),
                AllOf(HasSubstr("the report of 1 recording would have "),
                      HasSubstr("more than 5 MB, with the smallest images; choose fewer")));
  }
}

TEST(ReportPage, ShowsWhyAnInitializationFailed) {
  const ReportSection section = made_section("made", {.ok = false});
  const std::string page = report_page({.sections = {section}, .program = "1"});
  EXPECT_THAT(page, HasSubstr("<div class=\"verdict failed\"><b>failed</b>"));
  EXPECT_THAT(page, HasSubstr(html_text(section.inspection->initialization->reason)));
  EXPECT_THAT(page, Not(HasSubstr("<h3>Numbers</h3>")));
}

TEST(ReportPage, ListsFindings) {
  ReportSection section = made_section("made");
  EXPECT_THAT(report_page({.sections = {section}, .program = "1"}),
              Not(HasSubstr("<h3>Findings</h3>")));
  auto inspection = std::make_shared<Inspection>(*section.inspection);
  inspection->findings = {{.key = "implausible-intrinsics",
                           .level = Level::weak,
                           .sentence = "fx < fy",
                           .advice = "check them",
                           .command = "set intrinsics_scale 0.75"},
                          {.key = "guessed-camera", .sentence = "a guess", .ignored = true}};
  section.inspection = inspection;
  const std::string page = report_page({.sections = {section}, .program = "1"});
  for (const char* text : {"<h3>Findings</h3>",
                           ">implausible-intrinsics<",
                           ">weak<",
                           "fx &lt; fy",
                           ">check them<",
                           ">set intrinsics_scale 0.75<",
                           ">ignored<"})
    EXPECT_THAT(page, HasSubstr(text));
}

TEST(ReportPage, ShowsNoSigmaOfAFailedInitialization) {
  ReportSection section = made_section("made", {.ok = false});
  auto inspection = std::make_shared<Inspection>(*section.inspection);
  auto result = std::make_shared<Initialization>(*inspection->initialization);
  result->verdict = Verdict{.normal_sigma_deg = 0.3125};
  inspection->initialization = result;
  section.inspection = inspection;
  const std::string page = report_page({.sections = {section}, .program = "1"});
  EXPECT_EQ(page.find("normal of the plane"), std::string::npos);
}

TEST(ReportPage, NamesAnUncertaintyThatIsNotTheMethodsOwn) {
  ReportSection section = made_section("made", {.normal_sigma_deg = 0.5});
  const auto page = [&] { return report_page({.sections = {section}, .program = "1"}); };
  EXPECT_THAT(page(), Not(HasSubstr("of the window, not of the method")));
  auto inspection = std::make_shared<Inspection>(*section.inspection);
  auto result = std::make_shared<Initialization>(*inspection->initialization);
  result->uncertainty->own = false;
  inspection->initialization = result;
  section.inspection = inspection;
  EXPECT_THAT(page(),
              AllOf(HasSubstr("of the window, not of the method; rotations"),
                    HasSubstr("normal of the plane, 1 sigma of the window")));
}

TEST(ReportScene, HasPointsCamerasAndColorsOfTheImages) {
  const Inspection inspection = made_inspection({.truth = true});
  const auto scene = report_scene(inspection);
  std::map<std::string, int> counts;
  for (const auto& item : scene["items"]) ++counts[item["layer"]];
  EXPECT_EQ(counts["points"], std::ssize(inspection.initialization->points));
  for (const char* layer : {"cameras", "grid", "cube", "truth", "axes"})
    EXPECT_GT(counts[layer], 3) << layer;
  ASSERT_EQ(counts["picture"], 1);
  const auto is_picture = [](const auto& item) { return item["layer"] == "picture"; };
  const auto& picture = *std::ranges::find_if(scene["items"], is_picture);
  const std::string colors = picture["colors"];
  EXPECT_EQ(colors.size(), 6U * picture["columns"].get<int>() * picture["rows"].get<int>());
  EXPECT_GT(std::set<char>(colors.begin(), colors.end()).size(), 3U) << "the floor is checkered";
}

TEST(ReportScene, DrawsEachCubeInTheColorOfItsPlane) {
  Inspection inspection = made_inspection();
  CubeAnchor other = *inspection.cube;
  other.plane = 1;
  inspection.other_cubes = {other};
  std::set<std::string> lines, faces;
  const auto scene = report_scene(inspection);
  for (const auto& item : scene["items"])
    if (item["layer"] == "cube") (item["kind"] == "face" ? faces : lines).insert(item["color"]);
  const auto css = [](std::uint32_t rgb) { return fmt::format("#{:06x}", rgb); };
  const std::string main = css(color_of(Role::cube_base, Theme::light));
  EXPECT_THAT(lines, testing::IsSupersetOf({main, css(cube_color(other, *inspection.window))}));
  EXPECT_THAT(
      faces,
      testing::UnorderedElementsAre(css(cube_face_color(*inspection.cube, *inspection.window)),
                                    css(cube_face_color(other, *inspection.window))));
}

TEST(ReportCommand, NamesChangedSettingsAndQuotesPaths) {
  Settings settings;
  settings.frames = 12;
  settings.options.method = "pba";
  const std::string line =
      report_command("it's a path", {"--tracks", "a b"}, settings, parse_configurations("gpo,pba"));
  EXPECT_THAT(line,
              AllOf(HasSubstr("gpo-inspector report 'it'\\''s a path' --tracks 'a b' "),
                    HasSubstr(" --frames 12"),
                    HasSubstr(" --method pba"),
                    HasSubstr(" --methods gpo,pba --output report.html")));
  EXPECT_EQ(report_command("a", {}, {}), "gpo-inspector report a --output report.html");
}

TEST(ReportCommand, DefinesEachOwnMethodOnce) {
  Method command = find_method("gpo"), result = command;
  command.command = "mine=./mine --fast";
  command.resampled = true;
  result.result = "orb=orb.txt,offset=auto";
  const auto choice = [](const Method& method) {
    return MethodChoice(std::make_shared<const Method>(method));
  };
  Settings settings;
  settings.options.method = choice(result);
  std::vector<Configuration> compared;
  for (const Method* one : {&command, &result, &command}) compared.push_back({choice(*one)});
  EXPECT_THAT(report_command("a", {}, settings, compared),
              HasSubstr(" --method-command 'mine=./mine --fast' --result orb=orb.txt,offset=auto "
                        "--method-resample --methods "));
}

TEST(ReportCommand, OpensTheRecordingAsItWasOpened) {
  Recording recording;
  EXPECT_THAT(opening_options(recording, {}, {}), testing::IsEmpty());
  recording.camera_source = CameraSource::self_calibrated;
  EXPECT_THAT(
      opening_options(recording, "t.csv", {{TopicRole::image, "/cam0"}}),
      testing::ElementsAre("--tracks", "t.csv", "--topic", "image=/cam0", "--calibrate", "auto"));
}

TEST(ReportFrames, AreDistinctAndCoverTheWindow) {
  Inspection inspection = made_inspection();
  const std::vector<int> frames = report_frames(inspection);
  EXPECT_EQ(frames.size(), 5U);
  EXPECT_EQ(frames.front(), inspection.window->start);
  EXPECT_EQ(frames.back(), inspection.window->start + inspection.window->frame_count() - 1);
}

}  // namespace
}  // namespace gpo
