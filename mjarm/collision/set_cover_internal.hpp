#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "mjarm/core/rng.hpp"

namespace mjarm::detail {

/// A search for few sets that together hold all elements: greedy, then parts of the solution are
/// thrown away and chosen anew. Sets and elements may be added between searches, which go on from
/// what was found before. The same calls find the same sets.
class SetCover {
 public:
  /// @param elements  that are in it, of those there are. @return its index, from 0.
  int add_set(std::span<const int> elements);
  /// @param sets  that hold it, at least one. @return its index, from 0.
  int add_element(std::vector<int> sets);

  /// Sets that hold all elements.
  /// @param rounds  of throwing away: more find fewer sets; 0 only adds to those chosen before.
  const std::vector<int>& solve(int rounds);

 private:
  /// A bit for every element; missing words are zero.
  using Bits = std::vector<std::uint64_t>;

  void find_open();
  Bits held_once() const;
  void drop(std::size_t place);
  void complete(double noise);
  void drop_needless();
  void drop_neighbours(int count);

  std::vector<Bits> sets_;                   // elements of each
  std::vector<std::vector<int>> sets_with_;  // per element
  std::vector<int> order_;                   // elements, those in the fewest sets first
  Bits all_;                                 // elements that there are
  Bits open_;                                // those that are not held yet, while sets are chosen
  std::vector<int> chosen_;
  Rng rng_{1};
};

}  // namespace mjarm::detail
