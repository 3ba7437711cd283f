#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <tuple>
#include <utility>

#include "mjarm/core/finite.hpp"
#include "mjarm/core/linear_algebra.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/core/units.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/kinematics/ik_all.hpp"
#include "mjarm/path/path_layers_internal.hpp"
#include "mjarm/path/path_speed_internal.hpp"

namespace mjarm::detail {
namespace {

constexpr double kSame = 1e-3;        // [rad or m] nearer answers are one
constexpr double kSameOfMany = 0.05;  // [rad] likewise for samples of a redundant arm
// What leaves enough room: at these a track is half tight.
constexpr double kRoom = 0.1;  // [rad or m] to a limit, or kRoomShare of the joint's range
constexpr double kRoomShare = 0.05;
constexpr double kSingular = 0.02;   // smallest singular value
constexpr double kClearance = 0.01;  // [m]

/// [rad or m] To the limits of a joint.
double wanted_room(double range) { return std::min(kRoom, kRoomShare * range); }

/// 0.5 where it is kClearance, 1 at contact and more beyond.
double clearance_tightness(double clearance) { return 1 - clearance / (2 * kClearance); }

double largest(const JointVec& d) { return d.cwiseAbs().maxCoeff(); }

IkOptions without_predicate(IkOptions options) {
  options.valid = {};
  options.max_step = kInfinity;
  return options;
}

IkOptions near_only(IkOptions options, double max_step) {
  options.valid = {};
  options.max_step = max_step;
  options.restarts = 0;
  return options;
}

/// `q` with every hinge in the winding within the limits that is nearest to `q_near`; none where a
/// joint has no such winding, or none within its `longest` step.
std::optional<JointVec> placed(const Chain& chain, const JointVec& q, const JointVec& q_near,
                               const JointVec& longest) {
  constexpr double kRounding = 1e-9;  // [rad or m]
  std::array<double, kMaxDof> out;
  for (int i = 0; i < chain.dof; ++i) {
    const auto k = static_cast<std::size_t>(i);
    double& value = out[k];
    value = q[i];
    if (!chain.slide[k]) {
      value += kFullTurn * static_cast<double>(std::llrint((q_near[i] - value) / kFullTurn));
      if (value > chain.upper[k] + kRounding) value -= kFullTurn;
      if (value < chain.lower[k] - kRounding) value += kFullTurn;
    }
    if (!(value >= chain.lower[k] - kRounding && value <= chain.upper[k] + kRounding)) {
      return std::nullopt;
    }
    value = std::clamp(value, chain.lower[k], chain.upper[k]);
    if (std::abs(value - q_near[i]) > longest[i]) return std::nullopt;
  }
  return joint_vec({out.data(), static_cast<std::size_t>(chain.dof)});
}

/// True where two answers differ by whole turns of hinges only.
bool same_place(const Chain& chain, const JointVec& a, const JointVec& b) {
  constexpr double kRounding = 1e-6;  // [rad or m]
  for (int i = 0; i < chain.dof; ++i) {
    const double d = a[i] - b[i];
    const bool slide = chain.slide[static_cast<std::size_t>(i)];
    if (std::abs(slide ? d : std::remainder(d, kFullTurn)) > kRounding) return false;
  }
  return true;
}

/// A number for each way in which the six joints of `q` are whole turns away from those of
/// `q_base`.
std::uint64_t winding(const JointVec& q, const JointVec& q_base) {
  constexpr std::uint64_t kMost = 1U << 10;  // turns, more than limits leave
  std::uint64_t out = 0;
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    const auto turns = static_cast<std::uint64_t>(std::llrint((q[i] - q_base[i]) / kFullTurn));
    out = out * kMost + turns % kMost;
  }
  return out;
}

/// Whether no singular value of J is below `least`: then J J^T less its square (J^T J of fewer than
/// six joints) has a Cholesky factor, which takes a tenth of the time of the values themselves.
bool is_regular(const Jacobian& J, double least) {
  const bool wide = J.cols() >= 6;
  const Eigen::Index n = wide ? 6 : J.cols();
  double L[6][6] = {};  // the product first, then its factor
  for (Eigen::Index k = 0; wide && k < J.cols(); ++k) {
    for (Eigen::Index i = 0; i < 6; ++i) {
      for (Eigen::Index j = 0; j <= i; ++j) L[i][j] += J(i, k) * J(j, k);
    }
  }
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j <= i; ++j) {
      double sum = wide ? L[i][j] : J.col(i).dot(J.col(j));
      if (i == j) sum -= least * least;
      for (Eigen::Index k = 0; k < j; ++k) sum -= L[i][k] * L[j][k];
      if (i == j && !(sum > 0)) return false;
      L[i][j] = i == j ? std::sqrt(sum) : sum / L[j][j];
    }
  }
  return true;
}

