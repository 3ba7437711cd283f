#pragma once

#include <nanobind/nanobind.h>

#include <atomic>
#include <memory>
#include <mutex>

#include "mjarm/core/stop.hpp"

namespace mjarm::python {

/// Runs long calls without the lock of Python's interpreter, and ends them at Ctrl-C (or whatever
/// other signal has a handler that throws).
class Interrupt {
 public:
  /// To be given to the call.
  [[nodiscard]] StopCheck check() const;
  /// What the handler threw, as soon as the call is back.
  void rethrow() const;

 private:
  struct State;
  std::shared_ptr<State> state_ = make();
  static std::shared_ptr<State> make();
};

/// `call(stop)` without the interpreter's lock.
template <class Call>
auto interruptible(const Call& call) {
  const Interrupt interrupt;
  auto result = [&] {
    const nanobind::gil_scoped_release free;
    return call(interrupt.check());
  }();
  interrupt.rethrow();
  return result;
}

/// Of an object that one thread at a time may use: calls that are made without the interpreter's
/// lock wait for each other.
class Turn {
 public:
  [[nodiscard]] std::unique_lock<std::mutex> lock() const { return std::unique_lock(*mutex_); }

 private:
  std::unique_ptr<std::mutex> mutex_ = std::make_unique<std::mutex>();
};

}  // namespace mjarm::python
