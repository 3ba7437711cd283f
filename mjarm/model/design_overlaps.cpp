#include <algorithm>
#include <numbers>

#include "mjarm/core/rng.hpp"
#include "mjarm/model/arm_parts_internal.hpp"
#include "mjarm/model/design_overlaps_internal.hpp"
#include "mjarm/model/home.hpp"
#include "mjarm/model/load_internal.hpp"
#include "mjarm/model/mujoco_guard.hpp"

namespace mjarm {
namespace {

constexpr int kPostures = 64;
constexpr double kFlush = 1e-4;  // [m] flush faces of links on one axis are off by rounding

/// Pairs of parts that overlap or touch at `d->qpos`, to the margin that `m` has for all geoms.
PartPairs overlapping(const mjModel* m, mjData* d, const ModelParts& parts) {
  mj_kinematics(m, d);
  mj_collision(m, d);
  PartPairs pairs;
  for (int c = 0; c < d->ncon; ++c) {
    const mjContact& contact = d->contact[c];
    if (contact.geom[0] < 0 || contact.geom[1] < 0) continue;
    const auto [a, b] = std::minmax(parts.of_geom[contact.geom[0]], parts.of_geom[contact.geom[1]]);
    if (!parts.may_count || parts.may_count(a, b)) pairs.insert({a, b});
  }
  return pairs;
}

void draw_posture(const mjModel* m, Rng& rng, mjtNum* qpos) {
  for (int j = 0; j < m->njnt; ++j) {
    if (m->jnt_type[j] != mjJNT_HINGE && m->jnt_type[j] != mjJNT_SLIDE) continue;
    const double max = m->jnt_type[j] == mjJNT_HINGE ? std::numbers::pi : 1.0;
    const bool limited = m->jnt_limited[j] != 0;
    const double lower = limited ? m->jnt_range[2 * j] : -max;
    const double upper = limited ? m->jnt_range[2 * j + 1] : max;
    qpos[m->jnt_qposadr[j]] = rng.uniform(lower, upper);
  }
}

PartPairs draw_overlapping(const mjModel& m, const mjtNum* qpos, const ModelParts& parts) {
  const MjDataPtr d(mj_makeData(&m));
  std::copy(qpos, qpos + m.nq, d->qpos);
  PartPairs always = overlapping(&m, d.get(), parts);
  Rng rng(1);
  for (int n = 0; n < kPostures && !always.empty(); ++n) {
    draw_posture(&m, rng, d->qpos);
    const PartPairs now = overlapping(&m, d.get(), parts);
    std::erase_if(always, [&](const auto& pair) { return now.count(pair) == 0; });
  }
  return always;
}

/// The nearest body, from `body` upwards, that can be anywhere: by a free or ball joint, or by a
/// user's hand (mocap); 0 where there is none.
int loose_above(const mjModel* m, int body) {
  const auto is_loose = [m](int b) {
    const int* const types = m->jnt_type + m->body_jntadr[b];
    return m->body_mocapid[b] >= 0 || std::any_of(types, types + m->body_jntnum[b], [](int type) {
             return type == mjJNT_FREE || type == mjJNT_BALL;
           });
  };
  while (body > 0 && !is_loose(body)) body = m->body_parentid[body];
  return body;
}

/// The parts of an arm's surroundings: the bodies that it moves, by their numbers, and each geom
/// that stands, by its number from `m->nbody` on. So a link that is sunk in the floor is still held
/// against a wall, though both are geoms of the world.
class ArmParts {
 public:
  ArmParts(const mjModel* m, int first_link) : m_(m), first_link_(first_link) {}

  [[nodiscard]] bool is_link(int part) const { return part < m_->nbody; }
  [[nodiscard]] int geom(int part) const { return part - static_cast<int>(m_->nbody); }
  [[nodiscard]] int body(int part) const {
    return is_link(part) ? part : m_->geom_bodyid[geom(part)];
  }
  [[nodiscard]] ModelParts parts() const {
    ModelParts out;
    for (int g = 0; g < m_->ngeom; ++g) {
      const int body = m_->geom_bodyid[g];
      const bool moved = hangs_on(m_, body, first_link_);
      out.of_geom.push_back(moved ? body : static_cast<int>(m_->nbody) + g);
    }
    out.may_count = [this](int a, int b) {
      return (is_link(a) || is_link(b)) && loose_above(m_, body(a)) == loose_above(m_, body(b));
    };
    return out;
  }
  /// Name of the body, or of the geom where it has one.
  [[nodiscard]] std::string name(int part) const {
    const char* const geom_name = is_link(part) ? nullptr : mj_id2name(m_, mjOBJ_GEOM, geom(part));
    return geom_name != nullptr ? geom_name : object_name(m_, mjOBJ_BODY, body(part));
  }

 private:
  const mjModel* m_;
  int first_link_;
};

}  // namespace

PartPairs always_overlapping(const mjModel* m, const mjtNum* qpos, const ModelParts& parts) {
  mjModel head = *m;  // its arrays are those of the model; only the options differ
  head.opt.disableflags &= ~(mjDSBL_CONTACT | mjDSBL_CONSTRAINT);
  head.opt.enableflags &= ~mjENBL_SLEEP;
  head.opt.enableflags |= mjENBL_OVERRIDE;  // of all geoms' margins
  head.opt.o_margin = kFlush;
  PartPairs found;
  const MujocoOutcome outcome = call_mujoco([&] { found = draw_overlapping(head, qpos, parts); });
  return outcome.failed ? PartPairs() : found;
}

BodyPairs always_touching(const mjModel* m) {
  const ModelParts bodies{{m->geom_bodyid, m->geom_bodyid + m->ngeom}};
  BodyPairs pairs;
  for (const auto& [a, b] : always_overlapping(m, m->qpos0, bodies)) {
    pairs.emplace_back(object_name(m, mjOBJ_BODY, a), object_name(m, mjOBJ_BODY, b));
  }
  return pairs;
}

std::vector<DesignOverlap> design_overlaps(const mjModel* m, const std::vector<int>& joints) {
  const ArmParts of(m, m->jnt_bodyid[joints.front()]);
  std::vector<DesignOverlap> out;
  // Numbers of links come before those of geoms, so the first of a pair is a link.
  for (const auto& [a, b] : always_overlapping(m, home_configuration(m).data(), of.parts())) {
    const bool stands = !of.is_link(b);
    out.push_back({a, stands ? of.geom(b) : b, stands, {of.name(a), of.name(b)}});
  }
  return out;
}

}  // namespace mjarm
