#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "mjarm/collision/cover_geoms_internal.hpp"
#include "mjarm/collision/fast_robot_internal.hpp"
#include "mjarm/collision/solid_scene_internal.hpp"

namespace mjarm::detail {

/// The geoms of a model as convex solids, in the order of their groups.
struct GeomSolids {
  std::vector<std::vector<CoverSolid>> covers;  ///< of each link
  std::vector<LinkSolid> links;                 ///< the same, one link after the other
  std::vector<StandingSolid> standing;          ///< of each obstacle
};
[[nodiscard]] GeomSolids solids_of_groups(const mjModel& m, const Arm& arm,
                                          const GeomGroups& groups);

/// Geoms of a link, or an obstacle, by index into the groups.
struct MeetingPart {
  bool moves = false;  ///< a link
  std::size_t group = 0;
  std::optional<std::size_t> geom = {};  ///< of the link; none: all
};

/// Which links can meet each other or an obstacle at all: by the model's rules and, with few joints
/// between the two, by a proof in exact geometry. Over a box of joint values the distance of two
/// geoms changes by at most (lever * half width), summed over the joints, so a box is cut until it
/// is clear, or its middle is too near.
class MeetingProof {
 public:
  /// Looks at `groups` and `solids` as long as it lives.
  MeetingProof(const mjModel& m, const Arm& arm, const GeomGroups& groups, const GeomSolids& solids,
               const ContactRules& rules);

  /// Whether the model's rules, and the user's, let geoms of the two collide; all geoms of a group
  /// are alike.
  [[nodiscard]] bool is_allowed(const GeomGroup& a, const GeomGroup& b) const;
  /// True where it is proved that the two never meet; `b` is a link, on the joint farther from the
  /// base.
  [[nodiscard]] bool never_meet(const MeetingPart& a, const MeetingPart& b) const;
  /// All that decides what can meet what: joints and their limits, solids, rules.
  [[nodiscard]] std::string key() const;
  /// [m a radian or metre] (dof,) By how much each joint moves any point of a link at most, within
  /// the limits of all.
  [[nodiscard]] std::vector<double> longest_levers() const;

 private:
  struct Search;
  [[nodiscard]] std::span<const LinkSolid> solids_of(const MeetingPart& part) const;

  const mjModel& m_;
  const Arm& arm_;
  const GeomGroups& groups_;
  const GeomSolids& solids_;
  ContactFilter filter_;
  std::vector<std::size_t> first_;  // of each link among the solids, and their number
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

/// @return none where `stop` ended the search.
[[nodiscard]] std::optional<Meetings> find_meetings(const MeetingProof& proof,
                                                    const GeomGroups& groups,
                                                    const StopCheck& stop);

}  // namespace mjarm::detail
