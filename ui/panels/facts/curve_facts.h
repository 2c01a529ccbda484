// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/chart.h"
#include "ui/workbench/compared.h"

#include <memory>
#include <string>
#include <vector>

namespace gpo {

/// The curves over the length of the window.
struct CurveFacts {
  std::vector<Configuration> configurations;  ///< also hidden ones
  Figure figure;     ///< ATE, PNE and PDE; without ground truth RMS and normal uncertainty
  std::string note;  ///< one line: why errors are missing; empty if they are not
  int done = 0;      ///< finished windows of the survey
  int of = 0;        ///< all of them; 0: the rows come from a file
};

/// Returns the curves of the open results.csv, or else of the compared configurations as far as
/// they are computed.
CurveFacts curve_facts(const WorkbenchState& state);

/// The same, computed again only if something that it depends on has changed.
class CachedCurveFacts {
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
