// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/recording/layouts/open_recording.h"
#include "tests/engine/test_folder.h"

#include <memory>
#include <vector>

#include <gmock/gmock.h>

namespace gpo::test {

/// A file's text, and the message of its error behind the file's path; "..." at the end stands for
/// the rest of the message.
struct Refusal {
  std::string text, message;
};

/// Expects that `read` refuses each text in a file of this name.
inline void expect_refusals(const std::string& name,
                            const std::vector<Refusal>& refusals,
                            const std::function<void(const std::filesystem::path& file)>& read) {
  const TestFolder folder;
  for (const auto& [text, message] : refusals) {
    const auto file = folder.write(name, text);
    const std::string error = error_of([&] { read(file); });
    const bool whole = !message.ends_with("...");
    const std::string expected =
        file.string() + (whole ? message : message.substr(0, message.size() - 3));
    EXPECT_THAT(whole ? error : error.substr(0, expected.size()), expected) << text.substr(0, 200);
  }
}

/// A folder of a recording.
class RecordingFolder : public testing::Test {
 protected:
  std::shared_ptr<const Recording> open() const { return open_recording(folder.path()); }
  std::string error() const {
    return error_of([this] { open(); });
  }
  std::string file(const std::string& name) const { return (folder.path() / name).string(); }

  const TestFolder folder;
};

}  // namespace gpo::test
