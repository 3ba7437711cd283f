#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>

#include "mjarm/kinematics/arms_test.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/kinematics/ik.hpp"
#include "mjarm/kinematics/self_motion.hpp"

// Counts every allocation of this program: operator new and Eigen both end in malloc. Sanitizers
// have a malloc of their own, and other C libraries no second name for theirs.
#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define MJARM_COUNTS_MALLOC 1
namespace {
std::atomic<long> allocations{0};
}
extern "C" void* __libc_malloc(std::size_t size);
extern "C" void* malloc(std::size_t size) {
  allocations.fetch_add(1, std::memory_order_relaxed);
  return __libc_malloc(size);
}

namespace mjarm {
namespace {

TEST(NoAllocation, TheCounterCounts) {
  const long before = allocations;
  const std::vector<double> some(100, 1.0);
  const Eigen::VectorXd more = Eigen::VectorXd::Ones(100);
  EXPECT_GE(allocations - before, 2);
  EXPECT_EQ(some[3], more[3]);
}

TEST(NoAllocation, FkAndIkNeverAllocate) {
  Rng rng(61);
  std::vector<Arm> arms{testing::ur5e(), testing::panda()};
  for (int dof = 1; dof <= 12; ++dof) arms.push_back(testing::random_arm(dof, rng));
  for (const Arm& arm : arms) {
    const IkSolver ik(arm);
    std::vector<Pose> X_WJ(arm.joints.size());
    const long before = allocations;
    double sum = 0;
    for (int i = 0; i < 50; ++i) {
      const JointVec q = testing::random_q(arm, rng);
      const FkJacobian both = fk_jacobian(arm, as_span(q));
      sum += fk(arm, as_span(q)).p.x() + fk_all(arm, as_span(q), X_WJ).p.x();
      sum += manipulability(both.J_W) + smallest_singular_value(both.J_W);
      sum += clamp_to_limits(arm, as_span(q)).sum() + (within_limits(arm, as_span(q)) ? 1 : 0);
      const auto answer = ik.solve(both.X_WT, as_span(arm.home));
      sum += answer ? answer->pos_err : answer.error().amount;
      const auto settled =
          null_space_step(ik, both.X_WT, as_span(q), {.goal = PostureGoal::manipulability});
      sum += settled ? settled->pos_err : settled.error().amount;
      Pose far = both.X_WT;
      far.p.x() += i;
      const auto none = ik.solve(far, as_span(arm.home));
      sum += none ? none->pos_err : none.error().amount;
    }
    EXPECT_EQ(allocations - before, 0) << arm.dof() << " joints";
    EXPECT_TRUE(std::isfinite(sum));
  }
}

}  // namespace
}  // namespace mjarm
#endif
