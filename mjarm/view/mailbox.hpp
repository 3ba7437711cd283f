#pragma once

#include <atomic>
#include <cstddef>
#include <mutex>
#include <utility>
#include <vector>

namespace mjarm::view {

/// Hands the latest of many values from one thread to another: older ones that nobody took are
/// lost. The lock is held only while two values are swapped, so neither waits for the other's work;
/// memory of the values goes round and is used again.
template <class T>
class Mailbox {
 public:
  /// True once the value posted last was taken: a good time to make the next one.
  [[nodiscard]] bool is_empty() const noexcept { return !full_.load(std::memory_order_acquire); }
  /// Leaves `value` for the other thread, and brings back an old one to be filled anew.
  void post(T& value) {
    const std::scoped_lock lock(mutex_);
    std::swap(slot_, value);
    full_.store(true, std::memory_order_release);
  }
  /// Takes the latest value.
  /// @return false, and leaves `value` as it is, where none came since.
  bool take(T& value) {
    if (is_empty()) return false;
    const std::scoped_lock lock(mutex_);
    std::swap(slot_, value);
    full_.store(false, std::memory_order_release);
    return true;
  }

 private:
  std::mutex mutex_;
  T slot_ = {};
  std::atomic<bool> full_{false};
};

/// Hands all values from one thread to another, in order.
template <class T>
class Queue {
 public:
  void push(std::vector<T> values) {
    if (values.empty()) return;
    const std::scoped_lock lock(mutex_);
    for (T& value : values) values_.push_back(std::move(value));
    full_.store(true, std::memory_order_release);
  }
  /// All values since the last call.
  [[nodiscard]] std::vector<T> take() {
    if (!full_.load(std::memory_order_acquire)) return {};
    const std::scoped_lock lock(mutex_);
    full_.store(false, std::memory_order_release);
    return std::exchange(values_, {});
  }
  /// Values that nobody took yet: who pushes what strangers send can wait for room.
  [[nodiscard]] std::size_t size() const {
    const std::scoped_lock lock(mutex_);
    return values_.size();
  }

 private:
  mutable std::mutex mutex_;
  std::vector<T> values_;
  std::atomic<bool> full_{false};
};

}  // namespace mjarm::view
