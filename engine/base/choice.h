// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <string>

namespace gpo {

/// Specialize it for enumerations that users choose from, with `NamedKeys` as the base: their name
/// and, in the order of the values, the keys on the command line, in scripts and in files.
template <class E>
struct ChoiceKeys;

/// A string literal as a template argument.
template <std::size_t size>
struct Literal {
  char text[size];
  constexpr Literal(const char (&literal)[size]) { std::ranges::copy(literal, text); }
};

template <Literal kName, Literal... kKeys>
struct NamedKeys {
  static constexpr const char* name = kName.text;
  static constexpr std::array<const char*, sizeof...(kKeys)> keys{kKeys.text...};
};

template <class E>
concept Choice = requires {
  ChoiceKeys<E>::keys;
};

template <Choice E>
constexpr const char* to_string(E value) {
  return ChoiceKeys<E>::keys[static_cast<std::size_t>(value)];
}

/// Throws SettingError with the known keys.
[[noreturn]] void refuse_choice(const char* name,
                                const std::string& key,
                                std::span<const char* const> known);

/// Returns the value of a key. Throws SettingError with the known keys.
template <Choice E>
E choice(const std::string& key) {
  const auto& keys = ChoiceKeys<E>::keys;
  for (std::size_t i = 0; i < keys.size(); ++i)
    if (key == keys[i]) return static_cast<E>(i);
  refuse_choice(ChoiceKeys<E>::name, key, keys);
}

}  // namespace gpo
