// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fmt/format.h>

// The core of fmt, which takes two seconds to compile. This header is precompiled, so that only
// compiled_once.cpp compiles it; sources without precompiled headers still do so themselves.
#if defined(FMT_HEADER_ONLY) && FMT_VERSION < 110000  // later versions have no such template
extern template void fmt::detail::vformat_to<char>(fmt::detail::buffer<char>&,
                                                   fmt::string_view,
                                                   fmt::format_args,
                                                   fmt::detail::locale_ref);
#endif
