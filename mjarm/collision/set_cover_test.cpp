#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstdint>

#include "mjarm/collision/set_cover_internal.hpp"

namespace mjarm {
namespace {

/// Some elements, each in at least one of some sets, as bits of the sets' words.
struct CoverProblem {
  int elements = 0;
  std::vector<std::uint32_t> sets;
};

CoverProblem random_problem(Rng& rng) {
  CoverProblem out{4 + static_cast<int>(rng.below(12)), {}};
  const int count = 3 + static_cast<int>(rng.below(9));
  for (int s = 0; s < count; ++s) {
    std::uint32_t set = 0;
    for (int e = 0; e < out.elements; ++e) set |= (rng.uniform() < 0.35 ? 1U : 0U) << e;
    out.sets.push_back(set);
  }
  for (int e = 0; e < out.elements; ++e) {
    out.sets[rng.below(out.sets.size())] |= 1U << e;  // every element is in one
  }
  return out;
}

/// The elements from `first` on are added last, after a search among those before.
std::vector<int> cover_of(const CoverProblem& problem, int rounds, int first) {
  detail::SetCover cover;
  for (std::size_t s = 0; s < problem.sets.size(); ++s) cover.add_set({});
  for (int e = 0; e < problem.elements; ++e) {
    if (e == first) cover.solve(rounds);
    std::vector<int> holders;
    for (std::size_t s = 0; s < problem.sets.size(); ++s) {
      if (((problem.sets[s] >> e) & 1) != 0) holders.push_back(static_cast<int>(s));
    }
    cover.add_element(holders);
  }
  return cover.solve(rounds);
}

std::uint32_t held_by(const CoverProblem& problem, const std::vector<int>& chosen) {
  std::uint32_t out = 0;
  for (const int s : chosen) out |= problem.sets[static_cast<std::size_t>(s)];
  return out;
}

/// By looking at every choice of sets.
int fewest(const CoverProblem& problem) {
  const std::uint32_t all = (1U << problem.elements) - 1;
  int best = 32;
  for (std::uint32_t choice = 0; choice < (1U << problem.sets.size()); ++choice) {
    std::uint32_t held = 0;
    for (std::size_t s = 0; s < problem.sets.size(); ++s) {
      if (((choice >> s) & 1) != 0) held |= problem.sets[s];
    }
    if (held == all) best = std::min(best, std::popcount(choice));
  }
  return best;
}

TEST(SetCover, HoldsEverythingWithAsFewSetsAsThereCanBe) {
  Rng rng(51);
  int best_at_once = 0;
  for (int round = 0; round < 200; ++round) {
    const CoverProblem problem = random_problem(rng);
    const std::uint32_t all = (1U << problem.elements) - 1;
    const int least = fewest(problem);
    const std::vector<int> quick = cover_of(problem, 0, 0), thorough = cover_of(problem, 60, 0);
    EXPECT_EQ(held_by(problem, quick), all);
    EXPECT_EQ(held_by(problem, thorough), all);
    EXPECT_EQ(std::ssize(thorough), least) << "round " << round;
    best_at_once += std::ssize(quick) == least ? 1 : 0;
  }
  EXPECT_LT(best_at_once, 200) << "the greedy choice alone would do";
}

TEST(SetCover, NoSetIsNeedlessOrTakenTwice) {
  Rng rng(52);
  for (int round = 0; round < 100; ++round) {
    const CoverProblem problem = random_problem(rng);
    std::vector<int> chosen = cover_of(problem, 5, 0);
    const std::uint32_t held = held_by(problem, chosen);
    for (std::size_t k = 0; k < chosen.size(); ++k) {
      std::vector<int> fewer = chosen;
      fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(k));
      EXPECT_NE(held_by(problem, fewer), held) << "set " << chosen[k];
    }
    std::sort(chosen.begin(), chosen.end());
    EXPECT_EQ(std::adjacent_find(chosen.begin(), chosen.end()), chosen.end());
  }
}

TEST(SetCover, GoesOnFromWhatWasFoundAndSaysTheSameTwice) {
  Rng rng(53);
  for (int round = 0; round < 100; ++round) {
    const CoverProblem problem = random_problem(rng);
    const std::vector<int> at_once = cover_of(problem, 8, 0);
    const std::vector<int> in_parts = cover_of(problem, 8, problem.elements / 2);
    EXPECT_EQ(held_by(problem, in_parts), held_by(problem, at_once));
    EXPECT_EQ(cover_of(problem, 8, problem.elements / 2), in_parts);
  }
}

}  // namespace
}  // namespace mjarm
