#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "mjarm/model/scene_bodies.hpp"
#include "mjarm/teleop/grasp_watch_internal.hpp"

namespace mjarm::detail {
namespace {

/// [N or N m] With less, fingers are on their way, or push something before them.
constexpr double kHoldingForce = 0.5;

}  // namespace

GraspWatch::GraspWatch(const Robot& robot) {
  if (robot.arm.gripper) drives_ = robot.arm.gripper->drives;
  const SceneBodies scene = scene_bodies(robot.model, robot.arm);
  names_ = scene.name;
  for (std::size_t b = 0; b < scene.role.size(); ++b) {
    hand_.push_back(scene.role[b] == BodyRole::hand);
    arm_.push_back(hand_.back() || scene.role[b] == BodyRole::link);
    const int object = scene.object_of[b];
    carried_.push_back(object < 0 ? -1 : scene.objects[static_cast<std::size_t>(object)].body);
  }
}

int GraspWatch::held(const Sim& sim, bool closing, int before) const {
  if (drives_.empty() || !closing) return -1;
  std::map<int, std::set<int>> sides;  // bodies of the hand that touch it, by what is touched
  for (const Contact& contact : sim.contacts()) {
    for (const auto& [hand, other] :
         {std::pair(contact.body1, contact.body2), std::pair(contact.body2, contact.body1)}) {
      if (hand < 0 || other < 0 || !hand_[static_cast<std::size_t>(hand)]) continue;
      const int object = carried_[static_cast<std::size_t>(other)];
      if (object >= 0) sides[object].insert(hand);
    }
  }
  double force = 0;
  for (const GripperDrive& drive : drives_) {
    force = std::max(force, std::abs(sim.actuator_force()[static_cast<std::size_t>(drive.id)]));
  }
  if (const auto kept = sides.find(before); kept != sides.end() && kept->second.size() > 1) {
    return before;
  }
  for (const auto& [object, hands] : sides) {
    if (hands.size() > 1 && force > kHoldingForce) return object;
  }
  return -1;
}

bool GraspWatch::touches(const Sim& sim, int held) const {
  const auto is_own = [&](int body) {
    const auto b = static_cast<std::size_t>(body);
    return body >= 0 && (arm_[b] || (held >= 0 && carried_[b] == held));
  };
  return std::ranges::any_of(sim.contacts(), [&](const Contact& contact) {
    return is_own(contact.body1) != is_own(contact.body2);
  });
}

std::string GraspWatch::name(int body) const {
  return body < 0 ? std::string() : names_[static_cast<std::size_t>(body)];
}

}  // namespace mjarm::detail
