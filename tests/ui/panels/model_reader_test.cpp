// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/engine/test_folder.h"
#include "ui/panels/panels.h"
#include "ui/views/model/solid_model.h"

#include <thread>

#include <gmock/gmock.h>

namespace gpo {
namespace {

using testing::HasSubstr;

LoadedModel wait_for(ModelReader& reader, const std::string& name) {
  std::optional<LoadedModel> model;
  while (!(model = reader.get(name))) std::this_thread::yield();
  return *model;
}

TEST(ModelReader, ReadsAModelInTheBackground) {
  const test::TestFolder folder;
  const std::string file =
      folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\n");
  ModelReader reader;
  EXPECT_FALSE(reader.get(file));
  const LoadedModel model = wait_for(reader, file);
  ASSERT_TRUE(model.model);
  EXPECT_EQ(model.model->triangles.size(), 2);
  EXPECT_EQ(model.error, "");
}

TEST(ModelReader, ReportsAFileThatCannotBeReadUntilAnotherIsChosen) {
  ModelReader reader;
  const LoadedModel missing = wait_for(reader, "missing.obj");
  EXPECT_FALSE(missing.model);
  EXPECT_THAT(missing.error, HasSubstr("missing.obj: no such file"));
  const std::optional<LoadedModel> none = reader.get("");
  ASSERT_TRUE(none);
  EXPECT_EQ(none->error, "");
}

}  // namespace
}  // namespace gpo
