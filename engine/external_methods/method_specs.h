// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/methods/methods.h"

#include <filesystem>
#include <string>
#include <vector>

namespace gpo {

/// The user's own methods as options of the command line and sessions spell them.
struct MethodSpecs {
  std::vector<std::string> commands;  ///< "NAME=COMMAND"
  std::vector<std::string> results;   ///< "NAME=FILE[,POINTS][,frame=camera|body]"

  bool empty() const { return commands.empty() && results.empty(); }
};

/// The names of all.
std::vector<std::string> names_of(const MethodSpecs& spelled);

/// Those of a table, for sessions to record them.
MethodSpecs specs_in(const MethodTable& methods);

/// A result's spelling with its files' whole paths, so that it is found from anywhere.
std::string with_whole_paths(const std::string& result);

/// What a session, a JSON file, records under `method_commands` and `results`; nothing of what is
/// no session. Throws InputError where these are no lists of texts.
MethodSpecs methods_in_session(const std::filesystem::path& file);

}  // namespace gpo
