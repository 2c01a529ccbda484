// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/methods/common/initialization.h"
#include "engine/methods/common/method_options.h"
#include "engine/methods/common/sources.h"
#include "engine/methods/common/watch.h"
#include "engine/window/window.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace gpo {

/// How a method uses many frames (paper, "Multi-frame Initialization Baselines").
enum class MethodFamily { aggregation, optimization };

/// A method is one file and one row of a table: the command line's choices, the combo box, the
/// legends and the tests read it.
struct Method {
  std::string key;         ///< on the command line, in files
  std::string title = {};  ///< for people
  std::uint32_t rgb = 0;   ///< 0xRRGGBB, Okabe-Ito
  MethodFamily family = MethodFamily::optimization;
  bool needs_plane = false;           ///< takes every track that it is given to lie on the plane
  Inliers inliers = Inliers::planes;  ///< by default: as its authors do
  /// Whether it takes the rotations as given or moves them all (free), by which its uncertainty is
  /// computed; nothing: it says so itself.
  std::optional<RotationModel> rotations = {};
  /// The options that it heeds (fields of `MethodOptions`), by the keys of their settings.
  std::vector<std::string> reads = {};
  std::function<Initialization(
      const Window& window, const MethodOptions& options, const Watch& watch)>
      initialize = {};
  /// What it does and what it assumes, two sentences for people.
  std::string help = "Your own initializer, a process beside this one";
  /// Of a user's own: the same for those who have more than the window; empty of ours.
  std::function<Initialization(const Window& window, const Sources& sources, const Watch& watch)>
      initialize_from = {};
  /// Of a user's own: what it is, by which results of another are told from its own; empty of ours.
  std::string identity = {};
  /// Of a user's own: how options and sessions write it; both empty of ours.
  std::string command = {};  ///< "NAME=COMMAND"
  std::string result = {};   ///< "NAME=FILE[,POINTS][,frame=camera|body]"
  int number = 0;            ///< of a user's own, among these, from 0
};

/// Our methods, in their order.
std::span<const Method> methods();

/// Our method named `key`. Throws SettingError that names all.
const Method& find_method(std::string_view key);

/// Keys of our methods that read an option, by the key of its setting. A user's own read none.
std::vector<std::string> readers_of(const std::string& option);

/// The method that options choose: one of ours by its key, or a row of the user's own.
class MethodChoice {
 public:
  MethodChoice(const char* key) : key_(key) {}
  MethodChoice(std::string key) : key_(std::move(key)) {}
  explicit MethodChoice(std::shared_ptr<const Method> own) : key_(own->key), own_(std::move(own)) {}

  const std::string& key() const { return key_; }
  operator const std::string&() const { return key_; }
  /// Throws SettingError if there is neither a row nor a method of ours of that key.
  const Method& row() const { return own_ ? *own_ : find_method(key_); }
  const std::shared_ptr<const Method>& own() const { return own_; }  ///< null: one of ours

  friend bool operator==(const MethodChoice&, const MethodChoice&) = default;

 private:
  std::string key_;
  std::shared_ptr<const Method> own_;
};

/// The methods to choose from: ours, then the user's own. A value; copies share their rows.
class MethodTable {
 public:
  /// Adds a method of the user's. Throws InputError for a key that is taken.
  void add(Method own);
  /// Adds the row of a choice, unless it is there or one of ours.
  void add(const MethodChoice& choice);

  const std::vector<std::shared_ptr<const Method>>& own() const { return own_; }
  std::vector<MethodChoice> all() const;
  bool contains(std::string_view key) const;
  /// Throws SettingError that names the known ones.
  MethodChoice find(std::string_view key) const;

 private:
  std::vector<std::shared_ptr<const Method>> own_;
};

/// What a method made of the window, with its uncertainty and the verdict on the window. A
/// degenerate window's result becomes a failure.
Initialization assessed(const Method& method, const Window& window, Initialization result);

}  // namespace gpo
