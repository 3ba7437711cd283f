#pragma once

#include <optional>
#include <span>
#include <vector>

#include "mjarm/planning/clear_path_internal.hpp"
#include "mjarm/planning/planning_world.hpp"
#include "mjarm/planning/region_goals.hpp"

namespace mjarm::detail {

/// One search in one scene, for a clearance where one is asked: the shortest path of one to all
/// goals and those to the nearest ones alone.
/// @param ends  what may be nearer.
[[nodiscard]] Result<PlannedPath, WorldFailure> search_scene(
    const ClearScene& scene, ClearEnds ends, std::span<const double> q_start,
    std::span<const JointVec> goals, const PlanOptions& options, PlanTimes* times);

/// The configurations of one end of a path.
class EndConfigurations {
 public:
  /// Those that are given.
  explicit EndConfigurations(std::vector<JointVec> q) : q_(std::move(q)) {}
  /// Those of regions.
  explicit EndConfigurations(RegionGoals goals) : goals_(std::move(goals)) {}

  [[nodiscard]] const std::vector<JointVec>& q() const { return goals_ ? goals_->q() : q_; }
  /// Of one of them; -1: it was given.
  [[nodiscard]] int region_of(int index) const { return goals_ ? goals_->region_of(index) : -1; }
  /// One of them, where it stands for a region nearer to `to` if that can be.
  [[nodiscard]] JointVec pulled(int index, const JointVec& q, const JointVec& to) const {
    return goals_ ? goals_->pulled(q, goals_->region_of(index), to) : q;
  }
  [[nodiscard]] bool may_draw() const { return goals_ && goals_->may_draw(); }
  bool draw_more() { return goals_ && goals_->draw_more(); }

 private:
  std::vector<JointVec> q_;
  std::optional<RegionGoals> goals_;
};

/// The same as search_scene() from one of several starts; where there is no path, again with more
/// of what is drawn from regions and twice as many samples, until PlanOptions::samples are spent.
[[nodiscard]] Result<PlannedPath, WorldFailure> search_between(
    const ClearScene& scene, ClearEnds ends, EndConfigurations& starts, EndConfigurations& goals,
    const PlanOptions& options, PlanTimes* times);

}  // namespace mjarm::detail
