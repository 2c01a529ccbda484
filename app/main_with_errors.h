// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace gpo {

/// Runs one command line and returns its exit code. Prints errors on standard error.
int main_with_errors(int argc, char** argv);

}  // namespace gpo
