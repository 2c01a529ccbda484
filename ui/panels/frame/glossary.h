// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

namespace gpo {

struct GlossaryTerm {
  const char *term, *meaning;
};

/// Returns the terms that the window uses, in the order of ui/GLOSSARY.md.
std::span<const GlossaryTerm> glossary();

}  // namespace gpo
