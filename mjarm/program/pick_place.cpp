#include "mjarm/program/pick_place.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <optional>
#include <utility>

#include "mjarm/core/messages/core.hpp"
#include "mjarm/core/messages/program.hpp"
#include "mjarm/program/grasp_choice_internal.hpp"

namespace mjarm::program {
namespace {

using detail::GoodGrasp;

constexpr int kFiner = 3;  // times as many directions where the first will not do

class PickPlanner {
 public:
  PickPlanner(const Robot& robot, const SceneState& scene, std::span<const double> q, PickTask task,
              const PickOptions& options)
      : robot_(robot),
        q_(q),
        options_(options),
        choice_(robot, scene, q, std::move(task), options) {}

  Result<PickPlan, PickFailure> plan() {
    if (auto ready = choice_.look(); !ready) return tl::unexpected(std::move(ready.error()));
    // Where none of a few directions will do, one between them may.
    for (const int turns : {options_.grasp.turns, kFiner * options_.grasp.turns}) {
      for (const GoodGrasp& one : choice_.choose(turns)) {
        if (is_stopped(options_.stop)) break;
        std::vector<Instruction> list = to_grasp(one);
        if (choice_.task().place) std::ranges::move(to_place(one), std::back_inserter(list));
        if (auto plan = planned(one, std::move(list))) return std::move(*plan);
      }
    }
    return none();
  }

  Result<PickPlan, PickFailure> plan_from_hand() {
    const std::vector<AttachedBody>& attached = choice_.scene().attached;
    if (attached.size() != 1) return failure(PickErrc::hand_full, text(msg::pick_hand_empty));
    auto one = choice_.in_hand(attached.front());
    if (!one) {
      choice_.drop({}, std::move(one.error()));
    } else if (auto plan = planned(*one, to_place(*one))) {
      return std::move(*plan);
    }
    return none();
  }

 private:
  static tl::unexpected<PickFailure> failure(PickErrc code, std::string what) {
    return tl::unexpected(PickFailure{code, std::move(what), {}});
  }

  static Instruction plan_to(const Pose& X_WT) {
    return {PlanMove{.goal = ProgramPose{.X_FT = X_WT}}};
  }
  static Instruction line_to(const Pose& X_WT) {
    return {MoveL{.goal = ProgramPose{.X_FT = X_WT}}};
  }
  [[nodiscard]] std::vector<Instruction> to_grasp(const GoodGrasp& one) const {
    std::vector<Instruction> out;
    if (!choice_.stands_open()) out.push_back({Grip{.close = false}});
    out.push_back(plan_to(choice_.back_from(one.X_WT)));
    out.push_back(line_to(one.X_WT));
    out.push_back({Grip{.close = true}});
    out.push_back(line_to(choice_.above(one.X_WT)));
    return out;
  }

  [[nodiscard]] std::vector<Instruction> to_place(const GoodGrasp& one) const {
    return {plan_to(choice_.above(one.X_WT_place)),
            line_to(one.X_WT_place),
            {Grip{.close = false}},
            line_to(choice_.back_from(one.X_WT_place))};
  }

  /// The whole of it, planned and proved; where that fails the grasp is dropped.
  std::optional<PickPlan> planned(const GoodGrasp& one, std::vector<Instruction> instructions) {
    Program program;
    program.name = "pick " + choice_.task().object;
    program.start.values.assign(q_.begin(), q_.end());
    program.instructions = std::move(instructions);
    ProgramPlan plan = plan_program(robot_.model, robot_.arm, program, plan_options());
    if (!plan.ok()) {
      choice_.drop(one.grasp, {PickErrc::no_way, plan.faults.front().what});
      return std::nullopt;
    }
    PickPlan out{.plan = std::move(plan),
                 .grasp = one.grasp,
                 .X_TB = one.X_TB,
                 .X_WB_place = {},
                 .dropped = choice_.dropped()};
    if (choice_.task().place) out.X_WB_place = one.X_WB_place;
    return out;
  }

  [[nodiscard]] ProgramPlanOptions plan_options() const {
    return {.tool_speed = options_.tool_speed,
            .scene = choice_.scene(),
            .to_first_fault = true,
            .after_step = {},
            .stop = options_.stop};
  }

  /// Why none of the grasps will do: how many fail for which reason.
  Result<PickPlan, PickFailure> none() {
    if (is_stopped(options_.stop)) return failure(PickErrc::stopped, stopped().what);
    std::map<PickErrc, std::size_t> counts;
    const DroppedGrasp* farthest = nullptr;
    for (const DroppedGrasp& one : choice_.dropped()) {
      ++counts[one.code];
      if (farthest == nullptr || farthest->code < one.code) farthest = &one;
    }
    if (farthest == nullptr) return failure(PickErrc::no_object, choice_.task().object);
    std::string list;
    for (const auto& [code, count] : counts) {
      list += (list.empty() ? "" : text(msg::core_comma)) +
              text(msg::pick_count, count, std::string(name(code)));
    }
    std::string what =
        text(msg::pick_none, choice_.dropped().size(), choice_.task().object, list, farthest->what);
    const PickErrc code = farthest->code;
    return tl::unexpected(PickFailure{code, std::move(what), std::move(choice_.dropped())});
  }

  const Robot& robot_;
  std::span<const double> q_;
  const PickOptions& options_;
  detail::GraspChoice choice_;
};

}  // namespace

std::string_view name(PickErrc code) noexcept {
  switch (code) {
    case PickErrc::not_seen:
      return "not_seen";
    case PickErrc::no_object:
      return "no_object";
    case PickErrc::no_gripper:
      return "no_gripper";
    case PickErrc::hand_full:
      return "hand_full";
    case PickErrc::too_wide:
      return "too_wide";
    case PickErrc::failed_before:
      return "failed_before";
    case PickErrc::grasp_out_of_reach:
      return "grasp_out_of_reach";
    case PickErrc::grasp_blocked:
      return "grasp_blocked";
    case PickErrc::not_held:
      return "not_held";
    case PickErrc::place_out_of_reach:
      return "place_out_of_reach";
    case PickErrc::place_blocked:
      return "place_blocked";
    case PickErrc::no_way:
      return "no_way";
    case PickErrc::stopped:
      break;
  }
  return "stopped";
}

Result<PickPlan, PickFailure> plan_pick(const Robot& robot, const SceneState& scene,
                                        std::span<const double> q, const PickTask& task,
                                        const PickOptions& options) {
  return PickPlanner(robot, scene, q, task, options).plan();
}

Result<PickPlan, PickFailure> plan_place(const Robot& robot, const SceneState& scene,
                                         std::span<const double> q, const PlaceGoal& place,
                                         const PickOptions& options) {
  return PickPlanner(robot, scene, q, {.object = {}, .place = place}, options).plan_from_hand();
}

}  // namespace mjarm::program
