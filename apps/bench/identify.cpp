#include "apps/bench/identify.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "apps/bench/messages/bench.hpp"
#include "apps/bench/robust_lap.hpp"
#include "apps/mjarm/cli/table.hpp"
#include "apps/mjarm/cli/usage.hpp"
#include "mjarm/collision/exact.hpp"
#include "mjarm/core/log.hpp"
#include "mjarm/core/messages/program.hpp"
#include "mjarm/core/rng.hpp"
#include "mjarm/identification/excitation.hpp"
#include "mjarm/identification/identify.hpp"
#include "mjarm/model/moved_bodies.hpp"
#include "mjarm/model/wrong_model.hpp"
#include "mjarm/path/clearance.hpp"

namespace mjarm::app {
namespace {

/// Errors of one world, each over the truth.
struct IdentifiedWorld {
  double mass = 0;          ///< of the payload
  double center = 0;        ///< of its centre of mass, over its distance from the tool
  double friction = 0;      ///< of the worst joint
  double links = 0;         ///< rms torque of the links in random states
  double links_before = 0;  ///< the same of the model
  double mass_alone = 0, center_alone = 0;  ///< from the one log with the payload
  double mass_errors = 0;                   ///< error of the mass in standard errors
  double without = 0, told = 0, found = 0;  ///< [m] of laps that know no payload, 2 kg, the found
};

Result<Trajectory> excitation_of(const Robot& bare) {
  constexpr double kClear = 0.02;  // [m]
  const ExactChecker checker(bare.model, bare.arm);
  const ClearanceCheck clearance = clearance_check(checker);
  ExcitationOptions options;
  options.valid = [&](std::span<const double> q) { return clearance(q).distance > kClear; };
  return excitation(bare.model, bare.arm, bare.arm.home, options);
}

/// What the encoders and the commands of one run are.
Result<JointLog> drive_log(const Robot& known, const Robot& bare, std::span<const JointVec> q,
                           bool loaded, std::uint64_t seed, std::uint64_t world) {
  JointLog log{known.model.timestep(), {}, {}};
  const WrongDrive drive{
      known, bare, q, ControlMode::robust, {.robust = {.late_steps = kRobustLate}}, loaded};
  const auto driven = drive_references(drive, seed, world, [&](const Sim&, const WrongStep& step) {
    log.q.push_back(step.q);
    log.torque.push_back(step.torque);
  });
  if (!driven) return fail(driven.error());
  return log;
}

/// rms torque of base parameters that differ by `off`, over that of `truth`.
double share_of_torque(const Robot& bare, const BaseColumns& base, const Eigen::VectorXd& off,
                       const Eigen::VectorXd& truth) {
  constexpr int kStates = 200;
  Rng rng(11);
  double squares = 0, all = 0;
  for (int i = 0; i < kStates; ++i) {
    JointState state = JointState::at_rest(bare.arm.home);
    for (int j = 0; j < bare.arm.dof(); ++j) {
      state.q[j] += rng.normal();
      state.v[j] = rng.normal();
      state.a[j] = rng.normal();
    }
    const Eigen::MatrixXd W =
        regressor_at(bare.arm, gravity_of(bare.model), state).links(Eigen::all, base.kept);
    squares += (W * off).squaredNorm();
    all += (W * truth).squaredNorm();
  }
  return std::sqrt(squares / all);
}

/// Of the centre of mass, over its distance from the tool.
double center_error(const PayloadEstimate& found, const Payload& truth) {
  return (found.payload().center - truth.center).norm() / truth.center.norm();
}

IdentifiedWorld compare(const Identification& found, const WrongArm& truth, const Robot& bare) {
  IdentifiedWorld out;
  const PayloadEstimate& payload = *found.payload;
  out.mass = std::abs(payload.mass.value / truth.payload.mass - 1);
  out.mass_errors = (payload.mass.value - truth.payload.mass) / payload.mass.error;
  out.center = center_error(payload, truth.payload);
  for (int j = 0; j < bare.arm.dof(); ++j) {
    const double friction = ModelErrors{}.friction * bare.arm.limits.torque[j];
    const double share = found.joints[static_cast<std::size_t>(j)].friction.value / friction;
    out.friction = std::max(out.friction, std::abs(share - 1));
  }
  const Eigen::VectorXd links = found.base.of(parameters_of(truth.empty, bare.arm));
  Eigen::VectorXd off(links.size());
  for (Eigen::Index i = 0; i < off.size(); ++i) {
    off[i] = found.links[static_cast<std::size_t>(i)].value - links[i];
  }
  out.links = share_of_torque(bare, found.base, off, links);
  out.links_before = share_of_torque(bare, found.base, found.model_links - links, links);
  return out;
}

/// Farthest from the ellipse, by computed torque that knows this payload.
Result<double> lap_error(RobustLaps laps, const Robot& bare, const Payload& payload,
                         std::uint64_t seed, std::uint64_t world) {
  const Result<Model> model = with_payload(bare.model, bare.arm.tip, payload);
  if (!model) return fail(model.error());
  laps.robot = with_torque_drives({*model, bare.arm});
  const auto done = drive_wrong_world(laps, bare, ControlMode::computed_torque,
                                      {.robust = {.late_steps = kRobustLate}}, seed, world);
  if (!done) return fail(done.error());
  return done->max;
}

Result<IdentifiedWorld> identify_world(const RobustLaps& laps, const Robot& bare,
                                       std::span<const JointVec> q, std::uint64_t seed,
                                       std::uint64_t world) {
  const Result<WrongArm> truth = draw_wrong_arm(bare, seed, world);
  if (!truth) return fail(truth.error());
  const Robot known = with_torque_drives(bare);
  const Result<JointLog> empty = drive_log(known, bare, q, false, seed, world);
  if (!empty) return fail(empty.error());
  const Result<JointLog> loaded = drive_log(laps.robot, bare, q, true, seed, world);
  if (!loaded) return fail(loaded.error());
  const auto found = identify(known, {.log = &*loaded, .empty = &*empty});
  if (!found) return fail(found.error());
  const auto alone = identify(known, {.log = &*loaded});
  if (!alone) return fail(alone.error());
  IdentifiedWorld out = compare(*found, *truth, bare);
  out.mass_alone = std::abs(alone->payload->mass.value / truth->payload.mass - 1);
  out.center_alone = center_error(*alone->payload, truth->payload);
  const std::pair<Payload, double*> cases[] = {
      {{}, &out.without}, {{.mass = 2}, &out.told}, {found->payload->payload(), &out.found}};
  for (const auto& [payload, error] : cases) {
    const Result<double> farthest = lap_error(laps, bare, payload, seed, world);
    if (!farthest) return fail(farthest.error());
    *error = *farthest;
  }
  return out;
}

Result<std::vector<IdentifiedWorld>> identify_worlds(const Robot& bare, int worlds, int seed) {
  const Result<RobustLaps> laps = robust_laps(bare);
  if (!laps) return fail(laps.error());
  const Result<Trajectory> motion = excitation_of(bare);
  if (!motion) return fail(motion.error());
  const double h = bare.model.timestep();
  std::vector<JointVec> q = warm_up_at(motion->at(0).q, h);
  const auto steps = static_cast<int>(motion->duration() / h);
  for (int i = 0; i < steps; ++i) q.push_back(motion->at(i * h).q);
  Progress progress(text(msg::control_suite_progress), static_cast<std::uint64_t>(worlds));
  std::vector<IdentifiedWorld> out;
  for (int i = 0; i < worlds; ++i) {
    if (interrupted()) return fail(stopped());
    auto one = identify_world(*laps, bare, q, static_cast<std::uint64_t>(seed),
                              static_cast<std::uint64_t>(i));
    if (!one) return fail(std::move(one.error()));
    out.push_back(*one);
    progress.advance();
  }
  return out;
}

struct Column {
  const char* name;  ///< in JSON
  std::string title;
  double IdentifiedWorld::* value;
  double factor;
};
std::vector<Column> columns() {
  return {
      {"mass", text(msg::control_suite_id_mass), &IdentifiedWorld::mass, 100},
      {"com", text(msg::control_suite_id_center), &IdentifiedWorld::center, 100},
      {"friction", text(msg::control_suite_id_friction), &IdentifiedWorld::friction, 100},
      {"links", text(msg::control_suite_id_links), &IdentifiedWorld::links, 100},
      {"mass_alone", text(msg::control_suite_id_mass_alone), &IdentifiedWorld::mass_alone, 100},
      {"com_alone", text(msg::control_suite_id_center_alone), &IdentifiedWorld::center_alone, 100},
      {"links_model", text(msg::control_suite_id_model), &IdentifiedWorld::links_before, 100},
      {"lap_without", text(msg::control_suite_id_without), &IdentifiedWorld::without, 1e3},
      {"lap_told", text(msg::control_suite_id_told), &IdentifiedWorld::told, 1e3},
      {"lap_found", text(msg::control_suite_id_found), &IdentifiedWorld::found, 1e3}};
}

std::string identify_table(const std::vector<IdentifiedWorld>& worlds) {
  std::vector<std::vector<std::string>> rows{
      {""}, {text(msg::control_suite_id_mean)}, {text(msg::control_suite_id_worst)}};
  for (const Column& column : columns()) {
    double sum = 0, most = 0;
    for (const IdentifiedWorld& world : worlds) {
      sum += world.*column.value;
      most = std::max(most, world.*column.value);
    }
    rows[0].push_back(column.title);
    rows[1].push_back(
        fmt::format("{:.2f}", column.factor * sum / static_cast<double>(worlds.size())));
    rows[2].push_back(fmt::format("{:.2f}", column.factor * most));
  }
  return markdown_table(rows);
}

JsonDoc identify_doc(const std::vector<IdentifiedWorld>& worlds) {
  std::vector<JsonDoc> docs;
  for (const IdentifiedWorld& world : worlds) {
    JsonDoc doc{{"mass_errors", world.mass_errors}};
    for (const Column& column : columns()) doc.set(column.name, world.*column.value);
    docs.push_back(std::move(doc));
  }
  return docs;
}

}  // namespace

Result<int> run_identify(const ReportOptions& report, const RobustWords& words,
                         const Robot& robot) {
  constexpr int kMostWorlds = 10'000, kLastSeed = 1'000'000;
  const Result<int> worlds = parse_count("--worlds", words.worlds, kMostWorlds);
  if (!worlds) return fail(worlds.error());
  const Result<int> seed = parse_count("--seed", words.seed, kLastSeed);
  if (!seed) return fail(seed.error());
  const auto found = identify_worlds(robot, *worlds, *seed);
  if (!found) return fail(found.error());
  const JsonDoc doc{{"model", robot.model.name()}, {"identify", identify_doc(*found)}};
  print_robot(report, robot, identify_table(*found), doc);
  return 0;
}

}  // namespace mjarm::app
