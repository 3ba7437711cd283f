#include <mujoco/mujoco.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdio>

#include "mjarm/core/messages/view.hpp"
#include "mjarm/view/pick_internal.hpp"

namespace mjarm::view {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kMaxPairs = 6;  // of contacts that are told

std::string name_of(const mjModel& m, int type, int id, const char* kind) {
  if (id < 0) return {};
  const char* name = mj_id2name(&m, type, id);
  return name != nullptr ? name : kind + (" " + std::to_string(id));
}

/// As contacts are told everywhere: by its own name, else by that of its body.
std::string geom_name(const mjModel& m, int geom) {
  if (geom < 0) return {};
  const char* name = mj_id2name(&m, mjOBJ_GEOM, geom);
  return name != nullptr ? name : name_of(m, mjOBJ_BODY, m.geom_bodyid[geom], "body");
}

std::string vector_text(const mjtNum* values, int count) {
  std::string result;
  for (int i = 0; i < count; ++i) {
    char number[32];
    std::snprintf(number, sizeof(number), "%s%.4f", i == 0 ? "" : "  ", values[i]);
    result += number;
  }
  return result;
}

}  // namespace

SelectEvent Picker::select(const PicturePoint& point) {
  scene_.set_dynamics(true);
  const mjModel& m = scene_.model();
  const mjData& d = scene_.data();
  mjvPerturb& pert = scene_.perturb();
  SelectEvent event;
  int flex = -1;
  int skin = -1;
  mjtNum hit[3] = {0, 0, 0};
  event.body = mjv_select(&m, &d, &scene_.option(), point.aspect, point.x, point.y, &scene_.raw(),
                          hit, &event.geom, &flex, &skin);
  pert.active = 0;
  geom_ = event.geom;
  if (event.body < 0) {
    pert.select = 0;
    pert.flexselect = pert.skinselect = -1;
    return event;
  }
  mjtNum from_body[3];
  mju_sub3(from_body, hit, d.xpos + 3 * event.body);
  mju_mulMatTVec3(pert.localpos, d.xmat + 9 * event.body, from_body);
  pert.select = event.body;
  pert.flexselect = flex;
  pert.skinselect = skin;
  event.point_W = Eigen::Map<const Vector3d>(hit);
  event.body_name = name_of(m, mjOBJ_BODY, event.body, "body");
  event.geom_name = geom_name(m, event.geom);
  return event;
}

bool Picker::can_move(int body) const { return body > 0 && scene_.model().body_weldid[body] != 0; }

bool Picker::take_hold(const PicturePoint& point, bool twist) {
  (void)select(point);
  mjvPerturb& pert = scene_.perturb();
  if (!can_move(pert.select)) return false;
  mjv_initPerturb(&scene_.model(), &scene_.data(), &scene_.raw(), &pert);
  pert.active = twist ? mjPERT_ROTATE : mjPERT_TRANSLATE;
  twist_ = twist;
  return true;
}

void Picker::drag(double dx, double dy) {
  const int action = twist_ ? mjMOUSE_ROTATE_V : mjMOUSE_MOVE_V;
  mjv_movePerturb(&scene_.model(), &scene_.data(), action, dx, -dy, &scene_.raw(),
                  &scene_.perturb());
}

bool Picker::holds() const { return scene_.perturb().active != 0; }

std::optional<PushEvent> Picker::push() {
  if (!holds()) return {};
  const mjModel& m = scene_.model();
  mjData& d = scene_.data();
  const mjvPerturb& pert = scene_.perturb();
  mjtNum* wrench = d.xfrc_applied + 6 * pert.select;
  mju_zero(wrench, 6);
  mjv_applyPerturbForce(&m, &d, &pert);
  PushEvent event{.body = pert.select, .name = name_of(m, mjOBJ_BODY, pert.select, "body")};
  event.force_W = Eigen::Map<const Vector3d>(wrench);
  event.torque_W = Eigen::Map<const Vector3d>(wrench + 3);
  mjtNum point[3];
  mju_mulMatVec3(point, d.xmat + 9 * pert.select, pert.localpos);
  mju_addTo3(point, d.xpos + 3 * pert.select);
  event.point_W = Eigen::Map<const Vector3d>(point);
  return event;
}

std::optional<ReleaseEvent> Picker::let_go() {
  if (!holds()) return {};
  scene_.perturb().active = 0;
  return ReleaseEvent{scene_.perturb().select};
}

int Picker::body() const {
  const mjvPerturb& pert = scene_.perturb();
  return pert.select > 0 || geom_ >= 0 ? pert.select : -1;
}

std::vector<Picker::Row> Picker::describe() const {
  const int selected = body();
  if (selected < 0) return {};
  const mjModel& m = scene_.model();
  const mjData& d = scene_.data();
  std::vector<Row> rows = {{text(msg::view_body), name_of(m, mjOBJ_BODY, selected, "body")}};
  if (geom_ >= 0) rows.push_back({text(msg::view_geom), geom_name(m, geom_)});
  rows.push_back({text(msg::view_position), vector_text(d.xpos + 3 * selected, 3)});
  rows.push_back({text(msg::view_quaternion), vector_text(d.xquat + 4 * selected, 4)});
  std::vector<std::string> pairs;
  for (int i = 0; i < d.ncon; ++i) {
    const mjContact& contact = d.contact[i];
    if (contact.exclude != 0 || contact.geom[0] < 0 || contact.geom[1] < 0) continue;
    if (m.geom_bodyid[contact.geom[0]] != selected && m.geom_bodyid[contact.geom[1]] != selected) {
      continue;
    }
    std::string pair = geom_name(m, contact.geom[0]) + " - " + geom_name(m, contact.geom[1]);
    if (std::find(pairs.begin(), pairs.end(), pair) == pairs.end()) pairs.push_back(pair);
  }
  rows.push_back({text(msg::view_contacts), pairs.empty() ? text(msg::view_none) : pairs.front()});
  for (std::size_t i = 1; i < std::min(pairs.size(), kMaxPairs); ++i) {
    rows.push_back({" ", pairs[i]});
  }
  return rows;
}

}  // namespace mjarm::view
