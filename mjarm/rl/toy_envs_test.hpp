#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "mjarm/core/rng.hpp"
#include "mjarm/rl/vec_env.hpp"

namespace mjarm::testing {

using namespace rl;

/// What small tasks share: rows of numbers, and a random stream for each copy.
class ToyEnv : public VecEnv {
 public:
  ToyEnv(int copies, int observations, int actions, int step_limit)
      : copies_(copies), observations_(observations), actions_(actions), limit_(step_limit) {
    const auto n = static_cast<std::size_t>(copies);
    now_.resize(n * static_cast<std::size_t>(observations));
    last_.assign(now_.size(), std::numeric_limits<float>::quiet_NaN());
    rewards_.resize(n);
    terminated_.resize(n);
    truncated_.resize(n);
    steps_.resize(n);
  }

  [[nodiscard]] int count() const noexcept override { return copies_; }
  [[nodiscard]] int observation_size() const noexcept override { return observations_; }
  [[nodiscard]] int action_size() const noexcept override { return actions_; }

  [[nodiscard]] Result<void> reset(std::uint64_t seed) override {
    seed_ = seed;
    rngs_.clear();
    for (std::size_t copy = 0; copy < steps_.size(); ++copy) {
      rngs_.emplace_back(seed, copy + 1);
      begin(copy);
    }
    return {};
  }

  [[nodiscard]] Result<void> step(std::span<const float> actions) override {
    for (std::size_t copy = 0; copy < steps_.size(); ++copy) {
      const auto width = static_cast<std::size_t>(actions_);
      steps_[copy] += 1;
      const bool ends = move(copy, actions.subspan(copy * width, width));
      terminated_[copy] = ends ? 1 : 0;
      truncated_[copy] = !ends && steps_[copy] >= limit_ ? 1 : 0;
      if (terminated_[copy] == 0 && truncated_[copy] == 0) continue;
      std::ranges::copy(row(copy), last_.begin() + (row(copy).data() - now_.data()));
      begin(copy);
    }
    if (++done_ == fail_at) rewards_.back() = std::numeric_limits<float>::quiet_NaN();
    if (done_ == refuse_at) return fail(Errc::impossible, "out of order");
    return {};
  }

  [[nodiscard]] std::span<const float> observations() const noexcept override { return now_; }
  [[nodiscard]] std::span<const float> rewards() const noexcept override { return rewards_; }
  [[nodiscard]] std::span<const std::uint8_t> terminated() const noexcept override {
    return terminated_;
  }
  [[nodiscard]] std::span<const std::uint8_t> truncated() const noexcept override {
    return truncated_;
  }
  [[nodiscard]] std::span<const float> final_observations() const noexcept override {
    return last_;
  }

  [[nodiscard]] std::vector<double> state() const override {
    std::vector<double> out(now_.begin(), now_.end());
    out.insert(out.end(), steps_.begin(), steps_.end());
    for (const Rng& rng : rngs_) {
      for (const std::uint64_t word : rng.state()) {
        out.push_back(static_cast<double>(word >> 32));
        out.push_back(static_cast<double>(word & 0xffffffffU));
      }
    }
    return out;
  }
  [[nodiscard]] Result<void> set_state(std::span<const double> state) override {
    if (state.size() != now_.size() + 9 * steps_.size()) {
      return fail(Errc::bad_input, "a state of another size");
    }
    const double* from = state.data();
    for (float& value : now_) value = static_cast<float>(*from++);
    for (int& value : steps_) value = static_cast<int>(*from++);
    for (Rng& rng : rngs_) {
      std::array<std::uint64_t, 4> words{};
      for (std::uint64_t& word : words) {
        word = static_cast<std::uint64_t>(*from++) << 32;
        word |= static_cast<std::uint64_t>(*from++);
      }
      rng = Rng(words);
    }
    return {};
  }

  [[nodiscard]] std::uint64_t seed() const noexcept { return seed_; }

  int fail_at = -1;    ///< number of the step whose last reward is not a number
  int refuse_at = -1;  ///< number of the step that is an error

 protected:
  /// First observation of an episode.
  virtual void start(Rng& rng, std::span<float> observation) = 0;
  /// One step of a copy: sets observation and reward.  @return whether the episode ends.
  virtual bool advance(std::span<float> observation, std::span<const float> action,
                       float& reward) = 0;

 private:
  [[nodiscard]] std::span<float> row(std::size_t copy) {
    const auto width = static_cast<std::size_t>(observations_);
    return std::span(now_).subspan(copy * width, width);
  }
  void begin(std::size_t copy) {
    steps_[copy] = 0;
    start(rngs_[copy], row(copy));
  }
  bool move(std::size_t copy, std::span<const float> action) {
    return advance(row(copy), action, rewards_[copy]);
  }

  int copies_, observations_, actions_, limit_;
  std::uint64_t seed_ = 0;
  int done_ = 0;
  std::vector<float> now_, last_, rewards_;
  std::vector<std::uint8_t> terminated_, truncated_;
  std::vector<int> steps_;
  std::vector<Rng> rngs_;
};

/// A point in the plane that is pushed to a random goal; observed are goal minus point, and the
/// point on a scale of its own. It costs its distance; there, it is done.
class PointMass : public ToyEnv {
 public:
  explicit PointMass(int copies) : ToyEnv(copies, 4, 2, 25) {}

 private:
  void start(Rng& rng, std::span<float> observation) override {
    for (int k = 0; k < 2; ++k) {
      const double point = rng.uniform(-1, 1), goal = rng.uniform(-1, 1);
      observation[k] = static_cast<float>(goal - point);
      observation[k + 2] = static_cast<float>(100 + 20 * point);
    }
  }
  bool advance(std::span<float> observation, std::span<const float> action,
               float& reward) override {
    for (int k = 0; k < 2; ++k) {
      const float push = 0.2F * std::clamp(action[k], -1.0F, 1.0F);
      observation[k] -= push;
      observation[k + 2] += 20 * push;
    }
    const float distance = std::hypot(observation[0], observation[1]);
    reward = -distance;
    return distance < 0.1F;
  }
};

/// Every step gives 1, for ever; a positive action gives 6 once and ends it. Episodes are cut after
/// 4 steps. Going on is worth 1 / (1 - discount): more than 6 from a discount of 5/6 on, but only
/// to those who know that a cut is no end.
class CashOut : public ToyEnv {
 public:
  explicit CashOut(int copies) : ToyEnv(copies, 1, 1, 4) {}

 private:
  void start(Rng& rng, std::span<float> observation) override {
    observation[0] = static_cast<float>(rng.normal());  // means nothing
  }
  bool advance(std::span<float> observation, std::span<const float> action,
               float& reward) override {
    const bool out = action[0] > 0;
    reward = out ? 6.0F : 1.0F;
    observation[0] = -observation[0];
    return out;
  }
};

/// Every step gives the level of the episode, whatever is done; it is shown on a scale of its own.
/// Episodes are cut after 4 steps: the value of going on is level / (1 - discount).
class Level : public ToyEnv {
 public:
  explicit Level(int copies) : ToyEnv(copies, 1, 1, 4) {}
  static float shown(double level) { return static_cast<float>(100 + 20 * level); }

 private:
  void start(Rng& rng, std::span<float> observation) override {
    observation[0] = shown(rng.uniform(-1, 1));
  }
  bool advance(std::span<float> observation, std::span<const float>, float& reward) override {
    reward = (observation[0] - 100) / 20;
    return false;
  }
};

}  // namespace mjarm::testing
