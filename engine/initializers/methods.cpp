// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/initializers/methods.h"

#include "engine/error.h"
#include "engine/initializers/ba.h"
#include "engine/initializers/closed_form.h"
#include "engine/initializers/dbscan.h"
#include "engine/initializers/fpba.h"
#include "engine/initializers/gpo.h"
#include "engine/initializers/gpo_joint.h"
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

namespace {

/// Of a method that leaves its user no choice.
template <Initialization (*initialize)(const Window&, const std::stop_token&)>
Initialization plain(const Window& window,
                     const InitializerOptions& /*options*/,
                     const std::stop_token& stop) {
  return initialize(window, stop);
}

}  // namespace

std::span<const Method> methods() {
  using enum MethodFamily;
  using enum Inliers;
  static const std::array table{
      Method{"gpo", "GPO", 0x009E73, optimization, true, per_frame, initialize_gpo},
      Method{"pnp", "PnP", 0xE69F00, aggregation, true, per_frame, plain<initialize_pnp>},
      Method{"dbscan", "DBSCAN", 0xF0E442, aggregation, true, per_frame, plain<initialize_dbscan>},
      Method{"ba", "BA", 0xD55E00, optimization, false, per_frame, plain<initialize_ba>},
      Method{
          "pnp_ba", "PnP + BA", 0xCC79A7, optimization, false, per_frame, plain<initialize_pnp_ba>},
      Method{"pba", "PBA", 0x8B5A2B, optimization, true, per_frame, plain<initialize_pba>},
      Method{"fpba", "FPBA", 0x6E7681, optimization, true, per_frame, plain<initialize_fpba>},
      Method{"closed_form",
             "Closed form",
             0x56B4E9,
             aggregation,
             true,
             consistent,
             plain<initialize_closed_form>},
      Method{
          "gpo_joint", "GPO joint", 0x0072B2, optimization, true, consistent, initialize_gpo_joint},
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
