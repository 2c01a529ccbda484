// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/internal/compiled_once.h"

#if defined(FMT_HEADER_ONLY) && FMT_VERSION < 110000
template void fmt::detail::vformat_to<char>(fmt::detail::buffer<char>&,
                                            fmt::string_view,
                                            fmt::format_args,
                                            fmt::detail::locale_ref);
#endif
