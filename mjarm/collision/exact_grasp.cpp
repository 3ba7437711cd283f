#include "mjarm/collision/exact_grasp.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <optional>

#include "mjarm/collision/exact_arm_bodies_internal.hpp"
#include "mjarm/collision/exact_data_internal.hpp"
#include "mjarm/collision/exact_gaps_internal.hpp"
#include "mjarm/collision/exact_gripper_way_internal.hpp"
#include "mjarm/core/finite.hpp"
#include "mjarm/core/messages/collision.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/model/scene_bodies.hpp"

namespace mjarm {
namespace {

using detail::GeomGap;
using detail::GeomIds;
using Eigen::Vector3d;

constexpr int kSteps = 200;         // of the way of the fingers
constexpr double kLook = 5e-3;      // [m] so near a finger is looked at
constexpr double kTouch = 1e-6;     // [m] nearer than this is touching
constexpr double kOpposite = -0.4;  // cosine of two normals that hold something between them

/// How near one finger, or the hand itself, is to a body.
struct Side {
  double distance = kLook;           ///< [m] negative where they overlap
  Vector3d push = Vector3d::Zero();  ///< unit, from the finger into the body
};

/// A free body that may come between the fingers.
struct Candidate {
  SceneObject object;
  std::vector<int> geoms;
  std::map<int, Side> sides;  ///< by the body of the finger
};

/// Distance of two geoms, at most kLook, and the direction from the first to the second.
Side measure(const mjModel& m, mjData* d, GeomIds ids) {
  Side out;
  const bool swapped = detail::is_measured_here(m, ids.geom2, ids.geom1);
  if (swapped || detail::is_measured_here(m, ids.geom1, ids.geom2)) {
    const GeomIds pair = swapped ? GeomIds{ids.geom2, ids.geom1} : ids;
    const std::optional<GeomGap> gap = detail::gap_measured_here(m, d, pair, kLook);
    if (gap) out = {gap->distance, swapped ? Vector3d(-gap->normal_W) : gap->normal_W};
    return out;
  }
  const bool turned = m.geom_type[ids.geom1] > m.geom_type[ids.geom2];  // MuJoCo's order
  std::array<mjtNum, 6> segment{};
  out.distance = mj_geomDistance(&m, d, turned ? ids.geom2 : ids.geom1,
                                 turned ? ids.geom1 : ids.geom2, kLook, segment.data());
  const Vector3d way(segment[3] - segment[0], segment[4] - segment[1], segment[5] - segment[2]);
  const bool against = turned != (out.distance < 0);
  if (way.norm() > kTouch) out.push = way.normalized() * (against ? -1 : 1);
  return out;
}

class Closing {
 public:
  Closing(const Model& model, const Arm& arm, std::span<const double> q, const SceneState& before)
      : m_(*model.raw()), arm_(arm), q_(q), state_(before), way_(m_, arm), d_(mj_makeData(&m_)) {
    if (state_.qpos.empty()) state_.qpos = detail::rest_configuration(m_);
    const detail::ArmBodies bodies(m_, arm, before.attached);
    for (std::size_t i = 0; i < q.size(); ++i) {
      state_.qpos[static_cast<std::size_t>(bodies.addresses[i])] = q[i];
    }
    bodies.place_attached(fk(arm, q), state_.qpos.data());
    find_sides(model);
  }

  SceneState run() {
    if (!state_.attached.empty()) return std::move(state_);  // it is closed on that
    const std::vector<double> from = state_.qpos;
    const int steps = way_.has_ends() && !candidates_.empty() ? kSteps : 0;
    way_.find_way(from);
    for (int k = 0; k <= steps; ++k) {
      way_.set(from, steps == 0 ? 1.0 : static_cast<double>(k) / steps, state_.qpos);
      if (steps == 0 || close_to_here()) break;
    }
    return std::move(state_);
  }

 private:
  /// The geoms of each finger and of the hand, and the bodies that may come between them.
  void find_sides(const Model& model) {
    const SceneBodies scene = scene_bodies(model, arm_);
    std::vector<int> side(scene.role.size(), -1);
    for (std::size_t b = 1; b < side.size(); ++b) {
      if (scene.role[b] != BodyRole::hand) continue;
      const int parent = side[static_cast<std::size_t>(m_.body_parentid[b])];
      side[b] = way_.moves(static_cast<int>(b)) ? static_cast<int>(b) : std::max(parent, 0);
    }
    const auto is_attached = [&](const SceneObject& object) {
      return std::ranges::any_of(state_.attached, [&](const AttachedBody& one) {
        return detail::find_body(m_, one.body) == object.body;
      });
    };
    std::vector<Candidate> all;
    for (const SceneObject& object : scene.objects) all.push_back({object, {}, {}});
    for (int g = 0; g < static_cast<int>(m_.ngeom); ++g) {
      const auto body = static_cast<std::size_t>(m_.geom_bodyid[g]);
      if (side[body] >= 0) fingers_[side[body]].push_back(g);
      const int object = scene.object_of[body];
      if (object >= 0) all[static_cast<std::size_t>(object)].geoms.push_back(g);
    }
    for (Candidate& one : all) {
      if (!is_attached(one.object)) candidates_.push_back(std::move(one));
    }
  }

