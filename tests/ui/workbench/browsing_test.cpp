// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause

#include "ui/workbench/work/folder_lister.h"

#include <algorithm>
#include <chrono>
#include <map>
#include <thread>
#include <tuple>

#include <gmock/gmock.h>

namespace gpo {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;

const std::vector<FolderEntry> kEntries = {
    {"desk", true}, {"Desk-2", true}, {"orbit", true}, {".git", true}, {"desk.yaml"}};

std::vector<std::string> names(const std::vector<FolderEntry>& entries) {
  std::vector<std::string> all;
  for (const FolderEntry& entry : entries) all.push_back(entry.name);
  return all;
}

TEST(Browsing, SplitsATypedPath) {
  for (const auto& [text, folder, name] : {std::tuple{"/a/b", fs::path("/a/"), "b"},
                                           {"/a/b/", "/a/b/", ""},
                                           {"/a/../c/d", "/c/", "d"},
                                           {"x", fs::current_path() / "", "x"},
                                           {"/a/b//c/d", "/c/", "d"}}) {
    EXPECT_EQ(typed_path(text).folder, folder) << text;
    EXPECT_EQ(typed_path(text).name, name) << text;
  }
  EXPECT_EQ(typed_path("/a/~/d").folder, typed_path("~/").folder);
  EXPECT_EQ(typed_path("~").folder, typed_path("~/").folder.parent_path().parent_path() / "");
}

TEST(Browsing, MatchesAnyPartAndHiddenEntriesOnRequest) {
  EXPECT_THAT(names(matching(kEntries, "")), ElementsAre("desk", "Desk-2", "orbit", "desk.yaml"));
  EXPECT_THAT(names(matching(kEntries, "DESK")), ElementsAre("desk", "Desk-2", "desk.yaml"));
  EXPECT_THAT(names(matching(kEntries, "bit")), ElementsAre("orbit"));
  EXPECT_THAT(names(matching(kEntries, ".")), ElementsAre(".git", "desk.yaml"));
}

TEST(Browsing, CompletesAsFarAsNamesAgree) {
  EXPECT_EQ(completed("/w/or", kEntries), "/w/orbit/");
  EXPECT_EQ(completed("/w/desk", kEntries), "/w/desk");
  EXPECT_EQ(completed("/w/desk.", kEntries), "/w/desk.yaml");
  EXPECT_EQ(completed("/w/nothing", kEntries), "/w/nothing");
  EXPECT_EQ(completed("/w/", kEntries), "/w/");
}

/// Waits until the list is complete.
FolderList whole_list(FolderLister& lister, const fs::path& folder) {
  FolderList list = lister.list(folder);
  while (list.reading) {
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
    list = lister.list(folder);
  }
  return list;
}

TEST(FolderLister, DescribesRecordings) {
  FolderLister lister;
  const FolderList list = whole_list(lister, fs::path(GPO_SOURCE_DIR) / "sequences");
  EXPECT_EQ(list.error, "");
  std::map<std::string, std::string> what;
  for (const FolderEntry& entry : list.entries) what[entry.name] = entry.what;
  EXPECT_EQ(what.at("desk"), "EuRoC \u00b7 60 frames \u00b7 2.0 s");
  EXPECT_EQ(what.at("companions"), "");
  EXPECT_EQ(what.at("orbit.yaml"), "recipe, rendered when opened");
  EXPECT_TRUE(list.entries.front().folder);
}

TEST(FolderLister, ReportsAMissingFolder) {
  FolderLister lister;
  EXPECT_EQ(whole_list(lister, "/no/such/folder").error, "No such file or directory");
}

TEST(FolderLister, ListsTheLastRequestedFolder) {
  FolderLister lister;
  for (int i = 0; i < 20; ++i) {
    lister.list("/usr");
    lister.list(GPO_SOURCE_DIR);
  }
  const FolderList list = whole_list(lister, GPO_SOURCE_DIR);
  EXPECT_EQ(std::ranges::count(list.entries, "engine", &FolderEntry::name), 1);
}

}  // namespace
}  // namespace gpo
