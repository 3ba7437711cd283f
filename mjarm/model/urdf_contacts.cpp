#include <algorithm>
#include <numbers>
#include <set>
#include <utility>

#include "mjarm/core/messages/model.hpp"
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
    const double most = m->jnt_type[j] == mjJNT_HINGE ? std::numbers::pi : 1.0;
    const bool limited = m->jnt_limited[j] != 0;
    const double lower = limited ? m->jnt_range[2 * j] : -most;
    const double upper = limited ? m->jnt_range[2 * j + 1] : most;
    qpos[m->jnt_qposadr[j]] = rng.uniform(lower, upper);
  }
}

/// Pairs of bodies that touch in the first and in every drawn posture.
Pairs always_touching(const mjModel* m) {
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

Result<void> leave_out_touching(const std::filesystem::path& file, LoadedModel& loaded) {
  Pairs pairs;
  MujocoOutcome outcome = call_mujoco([&] { pairs = always_touching(loaded.model.get()); });
  if (outcome.failed || pairs.empty()) return {};
  std::string words;
  for (const auto& [a, b] : pairs) {
    const std::string first = object_name(loaded.model.get(), mjOBJ_BODY, a);
    const std::string second = object_name(loaded.model.get(), mjOBJ_BODY, b);
    mjsExclude* exclude = mjs_addExclude(loaded.spec.get());
    mjs_setString(exclude->bodyname1, first.c_str());
    mjs_setString(exclude->bodyname2, second.c_str());
    words += (words.empty() ? "" : ", ") + first + " - " + second;
  }
  mjModel* compiled = nullptr;
  outcome = call_mujoco([&] { compiled = mj_compile(loaded.spec.get(), nullptr); });
  if (outcome.failed || compiled == nullptr) {
    return fail(Errc::bad_input,
                text(msg::model_unexpected, file.string(),
                     outcome.failed ? outcome.error : mjs_getError(loaded.spec.get())));
  }
  loaded.model.reset(compiled);
  loaded.warnings.push_back(text(msg::model_always_touching, file.string(), words));
  return {};
}

}  // namespace mjarm
