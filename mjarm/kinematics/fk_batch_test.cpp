#include "mjarm/kinematics/fk_batch.hpp"

#include <gtest/gtest.h>

#include <cstring>

#include "mjarm/core/cpu.hpp"
#include "mjarm/kinematics/arms_test.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/kinematics/fk_batch_internal.hpp"

namespace mjarm {
namespace {

/// `n` random configurations, row by row.
std::vector<double> rows(const Arm& arm, std::size_t n, Rng& rng) {
  std::vector<double> out;
  for (std::size_t i = 0; i < n; ++i) {
    const JointVec q = testing::random_q(arm, rng);
    out.insert(out.end(), q.begin(), q.end());
  }
  return out;
}

TEST(FkBatch, AgreesWithFkForAnyArmAndCount) {
  Rng rng(1);
  for (std::size_t n = 0; n < 40; ++n) {
    const Arm arm = testing::random_arm(1 + static_cast<int>(n) % kMaxDof, rng);
    const auto dof = static_cast<std::size_t>(arm.dof());
    const std::vector<double> q = rows(arm, n, rng);
    const std::vector<float> q_float(q.begin(), q.end());
    std::vector<Pose> X(n);
    std::vector<float> X_float(12 * n);
    fk_batch(Chain(arm), q, X);
    fk_batch(Chain(arm), q_float, X_float);
    for (std::size_t i = 0; i < n; ++i) {
      const Pose wanted = fk(arm, {q.data() + i * dof, dof});
      EXPECT_LT((X[i].p - wanted.p).norm(), 1e-13);
      EXPECT_LT((X[i].R - wanted.R).norm(), 1e-13);
      const Eigen::Map<const Eigen::Vector3f> p(&X_float[12 * i]);
      const Eigen::Map<const Eigen::Matrix3f> R(&X_float[12 * i + 3]);
      EXPECT_LT((p.cast<double>() - wanted.p).norm(), 2e-5);
      EXPECT_LT((R.cast<double>() - wanted.R).norm(), 2e-5);
    }
  }
}

TEST(FkBatch, FarAnglesKeepTheirPrecision) {
  const Arm arm = testing::panda();
  Rng rng(2);
  std::vector<double> q(7 * 64);
  for (double& value : q) value = rng.uniform(-9e4, 9e4);
  std::vector<Pose> X(64);
  fk_batch(Chain(arm), q, X);
  for (std::size_t i = 0; i < 64; ++i) {
    EXPECT_LT((X[i].R - fk(arm, {&q[7 * i], 7}).R).norm(), 1e-10);
  }
}

TEST(FkBatch, NeighboursDoNotMatter) {
  const Arm arm = testing::ur5e();
  const Chain chain(arm);
  Rng rng(3);
  const std::vector<double> q = rows(arm, 21, rng);
  std::vector<Pose> all(21);
  fk_batch(chain, q, all);
  for (std::size_t i = 0; i < 21; ++i) {
    Pose one;
    fk_batch(chain, std::span<const double>(&q[6 * i], 6), {&one, 1});
    EXPECT_EQ(std::memcmp(&one, &all[i], sizeof one), 0);
  }
}

#if defined(__x86_64__)
TEST(FkBatch, WidthsOfRegistersAgree) {
  const Arm arm = testing::panda();
  const Chain chain(arm);
  Rng rng(4);
  const std::vector<double> q = rows(arm, 50, rng);
  const std::vector<float> q_float(q.begin(), q.end());
  std::vector<double> narrow(600), wide(600);
  std::vector<float> narrow_float(600), wide_float(600);
  detail::kFkBaseline.doubles(chain, q.data(), 50, narrow.data());
  detail::kFkBaseline.floats(chain, q_float.data(), 50, narrow_float.data());
  for (const auto& [level, kernels] : {std::pair{SimdLevel::avx2, &detail::kFkAvx2},
                                       std::pair{SimdLevel::avx512, &detail::kFkAvx512}}) {
    if (simd_level() < level) continue;
    kernels->doubles(chain, q.data(), 50, wide.data());
    kernels->floats(chain, q_float.data(), 50, wide_float.data());
    for (std::size_t i = 0; i < 600; ++i) {
      EXPECT_NEAR(wide[i], narrow[i], 1e-13);
      EXPECT_NEAR(wide_float[i], narrow_float[i], 1e-5);
    }
  }
}
#endif

}  // namespace
}  // namespace mjarm
