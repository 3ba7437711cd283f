#include "mjarm/render/overlay.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

#include "mjarm/core/messages/render.hpp"
#include "mjarm/render/overlay_internal.hpp"
#include "mjarm/render/polyline.hpp"

namespace mjarm::render {
namespace {

using Eigen::Vector3d;

constexpr Rgba kRed = {0.85F, 0.22F, 0.20F, 1};
constexpr Rgba kGreen = {0.25F, 0.66F, 0.28F, 1};
constexpr Rgba kBlue = {0.20F, 0.38F, 0.85F, 1};

/// Tubes that a picture can afford. Without a GPU a tube costs some ten thin lines at low quality,
/// and some milliseconds of processor time at high.
constexpr std::size_t kMaxTubes = 100;
constexpr double kPixelsPerMetre = 700;   ///< width of thin lines: 3 mm are about two pixels
constexpr double kThinnest = 1.0;         ///< [px]
constexpr double kThickest = 5.0;         ///< [px]
constexpr double kUnseen = 0.15;          ///< of its width a line may be off, to need fewer pieces
constexpr std::size_t kMaxDashes = 1000;  ///< of a line
constexpr double kFlat = 1e-3;            ///< smallest semi-axis as a share of the largest

/// Lets `room` of `wanted` things pass, evenly.
class Sieve {
 public:
  Sieve(std::size_t wanted, std::size_t room) : wanted_(wanted), room_(std::min(wanted, room)) {}
  bool pass() {
    if (room_ == wanted_) return true;
    sum_ += room_;
    if (sum_ < wanted_) return false;
    sum_ -= wanted_;
    return true;
  }
  [[nodiscard]] std::size_t room() const { return room_; }

 private:
  std::size_t wanted_;
  std::size_t room_;
  std::size_t sum_ = 0;
};

/// A line as it is drawn: a polyline, or separate pieces with two ends each.
struct Strokes {
  std::span<const Vector3d> points;
  bool connected = true;
  double width = 0;
  Rgba color;
  LineLook look = LineLook::automatic;
  std::vector<Vector3d> own;  ///< points made for it (dashes)

