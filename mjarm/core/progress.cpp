#include "mjarm/core/progress.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "mjarm/core/log.hpp"
#include "mjarm/core/messages/core.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/core/progress_sink.hpp"
#include "mjarm/core/text_width.hpp"

namespace mjarm {
namespace {

constexpr std::int64_t kFirstDrawNs = 500'000'000;  // short jobs show nothing at all
constexpr std::int64_t kBetweenDrawsNs = 100'000'000;

ProgressSink& own_sink() {
  static ProgressSink sink;
  return sink;
}

void put(const std::string& line) {
  if (own_sink()) return own_sink()(line);
  show_status(line);
}

std::string duration_text(double seconds) {
  const auto s = static_cast<long long>(std::ceil(std::min(seconds, 359'999.0)));
  if (s < 3600) return fmt::format("{}:{:02}", s / 60, s % 60);
  return fmt::format("{}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60);
}

}  // namespace

void set_progress_sink(ProgressSink sink) { own_sink() = std::move(sink); }

std::string progress_line(const std::string& label, std::uint64_t done, std::uint64_t total,
                          double seconds, int width) {
  const double rate = seconds > 0 ? static_cast<double>(done) / seconds : 0;
  const std::string rate_text = text(msg::core_progress_rate, rate);
  if (total == 0) return fmt::format("{} {} {}", label, done, rate_text);
  const double share = std::min(1.0, static_cast<double>(done) / static_cast<double>(total));
  const auto left = static_cast<double>(total - std::min(done, total));
  std::string tail = fmt::format(" {:3.0f}% {}/{} {}", 100 * share, done, total, rate_text);
  if (rate > 0) tail += " " + text(msg::core_progress_left, duration_text(left / rate));
  const int room = std::min(40, width - 1 - text_width(label) - text_width(tail) - 3);
  if (room < 5) return label + tail;
  const auto filled = static_cast<std::size_t>(std::floor(share * room));
  return label + " [" + std::string(filled, '#') +
         std::string(static_cast<std::size_t>(room) - filled, '.') + "]" + tail;
}

Progress::Progress(std::string label, std::uint64_t total)
    : label_(std::move(label)),
      total_(total),
      visible_((own_sink() || stderr_is_terminal()) && log_level() <= LogLevel::info),
      start_(Clock::now()),
      next_draw_ns_(kFirstDrawNs) {}

Progress::~Progress() {
  if (visible_) put("");
}

void Progress::advance(std::uint64_t steps) noexcept {
  done_.fetch_add(steps, std::memory_order_relaxed);
  draw_if_due([&](double seconds) {
    return progress_line(label_, done_, total_, seconds, terminal_width());
  });
}

void Progress::show(const std::function<std::string()>& line) noexcept {
  draw_if_due([&](double) { return line(); });
}

template <class Line>
void Progress::draw_if_due(const Line& line) noexcept {
  if (!visible_) return;
  const std::chrono::nanoseconds elapsed = Clock::now() - start_;
  if (elapsed.count() < next_draw_ns_.load(std::memory_order_relaxed)) return;
  const std::unique_lock<std::mutex> lock(drawing_, std::try_to_lock);
  if (!lock.owns_lock()) return;  // another thread is at it
  if (elapsed.count() < next_draw_ns_) return;
  next_draw_ns_ = elapsed.count() + kBetweenDrawsNs;
  try {
    put(line(std::chrono::duration<double>(elapsed).count()));
  } catch (...) {  // a bar that cannot be drawn is no reason to stop the job
  }
}

}  // namespace mjarm
