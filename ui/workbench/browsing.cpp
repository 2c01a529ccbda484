// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/browsing.h"

#include "engine/files/text_file.h"

#include <algorithm>
#include <cstdlib>

namespace gpo {
namespace {

namespace fs = std::filesystem;

fs::path home() {
  const char* home = std::getenv("HOME");  // NOLINT(concurrency-mt-unsafe): nobody sets it
  return home != nullptr ? home : "/";
}

bool begins(const FolderEntry& entry, const std::string& name) {
  return lower_case(entry.name).starts_with(lower_case(name));
}

}  // namespace

TypedPath typed_path(const std::string& text) {
  // A path typed after another one begins anew: /work//home, /work/~.
  std::string whole = text;
  if (const std::size_t at = whole.rfind("//"); at != std::string::npos) whole.erase(0, at + 1);
  if (const std::size_t at = whole.rfind("/~"); at != std::string::npos) whole.erase(0, at + 1);
  if (whole == "~" || whole.starts_with("~/")) whole = home().string() + whole.substr(1);
  std::error_code none;
  if (!whole.starts_with('/')) whole = (fs::current_path(none) / whole).string();
  const std::size_t slash = whole.rfind('/');
  return {fs::path(whole.substr(0, slash + 1)).lexically_normal(), whole.substr(slash + 1)};
}

std::vector<FolderEntry> matching(std::span<const FolderEntry> entries, const std::string& name) {
  std::vector<FolderEntry> found;
  for (const FolderEntry& entry : entries) {
    const bool hidden = entry.name.starts_with('.') && !name.starts_with('.');
    if (!hidden && lower_case(entry.name).find(lower_case(name)) != std::string::npos)
      found.push_back(entry);
  }
  // Clang 14 cannot read what the one of std::ranges returns.
  std::stable_partition(
      found.begin(), found.end(), [&](const auto& entry) { return begins(entry, name); });
  return found;
}

std::string completed(const std::string& text, std::span<const FolderEntry> entries) {
  const std::string name = text.substr(text.rfind('/') + 1);
  std::vector<FolderEntry> found = matching(entries, name);
  std::erase_if(found, [&](const auto& entry) { return !begins(entry, name); });
  if (found.empty()) return text;
  std::string common = found.front().name;
  for (const FolderEntry& entry : found) {
    const auto [a, b] = std::ranges::mismatch(common, entry.name);
    common.erase(a, common.end());
  }
  // Names that differ in nothing but their case agree in what was typed.
  if (common.size() < name.size()) return text;
  const bool alone = found.size() == 1 && found.front().folder;
  return text.substr(0, text.size() - name.size()) + common + (alone ? "/" : "");
}

}  // namespace gpo
