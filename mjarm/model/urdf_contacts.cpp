#include <algorithm>
#include <numbers>
#include <set>
#include <utility>

#include "mjarm/core/rng.hpp"
#include "mjarm/model/arm_parts_internal.hpp"
#include "mjarm/model/load_internal.hpp"
#include "mjarm/model/mujoco_guard.hpp"

namespace mjarm {
namespace {

using Pairs = std::set<std::pair<int, int>>;

constexpr int kPostures = 64;

struct DeleteMjData {
  void operator()(mjData* data) const { mj_deleteData(data); }
};

/// Pairs of bodies that touch at `d->qpos`.
Pairs touching(const mjModel* m, mjData* d) {
  mj_kinematics(m, d);
  mj_collision(m, d);
  Pairs pairs;
  for (int c = 0; c < d->ncon; ++c) {
    if (d->contact[c].geom[0] < 0 || d->contact[c].geom[1] < 0) continue;
    const int a = m->geom_bodyid[d->contact[c].geom[0]];
    const int b = m->geom_bodyid[d->contact[c].geom[1]];
    pairs.insert({std::min(a, b), std::max(a, b)});
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

Pairs find_always_touching(const mjModel* m) {
  const std::unique_ptr<mjData, DeleteMjData> d(mj_makeData(m));
  Pairs always = touching(m, d.get());
  Rng rng(1);
  for (int n = 0; n < kPostures && !always.empty(); ++n) {
    draw_posture(m, rng, d->qpos);
    const Pairs now = touching(m, d.get());
    std::erase_if(always, [&](const auto& pair) { return now.count(pair) == 0; });
  }
  return always;
}

}  // namespace

BodyPairs always_touching(const mjModel* model) {
  Pairs found;
  const MujocoOutcome outcome = call_mujoco([&] { found = find_always_touching(model); });
  BodyPairs pairs;
  if (outcome.failed) return pairs;
  for (const auto& [a, b] : found) {
    pairs.emplace_back(object_name(model, mjOBJ_BODY, a), object_name(model, mjOBJ_BODY, b));
  }
  return pairs;
}

}  // namespace mjarm