/// Sorts `layer` and keeps the best `max`.
void keep_best(Layer& layer, std::size_t max) {
  if (layer.size() < 2) return;
  std::vector<std::size_t> order(layer.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return layer[a].rank < layer[b].rank; });
  if (order.size() > max) order.resize(max);
  Layer sorted;
  sorted.reserve(order.size());
  for (const std::size_t k : order) sorted.push_back(layer[k]);
  layer = std::move(sorted);
}

}  // namespace

IkSolver without_limits(const IkSolver& ik) {
  Arm arm = ik.arm();
  if (arm.limits.lower.maxCoeff() == -kInfinity && arm.limits.upper.minCoeff() == kInfinity) {
    return ik;
  }
  arm.limits.lower.setConstant(-kInfinity);
  arm.limits.upper.setConstant(kInfinity);
  return IkSolver(arm, ik.options());
}

Pose turned_to(const Pose& X_WT, const Eigen::Matrix3d& R_WT, double tol) {
  if (tol == 0) return X_WT;
  const Eigen::Vector3d turn = rotation_log(X_WT.R.transpose() * R_WT);
  const double share = std::min(1.0, tol / std::max(turn.norm(), tol));
  return {X_WT.p, X_WT.R * rotation_exp(share * turn)};
}

bool TrackRank::operator<(const TrackRank& other) const noexcept {
  return std::tie(tightness, posture, start, length) <
         std::tie(other.tightness, other.posture, other.start, other.length);
}

PathLayers::PathLayers(const IkSolver& ik, const PathOptions& options)
    : ik_(ik),
      options_(options),
      all_(ik.with(without_predicate(ik.options()))),
      near_(ik.with(near_only(ik.options(), options.max_step))),
      boundless_(without_limits(ik).with(without_predicate(ik.options()))),
      chain_(ik.chain()) {
  if (options.best_posture) posture_.emplace(ik);
}

double PathLayers::smallest_singular_value(const JointVec& q) const {
  return mjarm::smallest_singular_value(fk_jacobian(chain_, as_span(q)).J_W);
}

/// 0.5 where the smallest singular value is kSingular, 1 at a singularity.
double PathLayers::singular_tightness(const JointVec& q) const {
  constexpr double kRounding = 1 + 1e-6;
  const Jacobian J = fk_jacobian(chain_, as_span(q)).J_W;
  if (is_regular(J, kRounding * 2 * kSingular)) return 0;
  return std::max(0.0, 1 - mjarm::smallest_singular_value(J) / (2 * kSingular));
}

bool PathLayers::fits(const JointVec& q, double tightness) const {
  return within_limits(ik_.arm(), as_span(q)) && level(limit_tightness(q)) <= tightness;
}

bool PathLayers::has_room(const JointVec& q, double tightness) const {
  if (!fits(q, tightness)) return false;
  auto here = room(q);
  if (!here) return false;
  // A tool that may be turned aside passes a singularity best evenly, and so through it.
  if (options_.orientation_tol > 0) here->tightness = clearance_tightness(here->clearance);
  return level(here->tightness) <= tightness;
}

IkSolver PathLayers::within(double tightness) const {
  constexpr double kRounding = 1e-12;
  Arm arm = ik_.arm();
  JointLimits& limits = arm.limits;
  for (Eigen::Index i = 0; i < limits.lower.size(); ++i) {
    const double range = limits.upper[i] - limits.lower[i];
    if (!std::isfinite(range)) continue;
    const double margin = 2 * wanted_room(range) * (1 - tightness) + kRounding * range;
    limits.lower[i] += margin;
    limits.upper[i] -= margin;
  }
  return IkSolver(arm, near_.options());
}

double PathLayers::step_share(const Pose& X_before, const Pose& X_WT, const JointVec& step) const {
  return largest(step.cwiseQuotient(longest_step(X_before, X_WT)));
}

/// 0.5 at kRoom from the nearest limit, 1 on it.
double PathLayers::limit_tightness(const JointVec& q) const {
  double worst = 0;
  const JointLimits& limits = ik_.arm().limits;
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    const double range = limits.upper[i] - limits.lower[i];
    if (!std::isfinite(range)) continue;
    const double room = wanted_room(range);
    const double margin = std::min(q[i] - limits.lower[i], limits.upper[i] - q[i]);
    worst = std::max(worst, 1 - margin / (2 * room));
  }
  return worst;
}

