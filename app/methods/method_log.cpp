// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "app/methods/method_log.h"

#include <cstdio>
#include <utility>

#include <fmt/format.h>

namespace gpo {

void MethodLog::add(const std::string& name, const std::string& line) {
  constexpr int kMostLines = 200;
  const std::lock_guard lock(mutex_);
  if (++count_ > kMostLines + 1) return;
  lines_.push_back(count_ <= kMostLines ? fmt::format("{}: {}", name, line)
                                        : fmt::format("{}: (what follows is not shown)", name));
  fmt::print(stderr, "{}\n", lines_.back());
  if (changed_) changed_();
}

std::vector<std::string> MethodLog::take() {
  const std::lock_guard lock(mutex_);
  return std::exchange(lines_, {});
}

void MethodLog::on_change(std::function<void()> changed) {
  const std::lock_guard lock(mutex_);
  changed_ = std::move(changed);
}

}  // namespace gpo
