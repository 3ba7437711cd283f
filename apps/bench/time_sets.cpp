#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "apps/bench/robots.hpp"
#include "apps/bench/time.hpp"
#include "mjarm/core/file.hpp"
#include "mjarm/core/json.hpp"
#include "mjarm/core/messages/json.hpp"
#include "mjarm/trajectory/point_to_point.hpp"

namespace mjarm::app {
namespace {

namespace fs = std::filesystem;
constexpr std::uint64_t kTimeSeed = 1;
constexpr int kMoves = 500;
constexpr int kRangeMoves = 10'000;
constexpr int kTimedPaths = 20;
constexpr int kWaypoints = 10;
constexpr int kLapPoints = 200;
constexpr std::size_t kLargest = 1 << 28;  // [bytes] of a file

/// One in each direction of every joint, uniform.
JointVec random_vec(Rng& rng, const JointVec& half) {
  JointVec out(half.size());
  for (Eigen::Index i = 0; i < out.size(); ++i) out[i] = rng.uniform(-half[i], half[i]);
  return out;
}

/// Moves by up to half a turn of each joint; one in ten is a very short one.
std::vector<TimeCase> make_moves(const JointLimits& limits, bool at_rest) {
  Rng rng(kTimeSeed, at_rest ? 0 : 1);
  const JointVec turn = JointVec::Constant(limits.velocity.size(), std::numbers::pi);
  // An acceleration from which the joint can still brake within its velocity limit.
  const JointVec a =
      0.3 * limits.acceleration.cwiseMin(limits.velocity.cwiseProduct(limits.jerk).cwiseSqrt());
  std::vector<TimeCase> cases;
  for (int i = 0; i < kMoves; ++i) {
    TimeCase entry{std::to_string(i), JointState::at_rest(random_vec(rng, turn)), {}, {}};
    const double share = i % 10 == 9 ? 0.01 : 1;
    entry.end = JointState::at_rest(entry.start.q + share * random_vec(rng, turn));
    if (!at_rest) {
      entry.start.v = random_vec(rng, 0.5 * limits.velocity);
      entry.start.a = random_vec(rng, a);
      entry.end.v = random_vec(rng, 0.5 * limits.velocity);
    }
    cases.push_back(std::move(entry));
  }
  return cases;
}

/// Random waypoints, 0.3 to 1.5 rad (or m) apart.
std::vector<TimeCase> make_paths(Eigen::Index dof) {
  Rng rng(kTimeSeed, 2);
  const JointVec one = JointVec::Constant(dof, 1);
  std::vector<TimeCase> cases;
  for (int i = 0; i < kTimedPaths; ++i) {
    TimeCase entry{std::to_string(i), {}, {}, {random_vec(rng, one)}};
    while (entry.waypoints.size() < kWaypoints) {
      const JointVec way = random_vec(rng, one).normalized();
      entry.waypoints.push_back(entry.waypoints.back() + rng.uniform(0.3, 1.5) * way);
    }
    cases.push_back(std::move(entry));
  }
  return cases;
}

/// A lap around an ellipse in joint space.
std::vector<TimeCase> make_lap(Eigen::Index dof) {
  Rng rng(kTimeSeed, 3);
  const JointVec one = JointVec::Constant(dof, 1);
  const JointVec u = random_vec(rng, one).normalized(), v = random_vec(rng, one).normalized();
  TimeCase entry{"0", {}, {}, {}};
  for (int i = 0; i < kLapPoints; ++i) {
    const double angle = 2 * std::numbers::pi * i / (kLapPoints - 1);
    entry.waypoints.push_back(std::cos(angle) * u + 0.5 * std::sin(angle) * v);
  }
  return {std::move(entry)};
}

/// What full braking of a joint that moves up comes to: the way up, and the deceleration there.
struct Braked {
  double way = 0, deceleration = 0;
};

Braked braked(double v, double a, double a_max, double jerk) {
  const double up = std::max(a, 0.0);
  if (v + up * up / (2 * jerk) <= 0) return {};
  const double stop = (a + std::sqrt(a * a + 2 * jerk * v)) / jerk, ramp = (a + a_max) / jerk;
  const double t = std::min(stop, ramp);
  const double way = t * (v + t * (a / 2 - t * jerk / 6));
  if (stop <= ramp) return {std::max(way, 0.0), jerk * stop - a};
  const double left = v + t * (a - t * jerk / 2);
  return {way + left * left / (2 * a_max), a_max};
}

/// Whether a joint that brakes fully, then eases off, stays between both ends: with a deceleration
/// d in the end it falls back by 2 d^3 / (3 jerk^2).
bool brakes_within(double v, double a, double a_max, double jerk, double below, double above) {
  const Braked end = braked(v, a, a_max, jerk);
  const double back = 2 * std::pow(end.deceleration, 3) / (3 * jerk * jerk);
  return end.way < above && end.way - back > -below;
}

/// A state near one end of each joint's range that can stay in it (`sign` 1) or can have come from
/// there (-1). Each try is slower than the one before, so a range that is too narrow ends in rest.
JointState state_near_limits(Rng& rng, const JointLimits& limits, int sign) {
  constexpr double kDecades = 4;  // of the distance from the end, up to 1 rad or m
  JointState x = JointState::at_rest(JointVec::Zero(limits.velocity.size()));
  for (Eigen::Index i = 0; i < x.q.size(); ++i) {
    const double v_max = limits.velocity[i], a_max = limits.acceleration[i], j = limits.jerk[i];
    const double range = limits.upper[i] - limits.lower[i];
    for (double fast = 1; fast > 0; fast = fast > 1e-3 ? 0.95 * fast : 0) {
      const double away = std::min(std::pow(10, -kDecades * rng.uniform()), 0.5 * range);
      x.q[i] = rng.uniform() < 0.5 ? limits.lower[i] + away : limits.upper[i] - away;
      x.v[i] = fast * rng.uniform(-v_max, v_max);
      const double most = std::min(a_max, std::sqrt(2 * j * (v_max - std::abs(x.v[i]))));
      x.a[i] = 0.999 * fast * rng.uniform(-most, most);
      const double v = sign * x.v[i], below = x.q[i] - limits.lower[i];
      const double above = limits.upper[i] - x.q[i];
      if (brakes_within(v, x.a[i], a_max, j, below, above) &&
          brakes_within(-v, -x.a[i], a_max, j, above, below)) {
        break;
      }
      x.v[i] = x.a[i] = 0;
    }
  }
  return x;
}

/// Moves between states near the ends of the joints' ranges. Compared with the fastest motions
/// that know no range, whether those stay in it or not.
TimeSet make_range_set(JointLimits limits) {
  constexpr double kFar = 2 * std::numbers::pi;  // [rad] of joints that turn without end
  limits.lower = limits.lower.cwiseMax(-kFar);
  limits.upper = limits.upper.cwiseMin(kFar);
  JointLimits open = limits;
  open.lower = open.upper = {};
  TimeSet set{"range", TimeProblem::p2p, limits, {}};
  Rng rng(kTimeSeed, 4);
  for (int i = 0; i < kRangeMoves; ++i) {
    TimeCase entry{std::to_string(i),
                   state_near_limits(rng, limits, 1),
                   state_near_limits(rng, limits, -1),
                   {}};
    const auto fastest = PointToPoint::solve(entry.start, entry.end, open);
    set.best.push_back(fastest ? fastest->duration() : 0);
    set.cases.push_back(std::move(entry));
  }
  return set;
}

std::vector<TimeSet> make_sets(const JointLimits& arm) {
  const JointLimits limits = unbounded(arm.velocity, arm.acceleration, arm.jerk);
  const Eigen::Index dof = limits.velocity.size();
  const std::vector<TimeCase> paths = make_paths(dof);
  return {{"rest", TimeProblem::p2p, limits, make_moves(limits, true)},
          {"state", TimeProblem::p2p, limits, make_moves(limits, false)},
          make_range_set(arm),
          {"path_va", TimeProblem::path_va, limits, paths},
          {"path_vaj", TimeProblem::path_vaj, limits, paths},
          {"via_vaj", TimeProblem::via_vaj, limits, paths},
          {"ellipse", TimeProblem::path_va, limits, make_lap(dof)}};
}

Result<TimeCases> read_motions(const fs::path& file, TimeProblem problem) {
  const Result<std::string> content = read_file(file, kLargest);
  if (!content) return fail(content.error());
  Result<TimeCases> cases = read_time_cases(*content, problem);
  if (!cases) return fail(cases.error().code, file.string() + ": " + cases.error().what);
  if (cases->cases.empty()) return fail(no_cases(file));
  return cases;
}

/// Member `problem` of `known`, as `best_known.json` holds it; empty unless it has all cases.
std::vector<double> best_of(const JsonValue& known, const std::string& file, const char* problem,
                            const std::vector<TimeCase>& cases) {
  std::vector<double> best;
  const JsonValue* durations = known.find(file);
  if (durations != nullptr) durations = durations->find(problem);
  for (const TimeCase& entry : cases) {
    const JsonValue* const duration = durations != nullptr ? durations->find(entry.id) : nullptr;
    if (duration == nullptr || !(duration->number() > 0)) return {};
    best.push_back(duration->number());
  }
  return best;
}

Result<JsonObject> read_best_known(const fs::path& folder) {
  const fs::path file = folder / "best_known.json";
  if (!is_there(file)) return JsonObject();
  const Result<std::string> content = read_file(file, kLargest);
  if (!content) return fail(content.error());
  Result<JsonObject> known = parse_json_object(*content);
  if (!known) return fail(known.error().code, file.string() + ": " + known.error().what);
  for (const JsonValue& cases : **known) {
    if (cases.is_object()) continue;
    return fail(Errc::bad_input, file.string() + ": \"" + std::string(cases.key()) +
                                     "\": " + text(msg::json_no_object));
  }
  return known;
}

bool rests(const TimeCase& entry) {
  return entry.start.v.isZero(0) && entry.start.a.isZero(0) && entry.end.v.isZero(0) &&
         entry.end.a.isZero(0);
}

/// Point to point apart by whether it goes from rest to rest.
Result<void> read_moves(const fs::path& file, const JsonValue& known, std::vector<TimeSet>& sets) {
  const Result<TimeCases> all = read_motions(file, TimeProblem::p2p);
  if (!all) return fail(all.error());
  for (const bool rest : {true, false}) {
    TimeSet set{rest ? "rest" : "state", TimeProblem::p2p, all->limits, {}};
    std::copy_if(all->cases.begin(), all->cases.end(), std::back_inserter(set.cases),
                 [&](const TimeCase& entry) { return rests(entry) == rest; });
    set.best = best_of(known, file.stem().string(), "p2p_vaj", set.cases);
    if (!set.cases.empty()) sets.push_back(std::move(set));
  }
  sets.push_back(make_range_set(all->limits));
  return {};
}

Result<void> read_timed_paths(const fs::path& file, const JsonValue& known,
                              std::vector<TimeSet>& sets) {
  struct TimedKind {
    const char *name, *best;
    TimeProblem problem;
  };
  std::vector<TimedKind> kinds{{"path_va", "spline_va", TimeProblem::path_va},
                               {"path_vaj", "spline_va", TimeProblem::path_vaj},
                               {"via_vaj", "via_vaj", TimeProblem::via_vaj}};
  if (file.stem().string().ends_with("_ellipse")) {
    kinds = {{"ellipse", "spline_va", TimeProblem::path_va}};
  }
  if (!is_there(file)) return {};
  const Result<TimeCases> all = read_motions(file, TimeProblem::path_va);
  if (!all) return fail(all.error());
  for (const TimedKind& kind : kinds) {
    sets.push_back({kind.name, kind.problem, all->limits, all->cases,
                    best_of(known, file.stem().string(), kind.best, all->cases)});
  }
  return {};
}

Result<std::vector<TimeSet>> read_time_sets(const std::string& name, const fs::path& folder) {
  const Result<JsonObject> known = read_best_known(folder);
  if (!known) return fail(known.error());
  std::vector<TimeSet> sets;
  Result<void> done = read_moves(folder / (name + "_p2p.json"), **known, sets);
  if (done) done = read_timed_paths(folder / (name + "_paths.json"), **known, sets);
  if (done) done = read_timed_paths(folder / (name + "_ellipse.json"), **known, sets);
  if (!done) return fail(done.error());
  return sets;
}

}  // namespace

Result<std::vector<TimeSet>> load_time_sets(const std::string& robot, const fs::path& folder) {
  if (!folder.empty()) return read_time_sets(robot, folder);
  const Result<Robot> loaded = load_robot({.robot = robot});
  if (!loaded) return fail(loaded.error());
  return make_sets(loaded->arm.limits);
}

}  // namespace mjarm::app
