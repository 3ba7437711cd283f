#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <vector>

#include "mjarm/core/json_writer.hpp"
#include "mjarm/serve/json_parts_internal.hpp"
#include "mjarm/serve/live_messages.hpp"

namespace mjarm::serve {
namespace {

using Eigen::Vector3d;

bool are_finite(std::initializer_list<double> values) {
  return std::ranges::all_of(values, [](double value) { return std::isfinite(value); });
}
bool is_finite(const Vector3d& p) { return p.allFinite(); }
bool is_finite(const Pose& X) { return X.p.allFinite() && X.R.allFinite(); }

JsonWriter& open_item(JsonWriter& json, const char* kind) {
  return json.object().member("kind", kind);
}

void add(JsonWriter& json, const render::OverlaySphere& sphere) {
  if (!is_finite(sphere.p_W) || !are_finite({sphere.radius})) return;
  add_point(open_item(json, "sphere").key("pos"), sphere.p_W);
  json.member("radius", shortened(sphere.radius));
  add_color(json, sphere.color);
  json.end_object();
}

void add(JsonWriter& json, const render::OverlayArrow& arrow) {
  if (!is_finite(arrow.from_W) || !is_finite(arrow.to_W) || !are_finite({arrow.width})) return;
  add_point(open_item(json, "arrow").key("from"), arrow.from_W);
  add_point(json.key("to"), arrow.to_W);
  json.member("width", shortened(arrow.width));
  add_color(json, arrow.color);
  json.end_object();
}

void add(JsonWriter& json, const render::OverlayFrame& frame) {
  if (!is_finite(frame.X_WF) || !are_finite({frame.length, frame.width})) return;
  add_place(open_item(json, "frame"), frame.X_WF);
  json.member("length", shortened(frame.length)).member("width", shortened(frame.width));
  json.end_object();
}

void add(JsonWriter& json, const render::OverlayLabel& label) {
  if (!is_finite(label.p_W)) return;
  add_point(open_item(json, "label").key("pos"), label.p_W);
  json.member("text", label.text).end_object();
}

void add(JsonWriter& json, const render::OverlayEllipsoid& ellipsoid) {
  if (!is_finite(ellipsoid.X_WE) || !is_finite(ellipsoid.semi_axes)) return;
  add_place(open_item(json, "ellipsoid"), ellipsoid.X_WE);
  add_point(json.key("semi_axes"), ellipsoid.semi_axes);
  add_color(json, ellipsoid.color);
  json.end_object();
}

void add(JsonWriter& json, const render::OverlayBox& box) {
  if (!is_finite(box.X_WB) || !is_finite(box.half_sizes)) return;
  add_place(open_item(json, "box"), box.X_WB);
  add_point(json.key("half_sizes"), box.half_sizes);
  add_color(json, box.color);
  json.end_object();
}

void add(JsonWriter& json, const render::OverlayCapsule& capsule) {
  if (!is_finite(capsule.from_W) || !is_finite(capsule.to_W) || !are_finite({capsule.radius})) {
    return;
  }
  add_point(open_item(json, "capsule").key("from"), capsule.from_W);
  add_point(json.key("to"), capsule.to_W);
  json.member("radius", shortened(capsule.radius));
  add_color(json, capsule.color);
  json.end_object();
}

/// Every n-th point, and the last.
void add(JsonWriter& json, const render::OverlayLine& line, std::size_t stride) {
  std::vector<Vector3d> points;
  std::vector<double> times;
  const bool has_times = line.times.size() == line.points_W.size();
  for (std::size_t i = 0; i < line.points_W.size(); ++i) {
    const bool is_kept = i % stride == 0 || i + 1 == line.points_W.size();
    if (!is_kept || !is_finite(line.points_W[i])) continue;
    points.push_back(line.points_W[i]);
    if (has_times) times.push_back(line.times[i]);
  }
  if (points.size() < 2 || !are_finite({line.width, line.dash})) return;
  open_item(json, "line").key("points").list();
  for (const Vector3d& point : points) add_point(json, point);
  json.end_list();
  if (has_times) {
    json.key("times").list();
    for (const double time : times) json.value(shortened(time));
    json.end_list();
  }
  json.member("width", shortened(line.width));
  add_color(json, line.color);
  json.member("dash", shortened(line.dash)).end_object();
}

/// Every n-th piece.
void add(JsonWriter& json, const render::OverlaySegments& segments, std::size_t stride) {
  if (segments.ends_W.size() < 2 || !are_finite({segments.width})) return;
  open_item(json, "segments").key("ends").list();
  for (std::size_t i = 0; i + 1 < segments.ends_W.size(); i += 2 * stride) {
    if (!is_finite(segments.ends_W[i]) || !is_finite(segments.ends_W[i + 1])) continue;
    add_point(json, segments.ends_W[i]);
    add_point(json, segments.ends_W[i + 1]);
  }
  json.end_list().member("width", shortened(segments.width));
  add_color(json, segments.color);
  json.end_object();
}

void add(JsonWriter& json, const render::OverlayGhost& ghost, BodyPoses& poses) {
  const std::vector<BodyPoses::Moved> bodies = poses.moved(ghost.qpos_index, ghost.qpos);
  if (bodies.empty()) return;
  open_item(json, "ghost").key("bodies").list();
  for (const BodyPoses::Moved& moved : bodies) {
    json.list().value(moved.body);
    add_seven(json, moved.X_WB);
    json.end_list();
  }
  json.end_list();
  add_color(json, ghost.color);
  json.member("item", ghost.item).member("value", ghost.value).end_object();
}

std::size_t stride_of(std::size_t points) {
  return (points + kMaxOverlayPoints - 1) / kMaxOverlayPoints;
}

/// Of more shapes of a kind than are drawn, every n-th.
template <class Shape>
void add_all(JsonWriter& json, const std::vector<Shape>& shapes) {
  const std::size_t stride = std::max<std::size_t>(1, stride_of(shapes.size()));
  for (std::size_t i = 0; i < shapes.size(); i += stride) add(json, shapes[i]);
}

std::size_t points_of(const render::Overlay& overlay) {
  std::size_t points = 0;
  for (const render::OverlayLine& line : overlay.lines) points += line.points_W.size();
  for (const render::OverlaySegments& set : overlay.segments) points += set.ends_W.size();
  return points;
}

}  // namespace

std::string overlay_message(const render::Overlay& overlay, BodyPoses& poses) {
  std::string out;
  JsonWriter json(out);
  json.object().member("type", "overlay").key("items").list();
  const std::size_t stride = std::max<std::size_t>(1, stride_of(points_of(overlay)));
  add_all(json, overlay.spheres);
  for (const render::OverlayLine& line : overlay.lines) add(json, line, stride);
  for (const render::OverlaySegments& segments : overlay.segments) add(json, segments, stride);
  add_all(json, overlay.arrows);
  add_all(json, overlay.frames);
  add_all(json, overlay.labels);
  add_all(json, overlay.ellipsoids);
  add_all(json, overlay.boxes);
  add_all(json, overlay.capsules);
  const std::size_t ghosts = std::min(overlay.ghosts.size(), render::kMaxGhosts);
  for (std::size_t i = 0; i < ghosts; ++i) add(json, overlay.ghosts[i], poses);
  json.end_list().end_object();
  return out;
}

}  // namespace mjarm::serve
