#include <system_error>

#include "mjarm/rl/workers_internal.hpp"

namespace mjarm::rl::detail {

Workers::Workers(int threads) {
  try {
    for (int i = 1; i < threads; ++i) others_.emplace_back([this, i] { wait_for_work(i); });
  } catch (const std::system_error&) {  // no more threads to be had
  }
}

Workers::~Workers() {
  {
    const std::lock_guard lock(mutex_);
    over_ = true;
  }
  begun_.notify_all();
  for (std::thread& thread : others_) thread.join();
}

void Workers::run(int tasks, const std::function<void(int, int)>& work) {
  std::unique_lock lock(mutex_);
  work_ = &work;
  next_ = 0;
  tasks_ = open_ = tasks;
  if (tasks > 1) begun_.notify_all();
  work_off(lock, 0);
  ended_.wait(lock, [this] { return open_ == 0; });
}

void Workers::work_off(std::unique_lock<std::mutex>& lock, int thread) {
  while (next_ < tasks_) {
    const int task = next_++;
    lock.unlock();
    (*work_)(task, thread);
    lock.lock();
    if (--open_ == 0) ended_.notify_one();
  }
}

void Workers::wait_for_work(int thread) {
  std::unique_lock lock(mutex_);
  for (;;) {
    begun_.wait(lock, [this] { return over_ || next_ < tasks_; });
    if (over_) return;
    work_off(lock, thread);
  }
}

}  // namespace mjarm::rl::detail
