#include "apps/mjarm/commands/policy_run.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "apps/mjarm/commands/train_outcome.hpp"
#include "apps/mjarm/messages/train.hpp"
#include "mjarm/core/file.hpp"
#include "mjarm/core/language_scope.hpp"
#include "mjarm/core/log.hpp"
#include "mjarm/core/messages/core.hpp"
#include "mjarm/core/number.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/core/output_folder.hpp"
#include "mjarm/core/progress.hpp"
#include "mjarm/core/stopwatch.hpp"
#include "mjarm/render/fonts.hpp"
#include "mjarm/rl/reach_env.hpp"
#include "mjarm/session/policy_player.hpp"
#include "mjarm/session/run_output.hpp"
#include "mjarm/session/run_show.hpp"

namespace mjarm::app {
namespace {

using session::PolicyPlayer;

/// What was measured of the episodes that were shown.
struct Played {
  std::string csv;
  std::vector<render::PlotLine> distances;  ///< [mm] over time [s], one an episode
  double max_joint_step = 0;                ///< [rad]
  bool ended_by_user = false;
};

std::string heading(const Arm& arm) {
  std::string line = "episode,time [s]";
  for (const ArmJoint& joint : arm.joints) line += "," + joint.name + " [rad]";
  return line + ",x [m],y [m],z [m],goal x [m],goal y [m],goal z [m],distance [m]\n";
}

void add_row(int episode, double time, const JointVec& q, const PolicyPlayer& player,
             const Eigen::Vector3d& p_WT, Played& played) {
  const Eigen::Vector3d goal = player.goal();
  const double distance = (goal - p_WT).norm();
  played.csv += std::to_string(episode) + "," + number(time);
  for (const double value : q) played.csv += "," + number(value);
  for (const Eigen::Vector3d& p : {p_WT, goal}) {
    for (const double value : p) played.csv += "," + number(value);
  }
  played.csv += "," + number(distance) + "\n";
  played.distances.back().x.push_back(time);
  played.distances.back().y.push_back(1e3 * distance);
}

/// One episode, until its end or that of the window.
Result<void> play_episode(int episode, PolicyPlayer& player, session::RunShow& show,
                          Played& played) {
  if (auto begun = player.begin_episode(); !begun) return begun;
  Sim& sim = player.sim();
  show.begin_goal(sim, player.goal());
  played.distances.push_back({.label = std::to_string(episode)});
  const double start = sim.time();
  JointVec q = sim.arm_state(player.arm()).q;
  add_row(episode, 0, q, player, player.tool().p, played);
  for (;;) {
    const Result<bool> stepped = player.step();
    if (!stepped) return fail(stepped.error());
    if (!*stepped) return {};
    const JointVec now = sim.arm_state(player.arm()).q;
    played.max_joint_step = std::max(played.max_joint_step, (now - q).cwiseAbs().maxCoeff());
    q = now;
    const Eigen::Vector3d p_WT = player.tool().p;
    add_row(episode, sim.time() - start, q, player, p_WT, played);
    if (!show.step(sim, p_WT)) {
      played.ended_by_user = true;
      return {};
    }
  }
}

/// Shows the first goals; with a window, more of them until it is closed.
Result<Played> play(PolicyPlayer& player, const PolicyTrial& trial, session::RunShow& show) {
  Played played;
  played.csv = heading(player.arm());
  for (int i = 0; i < trial.shown && !played.ended_by_user; ++i) {
    if (auto done = play_episode(i + 1, player, show, played); !done) {
      return fail(std::move(done.error()));
    }
  }
  show.set_filming(false);
  Played more;
  while (show.has_window() && !played.ended_by_user && !more.ended_by_user) {
    more = {};
    if (auto done = play_episode(0, player, show, more); !done) {
      return fail(std::move(done.error()));
    }
  }
  return played;
}

render::Plot plot_of(const std::string& title, const rl::Evaluation& evaluation, Played& played) {
  const LanguageScope drawn(render::picture_language());
  render::PlotPanel over_time{.title = text(msg::train_plot_over_time),
                              .x_label = text(msg::train_plot_time),
                              .y_label = text(msg::train_plot_mm)};
  over_time.lines = std::move(played.distances);
  over_time.y_from_zero = true;
  return {.title = title,
          .note = in_words(evaluation),
          .panels = {std::move(over_time), distance_panel(evaluation)}};
}

Report report_of(const PolicyTrial& trial, const Model& model, const rl::ReachOptions& task,
                 const rl::Evaluation& evaluation, const Played& played) {
  Report report;
  report.name = trial.name;
  report.model = model.name();
  report.steps = std::lround(evaluation.steps * evaluation.episodes * task.frame_skip);
  report.duration = static_cast<double>(report.steps) * model.timestep();
  report.done = evaluation.within_2cm;
  report.static_error = PoseError{evaluation.max, evaluation.turn_p95};
  report.max_joint_step = played.max_joint_step;
  report.facts = facts_of(evaluation);
  report.ok = evaluation.within_2cm >= trial.least_success;
  if (!report.ok) {
    report.reason = "goals_missed";
    report.detail = text(msg::train_missed, missed_of(evaluation), evaluation.episodes,
                         100 * trial.least_success, in_words(evaluation));
  }
  return report;
}

/// The evaluation, with a progress bar; ended by interrupts.
Result<rl::Evaluation> judged(const Model& model, const rl::TrainedPolicy& loaded,
                              const PolicyTrial& trial) {
  rl::EvaluateOptions how{.episodes = trial.episodes, .seed = trial.seed, .stop = interrupted};
  std::optional<Progress> progress;
  std::int64_t told = 0;
  how.progress = [&](std::int64_t done, std::int64_t max) {
    if (!progress) progress.emplace(text(msg::train_judging), static_cast<std::uint64_t>(max));
    progress->advance(static_cast<std::uint64_t>(done - std::exchange(told, done)));
  };
  return rl::evaluate(model, loaded.task, loaded.policy, how);
}

}  // namespace

Result<PolicyOutcome> run_policy(const rl::TrainedPolicy& loaded, const PolicyTrial& trial,
                                 const session::StageOptions& options) {
  const Result<Model> model = rl::reach_model(loaded.task);
  if (!model) return fail(model.error());
  // What does not fit the task is refused before a folder is made for it.
  Result<PolicyPlayer> player =
      PolicyPlayer::create(*model, loaded.task, loaded.policy, trial.seed);
  if (!player) {
    return fail(player.error().code,
                text(msg::core_at_place, loaded.file.string(), player.error().what));
  }
  const Result<OutputFolder> folder = OutputFolder::open(options.out, options.replace);
  if (!folder) return fail(folder.error());
  const Stopwatch watch;
  auto evaluation = judged(*model, loaded, trial);
  if (!evaluation) {
    if (interrupted()) return fail(evaluation.error());
    return fail(evaluation.error().code,
                text(msg::core_at_place, loaded.file.string(), evaluation.error().what));
  }
  const double seconds = 1e-6 * watch.us();
  log_info(in_words(*evaluation));

  Result<session::RunShow> show =
      session::RunShow::open(*model, "mjarm " + trial.name, options.headless);
  if (!show) return fail(std::move(show.error()));
  show->set_pen(render::Pen::down);
  if (options.video) {
    auto filming = show->film(*model, options.out / session::kVideoFile, {});
    if (!filming) return fail(std::move(filming.error()));
  }
  if (options.record) show->record(player->sim(), &player->arm());
  Result<Played> played = play(*player, trial, *show);
  if (!played) return fail(std::move(played.error()));
  Report report = report_of(trial, *model, loaded.task, *evaluation, *played);
  if (options.timing) report.rtf = report.duration / seconds;
  const session::RunOutput output{
      report, plot_of(trial.name, *evaluation, *played), show->overlay(), {}, show->is_filming()};
  auto written =
      write_file(options.out / "log.csv", played->csv)
          .and_then([&] {
            return session::write_output(options.out, *model, player->sim().snapshot(), output);
          })
          .and_then([&] {
            return show->end_record(*model, player->sim().snapshot(), output, options.record);
          })
          .and_then([&] { return show->end_film(); });
  if (!written) return fail(std::move(written.error()));
  if (!show->has_window()) folder->made();
  return PolicyOutcome{std::move(report), std::move(*evaluation)};
}

}  // namespace mjarm::app
