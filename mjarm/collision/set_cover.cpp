#include <algorithm>

#include "mjarm/collision/set_cover_internal.hpp"

namespace mjarm::detail {

int SetCover::add_set(std::vector<int> elements) {
  const int set = static_cast<int>(sets_.size());
  for (const int e : elements) sets_with_[static_cast<std::size_t>(e)].push_back(set);
  sets_.push_back(std::move(elements));
  return set;
}

int SetCover::add_element(std::vector<int> sets) {
  const int element = static_cast<int>(sets_with_.size());
  for (const int s : sets) sets_[static_cast<std::size_t>(s)].push_back(element);
  const auto times = std::count_if(chosen_.begin(), chosen_.end(), [&](int s) {
    return std::find(sets.begin(), sets.end(), s) != sets.end();
  });
  times_.push_back(static_cast<int>(times));
  sets_with_.push_back(std::move(sets));
  order_.push_back(element);
  return element;
}

void SetCover::take(int set) {
  chosen_.push_back(set);
  for (const int e : sets_[static_cast<std::size_t>(set)]) ++times_[static_cast<std::size_t>(e)];
}

void SetCover::drop(std::size_t place) {
  const auto set = static_cast<std::size_t>(chosen_[place]);
  for (const int e : sets_[set]) --times_[static_cast<std::size_t>(e)];
  chosen_.erase(chosen_.begin() + static_cast<std::ptrdiff_t>(place));
}

/// Covers, one after the other, the elements that the fewest sets hold, by the set that holds most
/// of what is left.
void SetCover::complete(double noise) {
  for (const int element : order_) {
    if (times_[static_cast<std::size_t>(element)] > 0) continue;
    double best = -1;
    int which = -1;
    for (const int s : sets_with_[static_cast<std::size_t>(element)]) {
      const std::vector<int>& set = sets_[static_cast<std::size_t>(s)];
      const auto fresh = std::count_if(
          set.begin(), set.end(), [&](int e) { return times_[static_cast<std::size_t>(e)] == 0; });
      const double gain = static_cast<double>(fresh) * (1 + noise * rng_.uniform());
      if (gain <= best) continue;
      best = gain;
      which = s;
    }
    if (which >= 0) take(which);
  }
}

void SetCover::drop_needless() {
  for (std::size_t k = 0; k < chosen_.size();) {
    const std::vector<int>& set = sets_[static_cast<std::size_t>(chosen_[k])];
    const bool needed = std::any_of(
        set.begin(), set.end(), [&](int e) { return times_[static_cast<std::size_t>(e)] == 1; });
    if (needed) {
      ++k;
    } else {
      drop(k);
    }
  }
}

/// Drops a set and the `count` that share the most elements with it, by and large.
void SetCover::drop_neighbours(int count) {
  const auto first = static_cast<std::size_t>(rng_.below(chosen_.size()));
  std::vector<bool> marked(times_.size(), false);
  for (const int e : sets_[static_cast<std::size_t>(chosen_[first])]) {
    marked[static_cast<std::size_t>(e)] = true;
  }
  drop(first);
  for (int k = 0; k < count && !chosen_.empty(); ++k) {
    double max = -1;
    std::size_t which = 0;
    for (std::size_t i = 0; i < chosen_.size(); ++i) {
      const std::vector<int>& set = sets_[static_cast<std::size_t>(chosen_[i])];
      const auto shared = std::count_if(set.begin(), set.end(),
                                        [&](int e) { return marked[static_cast<std::size_t>(e)]; });
      const double weight = static_cast<double>(shared + 1) * rng_.uniform();
      if (weight <= max) continue;
      max = weight;
      which = i;
    }
    drop(which);
  }
}

const std::vector<int>& SetCover::solve(int rounds) {
  std::stable_sort(order_.begin(), order_.end(), [&](int a, int b) {
    return sets_with_[static_cast<std::size_t>(a)].size() <
           sets_with_[static_cast<std::size_t>(b)].size();
  });
  complete(0);
  if (rounds == 0) return chosen_;
  drop_needless();
  std::vector<int> best = chosen_;
  for (int round = 0; round < rounds && chosen_.size() > 1; ++round) {
    drop_neighbours(1 + static_cast<int>(rng_.below(4)));
    complete(0.3);
    drop_needless();
    if (chosen_.size() <= best.size()) {
      best = chosen_;
    } else {
      std::fill(times_.begin(), times_.end(), 0);
      chosen_.clear();
      for (const int set : best) take(set);
    }
  }
  return chosen_;
}

}  // namespace mjarm::detail
