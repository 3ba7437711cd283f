#include "mjarm/kinematics/fk.hpp"

#include <memory>
#include <optional>

#include "apps/mjarm/cli/batch.hpp"
#include "apps/mjarm/cli/command.hpp"
#include "apps/mjarm/cli/options.hpp"
#include "apps/mjarm/cli/robot.hpp"
#include "apps/mjarm/cli/usage.hpp"
#include "apps/mjarm/messages/app.hpp"
#include "mjarm/core/json.hpp"
#include "mjarm/core/json_writer.hpp"
#include "mjarm/model/joint_values.hpp"

namespace mjarm::app {
namespace {

struct FkOptions {
  RobotChoice robot{.looks = false};
  BatchOptions batch;
  std::string q;
};

/// `{"pos":[3],"quat":[4]}`
void append_pose(std::string& out, const Pose& X_WT) {
  JsonWriter(out).object().pose_members(X_WT).end_object();
}

Result<int> answer_one(const Arm& arm, const FkOptions& options) {
  const Result<std::vector<double>> q = parse_joints("--q", options.q, arm);
  if (!q) return fail(q.error());
  std::string line;
  append_pose(line, fk(arm, *q));
  if (Result<void> written = write_answer(options.batch, line); !written) {
    return fail(std::move(written.error()));
  }
  return 0;
}

Result<int> run(const FkOptions& options) {
  if (Result<void> fine = one_source(options.batch.in, options.q, "--q"); !fine) {
    return fail(std::move(fine.error()));
  }
  const Result<Robot> robot = load_robot(options.robot);
  if (!robot) return fail(robot.error());
  const Arm& arm = robot->arm;
  if (options.batch.in.empty()) return answer_one(arm, options);
  const auto answer = [&arm](std::string_view request,
                             std::string& out) -> Result<std::optional<std::string>> {
    const Result<JsonObject> object = parse_json_object(request);
    if (!object) return fail(object.error());
    constexpr std::string_view kKnown[] = {"q"};
    if (Result<void> fine = check_keys(**object, kKnown); !fine)
      return fail(std::move(fine.error()));
    const Result<std::vector<double>> q =
        number_list(**object, "q", static_cast<std::size_t>(arm.dof()));
    if (!q) return fail(q.error());
    if (Result<void> fine = check_joint_units(*q, arm); !fine)
      return fail(in_option("q", fine.error()));
    append_pose(out, fk(arm, *q));
    return std::nullopt;
  };
  const Result<BatchResult> done = run_batch(options.batch, text(msg::app_fk_progress), answer);
  if (!done) return fail(done.error());
  return 0;
}

Run setup(CLI::App& app) {
  auto options = std::make_shared<FkOptions>();
  add_robot_options(app, options->robot);
  add_option(app, "--q", options->q, msg::app_option_q, "Q1,Q2,...");
  add_batch_options(app, options->batch);
  return [options] { return run(*options); };
}

}  // namespace

Command fk_command() { return {"fk", msg::app_fk_summary, msg::app_fk_examples, setup}; }

}  // namespace mjarm::app
