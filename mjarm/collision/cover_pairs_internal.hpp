#pragma once

#include <memory>

#include "mjarm/collision/cover_geoms_internal.hpp"
#include "mjarm/collision/fast_robot_internal.hpp"

namespace mjarm::detail {

/// Which links can meet each other or an obstacle at all: by the model's rules and, with few joints
/// between the two, by a proof in exact geometry. Over a box of joint values the distance of two
/// geoms changes by at most (lever * half width), summed over the joints, so a box is cut until it
/// is clear, or its middle is too near.
class MeetingProof {
 public:
  MeetingProof(const Model& model, const Arm& arm, const GeomGroups& groups,
               const ContactRules& rules);

  /// Whether the model's rules, and the user's, let geoms of the two collide; all geoms of a group
  /// are alike.
  [[nodiscard]] bool is_allowed(const GeomGroup& a, const GeomGroup& b) const;
  /// True where it is proved that the two never meet; `b` is link `index`, on the joint farther
  /// from the base.
  [[nodiscard]] bool never_meet(const GeomGroup& a, const GeomGroup& b, std::size_t index);
  /// [m a radian or metre] (dof,) By how much each joint moves any point of a link at most, within
  /// the limits of all.
  [[nodiscard]] std::vector<double> longest_levers() const;

 private:
  struct Search;
  struct DeletePlaces {
    void operator()(mjData* data) const { mj_deleteData(data); }
  };

  const mjModel& m_;
  const Arm& arm_;
  ContactFilter filter_;
  std::unique_ptr<mjData, DeletePlaces> d_;
  std::vector<std::array<double, kMaxDof>> levers_;  // per link
};

/// What can meet what, by index into the groups.
struct Meetings {
  /// An obstacle that some link can meet, and the links that cannot.
  struct Standing {
    std::size_t obstacle = 0;
    std::vector<int> ignored;
  };
  std::vector<std::array<int, 2>> pairs;  ///< of links
  std::vector<Standing> standing;
  int apart = 0;  ///< pairs of links (links and obstacles) that were proved never to meet
};

/// @param stop  ends the search: what was found so far comes back.
[[nodiscard]] Meetings find_meetings(MeetingProof& proof, const GeomGroups& groups,
                                     const StopCheck& stop);

}  // namespace mjarm::detail
