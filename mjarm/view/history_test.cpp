#include "mjarm/view/history.hpp"

#include <gtest/gtest.h>

#include <deque>

#include "mjarm/core/rng.hpp"

namespace mjarm::view {
namespace {

TEST(History, GoesBackAndForth) {
  History<int> history(10);
  EXPECT_EQ(history.back(), nullptr);
  EXPECT_EQ(history.forward(), nullptr);
  for (int i = 1; i <= 3; ++i) history.add(i);
  EXPECT_EQ(history.at(), 3);
  EXPECT_EQ(*history.back(), 2);
  EXPECT_TRUE(history.is_past());
  EXPECT_EQ(*history.back(), 1);
  EXPECT_EQ(history.back(), nullptr);
  EXPECT_EQ(*history.forward(), 2);
  history.to_present();
  EXPECT_EQ(history.at(), 3);
  EXPECT_FALSE(history.is_past());
  history.clear();
  EXPECT_EQ(history.size(), 0U);
}

TEST(History, WhatIsAddedInThePastReplacesWhatCameAfter) {
  History<int> history(10);
  for (int i = 1; i <= 5; ++i) history.add(i);
  (void)history.back();
  (void)history.back();
  history.add(40);
  EXPECT_EQ(history.at(), 40);
  EXPECT_EQ(history.forward(), nullptr);
  EXPECT_EQ(*history.back(), 3);
}

/// Against a plain list, for a long time, with a ring that goes round often.
TEST(History, IsTheSameAsAListThatIsCut) {
  Rng rng(4);
  for (const std::size_t max : {1U, 2U, 7U}) {
    History<int> history(max);
    std::deque<int> list;
    std::size_t at = 0;
    for (int i = 0; i < 3000; ++i) {
      const double choice = rng.uniform(0, 1);
      if (choice < 0.6 || list.empty()) {
        if (!list.empty()) list.resize(at + 1);
        list.push_back(i);
        if (list.size() > max) list.pop_front();
        at = list.size() - 1;
        history.add(i);
      } else if (choice < 0.8) {
        ASSERT_EQ(history.back() != nullptr, at > 0);
        if (at > 0) --at;
      } else {
        ASSERT_EQ(history.forward() != nullptr, at + 1 < list.size());
        if (at + 1 < list.size()) ++at;
      }
      ASSERT_EQ(history.at(), list[at]);
      ASSERT_EQ(history.size(), list.size());
    }
  }
}

}  // namespace
}  // namespace mjarm::view
