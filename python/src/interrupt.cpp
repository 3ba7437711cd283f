#include "python/src/interrupt.hpp"

#include <chrono>
#include <mutex>
#include <optional>
#include <utility>

namespace mjarm::python {

namespace {
constexpr auto kEvery = std::chrono::milliseconds(20);
}

struct Interrupt::State {
  std::atomic<bool> stopped = false;
  std::atomic<std::chrono::steady_clock::rep> next = 0;
  std::optional<nanobind::python_error> thrown = {};  // guarded by the interpreter's lock

  bool look() {
    if (stopped) return true;
    const auto now = std::chrono::steady_clock::now().time_since_epoch();
    auto due = next.load();
    if (now.count() < due) return false;
    if (!next.compare_exchange_strong(
            due, (now + std::chrono::duration_cast<std::chrono::steady_clock::duration>(kEvery))
                     .count())) {
      return stopped;
    }
    const nanobind::gil_scoped_acquire bound;
    if (PyErr_CheckSignals() == 0) return false;
    thrown.emplace();
    stopped = true;
    return true;
  }
};

std::shared_ptr<Interrupt::State> Interrupt::make() { return std::make_shared<State>(); }

StopCheck Interrupt::check() const {
  return [state = state_] { return state->look(); };
}

void Interrupt::rethrow() const {
  if (state_->thrown) throw nanobind::python_error(std::move(*state_->thrown));
}

}  // namespace mjarm::python
