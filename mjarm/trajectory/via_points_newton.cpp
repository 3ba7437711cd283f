#include <Eigen/Cholesky>

#include "mjarm/trajectory/via_points_newton_internal.hpp"

namespace mjarm::detail {

ViaSpline::ViaSpline(int joints, int segments)
    : v(Eigen::MatrixXd::Zero(joints, segments + 1)),
      a(v),
      h(static_cast<std::size_t>(segments)),
      inner(h.size() * static_cast<std::size_t>(joints)) {}

double ViaSpline::duration() const {
  double sum = 0;
  for (const double cell : h) sum += kCells * cell;
  return sum;
}

ViaNewton::ViaNewton(int joints, int segments)
    : joints_(joints),
      segments_(segments),
      diag_(static_cast<std::size_t>(segments) + 1, Eigen::MatrixXd(2 * joints, 2 * joints)),
      next_(diag_),
      rhs_(diag_.size(), Eigen::VectorXd(2 * joints)),
      before_(diag_.size() - 1, Eigen::VectorXd(2 * joints)),
      after_(before_),
      time_(before_.size()),
      time_grad_(before_.size()) {}

void ViaNewton::assemble(const std::vector<Condensed>& parts, int k) {
  const auto i = static_cast<std::size_t>(k);
  next_[i].setZero();
  for (int j = 0; j < joints_; ++j) {
    const Condensed& part =
        parts[i * static_cast<std::size_t>(joints_) + static_cast<std::size_t>(j)];
    for (int a = 0; a < 2; ++a) {
      const int row = 2 * j + a;
      const auto s = static_cast<std::size_t>(a), e = s + 2;
      for (int b = 0; b < 2; ++b) {
        const auto c = static_cast<std::size_t>(b);
        diag_[i](row, 2 * j + b) += part.m[s][c];
        diag_[i + 1](row, 2 * j + b) += part.m[e][c + 2];
        next_[i](row, 2 * j + b) = part.m[s][c + 2];
      }
      rhs_[i][row] += part.grad[s];
      rhs_[i + 1][row] += part.grad[e];
      before_[i][row] = part.m[s][4];
      after_[i][row] = part.m[e][4];
    }
    time_[i] += part.m[4][4];
    time_grad_[i] += part.grad[4];
  }
}

bool ViaNewton::eliminate_time(int k) {
  const auto i = static_cast<std::size_t>(k);
  if (!(time_[i] > 0)) return false;
  const double scale = 1 / time_[i];
  diag_[i].noalias() -= (scale * before_[i]) * before_[i].transpose();
  diag_[i + 1].noalias() -= (scale * after_[i]) * after_[i].transpose();
  next_[i].noalias() -= (scale * before_[i]) * after_[i].transpose();
  rhs_[i] -= scale * time_grad_[i] * before_[i];
  rhs_[i + 1] -= scale * time_grad_[i] * after_[i];
  return true;
}

bool ViaNewton::factor() {
  for (std::size_t k = 1; k < time_.size(); ++k) {
    const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> llt(diag_[k]);
    if (llt.info() != Eigen::Success) return false;
    const auto lower = diag_[k].triangularView<Eigen::Lower>();
    lower.solveInPlace(rhs_[k]);
    if (k + 1 == time_.size()) break;
    lower.solveInPlace(next_[k]);
    diag_[k + 1].noalias() -= next_[k].transpose() * next_[k];
    rhs_[k + 1].noalias() -= next_[k].transpose() * rhs_[k];
  }
  return true;
}

void ViaNewton::substitute(const std::vector<Condensed>& parts, bool fixed_times, ViaSpline& out) {
  const std::size_t count = time_.size();
  rhs_[0].setZero();
  rhs_[count].setZero();
  for (std::size_t k = count - 1; k >= 1; --k) {
    rhs_[k] = -rhs_[k];
    if (k + 1 < count) rhs_[k].noalias() -= next_[k] * rhs_[k + 1];
    diag_[k].triangularView<Eigen::Lower>().transpose().solveInPlace(rhs_[k]);
  }
  for (int k = 0; k <= segments_; ++k) {
    for (int j = 0; j < joints_; ++j) {
      out.v(j, k) = rhs_[static_cast<std::size_t>(k)][2 * j];
      out.a(j, k) = rhs_[static_cast<std::size_t>(k)][2 * j + 1];
    }
  }
  for (int k = 0; k < segments_; ++k) {
    const auto i = static_cast<std::size_t>(k);
    const double force = time_grad_[i] + before_[i].dot(rhs_[i]) + after_[i].dot(rhs_[i + 1]);
    out.h[i] = fixed_times ? 0 : -force / time_[i];
    for (int j = 0; j < joints_; ++j) {
      const std::size_t id = out.index(k, j);
      out.inner[id] = inner_step(parts[id], out.shared(k, j));
    }
  }
}

bool ViaNewton::solve(const std::vector<Condensed>& parts, double time_weight, ViaSpline& out) {
  for (Eigen::MatrixXd& block : diag_) block.setZero();
  for (Eigen::VectorXd& column : rhs_) column.setZero();
  std::fill(time_.begin(), time_.end(), 0.0);
  std::fill(time_grad_.begin(), time_grad_.end(), time_weight * kCells);
  for (int k = 0; k < segments_; ++k) {
    assemble(parts, k);
    if (time_weight > 0 && !eliminate_time(k)) return false;
  }
  if (!factor()) return false;
  substitute(parts, time_weight == 0, out);
  return true;
}

}  // namespace mjarm::detail
