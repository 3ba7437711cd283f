#include "mjarm/core/linear_algebra.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <utility>

#include "mjarm/core/rng.hpp"

namespace mjarm {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd draw(Rng& rng, int rows, int columns) {
  return MatrixXd::NullaryExpr(rows, columns, [&] { return rng.uniform(-1, 1); });
}

double largest_gap(const MatrixXd& a, const MatrixXd& b) { return (a - b).cwiseAbs().maxCoeff(); }

TEST(LinearAlgebra, SolvesSymmetricSystems) {
  Rng rng(1);
  for (int n = 1; n <= 16; ++n) {
    const MatrixXd root = draw(rng, n, n);
    const MatrixXd A = root * root.transpose() + MatrixXd::Identity(n, n);
    const MatrixXd X = draw(rng, n, 3);
    EXPECT_LT(largest_gap(solve_symmetric(A, A * X), X), 1e-12);
    EXPECT_LT(largest_gap(solve_symmetric(-A, A * X), -X), 1e-12);
    const MatrixXd lower = A.triangularView<Eigen::Lower>();
    EXPECT_LT(largest_gap(solve_symmetric(lower, A * X), X), 1e-12);
  }
}

TEST(LinearAlgebra, EigenvaluesAscendAndRebuildTheMatrix) {
  Rng rng(2);
  for (int n = 1; n <= 16; ++n) {
    const MatrixXd half = draw(rng, n, n);
    const MatrixXd A = half + half.transpose();
    const SymmetricEigen eigen = symmetric_eigen(A);
    EXPECT_TRUE(std::is_sorted(eigen.values.begin(), eigen.values.end()));
    EXPECT_LT(largest_gap(eigen.vectors.transpose() * eigen.vectors, MatrixXd::Identity(n, n)),
              1e-12);
    EXPECT_LT(largest_gap(eigen.vectors * eigen.values.asDiagonal() * eigen.vectors.transpose(), A),
              1e-12);
  }
}

TEST(LinearAlgebra, SingularValuesRebuildTheMatrix) {
  Rng rng(3);
  for (const auto& [rows, columns] : {std::pair(3, 3), std::pair(6, 7), std::pair(9, 2)}) {
    const MatrixXd A = draw(rng, rows, columns);
    const SingularValues svd = singular_values(A);
    EXPECT_LT(largest_gap(svd.U * svd.values.asDiagonal() * svd.V.transpose(), A), 1e-12);
    EXPECT_TRUE(std::is_sorted(svd.values.begin(), svd.values.end(), std::greater<>()));
  }
}

TEST(LinearAlgebra, NullSpaceHasTheMissingDirections) {
  Rng rng(4);
  for (int rank = 0; rank <= 6; ++rank) {
    const MatrixXd A = draw(rng, 6, rank) * draw(rng, rank, 9);
    const MatrixXd N = null_space(A);
    ASSERT_EQ(N.cols(), 9 - rank);
    EXPECT_LT(largest_gap(N.transpose() * N, MatrixXd::Identity(9 - rank, 9 - rank)), 1e-12);
    EXPECT_LT(largest_gap(A * N, MatrixXd::Zero(6, 9 - rank)), 1e-12);
  }
  EXPECT_EQ(null_space(MatrixXd::Identity(4, 4)).cols(), 0);
  const VectorXd steps = VectorXd::LinSpaced(4, 1, 1e-8);
  EXPECT_EQ(null_space(steps.asDiagonal().toDenseMatrix(), 1e-6).cols(), 1);
}

TEST(LinearAlgebra, LeastSquaresIsTheShortestOfTheBest) {
  Rng rng(5);
  const MatrixXd A = draw(rng, 20, 6);
  const VectorXd x = draw(rng, 6, 1);
  EXPECT_LT(largest_gap(least_squares(A, A * x), x), 1e-12);
  // Twice the same column: each gets half.
  MatrixXd twice(20, 2);
  twice << A.col(0), A.col(0);
  EXPECT_LT(largest_gap(least_squares(twice, A.col(0)), VectorXd::Constant(2, 0.5)), 1e-12);
}

}  // namespace
}  // namespace mjarm
