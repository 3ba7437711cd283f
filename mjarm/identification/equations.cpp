#include <algorithm>
#include <cmath>

#include "mjarm/core/linear_algebra.hpp"
#include "mjarm/identification/equations_internal.hpp"
#include "mjarm/model/home.hpp"

namespace mjarm::detail {
namespace {

constexpr int kSamplesPerWindow = 10;
constexpr std::size_t kMostSamples = 4000;      // a log
constexpr double kEarliest = -2, kLatest = 15;  // [rows] delays that are tried

/// Whether joint `j` moves one way, fast enough, for a window about each sample.
std::vector<bool> moving_samples(const SmoothLog& log, int j) {
  const std::size_t count = log.state.size();
  std::vector<bool> out(count, false);
  const auto way = [&](std::size_t i) {
    const double v = log.state[i].v[j];
    return std::abs(v) > Equations::kSlowest ? (v > 0 ? 1 : -1) : 0;
  };
  std::size_t run = 0;  // samples up to this one that go the same way
  const auto window = static_cast<std::size_t>(2 * log.half + 1);
  for (std::size_t i = 0; i < count; ++i) {
    const int here = way(i);
    run = here == 0 ? 0 : (run > 0 && way(i - 1) == here ? run + 1 : 1);
    if (run >= window) out[i - static_cast<std::size_t>(log.half)] = true;
  }
  return out;
}

/// Least squares with W^T W = `normal`, in its own scale; directions without weight are left out.
struct Inverse {
  Eigen::MatrixXd inverse;
  std::vector<bool> known;
};
Inverse invert(const Eigen::MatrixXd& normal) {
  constexpr double kNothing = 1e-11;  // of the largest eigenvalue
  constexpr double kPart = 1e-3;      // of an unknown in a direction that is left out
  Eigen::VectorXd scale = normal.diagonal().cwiseSqrt();
  for (double& s : scale) s = s > 0 ? 1 / s : 0;
  const SymmetricEigen eigen = symmetric_eigen(scale.asDiagonal() * normal * scale.asDiagonal());
  Inverse out{Eigen::MatrixXd::Zero(normal.rows(), normal.cols()),
              std::vector<bool>(static_cast<std::size_t>(normal.rows()), true)};
  const double least = kNothing * eigen.values.tail<1>()[0];
  for (Eigen::Index k = 0; k < eigen.values.size(); ++k) {
    const Eigen::VectorXd direction = eigen.vectors.col(k);
    if (eigen.values[k] > least) {
      out.inverse += direction * direction.transpose() / eigen.values[k];
      continue;
    }
    for (Eigen::Index i = 0; i < direction.size(); ++i) {
      if (std::abs(direction[i]) > kPart) out.known[static_cast<std::size_t>(i)] = false;
    }
  }
  out.inverse = scale.asDiagonal() * out.inverse * scale.asDiagonal();
  return out;
}

}  // namespace

Equations::Equations(const Robot& robot, const Eigen::Vector3d& gravity, const Unknowns& unknowns)
    : robot_(robot),
      gravity_(gravity),
      unknowns_(unknowns),
      inverse_(robot.model, robot.arm),
      qpos_(home_configuration(robot.model.raw()).begin(),
            home_configuration(robot.model.raw()).end()),
      qvel_(static_cast<std::size_t>(robot.model.nv()), 0.0) {}

void Equations::add(const SmoothLog& log, bool loaded) {
  const Arm& arm = robot_.arm;
  std::vector<std::vector<bool>> moving;
  for (int j = 0; j < arm.dof(); ++j) moving.push_back(moving_samples(log, j));
  const std::size_t count = log.state.size();
  const std::size_t stride =
      std::max({std::size_t{1}, static_cast<std::size_t>(2 * log.half / kSamplesPerWindow),
                count / kMostSamples});
  // Delayed torques are looked up on both sides.
  const auto edge = static_cast<std::size_t>(kLatest) + 1;
  for (std::size_t i = edge; i + edge < count; i += stride) {
    const JointState& state = log.state[i];
    for (int j = 0; j < arm.dof(); ++j) {
      const ArmJoint& joint = arm.joints[static_cast<std::size_t>(j)];
      qpos_[static_cast<std::size_t>(joint.qpos)] = state.q[j];
      qvel_[static_cast<std::size_t>(joint.dof)] = state.v[j];
    }
    const JointVec known = inverse_.torque(qpos_, qvel_, state.a);
    const Regressor regressor = regressor_at(arm, gravity_, state);
    for (int j = 0; j < arm.dof(); ++j) {
      if (moving[static_cast<std::size_t>(j)][i]) add_row(log, i, j, loaded, known, regressor);
    }
  }
  logs_.push_back(log);
}

void Equations::add_row(const SmoothLog& log, std::size_t sample, int joint, bool loaded,
                        const JointVec& known, const Regressor& regressor) {
  constexpr int kLogs = 1 << 24;  // clusters of one log are none of the other's
  const JointState& state = log.state[sample];
  const int number = static_cast<int>(logs_.size());
  const int cluster = static_cast<int>(sample) / (2 * log.half + 1);
  rows_.push_back(
      {number, static_cast<int>(sample), joint, number * kLogs + cluster, known[joint]});
  Eigen::VectorXd row = Eigen::VectorXd::Zero(unknowns_.size());
  row[unknowns_.friction(joint)] = state.v[joint] > 0 ? 1 : -1;
  row[unknowns_.viscous(joint)] = state.v[joint];
  row[unknowns_.offset(joint)] = 1;
  // Where links are unknown, rotors are among their base parameters.
  if (!unknowns_.base) row[unknowns_.inertia(joint)] = state.a[joint];
  const bool has = unknowns_.has_payload && loaded;
  if (has) {
    row.segment<4>(unknowns_.payload()) = regressor.payload.row(joint).head<4>();
  }
  if (unknowns_.base) {
    for (std::size_t i = 0; i < unknowns_.base->kept.size(); ++i) {
      row[unknowns_.link(static_cast<int>(i))] = regressor.links(joint, unknowns_.base->kept[i]);
    }
  }
  columns_.push_back(std::move(row));
  inertia_columns_.emplace_back(has ? Eigen::VectorXd(regressor.payload.row(joint))
                                    : Eigen::VectorXd::Zero(kInertialSize));
}

bool Equations::moves() const {
  return rows_.size() > static_cast<std::size_t>(2 * unknowns_.size());
}

/// What the model leaves to be explained, torques acting `delay` rows after they are told.
Eigen::VectorXd Equations::right_side(double delay) const {
  Eigen::VectorXd out(static_cast<Eigen::Index>(rows_.size()));
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    const Row& row = rows_[k];
    const double at = row.sample - delay, floor = std::floor(at), share = at - floor;
    const auto i = static_cast<std::size_t>(floor);
    const std::vector<JointVec>& torque = logs_[static_cast<std::size_t>(row.log)].torque;
    const double told = (1 - share) * torque[i][row.joint] + share * torque[i + 1][row.joint];
    out[static_cast<Eigen::Index>(k)] = told - row.known - inertia_columns_[k].dot(point_inertia_);
  }
  return out;
}

