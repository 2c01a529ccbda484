// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/files/late_function.h"

#include "engine/files/refuse.h"

#include <dlfcn.h>

namespace gpo {

void* load_library(const char* file) {
  void* const library = dlopen(file, RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) refuse(file, "the library cannot be loaded: {}", dlerror());
  return library;
}

void* find_symbol(void* library, const char* name) { return dlsym(library, name); }

void refuse_symbol(const char* library, const char* name) {
  refuse(library, "the library has no function {}", name);
}

}  // namespace gpo
