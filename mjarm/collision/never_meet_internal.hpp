#pragma once

#include <cstddef>
#include <map>
#include <vector>

#include "mjarm/collision/cover_pairs_internal.hpp"
#include "mjarm/collision/exact_gaps_internal.hpp"
#include "mjarm/core/result.hpp"

namespace mjarm::detail {

/// Which geoms the arm's joints cannot bring together, whatever they do within their limits; proved
/// for each pair when it is asked for, and remembered.
class NeverMeet {
 public:
  /// @param rules, qpos  as for the cover of the model.
  NeverMeet(const Model& model, const Arm& arm, const ContactRules& rules,
            const std::vector<double>& qpos);
  NeverMeet(const NeverMeet&) = delete;  // the proof looks at its members
  NeverMeet& operator=(const NeverMeet&) = delete;

  [[nodiscard]] bool operator()(GeomIds ids);
  /// Those of MeetingProof; empty where the model cannot be sorted.
  [[nodiscard]] std::vector<double> longest_levers() const {
    return proof_ ? proof_->longest_levers() : std::vector<double>();
  }

 private:
  /// Where a geom is in the groups.
  struct Place {
    int joint = -1;
    MeetingPart part;
  };
  Result<GeomGroups> groups_;
  GeomSolids solids_;
  std::map<int, Place> places_;
  std::unique_ptr<MeetingProof> proof_;  ///< none where the model cannot be sorted
  std::map<GeomIds, bool> known_;
};

}  // namespace mjarm::detail
