// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/initializers/methods.h"

#include "engine/error.h"
#include "engine/initializers/ba.h"
#include "engine/initializers/dbscan.h"
#include "engine/initializers/fpba.h"
#include "engine/initializers/gpo.h"
#include "engine/initializers/pba.h"
#include "engine/initializers/pnp.h"
#include "engine/initializers/pnp_ba.h"

#include <array>

#include <fmt/format.h>

namespace gpo {

Initialization failed(std::string reason, SolverReport solver) {
  Initialization result;
  result.reason = std::move(reason);
  result.solver = std::move(solver);
  return result;
}

std::span<const Method> methods() {
  static const std::array table{
      Method{"gpo", "GPO", 0x009E73, MethodFamily::optimization, true, initialize_gpo},
      Method{"pnp", "PnP", 0xE69F00, MethodFamily::aggregation, true, initialize_pnp},
      Method{"dbscan", "DBSCAN", 0xF0E442, MethodFamily::aggregation, true, initialize_dbscan},
      Method{"ba", "BA", 0xD55E00, MethodFamily::optimization, false, initialize_ba},
      Method{"pnp_ba", "PnP + BA", 0xCC79A7, MethodFamily::optimization, false, initialize_pnp_ba},
      Method{"pba", "PBA", 0x8B5A2B, MethodFamily::optimization, true, initialize_pba},
      Method{"fpba", "FPBA", 0x6E7681, MethodFamily::optimization, true, initialize_fpba},
  };
  return table;
}

const Method& find_method(const std::string& key) {
  std::string known;
  for (const Method& method : methods()) {
    if (method.key == key) return method;
    known += (known.empty() ? "" : ", ") + method.key;
  }
  throw InputError(fmt::format("--method: unknown method '{}', expected one of {}", key, known));
}

}  // namespace gpo
