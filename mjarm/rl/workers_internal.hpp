#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace mjarm::rl::detail {

/// Threads that wait for work: many short pieces of it, of which each is done once, by whoever
/// comes first. What a piece computes may not depend on the thread.
class Workers {
 public:
  /// @param threads  with the calling one; fewer where the system has no more to give.
  explicit Workers(int threads);
  ~Workers();
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  /// Most threads that may call `work`.
  [[nodiscard]] int count() const noexcept { return static_cast<int>(others_.size()) + 1; }
  /// Calls work(task, thread) for every task in [0, tasks) and returns when all are done.
  /// @param work  gets the number of its thread below count(); must not throw.
  void run(int tasks, const std::function<void(int task, int thread)>& work);

 private:
  /// Does tasks until none is left; called and left with the mutex locked.
  void work_off(std::unique_lock<std::mutex>& lock, int thread);
  void wait_for_work(int thread);

  std::mutex mutex_;
  std::condition_variable begun_, ended_;
  const std::function<void(int, int)>* work_ = nullptr;
  int next_ = 0;   ///< task to be done
  int tasks_ = 0;  ///< of this run
  int open_ = 0;   ///< tasks not done
  bool over_ = false;
  std::vector<std::thread> others_;
};

}  // namespace mjarm::rl::detail
