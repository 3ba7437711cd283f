#pragma once

#include <Eigen/Core>

namespace mjarm {

/// @file
/// Eigen's decompositions for matrices of any size, compiled once: each file that names one of them
/// itself takes seconds longer to compile. They allocate, so they are not for inner loops.

using ConstMatrixRef = Eigen::Ref<const Eigen::MatrixXd>;

/// X with A X = B for a symmetric A (n x n), positive or negative semi-definite, and B (n x k);
/// only the lower triangle of A is read. LDL^T with pivots.
[[nodiscard]] Eigen::MatrixXd solve_symmetric(const ConstMatrixRef& A, const ConstMatrixRef& B);

/// A = V diag(values) V^T.
struct SymmetricEigen {
  Eigen::VectorXd values;   ///< (n,), ascending
  Eigen::MatrixXd vectors;  ///< n x n, orthonormal columns
};

/// Of a symmetric A (n x n), of which only the lower triangle is read.
[[nodiscard]] SymmetricEigen symmetric_eigen(const ConstMatrixRef& A);

/// A = U diag(values) V^T.
struct SingularValues {
  Eigen::MatrixXd U;       ///< m x min(m, n), orthonormal columns
  Eigen::VectorXd values;  ///< (min(m, n),), descending
  Eigen::MatrixXd V;       ///< n x min(m, n), orthonormal columns
};
[[nodiscard]] SingularValues singular_values(const ConstMatrixRef& A);

/// Orthonormal columns that span {x : A x = 0}, n x (n - rank) for an A of m x n. Pivots of less
/// than `threshold` times the largest count as zero. QR with column pivoting.
[[nodiscard]] Eigen::MatrixXd null_space(const ConstMatrixRef& A, double threshold = 1e-12);

/// The shortest x that minimises |A x - b|, by singular values.
[[nodiscard]] Eigen::VectorXd least_squares(const ConstMatrixRef& A, const Eigen::VectorXd& b);

}  // namespace mjarm
