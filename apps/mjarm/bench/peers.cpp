#include "apps/mjarm/bench/peers.hpp"

#include <utility>

#include "mjarm/core/file.hpp"
#include "mjarm/core/messages/bench.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/core/os_program.hpp"
#include "mjarm/core/rotation.hpp"

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

Result<fs::path> find_script(const std::string& suite) {
  const Result<fs::path> program = executable_path();
  if (!program) return fail(program.error());
  fs::path script =
      (program->parent_path() / ".." / "share" / "mjarm" / "bench" / "peers" / (suite + ".py"))
          .lexically_normal();
  if (is_there(script)) return script;
  return fail(Errc::not_available, text(msg::bench_no_script, script.string()));
}

Result<void> take_line(const std::string& line, const TakeAnswer& take) {
  try {
    const nlohmann::json answer = nlohmann::json::parse(line);
    BenchEntry entry{.who = answer.at("who"),
                     .version = answer.value("version", ""),
                     .set = answer.value("set", ""),
                     .timed = answer.value("timed", ""),
                     .error = answer.value("error", "")};
    entry.us = answer.value("us", entry.us);
    return take(std::move(entry), answer);
  } catch (const nlohmann::json::exception& error) {
    return fail(Errc::system, text(msg::bench_bad_answer, error.what()));
  }
}

}  // namespace

nlohmann::json pose_json(const Pose& X) {
  const Quat q = to_quat(X.R);
  return {{"pos", {X.p[0], X.p[1], X.p[2]}}, {"quat", {q.w(), q.x(), q.y(), q.z()}}};
}

Result<void> run_peers(const fs::path& environment, const std::string& suite, nlohmann::json job,
                       const TakeAnswer& take) {
  const fs::path python = environment / "bin" / "python";
  if (!is_there(python)) return fail(Errc::bad_input, text(msg::bench_no_python, python.string()));
  const Result<fs::path> script = find_script(suite);
  if (!script) return fail(script.error());
  const ScratchFolder folder;
  const fs::path job_file = folder.path() / "job.json";
  const fs::path answer_file = folder.path() / "answer.jsonl";
  job["folder"] = folder.path().string();
  if (auto written = write_file(job_file, job.dump()); !written) return fail(written.error());
  const Result<int> code =
      run_program(python, {script->string(), job_file.string(), answer_file.string()});
  if (!code) return fail(code.error());
  if (*code != 0) return fail(Errc::system, text(msg::bench_peers_failed, *code));
  const Result<std::string> content = read_file(answer_file);
  if (!content) return fail(content.error());
  std::size_t from = 0;
  for (std::size_t to = content->find('\n'); to != std::string::npos;
       from = to + 1, to = content->find('\n', from)) {
    if (auto taken = take_line(content->substr(from, to - from), take); !taken) {
      return fail(taken.error());
    }
  }
  return {};
}

}  // namespace mjarm::app
