#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>

namespace mjarm {

/// Text of a progress bar, `width` columns at most; free of any clock, so that it can be tested.
/// @param seconds  [s] since the start, >= 0; rate and time left follow from it.
/// @param total    0 where unknown: then only count and rate are shown.
[[nodiscard]] std::string progress_line(const std::string& label, std::uint64_t done,
                                        std::uint64_t total, double seconds, int width);

/// Tells a user how far a long job is. On a terminal one line is redrawn at most ten times a
/// second; elsewhere, and where only warnings are logged, it is silent. `advance` may be called
/// from many threads. Never part of any result.
class Progress {
 public:
  /// @param label  from the catalogue, a few words.
  /// @param total  number of steps; 0 where unknown.
  explicit Progress(std::string label, std::uint64_t total);
  /// Takes the line away.
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// `steps` more are done.
  void advance(std::uint64_t steps = 1) noexcept;
  /// Shows a line of the caller's own, where it is time for one; only then it is made.
  void show(const std::function<std::string()>& line) noexcept;
  /// Whether anything is shown at all.
  [[nodiscard]] bool is_visible() const noexcept { return visible_; }

 private:
  using Clock = std::chrono::steady_clock;
  /// @param line  line(seconds): what is shown.
  template <class Line>
  void draw_if_due(const Line& line) noexcept;

  std::string label_;
  std::uint64_t total_;
  bool visible_;
  Clock::time_point start_;
  std::atomic<std::uint64_t> done_{0};
  std::atomic<std::int64_t> next_draw_ns_;  ///< since `start_`
  std::mutex drawing_;
};

}  // namespace mjarm
