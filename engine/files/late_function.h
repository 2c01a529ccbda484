// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>

namespace gpo {

/// Loads a shared library, such as "libavutil.so.57". Throws InputError if that fails.
void* load_library(const char* file);
/// Returns the address of a symbol in a library and those that it needs; null if it has none.
void* find_symbol(void* library, const char* name);
[[noreturn]] void refuse_symbol(const char* library, const char* name);

/// A function of a shared library that is loaded at the first call, because loading it takes
/// longer than most commands that do not need it. `find` returns the address of a function.
template <class Function, void* (*find)(const char* name)>
class LateFunction;

template <class Result, class... Arguments, void* (*find)(const char* name)>
class LateFunction<Result(Arguments...), find> {
 public:
  constexpr explicit LateFunction(const char* name) : name_(name) {}

  /// Throws InputError if the library or the function is missing.
  Result operator()(Arguments... arguments) const {
    void* address = address_.load(std::memory_order_acquire);
    if (address == nullptr) {
      address = find(name_);
      address_.store(address, std::memory_order_release);
    }
    return reinterpret_cast<Result (*)(Arguments...)>(address)(arguments...);
  }

 private:
  const char* name_;
  mutable std::atomic<void*> address_{nullptr};
};

}  // namespace gpo
