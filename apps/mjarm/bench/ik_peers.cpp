#include "apps/mjarm/bench/ik_peers.hpp"

#include <nlohmann/json.hpp>
#include <utility>

#include "apps/mjarm/line_reader.hpp"
#include "mjarm/core/file.hpp"
#include "mjarm/core/messages/bench.hpp"
#include "mjarm/core/number.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/core/os_program.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/kinematics/fk.hpp"

namespace mjarm::app {
namespace {

namespace fs = std::filesystem;

/// A folder of its own that goes with this object.
class ScratchFolder {
 public:
  ScratchFolder() : path_(temp_directory() / ("mjarm_bench_" + std::to_string(process_id()))) {
    std::error_code ignored;
    fs::create_directories(path_, ignored);
  }
  ~ScratchFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  [[nodiscard]] const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

bool is_there(const fs::path& path) {
  std::error_code ignored;
  return fs::exists(path, ignored);
}

Result<fs::path> find_script() {
  const Result<fs::path> program = executable_path();
  if (!program) return fail(program.error());
  fs::path script =
      (program->parent_path() / ".." / "share" / "mjarm" / "bench" / "peers" / "ik.py")
          .lexically_normal();
  if (is_there(script)) return script;
  return fail(Errc::not_available, text(msg::bench_ik_no_script, script.string()));
}

nlohmann::json pose_json(const Pose& X) {
  const Quat q = to_quat(X.R);
  return {{"pos", {X.p[0], X.p[1], X.p[2]}}, {"quat", {q.w(), q.x(), q.y(), q.z()}}};
}

/// All that a peer has to know.
nlohmann::json job_of(const IkProblem& problem, const fs::path& folder, int rounds) {
  const Arm& arm = problem.robot.arm;
  nlohmann::json job = {
      {"urdf", fs::absolute(problem.robot.model.file()).string()},
      {"tip", arm.tip},
      {"rounds", rounds},
      {"folder", folder.string()},
      {"lower", std::vector<double>(arm.limits.lower.begin(), arm.limits.lower.end())},
      {"upper", std::vector<double>(arm.limits.upper.begin(), arm.limits.upper.end())},
      {"zero", pose_json(fk(arm, view(JointVec(JointVec::Zero(arm.dof())))))},
      {"fk", problem.q}};
  for (const ArmJoint& joint : arm.joints) job["joints"].push_back(joint.name);
  for (const IkCaseSet& set : problem.sets) {
    nlohmann::json cases = nlohmann::json::array();
    for (const IkCase& entry : set.cases) {
      cases.push_back(pose_json(entry.X_WT));
      cases.back()["seed"] = entry.seed;
    }
    job["sets"].push_back({{"name", set.name}, {"cases", std::move(cases)}});
  }
  return job;
}

/// One line of the script's answer; throws json's exceptions.
IkRun run_of(const nlohmann::json& line) {
  IkRun run{.who = line.at("who"),
            .version = line.value("version", ""),
            .set = line.value("set", ""),
            .timed = line.value("timed", ""),
            .error = line.value("error", "")};
  run.us = line.value("us", run.us);
  if (!line.contains("q")) return run;
  for (const nlohmann::json& q : line.at("q")) {
    run.q.push_back(q.is_null() ? std::vector<double>() : q.get<std::vector<double>>());
  }
  return run;
}

Result<std::vector<IkRun>> read_runs(const fs::path& file) {
  const Result<std::string> content = read_file(file);
  if (!content) return fail(content.error());
  std::vector<IkRun> runs;
  std::size_t from = 0;
  for (std::size_t to = content->find('\n'); to != std::string::npos;
       from = to + 1, to = content->find('\n', from)) {
    try {
      runs.push_back(run_of(nlohmann::json::parse(content->substr(from, to - from))));
    } catch (const nlohmann::json::exception& error) {
      return fail(Errc::system, text(msg::bench_ik_bad_answer, error.what()));
    }
  }
  return runs;
}

}  // namespace

Result<std::vector<IkRun>> run_ik_peers(const IkProblem& problem, const fs::path& environment,
                                        int rounds) {
  if (problem.robot.model.format() != ModelFormat::urdf) {
    return fail(Errc::usage, text(msg::bench_ik_peers_urdf, problem.robot.model.file().string()));
  }
  const fs::path python = environment / "bin" / "python";
  if (!is_there(python)) {
    return fail(Errc::bad_input, text(msg::bench_ik_no_python, python.string()));
  }
  const Result<fs::path> script = find_script();
  if (!script) return fail(script.error());
  const ScratchFolder folder;
  const fs::path job = folder.path() / "job.json";
  const fs::path answer = folder.path() / "answer.jsonl";
  if (auto written = write_file(job, job_of(problem, folder.path(), rounds).dump()); !written) {
    return fail(written.error());
  }
  const Result<int> code = run_program(python, {script->string(), job.string(), answer.string()});
  if (!code) return fail(code.error());
  if (*code != 0) return fail(Errc::system, text(msg::bench_ik_peers_failed, *code));
  return read_runs(answer);
}

}  // namespace mjarm::app
