#include <algorithm>
#include <utility>

#include "apps/bench/messages/bench.hpp"
#include "apps/bench/peers.hpp"
#include "apps/bench/plan_near.hpp"

namespace mjarm::app {
namespace {

/// What peers call the cases, and how they are shown.
Msg near_case(const std::string& set) {
  if (set == "joints") return msg::bench_plan_near_joints;
  if (set == "pose") return msg::bench_plan_near_poses;
  if (set == "first") return msg::bench_plan_near_first;
  broken("set");
}

std::vector<JsonDoc> scenes_json(const NearSet& set) {
  std::vector<JsonDoc> scenes;
  std::size_t at = 0;  // of the problems
  for (std::size_t index = 0; index < set.scenes.size(); ++index) {
    std::vector<JsonDoc> problems;
    for (; at < set.problems.size() && set.problems[at].scene == index; ++at) {
      const NearProblem& problem = set.problems[at];
      JsonDoc& out = problems.emplace_back(JsonDoc{{"id", problem.id}, {"start", problem.start}});
      if (problem.X_WT) {
        out.set("pose", pose_json(*problem.X_WT));
      } else {
        out.set("goal", problem.goal);
      }
    }
    scenes.push_back({{"file", std::filesystem::absolute(set.scenes[index].file).string()},
                      {"problems", std::move(problems)}});
  }
  return scenes;
}

JsonDoc near_job(const NearSet& set, const PlanPeers& peers) {
  constexpr double kReady = 120;  // [s] to get ready
  std::vector<std::string> joints;
  const Arm& arm = set.scenes.front().robot.arm;
  for (const ArmJoint& joint : arm.joints) joints.push_back(joint.name);
  const double count = static_cast<double>(set.problems.size() + set.scenes.size());
  return {{"robot", std::filesystem::absolute(set.robot.file).string()},
          {"tip", set.robot.tip},
          {"joints", joints},
          {"lower", arm.limits.lower},
          {"upper", arm.limits.upper},
          {"velocity", arm.limits.velocity},
          {"acceleration", arm.limits.acceleration},
          {"scenes", scenes_json(set)},
          {"every", peers.every},
          {"limit", peers.limit},
          {"seconds", kReady + 3 * peers.limit * count}};
}

/// The answers of one peer in one case, judged; throws `BrokenAnswer`.
std::vector<SolvedProblem> near_answers_in(const NearSet& set, const BenchEntry& entry,
                                           const JsonValue& line) {
  const JsonValue& ids = list_in(line, "problems");
  auto paths = tables_in(line, "paths");
  if (paths.size() != ids.size()) broken("paths");
  if (entry.us.size() != ids.size()) broken("us");
  std::vector<double> world;
  if (line.contains("world")) world = numbers_in(line, "world");
  if (line.contains("world") && world.size() != ids.size()) broken("world");
  std::vector<double> motions;
  if (line.contains("motions")) motions = numbers_in(line, "motions");
  if (line.contains("motions") && motions.size() != ids.size()) broken("motions");
  std::vector<SolvedProblem> answers;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const auto problem = std::ranges::find_if(set.problems, [&](const NearProblem& known) {
      return ids[i].is_string() && known.id == ids[i].string();
    });
    if (problem == set.problems.end()) broken("problems");
    answers.push_back({.problem = static_cast<std::size_t>(problem - set.problems.begin()),
                       .path = std::move(paths[i]),
                       .us = entry.us[i],
                       .world_us = world.empty() ? 0 : world[i],
                       .motion_s = motions.empty() ? 0 : motions[i]});
  }
  return answers;
}

}  // namespace

Result<NearPeerRuns> run_near_peers(const NearSet& set, const PlanPeers& peers) {
  NearPeerRuns all;
  const auto take = [&](BenchEntry entry, const JsonValue& line) {
    if (!entry.error.empty()) {
      if (!entry.set.empty()) entry.set = text(near_case(entry.set));
      all.runs.push_back(PlanRun{std::move(entry)});
      return;
    }
    PlanRun run{std::move(entry)};
    run.answers = near_answers_in(set, run, line);
    if (auto judged = judge_near_answers(set, run.answers); !judged) {
      throw BrokenAnswer{std::move(judged.error())};
    }
    std::vector<PlanRun>& runs = run.set == "first" ? all.first : all.runs;
    run.set = text(near_case(run.set));
    runs.push_back(std::move(run));
  };
  if (auto done = run_peers(peers.environment, "near", near_job(set, peers), take); !done) {
    return fail(std::move(done.error()));
  }
  return all;
}

}  // namespace mjarm::app
