#include "mjarm/core/threads.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

#include "mjarm/core/os.hpp"

namespace mjarm {
namespace {

TEST(Threads, EveryPieceIsDoneOnce) {
  for (const int threads : {-1, 1, 2, 3, 8}) {
    std::vector<int> done(1000);
    std::atomic<std::size_t> next = 0;
    run_in_threads(threads, [&](int) {
      for (std::size_t i = next++; i < done.size(); i = next++) ++done[i];
    });
    EXPECT_EQ(std::count(done.begin(), done.end(), 1), 1000) << threads;
  }
}

TEST(Threads, AreNeverManyMoreThanTheCores) {
  std::atomic<int> now = 0, most = 0;
  run_in_threads(1024, [&](int) {
    const int running = ++now;
    int seen = most;
    while (running > seen && !most.compare_exchange_weak(seen, running)) {
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    --now;
  });
  EXPECT_GE(most, 1);
  EXPECT_LE(most, std::max(16, 2 * core_count()));
}

TEST(Threads, TheCallingOneIsNumberZeroAndTheOthersFollow) {
  std::vector<std::thread::id> ids(4);
  std::atomic<int> count = 0;
  run_in_threads(4, [&](int thread) {
    ids.at(static_cast<std::size_t>(thread)) = std::this_thread::get_id();
    ++count;
  });
  EXPECT_EQ(count, 4);
  EXPECT_EQ(ids[0], std::this_thread::get_id());
  std::sort(ids.begin(), ids.end());
  EXPECT_EQ(std::unique(ids.begin(), ids.end()), ids.end());
}

}  // namespace
}  // namespace mjarm
