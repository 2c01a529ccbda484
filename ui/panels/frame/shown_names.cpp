// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/panels/panels.h"

#include <tuple>

namespace gpo {

std::vector<std::string_view> shown_names(const PanelInput& input, const Views& views) {
  const auto& [document, files] = std::tie(input.state.document, input.state.files);
  const MessageLog& messages = input.state.messages;
  std::vector<std::string_view> names{messages.text,
                                      input.worker.error,
                                      input.worker.stage,
                                      input.example.native(),
                                      files.session_file.native(),
                                      document.model,
                                      input.state.results.experiment_name,
                                      views.browser.text.data(),
                                      views.palette.text.data()};
  for (const LogLine& line : messages.lines) names.push_back(line.text);
  for (const fs::path& recent : files.recent) names.push_back(recent.native());
  for (const Bookmark& bookmark : document.bookmarks) names.push_back(bookmark.note);
  for (const FolderEntry& entry : views.browser.listed.entries) names.push_back(entry.name);
  if (input.state.view.sources)
    for (const CameraDevice& camera : *input.state.view.sources) names.push_back(camera.name);
  if (!document.recording) return names;
  names.push_back(document.recording->name);
  names.push_back(document.recording->path.native());
  for (const std::string& note : document.recording->notes) names.push_back(note);
  return names;
}

}  // namespace gpo