/// None where the configuration is refused.
std::optional<PathLayers::Room> PathLayers::room(const JointVec& q) const {
  if (ik_.options().valid && !ik_.options().valid(as_span(q))) return std::nullopt;
  Room out{.tightness = singular_tightness(q)};
  if (options_.clearance) {
    out.clearance = options_.clearance(as_span(q)).distance;
    if (!(out.clearance >= 0)) return std::nullopt;
    out.tightness = std::max(out.tightness, clearance_tightness(out.clearance));
  }
  return out;
}

/// What is to be said against `q` on a track that begins at a distance of `start` from q_start: for
/// each answer of the track, so that its length does not matter.
double PathLayers::posture_cost(const JointVec& q, const Room& room, double start) const {
  if (!posture_) return 0;
  return posture_->at(as_span(q), room.clearance) +
         posture_->weights().travel * start / std::numbers::pi;
}

double PathLayers::level(double tightness) const {
  constexpr double kLevel = 0.02;
  return std::max(options_.comfort, kLevel * std::ceil(tightness / kLevel));
}

JointVec PathLayers::longest_step(const Pose& X_before, const Pose& X_WT) const {
  const JointVec any = JointVec::Constant(ik_.arm().dof(), options_.max_step);
  if (options_.tool_speed == 0) return any;
  return any.cwiseMin(longest_at_speed(ik_.arm(), X_before, X_WT, options_.tool_speed));
}

TrackRank PathLayers::extended(const TrackNode& node, const JointVec& q, const Room& room,
                               const JointVec& longest) const {
  const JointVec step = q - node.q;
  const double tight =
      std::max({room.tightness, limit_tightness(q), largest(step.cwiseQuotient(longest))});
  const TrackRank& before = node.rank;
  return {std::max(before.tightness, level(tight)),
          before.posture + posture_cost(q, room, before.start), before.start,
          before.length + step.norm()};
}

/// The pose itself, and with a tolerance the tool turned by it in eight directions across its z
/// axis, and both ways about that.
std::vector<Pose> PathLayers::allowed(const Pose& X_WT) const {
  std::vector<Pose> out{X_WT};
  const double tol = options_.orientation_tol;
  if (tol == 0) return out;
  for (int k = 0; k < 8; ++k) {
    const double way = k * kFullTurn / 8;
    const Eigen::Vector3d tilt(tol * std::cos(way), tol * std::sin(way), 0);
    out.push_back({X_WT.p, X_WT.R * rotation_exp(tilt)});
  }
  for (const double way : {tol, -tol}) {
    out.push_back({X_WT.p, X_WT.R * rotation_exp(Eigen::Vector3d(0, 0, way))});
  }
  return out;
}

Layer PathLayers::first(const Pose& X_WT, const JointVec& q_start) const {
  struct Seen {
    JointVec q;
    std::optional<Room> room;
  };
  std::vector<Seen> seen;  // the windings of a branch are one place
  Layer layer;
  double nearest = kInfinity;
  for (const Pose& X : allowed(X_WT)) {
    const auto answers = solve_all(all_, X, as_span(q_start), {.windings = true});
    if (!answers) continue;
    for (const IkSolution& answer : *answers) {
      const double start = largest(answer.q - q_start);
      nearest = std::min(nearest, start);
      const auto known = std::find_if(seen.begin(), seen.end(), [&](const Seen& other) {
        return same_place(ik_.chain(), other.q, answer.q);
      });
      const auto here = known != seen.end() ? known->room : room(answer.q);
      if (known == seen.end()) seen.push_back({answer.q, here});
      if (!here) continue;
      const double tight = level(std::max(here->tightness, limit_tightness(answer.q)));
      layer.push_back({answer.q, -1, {tight, posture_cost(answer.q, *here, start), start, 0}});
    }
  }
  if (options_.keep_start) {
    std::erase_if(layer, [&](const TrackNode& node) { return node.rank.start > nearest + kSame; });
  }
  keep_best(layer, ik_.six_axis() ? kMaxNodes : kMaxFollowed);
  return layer;
}

Layer PathLayers::next(const Pose& X_before, const Pose& X_WT, const Layer& before,
                       std::vector<Branch>& branches) const {
  const JointVec longest = longest_step(X_before, X_WT);
  if (!ik_.six_axis()) {
    Layer layer = follow(X_WT, before, longest);
    keep_best(layer, kMaxFollowed);
    return layer;
  }
  if (branches.empty()) branches = branches_at(X_WT, before.front().q);
  Layer layer = join(before, longest, branches);
  keep_best(layer, kMaxNodes);
  return layer;
}

