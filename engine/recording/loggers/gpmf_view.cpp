// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/loggers/gpmf_view.h"

#include "engine/base/error.h"
#include "engine/recording/loggers/gpmf_items.h"

#include <string>

#include <fmt/format.h>

namespace gpo {
namespace {

std::optional<ToldView> view_of_device(const GpmfItem& device, const std::string& source) {
  double diagonal_deg = 0;
  bool linear = false;
  GpmfItems items(device.data, source);
  while (const auto item = items.next()) {
    if (item->key == "VFOV") linear = gpmf_text(*item) == "L";
    if (item->key != "ZFOV") continue;
    const auto numbers = gpmf_numbers(*item, source);
    if (!numbers.empty()) diagonal_deg = numbers[0];
  }
  return view_of_angle(diagonal_deg,
                       !linear,
                       fmt::format("GoPro's settings: {:.0f} degrees along the diagonal{}",
                                   diagonal_deg,
                                   linear ? "" : " of a fisheye"));
}

}  // namespace

std::optional<ToldView> view_of_gpmf(std::string_view settings) {
  const std::string source = "settings";
  try {
    GpmfItems devices(settings, source);
    while (const auto device = devices.next()) {
      if (device->key != "DEVC" || device->type != 0) continue;
      if (auto view = view_of_device(*device, source)) return view;
    }
  } catch (const InputError&) {  // cut: nothing is known
  }
  return std::nullopt;
}

}  // namespace gpo