  void look(Candidate& one) {
    for (const auto& [finger, geoms] : fingers_) {
      Side best;
      for (const int g : geoms) {
        for (const int other : one.geoms) {
          const Vector3d way(Vector3d(d_->geom_xpos + 3 * g) - Vector3d(d_->geom_xpos + 3 * other));
          const double far = m_.geom_rbound[g] + m_.geom_rbound[other] + kLook;
          const bool bounded = m_.geom_rbound[g] > 0 && m_.geom_rbound[other] > 0;
          if ((bounded && way.norm() > far) || !detail::may_collide(m_, g, other)) continue;
          const Side here = measure(m_, d_.get(), {g, other});
          if (here.distance < best.distance) best = here;
        }
      }
      // Where they touch to the last bit there is no direction: the one before holds.
      Side& known = one.sides[finger];
      if (best.push.isZero()) best.push = known.push;
      known = best;
    }
  }

  /// The two sides that touch it from opposite directions.
  static bool is_between(const Candidate& one) {
    for (const auto& [finger, a] : one.sides) {
      for (const auto& [other, b] : one.sides) {
        if (finger >= other || a.distance > kTouch || b.distance > kTouch) continue;
        if (a.push.dot(b.push) < kOpposite) return true;
      }
    }
    return false;
  }

  /// A finger that reached it pushes it along; the hand itself does not move.
  bool push(const Candidate& one) {
    Vector3d way = Vector3d::Zero();
    for (const auto& [finger, side] : one.sides) {
      if (finger == 0 || side.distance >= 0 || way.norm() >= -side.distance) continue;
      way = -side.distance * side.push;
    }
    if (way.isZero()) return false;
    const int address = m_.jnt_qposadr[m_.body_jntadr[one.object.body]];
    for (int k = 0; k < 3; ++k) state_.qpos[static_cast<std::size_t>(address + k)] += way[k];
    return true;
  }

  void place() {
    std::ranges::copy(state_.qpos, d_->qpos);
    mj_kinematics(&m_, d_.get());
  }

  /// Pushes what the fingers have reached; true where they hold something.
  bool close_to_here() {
    place();
    bool pushed = false, holds = false;
    for (Candidate& one : candidates_) {
      look(one);
      if (!is_between(one)) pushed = push(one) || pushed;
    }
    if (pushed) {
      place();
      for (Candidate& one : candidates_) look(one);
    }
    for (const Candidate& one : candidates_) {
      if (!is_between(one)) continue;
      holds = true;
      using Rows = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
      const int body = one.object.body;
      const Pose X_WB{Vector3d(d_->xpos + 3 * body), Eigen::Map<const Rows>(d_->xmat + 9 * body)};
      state_.attached.push_back({one.object.name, fk(arm_, q_).inverse() * X_WB});
    }
    return holds;
  }

  const mjModel& m_;
  const Arm& arm_;
  std::span<const double> q_;
  SceneState state_;
  detail::GripperWay way_;
  detail::MjDataPtr d_;
  std::map<int, std::vector<int>> fingers_;  ///< geoms by finger; 0: the hand itself
  std::vector<Candidate> candidates_;
};

Result<void> check_grasp(const Model& model, const Arm& arm, std::span<const double> q,
                         const SceneState& state) {
  const mjModel& m = *model.raw();
  if (!state.qpos.empty() &&
      (state.qpos.size() != static_cast<std::size_t>(m.nq) || !all_finite(state.qpos))) {
    return fail(Errc::bad_input, text(msg::collision_cover_qpos, m.nq));
  }
  if (q.size() != static_cast<std::size_t>(arm.dof()) || !all_finite(q)) {
    return fail(Errc::bad_input, text(msg::collision_bad_q, arm.dof(), q.size()));
  }
  if (!detail::ArmBodies(m, arm).matches) {
    return fail(Errc::bad_input, text(msg::collision_other_arm, arm.name));
  }
  if (!arm.gripper) return fail(Errc::bad_input, text(msg::collision_no_gripper, arm.name));
  return check_contact_rules(model, arm, {.attached = state.attached});
}

}  // namespace

Result<SceneState> close_gripper(const Model& model, const Arm& arm, std::span<const double> q,
                                 const SceneState& before) {
  if (Result<void> fine = check_grasp(model, arm, q, before); !fine) return fail(fine.error());
  return Closing(model, arm, q, before).run();
}

Result<SceneState> open_gripper(const Model& model, const Arm& arm, std::span<const double> q,
                                const SceneState& before) {
  if (Result<void> fine = check_grasp(model, arm, q, before); !fine) return fail(fine.error());
  const mjModel& m = *model.raw();
  SceneState out = before;
  if (out.qpos.empty()) out.qpos = detail::rest_configuration(m);
  detail::ArmBodies(m, arm, out.attached).place_attached(fk(arm, q), out.qpos.data());
  out.attached.clear();
  detail::GripperWay(m, arm).set_open(out.qpos);
  return out;
}

std::vector<AttachedBody> attached_to(const Arm& other, const Arm& arm,
                                      std::span<const AttachedBody> attached) {
  std::vector<AttachedBody> out(attached.begin(), attached.end());
  const Pose X_OT = other.X_JT.inverse() * arm.X_JT;
  for (AttachedBody& one : out) one.X_TB = X_OT * one.X_TB;
  return out;
}

}  // namespace mjarm
