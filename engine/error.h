// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>

namespace gpo {

/// Bad input that a user can mend: a file, a key, a line, an option. The message is one line that
/// names the file, the line or key, what was found and what was expected. Caught once, in `app`
/// (exit code 2) and in the worker of the window. What merely fails to initialize is not an error
/// but a value with a reason (`Initialization`).
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace gpo
