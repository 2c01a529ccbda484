// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/chart.h"
#include "ui/workbench/compared.h"

#include <memory>
#include <string>
#include <vector>

namespace gpo {

/// What the curves over the window's length show.
struct CurveFacts {
  std::vector<Configuration> configurations;  ///< hidden ones, too
  Figure figure;     ///< ATE, PNE and PDE; without truth what needs none; no charts: nothing yet
  std::string note;  ///< one line: what stands in the way of more; empty: nothing
  int done = 0;      ///< of the survey's windows
  int of = 0;        ///< 0: the rows come from a file
};

/// Of the compared configurations, as far as they are computed; or of the results.csv that is open.
CurveFacts curve_facts(const WorkbenchState& state);

/// The same, computed again only when something that it depends on has changed.
class KeptCurveFacts {
 public:
  const CurveFacts& of(const WorkbenchState& state);

 private:
  std::shared_ptr<const SurveyResults> surveyed_;
  std::shared_ptr<const std::vector<Row>> experiment_;
  std::shared_ptr<const Inspection> inspection_;
  Settings settings_;
  std::vector<Configuration> compared_;
  std::vector<std::string> hidden_;
  CurveFacts facts_;
};

}  // namespace gpo