  [[nodiscard]] std::size_t count() const {
    if (!connected) return points.size() / 2;
    return points.empty() ? 0 : points.size() - 1;
  }
};

std::vector<Vector3d> finite(const std::vector<Vector3d>& points) {
  std::vector<Vector3d> out;
  out.reserve(points.size());
  std::ranges::copy_if(points, std::back_inserter(out),
                       [](const Vector3d& p) { return p.allFinite(); });
  return out;
}

std::vector<Strokes> strokes_of(const Overlay& overlay) {
  std::vector<Strokes> out;
  out.reserve(overlay.lines.size() + overlay.segments.size());
  for (const OverlayLine& line : overlay.lines) {
    Strokes& strokes = out.emplace_back();
    strokes = {{}, true, line.width, line.color, line.look, finite(line.points_W)};
    strokes.own = simplified(strokes.own, kUnseen * line.width);
    if (line.dash > 0) {
      strokes.own = dashes(strokes.own, line.dash, line.dash, kMaxDashes);
      strokes.connected = false;
    }
    strokes.points = strokes.own;
  }
  for (const OverlaySegments& segments : overlay.segments) {
    out.push_back({segments.ends_W, false, segments.width, segments.color, segments.look, {}});
  }
  return out;
}

/// Draws tubes where there are few of them: the shortest lines have the first claim.
void choose_looks(std::vector<Strokes>& all) {
  std::vector<Strokes*> order;
  for (Strokes& strokes : all) {
    if (strokes.look == LineLook::automatic) order.push_back(&strokes);
  }
  std::ranges::stable_sort(order, {}, [](const Strokes* strokes) { return strokes->count(); });
  std::size_t left = kMaxTubes;
  for (Strokes* strokes : order) {
    const bool tube = strokes->count() <= left;
    strokes->look = tube ? LineLook::tube : LineLook::thin;
    if (tube) left -= strokes->count();
  }
}

/// A new geom of the scene, without a place yet.
mjvGeom& add_geom(mjvScene& scene, int type, const Rgba& color) {
  mjvGeom& geom = scene.geoms[scene.ngeom++];
  const float rgba[4] = {color.r, color.g, color.b, color.a};
  mjv_initGeom(&geom, type, nullptr, nullptr, nullptr, rgba);
  geom.category = mjCAT_DECOR;
  geom.objtype = mjOBJ_UNKNOWN;
  geom.objid = -1;
  geom.segid = -1;
  geom.castshadow = 0;
  // Paths must be found at a glance, also on the side away from the light.
  geom.emission = 0.25F;
  geom.specular = 0.2F;
  return geom;
}

void add_connector(mjvScene& scene, int type, double width, const Vector3d& from,
                   const Vector3d& to, const Rgba& color) {
  const double length = (to - from).norm();
  if (!(length >= mjMINVAL) || !std::isfinite(length)) return;
  mjvGeom& geom = add_geom(scene, type, color);
  mjv_connector(&geom, type, width, from.data(), to.data());
  if (type == mjGEOM_ARROW) geom.size[2] *= 2;  // MuJoCo draws arrows half as long as they are
}

void add_solid(mjvScene& scene, int type, const Pose& X_WF, const Vector3d& sizes,
               const Rgba& color) {
  if (!X_WF.p.allFinite() || !X_WF.R.allFinite() || !sizes.allFinite()) return;
  mjvGeom& geom = add_geom(scene, type, color);
  for (int i = 0; i < 3; ++i) {
    geom.size[i] = static_cast<float>(sizes[i]);
    geom.pos[i] = static_cast<float>(X_WF.p[i]);
    for (int k = 0; k < 3; ++k) geom.mat[3 * i + k] = static_cast<float>(X_WF.R(i, k));
  }
}

void add_label(mjvScene& scene, const OverlayLabel& label) {
  if (!label.p_W.allFinite()) return;
  mjvGeom& geom = add_geom(scene, mjGEOM_LABEL, {1, 1, 1, 1});
  for (int i = 0; i < 3; ++i) geom.pos[i] = static_cast<float>(label.p_W[i]);
  std::size_t length = 0;
  for (const char c : label.text) {
    if (length + 1 == sizeof(geom.label)) break;
    const auto byte = static_cast<unsigned char>(c);
    if ((byte & 0xC0U) == 0x80U) continue;  // inside of a UTF-8 character, shown as one `?`
    geom.label[length++] = byte >= 32 && byte < 127 ? c : '?';
  }
  geom.label[length] = '\0';
}

/// Lines take no light, and each light with shadows draws the picture once more on top.
Rgba line_color(Rgba color, const mjvScene& scene) {
  if (scene.flags[mjRND_SHADOW] == 0) return color;
  const auto shadows = std::count_if(scene.lights, scene.lights + scene.nlight,
                                     [](const mjvLight& light) { return light.castshadow != 0; });
  const float share = 1.0F / static_cast<float>(1 + shadows);
  return {share * color.r, share * color.g, share * color.b, color.a};
}

void add_strokes(const Strokes& strokes, Sieve& sieve, mjvScene& scene) {
  const bool thin = strokes.look == LineLook::thin;
  const int type = thin ? mjGEOM_LINE : mjGEOM_CAPSULE;
  const double width =
      thin ? std::clamp(kPixelsPerMetre * strokes.width, kThinnest, kThickest) : strokes.width / 2;
  const Rgba color = thin ? line_color(strokes.color, scene) : strokes.color;
  const std::span<const Vector3d> points = strokes.points;
  if (!strokes.connected) {
    for (std::size_t i = 1; i < points.size(); i += 2) {
      if (sieve.pass()) add_connector(scene, type, width, points[i - 1], points[i], color);
    }
    return;
  }
  std::size_t from = 0;  // what does not pass is bridged
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (!sieve.pass()) continue;
    add_connector(scene, type, width, points[from], points[i], color);
    from = i;
  }
}

/// What there are few of: said and shown first.
std::size_t single_shapes(const Overlay& overlay) {
  return overlay.arrows.size() + 3 * overlay.frames.size() + overlay.labels.size() +
         overlay.ellipsoids.size() + overlay.boxes.size();
}

void add_singles(const Overlay& overlay, Sieve& sieve, mjvScene& scene) {
  for (const OverlayArrow& arrow : overlay.arrows) {
    if (!sieve.pass()) continue;
    add_connector(scene, mjGEOM_ARROW, arrow.width / 2, arrow.from_W, arrow.to_W, arrow.color);
  }
  for (const OverlayFrame& frame : overlay.frames) {
    const Rgba colors[3] = {kRed, kGreen, kBlue};
    for (int i = 0; i < 3; ++i) {
      if (!sieve.pass()) continue;
      add_connector(scene, mjGEOM_CAPSULE, frame.width / 2, frame.X_WF.p,
                    frame.X_WF.p + frame.length * frame.X_WF.R.col(i), colors[i]);
    }
  }
  for (const OverlayLabel& label : overlay.labels) {
    if (sieve.pass()) add_label(scene, label);
  }
  for (const OverlayEllipsoid& ellipsoid : overlay.ellipsoids) {
    const Vector3d sizes = ellipsoid.semi_axes.cwiseMax(kFlat * ellipsoid.semi_axes.maxCoeff());
    if (!sieve.pass() || !(sizes.maxCoeff() > 0)) continue;
    add_solid(scene, mjGEOM_ELLIPSOID, ellipsoid.X_WE, sizes, ellipsoid.color);
  }
  for (const OverlayBox& box : overlay.boxes) {
    if (sieve.pass()) add_solid(scene, mjGEOM_BOX, box.X_WB, box.half_sizes, box.color);
  }
}

std::size_t many_shapes(const Overlay& overlay, const std::vector<Strokes>& strokes) {
  return std::accumulate(strokes.begin(), strokes.end(),
                         overlay.spheres.size() + overlay.capsules.size(),
                         [](std::size_t sum, const Strokes& one) { return sum + one.count(); });
}

template <class T>
void append_all(std::vector<T>& target, const std::vector<T>& source) {
  target.insert(target.end(), source.begin(), source.end());
}

}  // namespace

