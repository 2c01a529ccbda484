// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/diagnosis/diagnosis.h"

#include <gmock/gmock.h>

namespace gpo {
namespace {

using testing::IsEmpty, testing::SizeIs;

std::vector<Finding> found(const Evidence& evidence) {
  return findings_of(evidence, {Of::window, Of::inspection});
}

TEST(TruthConventionsCheck, IsANoteUnlessTheWindowUsesTheRotationsOfTheTruth) {
  EXPECT_THAT(found({}), IsEmpty());
  TruthConvention convention{.as_read_deg = 14.2,
                             .fitted_deg = 0.1,
                             .name = "its quaternions are read w first",
                             .advice = "write each quaternion as qx qy qz qw"};
  const auto note = found({.truth_convention = &convention});
  ASSERT_THAT(note, SizeIs(1));
  EXPECT_EQ(note[0].key, "truth-conventions");
  EXPECT_EQ(note[0].level, Level::note);
  EXPECT_EQ(text_of(note[0]),
            "the ground truth's rotations differ by 14 deg from those of the images; they fit to "
            "0.1 deg if its quaternions are read w first: write each quaternion as qx qy qz qw");
  convention.is_used = true;
  EXPECT_EQ(found({.truth_convention = &convention})[0].level, Level::degenerate);
}

TEST(TruthOfAnotherPlaneCheck, NamesThePlaneThatTheTruthDescribes) {
  Window window;
  Evaluation evaluation;
  EXPECT_THAT(found({.window = &window, .evaluation = &evaluation}), IsEmpty());
  evaluation.plane = 2;
  const auto other = found({.window = &window, .evaluation = &evaluation});
  ASSERT_THAT(other, SizeIs(1));
  EXPECT_EQ(other[0].key, "truth-of-another-plane");
  EXPECT_EQ(other[0].level, Level::note);
  EXPECT_EQ(other[0].command, "main-plane 3");
  EXPECT_EQ(other[0].sentence,
            "the ground truth describes plane 3 of the window, and plane 1 leads: no PNE and PDE");
  evaluation.plane = std::nullopt;
  const auto none = found({.window = &window, .evaluation = &evaluation});
  ASSERT_THAT(none, SizeIs(1));
  EXPECT_EQ(none[0].command, "");
}

TEST(TruthContradictsCheck, StatesTheErrorsBeyondTheirUncertainty) {
  Window window;
  Evaluation evaluation;
  evaluation.pne_deg = 13.8;
  evaluation.pne_sigmas = 3.9;
  evaluation.path_error_percent = 12;
  EXPECT_THAT(found({.window = &window, .evaluation = &evaluation}), IsEmpty());
  evaluation.pne_sigmas = 48;
  evaluation.tracks_px = 23;
  const auto off = found({.window = &window, .evaluation = &evaluation});
  ASSERT_THAT(off, SizeIs(1));
  EXPECT_EQ(off[0].key, "truth-contradicts");
  EXPECT_EQ(off[0].level, Level::note);
  EXPECT_EQ(off[0].sentence,
            "the normal is 14 deg off the ground truth (48 sigma), the path 12 % of its length, "
            "the tracks 23 px");
  EXPECT_EQ(off[0].advice, "check tracks, camera and ground truth");
  evaluation.tracks_px = 0.5;
  EXPECT_EQ(found({.window = &window, .evaluation = &evaluation})[0].advice,
            "compare other methods and rotations, the tracks fit the truth");
}

}  // namespace
}  // namespace gpo
