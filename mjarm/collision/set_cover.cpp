#include <algorithm>

#include "mjarm/collision/set_cover_internal.hpp"
#include "mjarm/core/cpu.hpp"

namespace mjarm::detail {
namespace {

using Bits = std::vector<std::uint64_t>;

void add_bit(Bits& bits, int element) {
  const auto word = static_cast<std::size_t>(element / 64);
  if (word >= bits.size()) bits.resize(word + 1, 0);
  bits[word] |= std::uint64_t{1} << (element % 64);
}

bool has_bit(const Bits& bits, int element) {
  const auto word = static_cast<std::size_t>(element / 64);
  return word < bits.size() && ((bits[word] >> (element % 64)) & 1) != 0;
}

/// @param bits  no longer than `from`.
void remove_bits(Bits& from, const Bits& bits) {
  for (std::size_t k = 0; k < bits.size(); ++k) from[k] &= ~bits[k];
}

/// Inlined into what is compiled for a machine that counts bits with one instruction.
[[gnu::always_inline]] inline int count_bits(const std::uint64_t* a, const std::uint64_t* b,
                                             std::size_t words) {
  int count = 0;
  for (std::size_t k = 0; k < words; ++k) count += __builtin_popcountll(a[k] & b[k]);
  return count;
}

#if defined(__x86_64__)
[[gnu::target("popcnt")]] int count_fast(const std::uint64_t* a, const std::uint64_t* b,
                                         std::size_t words) {
  return count_bits(a, b, words);
}
#endif

int count_common(const Bits& a, const Bits& b) {
  const std::size_t words = std::min(a.size(), b.size());
#if defined(__x86_64__)
  if (simd_level() != SimdLevel::baseline) return count_fast(a.data(), b.data(), words);
#endif
  return count_bits(a.data(), b.data(), words);
}

}  // namespace

int SetCover::add_set(std::span<const int> elements) {
  const int set = static_cast<int>(sets_.size());
  sets_.emplace_back();
  for (const int e : elements) {
    sets_with_[static_cast<std::size_t>(e)].push_back(set);
    add_bit(sets_.back(), e);
  }
  return set;
}

int SetCover::add_element(std::vector<int> sets) {
  const int element = static_cast<int>(sets_with_.size());
  for (const int s : sets) add_bit(sets_[static_cast<std::size_t>(s)], element);
  add_bit(all_, element);
  sets_with_.push_back(std::move(sets));
  order_.push_back(element);
  return element;
}

void SetCover::drop(std::size_t place) {
  chosen_.erase(chosen_.begin() + static_cast<std::ptrdiff_t>(place));
}

/// Elements that none of the chosen sets holds.
void SetCover::find_open() {
  open_ = all_;
  for (const int set : chosen_) remove_bits(open_, sets_[static_cast<std::size_t>(set)]);
}

/// Elements that exactly one of the chosen sets holds.
SetCover::Bits SetCover::held_once() const {
  Bits once(all_.size(), 0), more(all_.size(), 0);
  for (const int set : chosen_) {
    const Bits& bits = sets_[static_cast<std::size_t>(set)];
    for (std::size_t k = 0; k < bits.size(); ++k) {
      more[k] |= once[k] & bits[k];
      once[k] |= bits[k];
    }
  }
  remove_bits(once, more);
  return once;
}

/// Covers, one after the other, the elements that the fewest sets hold, by the set that holds most
/// of what is left.
void SetCover::complete(double noise) {
  for (const int element : order_) {
    if (!has_bit(open_, element)) continue;
    double best = -1;
    int which = -1;
    for (const int s : sets_with_[static_cast<std::size_t>(element)]) {
      const int fresh = count_common(sets_[static_cast<std::size_t>(s)], open_);
      const double gain = fresh * (1 + noise * rng_.uniform());
      if (gain <= best) continue;
      best = gain;
      which = s;
    }
    if (which < 0) continue;
    chosen_.push_back(which);
    remove_bits(open_, sets_[static_cast<std::size_t>(which)]);
  }
}

void SetCover::drop_needless() {
  Bits once = held_once();
  for (std::size_t k = 0; k < chosen_.size();) {
    if (count_common(sets_[static_cast<std::size_t>(chosen_[k])], once) > 0) {
      ++k;
    } else {
      drop(k);
      once = held_once();
    }
  }
}

/// Drops a set and the `count` that share the most elements with it, by and large.
void SetCover::drop_neighbours(int count) {
  const auto first = static_cast<std::size_t>(rng_.below(chosen_.size()));
  const Bits& marked = sets_[static_cast<std::size_t>(chosen_[first])];
  drop(first);
  for (int k = 0; k < count && !chosen_.empty(); ++k) {
    double max = -1;
    std::size_t which = 0;
    for (std::size_t i = 0; i < chosen_.size(); ++i) {
      const int shared = count_common(sets_[static_cast<std::size_t>(chosen_[i])], marked);
      const double weight = (shared + 1) * rng_.uniform();
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
  find_open();
  complete(0);
  if (rounds == 0) return chosen_;
  drop_needless();
  std::vector<int> best = chosen_;
  for (int round = 0; round < rounds && chosen_.size() > 1; ++round) {
    drop_neighbours(1 + static_cast<int>(rng_.below(4)));
    find_open();
    complete(0.3);
    drop_needless();
    if (chosen_.size() <= best.size()) {
      best = chosen_;
    } else {
      chosen_ = best;
    }
  }
  return chosen_;
}

}  // namespace mjarm::detail
