#pragma once

#include <cstddef>
#include <deque>
#include <functional>
#include <future>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mjarm/program/closed_way_internal.hpp"
#include "mjarm/program/program_plan.hpp"
#include "mjarm/program/program_steps_internal.hpp"
#include "mjarm/program/workplaces_internal.hpp"
#include "mjarm/trajectory/tool_motion.hpp"

namespace mjarm::program::detail {

/// Ends the work on one step.
struct PlanFault {
  std::size_t step;
  std::string reason;
  std::string what;
  Errc code = Errc::impossible;
  std::optional<ClosedWay> way = {};
};

/// A timed motion, and how near it comes to what it should keep away from.
struct JudgedMotion {
  Result<ToolMotion, MotionFailure> motion;
  MoveMeasures measures;
};

/// A motion of the tool whose path is planned; it is timed and measured on another thread while the
/// paths of what follows are planned.
struct PendingMotion {
  std::size_t step = 0;   ///< the first it does
  Stand at;               ///< where the arm was before
  std::size_t first = 0;  ///< of the attempt's moves, the first of that step
  std::size_t move = 0;   ///< of the attempt's moves, the one that lacks it
  Curve curve;
  PathOptions options;
  std::future<JudgedMotion> judged;
};

/// Moves that follow each other, and what ended them early.
struct Attempt {
  std::vector<PlannedMove> moves;
  std::size_t next = 0;  ///< the first step that is not done
  Stand at;              ///< where the arm is then
  std::optional<PlanFault> fault;
  std::optional<PlannedPath> detour = {};  ///< of the first move, where it is one
  std::deque<PendingMotion> pending = {};
};

/// Plans steps one by one, each with what hangs on its answer.
class StepPlanner {
 public:
  /// All of them outlive this.
  /// @param tell  called with the index of each step that is begun.
  StepPlanner(std::span<const Step> steps, const ProgramPlanOptions& options, Workplaces& places,
              std::function<void(std::size_t)> tell)
      : steps_(steps), options_(options), places_(places), tell_(std::move(tell)) {}

  /// Plans step `i` and what hangs on its answer; after a straight move or arc also what follows
  /// without a choice, so that the paths of some are planned while others are timed.
  [[nodiscard]] Attempt from(std::size_t i, const Stand& at);
  /// Plans step `i`, and what hangs on its answer.
  [[nodiscard]] Attempt only(std::size_t i, const Stand& at);

 private:
  using ToolPtr = std::shared_ptr<Tool>;

  [[nodiscard]] ToolPtr tool(std::size_t i, const Stand& at) const {
    return places_.tool(at.scene, steps_[i].tool);
  }
  [[nodiscard]] Attempt begin(std::size_t i, const Stand& at);
  [[nodiscard]] PlannedMove begun(std::size_t i, std::size_t scene) const;
  [[nodiscard]] Attempt rest(std::size_t i, const Stand& at, double seconds) const;
  [[nodiscard]] Attempt excite(std::size_t i, const Stand& at) const;
  [[nodiscard]] Attempt grip(std::size_t i, const Stand& at);
  [[nodiscard]] Attempt to_joints(std::size_t i, const Stand& at);
  [[nodiscard]] Attempt to_pose(std::size_t i, const Stand& at);
  [[nodiscard]] Attempt to_curve(std::size_t i, const Stand& at);
  [[nodiscard]] Attempt tool_move(std::size_t i, const Stand& at);
  [[nodiscard]] Attempt detour(std::size_t i, const Stand& at);
  [[nodiscard]] Attempt detour_to(std::size_t i, const Stand& at, std::span<const JointVec> to);
  [[nodiscard]] bool is_closed(const Attempt& attempt) const;
  void tool_moves(Attempt& attempt);
  void await(Attempt& attempt, std::size_t left);
  [[nodiscard]] std::optional<PlanFault> joint_move(std::size_t i, const Stand& at,
                                                    const JointVec& goal, const char* word,
                                                    std::vector<PlannedMove>& moves) const;
  [[nodiscard]] std::optional<PlanFault> out_of_place(std::size_t i, const Pose& X_WT,
                                                      const Stand& at) const;
  [[nodiscard]] Attempt along(std::size_t i, const Stand& at, const Curve& curve, bool here,
                              std::size_t count = 1);

  std::span<const Step> steps_;
  const ProgramPlanOptions& options_;
  Workplaces& places_;
  std::function<void(std::size_t)> tell_;
};

}  // namespace mjarm::program::detail
