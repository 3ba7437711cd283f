#include "mjarm/collision/never_meet_internal.hpp"

namespace mjarm::detail {

NeverMeet::NeverMeet(const Model& model, const Arm& arm, const ContactRules& rules,
                     const std::vector<double>& qpos)
    : groups_(group_geoms(model, arm, {.qpos = qpos, .rules = rules})) {
  if (!groups_) return;
  const mjModel& m = *model.raw();
  solids_ = solids_of_groups(m, arm, *groups_);
  proof_ = std::make_unique<MeetingProof>(m, arm, *groups_, solids_, rules);
  for (std::size_t k = 0; k < groups_->links.size(); ++k) {
    const GeomGroup& link = groups_->links[k];
    for (std::size_t i = 0; i < link.geoms.size(); ++i) {
      places_[link.geoms[i].geom] = {link.joint, {true, k, i}};
    }
  }
  for (std::size_t k = 0; k < groups_->obstacles.size(); ++k) {
    places_[groups_->obstacles[k].geoms.front().geom] = {-1, {false, k}};
  }
}

bool NeverMeet::operator()(GeomIds ids) {
  const auto [entry, fresh] = known_.try_emplace(ids, false);
  if (!fresh || !proof_) return entry->second;
  const auto first = places_.find(ids.geom1), second = places_.find(ids.geom2);
  if (first == places_.end() || second == places_.end()) return false;
  const bool swapped = first->second.joint > second->second.joint;
  const Place& near = swapped ? second->second : first->second;
  const Place& far = swapped ? first->second : second->second;
  if (near.joint == far.joint) return false;
  entry->second = proof_->never_meet(near.part, far.part);
  return entry->second;
}

}  // namespace mjarm::detail
