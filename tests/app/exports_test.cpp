// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/files/text_file.h"
#include "tests/app/program.h"

#include <gmock/gmock.h>

namespace gpo::test {
namespace {

using testing::HasSubstr;

TEST(RunExports, WritesEachFormatAndSaysWhatIsLeftOut) {
  const fs::path folder = fresh_folder();
  const Outcome run = succeeding(
      fmt::format("run --frames 10 --export colmap={1}/model {0} --export gltf={1}/new/a.glb "
                  "--export ply={1}/a.ply --export foxglove={1}/a.mcap --export tum={1}/a.txt "
                  "--trajectory {1}/b.txt",
                  kDesk,
                  folder.string()));
  EXPECT_THAT(run.out, HasSubstr("10 images, "));
  EXPECT_THAT(run.out, HasSubstr("mean reprojection error 0."));
  EXPECT_THAT(run.out, HasSubstr("left out: "));
  EXPECT_TRUE(fs::exists(folder / "model/points3D.bin") && fs::exists(folder / "new/a.glb"));
  EXPECT_EQ(read_file(folder / "a.txt"), read_file(folder / "b.txt"));
  // Read back as another program's result, and as a recording.
  const json estimated = run_json("{} --frames 10", kDesk);
  const json back =
      run_json("{} --frames 10 --method model --result model={}/model", kDesk, folder.string());
  ASSERT_EQ(back["frames"].size(), estimated["frames"].size());
  for (std::size_t i = 0; i < back["frames"].size(); ++i)
    for (int k = 0; k < 3; ++k)
      EXPECT_NEAR(back["frames"][i]["p_wc"][k], estimated["frames"][i]["p_wc"][k], 1e-3) << i;
  EXPECT_THAT(succeeding(fmt::format("info {}/a.mcap", folder.string())).out, HasSubstr("10"));
  expect_exit(2,
              program("run {} --export obj={}/a.obj", kDesk, folder.string()),
              "export format: found 'obj', expected one of colmap, gltf,");
  expect_exit(2, program("run {} --export colmap={}/model", kDesk, folder.string()), "model");
  expect_exit(2,
              program("run {0} --export ply={1}/c --export gltf={1}/c", kDesk, folder.string()),
              "expected a file for each");
}

}  // namespace
}  // namespace gpo::test
