#include "mjarm/collision/contact_rules.hpp"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <set>

#include "mjarm/collision/exact_arm_bodies_internal.hpp"
#include "mjarm/collision/exact_data_internal.hpp"
#include "mjarm/core/finite.hpp"
#include "mjarm/core/messages/collision.hpp"
#include "mjarm/core/nearest_word.hpp"
#include "mjarm/kinematics/fk.hpp"

namespace mjarm {
namespace {

bool is_free_body(const mjModel& m, int body) {
  const int joint = m.body_jntadr[body];
  return joint >= 0 && m.jnt_type[joint] == mjJNT_FREE;
}

std::vector<std::string> free_bodies(const mjModel& m) {
  std::vector<std::string> out;
  for (int b = 1; b < static_cast<int>(m.nbody); ++b) {
    if (is_free_body(m, b)) out.push_back(detail::body_name(m, b));
  }
  return out;
}

std::vector<std::string> bodies_and_geoms(const mjModel& m) {
  std::vector<std::string> out;
  for (int b = 0; b < static_cast<int>(m.nbody); ++b) out.push_back(detail::body_name(m, b));
  for (int g = 0; g < static_cast<int>(m.ngeom); ++g) out.push_back(detail::geom_name(m, g));
  std::erase(out, std::string());
  return out;
}

bool is_pose(const Pose& X) {
  return X.p.allFinite() && X.R.allFinite() &&
         (X.R.transpose() * X.R - Eigen::Matrix3d::Identity()).norm() < 1e-6 &&
         X.R.determinant() > 0;
}

Result<void> check_attached(const mjModel& m, const detail::ArmBodies& bodies,
                            const AttachedBody& attached, std::set<int>& known) {
  const int body = detail::find_body(m, attached.body);
  if (body < 0) {
    return fail(Errc::bad_input, text(msg::collision_held_unknown, attached.body,
                                      did_you_mean(attached.body, free_bodies(m))));
  }
  if (!is_free_body(m, body)) {
    return fail(Errc::bad_input, text(msg::collision_held_fixed, attached.body));
  }
  const bool carries_arm = std::any_of(bodies.bodies.begin(), bodies.bodies.end(),
                                       [&](int moved) { return m.body_rootid[moved] == body; });
  if (carries_arm || !known.insert(body).second) {
    return fail(Errc::bad_input, text(msg::collision_held_twice, attached.body));
  }
  if (!is_pose(attached.X_TB))
    return fail(Errc::bad_input, text(msg::collision_held_pose, attached.body));
  return {};
}

}  // namespace

Result<void> check_contact_rules(const Model& model, const Arm& arm, const ContactRules& rules) {
  const mjModel& m = *model.raw();
  const detail::ArmBodies bodies(m, arm);
  std::set<int> known;
  for (const AttachedBody& attached : rules.attached) {
    if (Result<void> fine = check_attached(m, bodies, attached, known); !fine) return fine;
  }
  const std::vector<std::string> words = bodies_and_geoms(m);
  for (const auto& pair : rules.allowed) {
    for (const std::string& word : pair) {
      if (std::find(words.begin(), words.end(), word) != words.end()) continue;
      return fail(Errc::bad_input,
                  text(msg::collision_allowed_unknown, word, did_you_mean(word, words)));
    }
  }
  return {};
}

Result<AttachedBody> attach_in_place(const Model& model, const Arm& arm, const std::string& body,
                                     std::span<const double> q) {
  if (q.size() != static_cast<std::size_t>(arm.dof()) || !all_finite(q)) {
    return fail(Errc::bad_input, text(msg::collision_bad_q, arm.dof(), q.size()));
  }
  AttachedBody attached{body, {}};
  if (Result<void> fine = check_contact_rules(model, arm, {.attached = {attached}}); !fine) {
    return fail(std::move(fine.error()));
  }
  const mjModel& m = *model.raw();
  const detail::MjDataPtr d(mj_makeData(&m));
  const std::vector<double> rest = detail::rest_configuration(m);
  std::copy(rest.begin(), rest.end(), d->qpos);
  mj_kinematics(&m, d.get());
  using Rows = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  const int id = detail::find_body(m, body);
  const Pose X_WB{Eigen::Vector3d(d->xpos + 3 * id), Eigen::Map<const Rows>(d->xmat + 9 * id)};
  attached.X_TB = fk(arm, q).inverse() * X_WB;
  return attached;
}

namespace detail {

ContactFilter::ContactFilter(const mjModel& m, const Arm& arm, const ContactRules& rules) {
  const auto geoms_where = [&](const auto& belongs) {
    std::vector<bool> out(static_cast<std::size_t>(m.ngeom));
    for (int g = 0; g < static_cast<int>(m.ngeom); ++g)
      out[static_cast<std::size_t>(g)] = belongs(g);
    return out;
  };
  const auto called = [&](const std::string& name) {
    return geoms_where(
        [&](int g) { return geom_name(m, g) == name || body_name(m, m.geom_bodyid[g]) == name; });
  };
  for (const auto& [first, second] : rules.allowed) {
    pairs_.push_back({called(first), called(second)});
  }
  const auto of_body = [&](int body) {
    return geoms_where([&](int g) { return m.geom_bodyid[g] == body; });
  };
  for (const DesignOverlap& pair : arm.overlapping) {
    pairs_.push_back({of_body(pair.link), pair.stands
                                              ? geoms_where([&](int g) { return g == pair.other; })
                                              : of_body(pair.other)});
  }
}

bool ContactFilter::may_touch(int geom1, int geom2) const {
  const auto i = static_cast<std::size_t>(geom1), j = static_cast<std::size_t>(geom2);
  return std::any_of(pairs_.begin(), pairs_.end(), [&](const auto& pair) {
    return (pair[0][i] && pair[1][j]) || (pair[0][j] && pair[1][i]);
  });
}

}  // namespace detail
}  // namespace mjarm
