#include <gtest/gtest.h>

#include <atomic>
#include <vector>

#include "mjarm/rl/workers_internal.hpp"

namespace mjarm::rl {
namespace {

TEST(Workers, DoEachTaskOnceAndAreDoneThen) {
  for (const int threads : {0, 1, 2, 5}) {
    detail::Workers workers(threads);
    EXPECT_GE(workers.count(), 1);
    for (int tasks = 0; tasks < 200; ++tasks) {
      std::vector<int> done(static_cast<std::size_t>(tasks), 0);  // not atomic: tsan would see
      std::atomic<bool> known = true;
      workers.run(tasks, [&](int task, int thread) {
        done[task] += 1;
        if (thread < 0 || thread >= workers.count()) known = false;
      });
      for (const int count : done) ASSERT_EQ(count, 1);
      ASSERT_TRUE(known);
    }
  }
}

}  // namespace
}  // namespace mjarm::rl
