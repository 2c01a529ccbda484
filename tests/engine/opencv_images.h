// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/files/late_function.h"
#include "engine/recording/images/images.h"

#include <string>
#include <vector>

#include <opencv2/core.hpp>

namespace gpo::test {

/// cv::imwrite(file, image, parameters) for formats that the engine does not write. Only the tests
/// that call it load its library.
inline const LateFunction<bool(const std::string&, cv::InputArray, const std::vector<int>&),
                          find_in_imgcodecs>
    imwrite(
        "_ZN2cv7imwriteERKNSt7__cxx1112basic_stringIcSt11char_traitsIcESaIcEEERKNS_11_"
        "InputArrayERKSt6vectorIiSaIiEE");

}  // namespace gpo::test
