// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/workbench/state.h"

namespace gpo {

/// The kinds of things that have a context menu.
enum class ContextKind { track, plane, point, number, frame, area };

/// The thing under the mouse when its context menu was opened.
struct ContextSubject {
  ContextKind kind = ContextKind::track;
  std::string title = {};                  ///< one line above the entries
  std::int64_t track = 0;                  ///< id
  int plane = 0;                           ///< number in the window, counts from 0
  std::optional<Vector3d> ray = {};        ///< from the reference camera to the plane's point
  std::string why_not_there = {};          ///< why there is no `ray`
  Vector2d raw_px = Vector2d::Zero();      ///< the pixel of a point
  int frame = 0;                           ///< counts in the recording
  std::string value = {}, uncertain = {};  ///< texts of a number; `uncertain` with its uncertainty
};

/// An entry of the context menus of one kind. Each runs an action.
struct ContextEntry {
  ContextKind kind;
  const char* title;  ///< for people
  /// Returns the line to run; empty if the entry is not available.
  std::string (*line)(const WorkbenchState&, const ContextSubject&);
};
std::span<const ContextEntry> context_entries();

/// Returns a text as one argument of a script's line.
std::string as_argument(const std::string& text);

/// The subject of a plane. `point` is in the reference camera's world; nullopt if the mouse is
/// beside the plane.
ContextSubject plane_subject(const Inspection& inspection,
                             int number,
                             const std::optional<Vector3d>& point);

/// The subject of a pixel of the current frame.
ContextSubject point_subject(const Vector2d& raw_px);

/// The subject of a track of the current inspection, with the reason for its rejection.
ContextSubject track_subject(const Inspection& inspection, std::int64_t id);

}  // namespace gpo
