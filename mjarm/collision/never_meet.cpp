#include "mjarm/collision/never_meet_internal.hpp"

namespace mjarm::detail {

NeverMeet::NeverMeet(const Model& model, const Arm& arm, const ContactRules& rules,
                     const std::vector<double>& qpos)
    : groups_(group_geoms(model, arm, {.qpos = qpos, .rules = rules})) {
  if (!groups_) return;
  proof_ = std::make_unique<MeetingProof>(model, arm, *groups_, rules);
  for (const std::vector<GeomGroup>* groups : {&groups_->links, &groups_->obstacles}) {
    for (std::size_t k = 0; k < groups->size(); ++k) {
      const GeomGroup& group = (*groups)[k];
      for (const PlacedGeom& one : group.geoms) places_[one.geom] = {group.joint, k, one};
    }
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
  entry->second =
      proof_->never_meet({{}, near.joint, {near.placed}}, {{}, far.joint, {far.placed}}, far.group);
  return entry->second;
}

}  // namespace mjarm::detail
