#include <algorithm>
#include <cmath>

#include "mjarm/kinematics/fk.hpp"
#include "mjarm/planning/path_keeper_internal.hpp"
#include "mjarm/planning/search_internal.hpp"

namespace mjarm::detail {
namespace {

constexpr int kMaxSteps = 16;         // of Newton's method
constexpr double kDamping = 1e-6;     // of its normal equations
constexpr int kMaxParts = 4096;       // of an edge that are looked at
constexpr double kFinestStep = 1e-4;  // [rad or m, L2] narrower parts of an edge are not cut again
constexpr double kLeastWay = 0.1;     // share of a step by which the end must come nearer
constexpr double kMaxWay = 2;         // a step that is put back may be so many times as long
constexpr double kRounding = 1e-9;    // [m or rad] that may be lacking
constexpr int kMaxRows = 16;          // of both regions, eight each

RegionRoom smaller(const RegionRoom& a, const RegionRoom& b) {
  return {std::min(a.place, b.place), std::min(a.turn, b.turn)};
}

/// A region on one edge, part by part.
struct Watched {
  const RegionProof* proof;  // null: none
  EdgeMotion motion = {};
  SeenTool from = {}, to = {};  // the ends of the part

  Watched(const RegionProof* region, std::span<const double> q0, std::span<const double> q1,
          const Pose& X_WT)
      : proof(region) {
    if (region == nullptr) return;
    motion = region->motion(q0, q1);
    from = region->see(X_WT);
  }
  /// @param X_WT  at the end of the part.
  /// @param part  share of the edge.
  [[nodiscard]] RegionRoom room(const Pose& X_WT, double part) {
    if (proof == nullptr) return {};
    to = proof->see(X_WT);
    return proof->room(from, to, motion, part);
  }
  void go_on() { from = to; }
};

}  // namespace

std::optional<PathKeeper> PathKeeper::create(const PlanOptions& options, const Arm& arm) {
  if (!options.tilt && !options.within) return std::nullopt;
  PathKeeper out(arm);
  if (options.tilt) out.tilt_.emplace(as_region(*options.tilt), arm);
  if (options.within) out.within_.emplace(*options.within, arm);
  for (const auto& proof : {out.tilt_, out.within_}) {
    if (proof) out.range_ = std::min(out.range_, proof->range());
  }
  return out;
}

bool PathKeeper::keeps(std::span<const double> q) const { return look(q, q).kept; }

bool PathKeeper::project(std::span<double> q) const {
  std::vector<JointVec> rows;
  std::vector<double> needs;
  for (int step = 0; step < kMaxSteps; ++step) {
    const FkJacobian at = fk_jacobian(chain_, q);
    rows.clear();
    needs.clear();
    if (tilt_) tilt_->add_rows(at, rows, needs);
    if (within_) within_->add_rows(at, rows, needs);
    if (rows.empty()) return true;
    const auto count = static_cast<Eigen::Index>(rows.size());
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxRows, kMaxDof> J(count,
                                                                                  chain_.dof);
    Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxRows, 1> need(count);
    for (Eigen::Index k = 0; k < count; ++k) {
      J.row(k) = rows[static_cast<std::size_t>(k)].transpose();
      need[k] = needs[static_cast<std::size_t>(k)];
    }
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxRows, kMaxRows> A =
        J * J.transpose();
    A.diagonal().array() += kDamping;
    const JointVec move = J.transpose() * A.ldlt().solve(need);
    for (int k = 0; k < chain_.dof; ++k) {
      double& value = q[static_cast<std::size_t>(k)];
      value = std::clamp(value + move[k], limits_.lower[k], limits_.upper[k]);
    }
  }
  return false;
}

std::optional<double> PathKeeper::step(std::span<const double> from, std::span<const double> to,
                                       double range, std::span<double> out) const {
  const double left = distance(from, to);
  detail::between(from, to, range / left, out);
  if (!project(out)) return std::nullopt;
  const double length = distance(from, out);
  const bool nearer = distance(out, to) < left - kLeastWay * range;
  if (!nearer || length > kMaxWay * range) return std::nullopt;
  return length;
}

PathKeeper::Edge PathKeeper::look(std::span<const double> q0, std::span<const double> q1) const {
  const Pose start = fk(chain_, q0);
  Watched leaning(tilt_ ? &*tilt_ : nullptr, q0, q1, start);
  Watched within(within_ ? &*within_ : nullptr, q0, q1, start);
  const double whole = distance(q0, q1);
  std::array<double, kMaxDof> row;
  const std::span<double> q(row.data(), q0.size());
  Edge out;
  double done = 0, part = 1;
  // From the left, each part as wide as it can be proved, at most twice the one before.
  for (int parts = 0; done < 1; ++parts) {
    const double end = std::min(1.0, done + part);
    detail::between(q0, q1, end, q);
    const Pose to = fk(chain_, end < 1 ? std::span<const double>(q) : q1);
    const RegionRoom tilt = leaning.room(to, end - done);
    const RegionRoom room = within.room(to, end - done);
    if (tilt.within(kRounding) && room.within(kRounding)) {
      out.tilt_room = std::min(out.tilt_room, tilt.turn);
      out.room = smaller(out.room, room);
      done = end;
      leaning.go_on();
      within.go_on();
      part *= 2;
    } else if (whole * (end - done) > kFinestStep && parts < kMaxParts) {
      part = 0.5 * (end - done);
    } else {
      out.t = done;
      return out;
    }
  }
  out.kept = true;
  return out;
}

bool prove_kept(const PathKeeper* keeper, const PlanOptions& options, PlannedPath& path) {
  path.tilt = 0;
  path.room = {};
  for (std::size_t i = 1; keeper != nullptr && i < path.q.size(); ++i) {
    const auto edge = keeper->look(mjarm::as_span(path.q[i - 1]), mjarm::as_span(path.q[i]));
    if (!edge.kept) return false;
    if (options.tilt) path.tilt = std::max(path.tilt, options.tilt->max - edge.tilt_room);
    path.room = smaller(path.room, edge.room);
  }
  return true;
}

}  // namespace mjarm::detail