std::size_t shapes_of(const Overlay& overlay) {
  std::size_t count = single_shapes(overlay) + overlay.spheres.size() + overlay.capsules.size();
  for (const OverlayLine& line : overlay.lines) {
    if (line.points_W.size() > 1) count += line.points_W.size() - 1;
    if (line.dash > 0) count += kMaxDashes;
  }
  for (const OverlaySegments& segments : overlay.segments) count += segments.ends_W.size() / 2;
  return count;
}

std::string overlay_notice(const Overlay& overlay) {
  if (shapes_of(overlay) <= kMaxOverlayShapes) return {};
  const std::size_t wanted = single_shapes(overlay) + many_shapes(overlay, strokes_of(overlay));
  if (wanted <= kMaxOverlayShapes) return {};
  return text(msg::render_overlay_thinned, kMaxOverlayShapes, wanted);
}

void append(Overlay& overlay, const Overlay& more) {
  append_all(overlay.spheres, more.spheres);
  append_all(overlay.lines, more.lines);
  append_all(overlay.arrows, more.arrows);
  append_all(overlay.frames, more.frames);
  append_all(overlay.labels, more.labels);
  append_all(overlay.ellipsoids, more.ellipsoids);
  append_all(overlay.boxes, more.boxes);
  append_all(overlay.capsules, more.capsules);
  append_all(overlay.segments, more.segments);
  append_all(overlay.ghosts, more.ghosts);
}

std::size_t geoms_of(const Overlay& overlay, const mjModel& m) {
  const std::size_t ghosts = std::min(overlay.ghosts.size(), kMaxGhosts);
  return std::min(shapes_of(overlay), kMaxOverlayShapes) +
         ghosts * static_cast<std::size_t>(m.ngeom);
}

void add_overlay(const Overlay& overlay, mjvScene& scene) {
  std::vector<Strokes> strokes = strokes_of(overlay);
  choose_looks(strokes);
  const auto free = static_cast<std::size_t>(std::max(scene.maxgeom - scene.ngeom, 0));
  const std::size_t room = std::min(free, kMaxOverlayShapes);
  Sieve singles(single_shapes(overlay), room);
  add_singles(overlay, singles, scene);
  Sieve many(many_shapes(overlay, strokes), room - singles.room());
  for (const OverlaySphere& sphere : overlay.spheres) {
    if (!many.pass()) continue;
    add_solid(scene, mjGEOM_SPHERE, {sphere.p_W, Eigen::Matrix3d::Identity()},
              Vector3d::Constant(sphere.radius), sphere.color);
  }
  for (const OverlayCapsule& capsule : overlay.capsules) {
    if (!many.pass()) continue;
    add_connector(scene, mjGEOM_CAPSULE, capsule.radius, capsule.from_W, capsule.to_W,
                  capsule.color);
  }
  for (const Strokes& one : strokes) add_strokes(one, many, scene);
}

}  // namespace mjarm::render
