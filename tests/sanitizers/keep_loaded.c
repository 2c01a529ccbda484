// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Preloaded for leak checks: prevents unloading of libraries. Mesa's drivers are unloaded with their context,
// and leaks in an unloaded library cannot be suppressed by name.
int dlclose(void* library) {
  (void)library;
  return 0;
}
