// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/initializers/common/sources.h"
#include "engine/window/window.h"

#include <nlohmann/json_fwd.hpp>

namespace gpo {

/// All that a user's own method is told of a window, as `method_window.schema.json` has it but for
/// `id`. What is not known is not there; what is not seen is null.
nlohmann::ordered_json window_json(const Window& window, const Sources& sources);

}  // namespace gpo
