#include <algorithm>
#include <map>
#include <utility>

#include "mjarm/collision/exact_arm_bodies_internal.hpp"
#include "mjarm/collision/exact_data_internal.hpp"
#include "mjarm/collision/exact_gaps_internal.hpp"
#include "mjarm/collision/exact_gripper_way_internal.hpp"
#include "mjarm/collision/exact_watch_internal.hpp"
#include "mjarm/collision/never_meet_internal.hpp"
#include "mjarm/core/messages/collision.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/model/scene_bodies.hpp"

namespace mjarm::detail {
namespace {

/// Of a finger's way: so many that its pieces overlap each other.
constexpr int kFingerPlaces = 5;

/// [m] An upper bound of the distance from the origin of any of the joints 0 to `joint` to a point
/// of that joint's frame, less what is in this frame.
double chain_length(const Arm& arm, int joint) {
  double length = 0;
  for (int k = 1; k <= joint; ++k) {
    const ArmJoint& one = arm.joints[static_cast<std::size_t>(k)];
    length += one.X_PJ.p.norm();
    if (one.type == JointType::slide) {
      length += std::max(std::abs(arm.limits.lower[k]), std::abs(arm.limits.upper[k]));
    }
  }
  return length;
}

class WatchBuilder {
 public:
  WatchBuilder(const Model& model, const Arm& arm)
      : model_(model),
        m_(*model.raw()),
        arm_(arm),
        bodies_(m_, arm),
        filter_(m_, arm, {}),
        scene_(scene_bodies(model, arm)),
        way_(m_, arm),
        rest_(rest_configuration(m_)),
        never_(model, arm, {}, rest_),
        d_(mj_makeData(&m_)) {}

  Result<WatchPairs> build() {
    find_fingers();
    add_shapes();
    for (std::size_t i = 0; i < out_.shapes.size(); ++i) {
      for (std::size_t k = i + 1; k < out_.shapes.size(); ++k) add_pair(i, k);
    }
    if (!unknown_.empty()) {
      return fail(Errc::not_available, text(msg::collision_watch_shape, unknown_));
    }
    if (m_.nflex > 0) return fail(Errc::not_available, text(msg::collision_watch_shape, "flex"));
    return std::move(out_);
  }

 private:
  void find_fingers() {
    finger_.assign(static_cast<std::size_t>(m_.nbody), false);
    if (!arm_.gripper) return;
    for (int b = 1; b < static_cast<int>(m_.nbody); ++b) {
      const auto i = static_cast<std::size_t>(b);
      const bool hand = scene_.role[i] == BodyRole::hand;
      finger_[i] =
          hand && (way_.moves(b) || finger_[static_cast<std::size_t>(m_.body_parentid[b])]);
    }
  }

  /// One geom where the joints stand in `qpos`.
  void add_shape(int geom) {
    const int body = m_.geom_bodyid[geom];
    const auto b = static_cast<std::size_t>(body);
    WatchShape shape;
    shape.geom = geom;
    shape.joint = bodies_.pieces[b] - 1;
    shape.finger = finger_[b];
    if (scene_.object_of[b] >= 0) {
      shape.object = scene_.objects[static_cast<std::size_t>(scene_.object_of[b])].body;
    }
    shape.still = m_.body_weldid[body] == 0;
    shape.radius = m_.geom_rbound[geom];
    if (shape.joint >= 0) {
      const Pose X_WG = geom_pose(*d_, geom);
      shape.X_LG = X_WJ_[static_cast<std::size_t>(shape.joint)].inverse() * X_WG;
      shape.reach = chain_length(arm_, shape.joint) + shape.X_LG.p.norm() + shape.radius;
    }
    out_.shapes.push_back(shape);
  }

  void place(const std::vector<double>& qpos) {
    std::ranges::copy(qpos, d_->qpos);
    mj_kinematics(&m_, d_.get());
    X_WJ_.resize(arm_.joints.size());
    (void)fk_all(arm_, as_span(arm_positions(arm_, qpos)), X_WJ_);
  }

  bool collides(int geom) const { return m_.geom_contype[geom] != 0 || m_.geom_conaffinity[geom]; }

  void add_shapes() {
    place(rest_);
    const auto is_finger = [&](int geom) {
      return finger_[static_cast<std::size_t>(m_.geom_bodyid[geom])];
    };
    for (int g = 0; g < static_cast<int>(m_.ngeom); ++g) {
      if ((collides(g) || m_.npair > 0) && !is_finger(g)) add_shape(g);
    }
    if (!arm_.gripper) return;
    std::vector<double> open = rest_, qpos = rest_;
    way_.set_open(open);
    way_.find_way(open);
    const int places = way_.has_ends() ? kFingerPlaces : 1;
    for (int k = 0; k < places; ++k) {
      way_.set(open, places == 1 ? 0 : static_cast<double>(k) / (places - 1), qpos);
      place(qpos);
      for (int g = 0; g < static_cast<int>(m_.ngeom); ++g) {
        if ((collides(g) || m_.npair > 0) && is_finger(g)) add_shape(g);
      }
    }
  }

  void add_pair(std::size_t i, std::size_t k) {
    const WatchShape &a = out_.shapes[i], &b = out_.shapes[k];
    if (a.joint == b.joint && a.object < 0 && b.object < 0) return;  // rigid, or both stand
    if (a.object >= 0 && a.object == b.object) return;
    if ((a.object >= 0 && b.finger) || (b.object >= 0 && a.finger)) return;
    if (!may_collide(m_, a.geom, b.geom) || filter_.may_touch(a.geom, b.geom)) return;
    for (const WatchShape* shape : {&a, &b}) {
      const int type = m_.geom_type[shape->geom];
      if (type == mjGEOM_HFIELD || type == mjGEOM_SDF) unknown_ = geom_name(m_, shape->geom);
    }
    const auto known = [](const WatchShape& shape) {
      return !shape.finger && shape.object < 0 && (shape.joint >= 0 || shape.still);
    };
    if (known(a) && known(b) && never_({a.geom, b.geom})) return;
    out_.pairs.push_back({static_cast<int>(i), static_cast<int>(k)});
  }

  const Model& model_;
  const mjModel& m_;
  const Arm& arm_;
  ArmBodies bodies_;
  ContactFilter filter_;
  SceneBodies scene_;
  GripperWay way_;
  std::vector<double> rest_;
  NeverMeet never_;
  MjDataPtr d_;
  std::vector<bool> finger_;  ///< per body
  std::vector<Pose> X_WJ_;
  std::string unknown_;  ///< a geom whose distance cannot be measured
  WatchPairs out_;
};

}  // namespace

Result<WatchPairs> watch_pairs(const Model& model, const Arm& arm) {
  return WatchBuilder(model, arm).build();
}

}  // namespace mjarm::detail
