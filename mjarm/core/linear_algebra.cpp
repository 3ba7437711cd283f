#include "mjarm/core/linear_algebra.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <Eigen/SVD>

namespace mjarm {
namespace {

using Svd = Eigen::JacobiSVD<Eigen::MatrixXd>;
constexpr int kThin = Eigen::ComputeThinU | Eigen::ComputeThinV;

}  // namespace

Eigen::MatrixXd solve_symmetric(const ConstMatrixRef& A, const ConstMatrixRef& B) {
  return Eigen::LDLT<Eigen::MatrixXd>(A).solve(B);
}

SymmetricEigen symmetric_eigen(const ConstMatrixRef& A) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(A);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

SingularValues singular_values(const ConstMatrixRef& A) {
  const Svd svd(A, kThin);
  return {svd.matrixU(), svd.singularValues(), svd.matrixV()};
}

Eigen::MatrixXd null_space(const ConstMatrixRef& A, double threshold) {
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr;
  qr.setThreshold(threshold);
  qr.compute(A.transpose());
  const Eigen::MatrixXd Q = qr.householderQ();
  return Q.rightCols(A.cols() - qr.rank());
}

Eigen::VectorXd least_squares(const ConstMatrixRef& A, const Eigen::VectorXd& b) {
  return Svd(A, kThin).solve(b);
}

}  // namespace mjarm
