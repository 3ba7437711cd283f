#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <variant>

#include "apps/mjarm/learn/exercise.hpp"
#include "apps/mjarm/learn/program_steps.hpp"
#include "apps/mjarm/messages/learn.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/model/describe.hpp"
#include "mjarm/model/scene_bodies.hpp"
#include "mjarm/program/load_program.hpp"
#include "mjarm/session/see_scene.hpp"

namespace mjarm::app {
namespace {

// The tray behind the fence, and how much room each of the two needs in it.
constexpr double kTrayX[] = {0.37, 0.63}, kTrayY[] = {-0.42, -0.10};  // [m]
constexpr double kApart = 0.06;                                       // [m]

/// Where something is put, by the text.
struct PutDown {
  std::string object;
  int line = 0;  ///< of the pick
  std::optional<Eigen::Vector3d> at = {};
};

/// Every pick, and the place that follows it.
std::vector<PutDown> put_downs(const std::vector<const program::Instruction*>& steps) {
  std::vector<PutDown> out;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const auto* const pick = std::get_if<program::Pick>(&steps[i]->what);
    if (pick == nullptr) continue;
    PutDown put{.object = pick->object, .line = steps[i]->place.line};
    const auto* const place =
        i + 1 < steps.size() ? std::get_if<program::Place>(&steps[i + 1]->what) : nullptr;
    if (place != nullptr) put.at = place->goal.X_FT.p;
    out.push_back(std::move(put));
  }
  return out;
}

const PutDown* put_down_of(const std::vector<PutDown>& puts, std::string_view object) {
  const auto found =
      std::ranges::find_if(puts, [&](const PutDown& put) { return put.object == object; });
  return found == puts.end() ? nullptr : &*found;
}

void judge_look(const std::vector<const program::Instruction*>& steps, LearnReport& out) {
  for (const program::Instruction* step : steps) {
    if (std::holds_alternative<program::Look>(step->what)) {
      out.right(text(msg::learn_carry_looks, step->place.line));
      return;
    }
    if (std::holds_alternative<program::Pick>(step->what)) break;
  }
  out.wrong(text(msg::learn_carry_no_look));
}

void judge_places(const PutDown& can, const PutDown& box, LearnReport& out) {
  bool good = true;
  for (const PutDown* put : {&can, &box}) {
    const Eigen::Vector3d& p = *put->at;
    const bool inside =
        p.x() >= kTrayX[0] && p.x() <= kTrayX[1] && p.y() >= kTrayY[0] && p.y() <= kTrayY[1];
    if (!inside) out.wrong(text(msg::learn_carry_off_tray, put->object, p.x(), p.y()));
    good = good && inside;
  }
  const double apart = (*can.at - *box.at).head<2>().norm();
  if (apart < kApart) {
    out.wrong(text(msg::learn_carry_same_place, 1e3 * apart, 1e3 * kApart));
  } else if (good) {
    out.right(text(msg::learn_carry_places, 1e3 * apart));
  }
}

void judge_text_of_carry(const program::LoadedProgram& loaded, LearnReport& out) {
  const std::vector<const program::Instruction*> steps = steps_of(loaded.program);
  judge_look(steps, out);
  const std::vector<PutDown> puts = put_downs(steps);
  const PutDown *can = put_down_of(puts, "can"), *box = put_down_of(puts, "box");
  if (can == nullptr) out.wrong(text(msg::learn_carry_not_picked, "can"));
  if (box == nullptr) out.wrong(text(msg::learn_carry_not_picked, "box"));
  for (const PutDown* put : {can, box}) {
    if (put != nullptr && !put->at) {
      out.wrong(text(msg::learn_carry_not_placed, put->object, put->line));
    }
  }
  if (can != nullptr && box != nullptr && can->at && box->at) judge_places(*can, *box, out);
}

/// Whether the scene has a camera and what the exercise carries.
bool judge_scene(const Robot& robot, LearnReport& out) {
  const SceneBodies bodies = scene_bodies(robot.model, robot.arm);
  const auto has = [&](std::string_view name) {
    return std::ranges::any_of(bodies.objects,
                               [&](const SceneObject& object) { return object.name == name; });
  };
  if (!describe(robot.model).cameras.empty() && has("can") && has("box")) return true;
  out.wrong(text(msg::learn_carry_scene));
  return false;
}

/// The same program planned without a picture, where this machine can make none.
Result<program::LoadedProgram> without_look(program::LoadedProgram loaded) {
  std::erase_if(loaded.program.instructions, [](const program::Instruction& instruction) {
    return std::holds_alternative<program::Look>(instruction.what);
  });
  return program::plan_loaded(loaded.file, std::move(loaded.program), std::move(loaded.robot),
                              interrupted);
}

bool has_no_picture(const program::ProgramPlan& plan) {
  return std::ranges::any_of(plan.faults, [](const program::ProgramFault& fault) {
    return fault.word == "look" && fault.code == Errc::not_available;
  });
}

void tell_plan(const program::LoadedProgram& loaded, LearnReport& out) {
  const program::ProgramPlan& plan = loaded.plan;
  if (!plan.ok()) {
    out.wrong(program::line_of(loaded, plan.faults.front()));
    out.note(text(msg::learn_program_see_all, loaded.file));
    return;
  }
  const MoveMeasures* tightest = nullptr;
  for (const PlannedMove& move : plan.moves) {
    if (move.word != "plan" || !move.measures) continue;  // things lie where they are picked
    if (tightest == nullptr || move.measures->clearance < tightest->clearance) {
      tightest = &*move.measures;
    }
  }
  out.right(text(msg::learn_carry_right, plan.moves.size(), plan.duration()));
  if (tightest != nullptr && tightest->clearance < std::numeric_limits<double>::max()) {
    out.note(text(msg::learn_carry_tightest, 1e3 * tightest->clearance, tightest->nearest.geom1,
                  tightest->nearest.geom2));
  }
}

}  // namespace

Result<LearnReport> check_two_objects(const Exercise& exercise) {
  Result<program::LoadedProgram> loaded =
      program::load_program(exercise.file, interrupted, {}, session::see_scene);
  if (!loaded) return fail(loaded.error());
  LearnReport out;
  if (!judge_scene(loaded->robot, out)) return out;
  judge_text_of_carry(*loaded, out);
  if (has_no_picture(loaded->plan)) {
    out.note(text(msg::learn_carry_no_picture));
    loaded = without_look(std::move(*loaded));
    if (!loaded) return fail(loaded.error());
  }
  tell_plan(*loaded, out);
  return out;
}

}  // namespace mjarm::app