std::vector<PathLayers::Branch> PathLayers::branches_at(const Pose& X_WT,
                                                        const JointVec& q_seed) const {
  std::vector<Branch> branches;
  for (const Pose& X : allowed(X_WT)) {
    const auto answers = solve_all(boundless_, X, as_span(q_seed));
    if (!answers) continue;
    for (const IkSolution& answer : *answers) branches.push_back({answer.q});
  }
  return branches;
}

/// Closed form of six axes: every branch from every answer before.
Layer PathLayers::join(const Layer& before, const JointVec& longest,
                       std::vector<Branch>& branches) const {
  Layer layer;
  layer.reserve(before.size());
  // By branch: its windings in the new layer, few, and the last one most often.
  std::vector<std::vector<std::pair<std::uint64_t, std::size_t>>> nodes(branches.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    for (std::size_t k = 0; k < branches.size(); ++k) {
      Branch& branch = branches[k];
      const auto q = placed(ik_.chain(), branch.q, before[i].q, longest);
      if (!q) continue;
      if (!branch.looked_at) branch.room = room(*q);
      branch.looked_at = true;
      if (!branch.room) continue;
      const TrackRank rank = extended(before[i], *q, *branch.room, longest);
      const std::uint64_t turns = winding(*q, branch.q);
      const auto known = std::find_if(nodes[k].rbegin(), nodes[k].rend(),
                                      [&](const auto& node) { return node.first == turns; });
      if (known == nodes[k].rend()) {
        nodes[k].emplace_back(turns, layer.size());
        layer.push_back({*q, static_cast<int>(i), rank});
      } else if (rank < layer[known->second].rank) {
        layer[known->second] = {*q, static_cast<int>(i), rank};
      }
    }
  }
  return layer;
}

/// Seeds beside `q` along the motions that leave the tool where it is.
std::vector<JointVec> PathLayers::aside(const JointVec& q) const {
  const double step = std::min(0.15, 0.25 * options_.max_step);  // [rad or m]
  const bool position = ik_.options().task == IkTask::position;
  const int rows = position ? 3 : 6;
  std::vector<JointVec> out;
  if (q.size() <= rows) return out;
  const Eigen::MatrixXd kernel = null_space(fk_jacobian(chain_, as_span(q)).J_W.topRows(rows));
  for (Eigen::Index k = 0; k < kernel.cols(); ++k) {
    const double size = kernel.col(k).cwiseAbs().maxCoeff();
    if (!(size > 0)) continue;
    for (const double way : {step / size, -step / size}) {
      out.push_back(clamp_to_limits(ik_.arm(), as_span(JointVec(q + way * kernel.col(k)))));
    }
  }
  return out;
}

/// Any other arm: from every answer before on to the nearest one, and to either side where that is
/// tight or missing.
Layer PathLayers::follow(const Pose& X_WT, const Layer& before, const JointVec& longest) const {
  const double same = ik_.arm().dof() > 6 ? kSameOfMany : kSame;
  Layer layer;
  const auto add = [&](const Pose& X, std::size_t i, const JointVec& seed, bool aside) {
    const auto answer = near_.solve(X, as_span(seed));
    if (!answer) return kInfinity;
    if (largest((answer->q - before[i].q).cwiseQuotient(longest)) > 1) return kInfinity;
    const auto here = room(answer->q);
    if (!here) return kInfinity;
    const TrackRank rank = extended(before[i], answer->q, *here, longest);
    const auto known = std::find_if(layer.begin(), layer.end(), [&](const TrackNode& node) {
      return largest(node.q - answer->q) < same;
    });
    if (known == layer.end()) {
      layer.push_back({answer->q, static_cast<int>(i), rank, aside});
    } else if (rank < known->rank) {
      *known = {answer->q, static_cast<int>(i), rank, aside};
    }
    return std::max(here->tightness, limit_tightness(answer->q));
  };
  constexpr double kTight = 0.5;
  constexpr std::size_t kAside = 16;  // only the best of them look to the sides
  const std::vector<Pose> poses = allowed(X_WT);
  for (std::size_t i = 0; i < before.size(); ++i) {
    const bool moved = before[i].aside;
    if (add(X_WT, i, before[i].q, moved) < kTight || i >= kAside) continue;
    for (const JointVec& seed : aside(before[i].q)) add(X_WT, i, seed, true);
    for (std::size_t k = 1; k < poses.size(); ++k) add(poses[k], i, before[i].q, moved);
  }
  return layer;
}

std::optional<JointVec> PathLayers::onward(const Pose& X_WT, const JointVec& q) const {
  const auto answer = boundless_.solve(X_WT, as_span(q));
  if (!answer) return std::nullopt;
  return answer->q;
}

}  // namespace mjarm::detail