JointVec Equations::joint_rms(const Eigen::VectorXd& residual) const {
  JointVec squares = JointVec::Zero(unknowns_.dof), count = squares;
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    const double e = residual[static_cast<Eigen::Index>(k)];
    squares[rows_[k].joint] += e * e;
    count[rows_[k].joint] += 1;
  }
  return squares.cwiseQuotient(count.cwiseMax(1)).cwiseSqrt();
}

/// Sum over clusters of (W^T e) (W^T e)^T, with the usual factor for few of them.
Eigen::MatrixXd Equations::clustered(const Eigen::MatrixXd& W,
                                     const Eigen::VectorXd& residual) const {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(W.cols(), W.cols());
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(W.cols());
  int clusters = 0;
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    sum += W.row(i).transpose() * residual[i];
    if (k + 1 < rows_.size() && rows_[k + 1].cluster == rows_[k].cluster) continue;
    out += sum * sum.transpose();
    sum.setZero();
    ++clusters;
  }
  // A cluster has as many independent residuals as joints.
  const double all = static_cast<double>(clusters) * unknowns_.dof;
  return out * all / std::max(1.0, all - static_cast<double>(W.cols()));
}

Result<Solution> Equations::solve(const StopCheck& stop) const {
  const auto count = static_cast<Eigen::Index>(rows_.size());
  Eigen::MatrixXd W(count, unknowns_.size());
  for (Eigen::Index i = 0; i < count; ++i) W.row(i) = columns_[static_cast<std::size_t>(i)];
  Eigen::VectorXd weight = Eigen::VectorXd::Ones(count);
  Solution out;
  const double h = logs_.front().timestep;
  constexpr int kRounds = 3;
  for (int round = 0; round < kRounds; ++round) {
    const Eigen::MatrixXd weighted = weight.asDiagonal() * W;
    const Inverse normal = invert(weighted.transpose() * weighted);
    const auto unexplained = [&](double delay, Eigen::VectorXd& x) {
      const Eigen::VectorXd y = weight.asDiagonal() * right_side(delay);
      x = normal.inverse * (weighted.transpose() * y);
      return (y - weighted * x).squaredNorm();
    };
    double best = 0, least = -1;
    for (double delay = kEarliest; delay <= kLatest; delay += 0.5) {
      if (is_stopped(stop)) return fail(stopped());
      const double squares = unexplained(delay, out.x);
      if (least < 0 || squares < least) {
        least = squares;
        best = delay;
      }
    }
    const double left = unexplained(best - 0.5, out.x), right = unexplained(best + 0.5, out.x);
    const double bend = left - 2 * least + right;
    const bool inside = best > kEarliest && best < kLatest && bend > 0;
    if (inside) best += 0.25 * (left - right) / bend;
    unexplained(best, out.x);
    const Eigen::VectorXd residual = right_side(best) - W * out.x;
    out.delay = best * h;
    out.rms = joint_rms(residual);
    out.known = normal.known;
    const Eigen::VectorXd scaled = weight.asDiagonal() * residual;
    out.covariance = normal.inverse * clustered(weighted, scaled) * normal.inverse;
    const double floor = 1e-9 + 1e-3 * out.rms.maxCoeff();
    for (Eigen::Index i = 0; i < count; ++i) {
      weight[i] = 1 / std::max(floor, out.rms[rows_[static_cast<std::size_t>(i)].joint]);
    }
  }
  out.rows = rows_.size();
  return out;
}

}  // namespace mjarm::detail
