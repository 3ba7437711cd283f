#include "apps/bench/plan_sets.hpp"

#include <algorithm>
#include <utility>

#include "apps/bench/messages/bench.hpp"
#include "apps/bench/messages/bench_plan.hpp"

namespace mjarm::app {
namespace {

namespace fs = std::filesystem;

/// The file of a set; empty where the folder has none.
fs::path file_in(const fs::path& folder, const std::string& name) {
  for (const char* extension : {".json.gz", ".json"}) {
    fs::path file = folder / ("mbm_" + name + "_public" + extension);
    std::error_code ignored;
    if (fs::exists(file, ignored)) return file;
  }
  return {};
}

}  // namespace

Result<PlanSet> load_plan_set(const fs::path& folder, const std::string& name) {
  const fs::path file = file_in(folder, name);
  if (folder.empty() || file.empty()) {
    return fail(Errc::not_available, text(msg::bench_plan_no_data, name, folder.string()));
  }
  Result<ProblemFile> content = read_problem_file(file.string());
  if (!content) return fail(std::move(content.error()));
  Result<FastRobot> robot = FastRobot::create(content->arm, content->spheres);
  if (!robot) return fail(std::move(robot.error()));
  PlanSet set{name, file, content->arm, content->spheres, std::move(*robot), {}};
  for (PlanProblem& problem : content->problems) {
    if (problem.valid && !problem.goals.empty()) set.cases.push_back(std::move(problem));
  }
  if (set.cases.empty()) return fail(Errc::bad_input, text(msg::bench_no_cases, file.string()));
  return set;
}

std::vector<std::string> scenes_of(const PlanSet& set) {
  std::vector<std::string> scenes;
  for (const PlanProblem& problem : set.cases) {
    if (std::find(scenes.begin(), scenes.end(), problem.scene) == scenes.end()) {
      scenes.push_back(problem.scene);
    }
  }
  return scenes;
}

std::vector<std::size_t> cases_of(const PlanSet& set, const std::string& scene) {
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < set.cases.size(); ++i) {
    if (set.cases[i].scene == scene) indices.push_back(i);
  }
  return indices;
}

}  // namespace mjarm::app
