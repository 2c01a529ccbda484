// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// Draws the scenes of a report: a canvas without WebGL, so that they also turn in mail viewers and on
// machines without graphics. Items are sorted by depth; drag turns, the wheel zooms.
"use strict";
(() => {
  const add = (a, b, s) => [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]];
  const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const unit = a => add([0, 0, 0], a, 1 / Math.hypot(...a));
  const radians = degrees => degrees * Math.PI / 180;
  const STEEPEST = 89, ZOOM_STEP = 1.2, REACH_PX = 9;

  /// Expands a plane's mosaic into one polygon per cell.
  function cells(item) {
    const made = [];
    for (let j = 0, k = 0; j < item.rows; ++j)
      for (let i = 0; i < item.columns; ++i, k += 6) {
        const color = item.colors.slice(k, k + 6);
        if (color === "------") continue;
        const corner = (u, v) => add(add(item.at, item.x, i + u), item.y, j + v);
        made.push({ layer: item.layer, kind: "face", color: "#" + color, alpha: item.alpha, seam: true,
          points: [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)] });
      }
    return made;
  }

  /// Splits a polyline into its segments, which are sorted one by one.
  function segments(item) {
    const made = [];
    for (let k = 0; k + 1 < item.points.length; ++k)
      made.push({ ...item, points: [item.points[k], item.points[k + 1]] });
    return made;
  }

  function expanded(items) {
    return items.flatMap(item => item.kind === "mosaic" ? cells(item) : item.kind === "line" ? segments(item) : [item]);
  }

  function start(view) {
    const canvas = view.querySelector("canvas"), tip = view.querySelector(".tip");
    const scene = JSON.parse(view.querySelector("script").textContent);
    const draw2d = canvas.getContext("2d");
    if (!draw2d) return;
    view.classList.add("live");
    const items = expanded(scene.items), hidden = new Set();
    let camera = { ...scene.camera }, chosen = null, drawn = [], waiting = false;

    function axes() {
      const yaw = radians(camera.yaw_deg), pitch = radians(camera.pitch_deg), up = camera.up;
      const side = cross(up, camera.front);
      const heading = add(add([0, 0, 0], camera.front, Math.cos(yaw)), side, Math.sin(yaw));
      const forward = add(add([0, 0, 0], heading, Math.cos(pitch)), up, -Math.sin(pitch));
      const right = unit(cross(forward, up));
      return { right, down: cross(forward, right), forward };
    }

    /// Returns a point as right, down, forward from the eye.
    function seen(point, a) {
      const from = add(point, camera.target, -1);
      return [dot(from, a.right), dot(from, a.down), dot(from, a.forward) + camera.distance];
    }

    /// Clips a polygon or line at a plane just before the eye.
    function clipped(points, closed) {
      const near = 0.01 * camera.distance, kept = [];
      for (let k = 0; k < points.length; ++k) {
        const p = points[k], q = points[(k + 1) % points.length];
        if (p[2] >= near) kept.push(p);
        if ((p[2] < near) !== (q[2] < near) && (closed || k + 1 < points.length))
          kept.push(add(p, add(q, p, -1), (near - p[2]) / (q[2] - p[2])));
      }
      return kept;
    }

    function draw() {
      waiting = false;
      const ratio = window.devicePixelRatio || 1;
      const width = canvas.clientWidth || 960, height = canvas.clientHeight || 540;
      canvas.width = Math.round(width * ratio);
      canvas.height = Math.round(height * ratio);
      draw2d.scale(ratio, ratio);
      const a = axes(), focal = height / (2 * Math.tan(radians(camera.view_angle_deg / 2)));
      const screen = p => [width / 2 + focal * p[0] / p[2], height / 2 + focal * p[1] / p[2]];
      drawn = [];
      for (const item of items) {
        if (hidden.has(item.layer)) continue;
        const points = clipped(item.points.map(p => seen(p, a)), item.kind === "face");
        if (points.length < (item.kind === "face" ? 3 : item.kind === "line" ? 2 : 1)) continue;
        // Lines and points lie on faces: a small bias draws them after these.
        const depth = points.reduce((sum, p) => sum + Math.hypot(...p), 0) / points.length;
        const bias = item.kind === "face" ? (item.seam ? 1.02 : 1) : item.kind === "line" ? 0.99 : 0.98;
        drawn.push({ item, depth: depth * bias, at: points.map(screen) });
      }
      drawn.sort((one, other) => other.depth - one.depth);
      drawn.forEach(paint);
      canvas.dataset.yaw = camera.yaw_deg;
      canvas.dataset.pitch = camera.pitch_deg;
      canvas.dataset.distance = camera.distance;
      canvas.dataset.drawn = drawn.length;
    }

    function paint({ item, at }) {
      draw2d.globalAlpha = item.alpha ?? 1;
      draw2d.fillStyle = draw2d.strokeStyle = item.color;
      draw2d.lineWidth = item.width ?? 1;
      draw2d.setLineDash(item.dashed ? [6, 4] : []);
      const marked = chosen !== null && item.frame === chosen;
      if (marked) { draw2d.strokeStyle = draw2d.fillStyle = "#d0480b"; draw2d.globalAlpha = 1; draw2d.lineWidth = 3; }
      draw2d.beginPath();
      if (item.kind === "dot") {
        draw2d.arc(at[0][0], at[0][1], item.width ?? 2.5, 0, 2 * Math.PI);
        return draw2d.fill();
      }
      if (item.kind === "text") {
        draw2d.font = "600 13px Inter, Arial, sans-serif";
        return draw2d.fillText(item.text, at[0][0] + 5, at[0][1] - 5);
      }
      at.forEach((p, k) => k ? draw2d.lineTo(...p) : draw2d.moveTo(...p));
      if (item.kind === "line") return draw2d.stroke();
      draw2d.closePath();
      draw2d.fill();
      if (item.seam) { draw2d.lineWidth = 0.7; draw2d.stroke(); }
    }

    const redraw = () => { if (!waiting) { waiting = true; requestAnimationFrame(draw); } };

    function turn(dx, dy) {
      const height = canvas.clientHeight || 540;
      camera.yaw_deg = (camera.yaw_deg - 180 * dx / height) % 360;
      camera.pitch_deg = Math.min(STEEPEST, Math.max(-STEEPEST, camera.pitch_deg + 180 * dy / height));
      redraw();
    }

    function move(dx, dy) {
      const a = axes(), per_px = 2 * camera.distance * Math.tan(radians(camera.view_angle_deg / 2)) / (canvas.clientHeight || 540);
      camera.target = add(add(camera.target, a.right, -dx * per_px), a.down, -dy * per_px);
      redraw();
    }

    function zoom(steps) {
      camera.distance = Math.min(1e4, Math.max(1e-3, camera.distance * ZOOM_STEP ** -steps));
      redraw();
    }

    function point_out(x, y) {
      let best = null, least = REACH_PX;
      for (const one of drawn) {
        if (!one.item.title) continue;
        for (const p of one.at) {
          const far = Math.hypot(p[0] - x, p[1] - y);
          if (far <= least) { least = far; best = one.item; }
        }
      }
      tip.style.visibility = best ? "visible" : "hidden";
      if (!best) return;
      tip.textContent = best.title;
      tip.style.left = canvas.offsetLeft + x + 14 + "px";
      tip.style.top = canvas.offsetTop + y + 8 + "px";
    }

    const held = new Map();
    canvas.addEventListener("pointerdown", event => {
      try { canvas.setPointerCapture(event.pointerId); } catch { /* a synthetic pointer */ }
      held.set(event.pointerId, [event.clientX, event.clientY]);
    });
    canvas.addEventListener("pointermove", event => {
      const from = held.get(event.pointerId);
      if (!from) return point_out(event.offsetX, event.offsetY);
      tip.style.visibility = "hidden";
      const dx = event.clientX - from[0], dy = event.clientY - from[1];
      const other = [...held].find(([id]) => id !== event.pointerId);
      if (other) {  // two fingers: their distance zooms
        const span = p => Math.hypot(p[0] - other[1][0], p[1] - other[1][1]) || 1;
        zoom(Math.log(span([event.clientX, event.clientY]) / span(from)) / Math.log(ZOOM_STEP));
      } else if (event.shiftKey || event.buttons === 2 || event.buttons === 4) move(dx, dy);
      else turn(dx, dy);
      held.set(event.pointerId, [event.clientX, event.clientY]);
    });
    for (const end of ["pointerup", "pointercancel"])
      canvas.addEventListener(end, event => held.delete(event.pointerId));
    canvas.addEventListener("pointerleave", () => { tip.style.visibility = "hidden"; });
    canvas.addEventListener("contextmenu", event => event.preventDefault());
    canvas.addEventListener("wheel", event => {
      event.preventDefault();
      zoom(Math.sign(-event.deltaY));
    }, { passive: false });
    const reset = () => { camera = { ...scene.camera }; redraw(); };
    canvas.addEventListener("dblclick", reset);
    canvas.addEventListener("keydown", event => {
      const step = { ArrowLeft: [-20, 0], ArrowRight: [20, 0], ArrowUp: [0, -20], ArrowDown: [0, 20] }[event.key];
      if (step) turn(...step);
      else if (event.key === "+" || event.key === "-") zoom(event.key === "+" ? 1 : -1);
      else if (event.key === "0") reset();
      else return;
      event.preventDefault();
    });
    for (const button of view.querySelectorAll("button"))
      button.addEventListener("click", () => {
        camera = { ...scene.camera };
        if (button.dataset.pitch) camera.pitch_deg = +button.dataset.pitch;
        if (button.dataset.yaw) camera.yaw_deg = +button.dataset.yaw;
        redraw();
      });
    for (const box of view.querySelectorAll("input"))
      box.addEventListener("change", () => {
        if (box.checked) hidden.delete(box.dataset.layer); else hidden.add(box.dataset.layer);
        redraw();
      });
    for (const figure of view.closest("section").querySelectorAll("figure[data-frame]")) {
      const mark = frame => { chosen = frame; redraw(); };
      figure.addEventListener("pointerenter", () => mark(+figure.dataset.frame));
      figure.addEventListener("pointerleave", () => mark(null));
    }
    window.addEventListener("resize", redraw);
    window.addEventListener("beforeprint", draw);
    draw();
  }

  for (const view of document.querySelectorAll(".scene")) start(view);
  for (const figure of document.querySelectorAll(".frames figure"))
    figure.addEventListener("click", () => figure.classList.toggle("large"));
})();
