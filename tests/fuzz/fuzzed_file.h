// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string_view>

namespace gpo::fuzz {

inline std::string_view bytes_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// A file in memory that holds these bytes until the next call.
std::filesystem::path file_of(std::string_view bytes);

/// Calls a parser, which may refuse its input by an InputError of one printable line. Anything else
/// that it throws ends the process, which libFuzzer takes for a crash.
void parse(const std::function<void()>& parser);

}  // namespace gpo::fuzz
