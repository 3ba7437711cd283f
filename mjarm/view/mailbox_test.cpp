#include "mjarm/view/mailbox.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <thread>

namespace mjarm::view {
namespace {

TEST(Mailbox, KeepsTheLatestOnly) {
  Mailbox<int> box;
  int value = 7;
  EXPECT_TRUE(box.is_empty());
  EXPECT_FALSE(box.take(value));
  EXPECT_EQ(value, 7);
  for (int i = 1; i <= 3; ++i) {
    int sent = i;
    box.post(sent);
    EXPECT_FALSE(box.is_empty());
  }
  EXPECT_TRUE(box.take(value));
  EXPECT_EQ(value, 3);
  EXPECT_FALSE(box.take(value));
}

TEST(Mailbox, MemoryGoesRound) {
  Mailbox<std::vector<int>> box;
  std::vector<int> sent(100, 1);
  const int* memory = sent.data();
  box.post(sent);
  std::vector<int> taken(50, 2);
  const int* other = taken.data();
  ASSERT_TRUE(box.take(taken));
  EXPECT_EQ(taken.data(), memory);
  box.post(sent);
  EXPECT_EQ(sent.data(), other);
}

/// Every value is whole (one number throughout), they never go back, and the last one arrives.
TEST(Mailbox, ThreadsNeverSeeHalfOfAValue) {
  constexpr int kCount = 20000;
  Mailbox<std::vector<int>> box;
  std::thread writer([&box] {
    std::vector<int> value;
    for (int i = 1; i <= kCount; ++i) {
      value.assign(64, i);
      box.post(value);
    }
  });
  int last = 0;
  std::vector<int> value;
  while (last < kCount) {
    if (!box.take(value)) {
      std::this_thread::yield();
      continue;
    }
    ASSERT_EQ(value.size(), 64U);
    ASSERT_GT(value.front(), last);
    for (const int number : value) ASSERT_EQ(number, value.front());
    last = value.front();
  }
  writer.join();
}

TEST(Queue, ThreadsGetAllInOrder) {
  constexpr int kCount = 20000;
  Queue<int> queue;
  std::thread writer([&queue] {
    for (int i = 0; i < kCount; i += 2) queue.push({i, i + 1});
  });
  std::vector<int> all;
  while (all.size() < kCount) {
    for (const int value : queue.take()) all.push_back(value);
    std::this_thread::yield();
  }
  writer.join();
  std::vector<int> expected(kCount);
  std::iota(expected.begin(), expected.end(), 0);
  EXPECT_EQ(all, expected);
  EXPECT_TRUE(queue.take().empty());
}

}  // namespace
}  // namespace mjarm::view
