// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
#include <string_view>

namespace gpo::fuzz {

/// A file in memory that holds these bytes until the next call.
std::filesystem::path file_of(std::string_view bytes);

/// Calls a parser, which may refuse its input by an InputError of one printable line. Anything else
/// that it throws is passed on: libFuzzer takes it for a crash.
void parse(const std::function<void()>& parser);

}  // namespace gpo::fuzz
