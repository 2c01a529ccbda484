// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/panels/facts/facts.h"

#include <algorithm>

namespace gpo {
namespace {

Role color_of_level(const Finding& finding) {
  if (finding.ignored) return Role::text_dim;
  if (finding.level == Level::note) return Role::text;
  return finding.level == Level::weak ? Role::warning : Role::bad;
}

}  // namespace

std::vector<FindingRow> finding_rows(const Inspection* inspection) {
  std::vector<FindingRow> rows;
  if (inspection == nullptr) return rows;
  for (const Finding& finding : inspection->findings) {
    const auto check = std::ranges::find(checks(), finding.key, &Check::key);
    rows.push_back({.finding = finding,
                    .word = finding.ignored ? "ignored" : to_string(finding.level),
                    .color = color_of_level(finding),
                    .title = check == checks().end() ? "" : check->title,
                    .may_be_ignored = check != checks().end() && check->may_be_ignored});
  }
  return rows;
}

bool is_said_by(std::span<const FindingRow> rows, const std::string& reason) {
  return std::ranges::any_of(rows,
                             [&](const FindingRow& row) { return text_of(row.finding) == reason; });
}

}  // namespace gpo
