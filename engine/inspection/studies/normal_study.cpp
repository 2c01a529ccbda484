// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inspection/studies/normal_study.h"

#include "engine/methods/candidates/homography_candidates.h"
#include "engine/truth/truth.h"
#include "engine/window/window.h"

#include <utility>

namespace gpo {

std::shared_ptr<const NormalStudy> study_normals(const Inspection& inspection,
                                                 const std::stop_token& stop) {
  constexpr int kSide = 96;  // cells of two degrees, narrower than the valley of a short window
  const Window& window = *inspection.window;
  auto landscape = normal_landscape(window, kSide, stop);
  auto candidates = candidates_of_window(window, stop);
  if (!landscape || stop.stop_requested()) return nullptr;
  auto clusters = normal_clusters(candidates);
  return std::make_shared<const NormalStudy>(NormalStudy{
      inspection.window, std::move(*landscape), std::move(candidates), std::move(clusters)});
}

std::optional<Eigen::Vector3d> true_normal(const Inspection& inspection) {
  const WindowTruth* truth = inspection.truth.get();
  if (truth == nullptr || !truth->plane || truth->cameras.empty() || !truth->cameras[0])
    return std::nullopt;
  const Eigen::Vector3d normal = truth->cameras[0]->R_wc.transpose() * truth->plane->normal;
  return normal.z() > 0 ? -normal : normal;
}

}  // namespace gpo
