// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string_view>
#include <vector>

namespace gpo::fuzz {

/// A parser that reads any bytes or refuses them. Seeds are in seeds/NAME, former crashes in
/// crashes/NAME.
struct Target {
  const char* name;
  void (*read)(std::string_view bytes);
};

const std::vector<Target>& targets();

/// Calls a parser, which may refuse its input by an InputError with one printable line. libFuzzer
/// takes any other exception for a crash.
void parse(const std::function<void()>& parser);

/// Calls the library with public structs that the bytes change.
void call_library(std::string_view bytes);

/// Silences libraries that print about broken files. Call it once, before any target.
void quiet_libraries();

}  // namespace gpo::fuzz
