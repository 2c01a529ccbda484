// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/look/method_help.h"

#include <map>

namespace gpo {

std::string method_help(const std::string& key) {
  static const std::map<std::string, const char*> kHelp = {
      {"gpo",
       "Global plane optimization: the plane's normal and all scaled translations in one "
       "optimization. Assumes one plane, and rotations that are right"},
      {"pnp",
       "Decomposes the homography of the widest pair, then PnP and triangulation frame by frame. "
       "Assumes a plane in that pair alone"},
      {"dbscan",
       "The normal where the decomposed homographies of all frames agree most, translations by "
       "least squares. Assumes one plane, and rotations that are right"},
      {"ba",
       "Bundle adjustment of poses and free points, from DBSCAN's. Assumes no plane, but "
       "parallax"},
      {"pnp_ba",
       "Bundle adjustment of poses and free points, from PnP's. Assumes no plane, but parallax"},
      {"pba",
       "Planar bundle adjustment: of poses, a plane and points that stay on it. Assumes one "
       "plane"},
      {"fpba",
       "Planar bundle adjustment with the normal fixed at DBSCAN's. Assumes one plane, and that "
       "normal"},
      {"closed_form",
       "Normal and translations from all homographies in one singular value decomposition, "
       "without iterations. Assumes one plane, and rotations that are right"},
      {"gpo_joint",
       "GPO over all planes of the window, with what is uncertain of the rotations unknown, too. "
       "Assumes planes, but neither a known bias nor, without a gyroscope, any rotation"}};
  const auto found = kHelp.find(key);
  return found == kHelp.end() ? "Your own initializer, a process beside this one" : found->second;
}

}  // namespace gpo
