#include <algorithm>
#include <cmath>

#include "mjarm/view/plot_history_internal.hpp"

namespace mjarm::view {
namespace {

/// `more` may be NaN (nothing), `into` as well.
void widen(TimedValue& into, const TimedValue& more, bool greatest) {
  if (std::isnan(more.value)) return;
  const bool further = greatest ? more.value > into.value : more.value < into.value;
  if (std::isnan(into.value) || further) into = more;
}

}  // namespace

PlotHistory::PlotHistory(std::size_t columns, std::size_t places, double span)
    : columns_(columns), max_(std::max<std::size_t>(places, 2)), span_(span) {}

void PlotHistory::clear() {
  rows_a_place_ = 1;
  rows_in_last_ = 0;
  starts_.clear();
  extremes_.clear();
  last_.clear();
}

void PlotHistory::add(double time, std::span<const double> values) {
  open_place(time);
  last_.resize(columns_);
  Extremes* extremes = place(starts_.size() - 1);
  for (std::size_t i = 0; i < columns_; ++i) {
    last_[i] = {time, values[i]};
    widen(extremes[i].least, last_[i], false);
    widen(extremes[i].greatest, last_[i], true);
  }
  ++rows_in_last_;
}

/// A new place where the last one is full.
void PlotHistory::open_place(double time) {
  if (!starts_.empty()) {
    const bool full = span_ > 0 ? time - starts_.back() >= span_ / static_cast<double>(max_)
                                : rows_in_last_ >= rows_a_place_;
    if (!full) return;
  }
  if (span_ > 0) {
    const auto old = std::ranges::find_if(starts_, [&](double t) { return t >= time - span_; });
    auto gone = static_cast<std::size_t>(old - starts_.begin());
    if (starts_.size() - gone >= max_) gone = starts_.size() - max_ + 1;
    starts_.erase(starts_.begin(), starts_.begin() + static_cast<std::ptrdiff_t>(gone));
    extremes_.erase(extremes_.begin(),
                    extremes_.begin() + static_cast<std::ptrdiff_t>(gone * columns_));
  } else if (starts_.size() == max_) {
    join_pairs();
    if (rows_in_last_ < rows_a_place_) return;
  }
  const TimedValue nothing{time, std::nan("")};
  starts_.push_back(time);
  extremes_.insert(extremes_.end(), columns_, {nothing, nothing});
  rows_in_last_ = 0;
}

void PlotHistory::join_pairs() {
  const std::size_t pairs = (starts_.size() + 1) / 2;
  for (std::size_t i = 0; i < pairs; ++i) {
    starts_[i] = starts_[2 * i];
    for (std::size_t k = 0; k < columns_; ++k) {
      Extremes joined = place(2 * i)[k];
      if (2 * i + 1 < starts_.size()) {
        widen(joined.least, place(2 * i + 1)[k].least, false);
        widen(joined.greatest, place(2 * i + 1)[k].greatest, true);
      }
      place(i)[k] = joined;
    }
  }
  // With an odd number of places the last one is half full.
  rows_in_last_ = starts_.size() % 2 == 0 ? 2 * rows_a_place_ : rows_a_place_;
  rows_a_place_ *= 2;
  starts_.resize(pairs);
  extremes_.resize(pairs * columns_);
}

std::vector<TimedValue> PlotHistory::column(std::size_t index) const {
  std::vector<TimedValue> out;
  out.reserve(2 * starts_.size() + 1);
  for (std::size_t i = 0; i < starts_.size(); ++i) {
    const Extremes& extremes = extremes_[i * columns_ + index];
    const bool rises = extremes.least.time <= extremes.greatest.time;
    out.push_back(rises ? extremes.least : extremes.greatest);
    const TimedValue& second = rises ? extremes.greatest : extremes.least;
    if (second.time > out.back().time) out.push_back(second);
  }
  if (!last_.empty() && last_[index].time > out.back().time) out.push_back(last_[index]);
  return out;
}

}  // namespace mjarm::view
