#include "mjarm/core/threads.hpp"

#include <system_error>
#include <thread>
#include <vector>

namespace mjarm {

void run_in_threads(int threads, const std::function<void(int thread)>& work) {
  std::vector<std::jthread> others;
  try {
    for (int i = 1; i < threads; ++i) others.emplace_back([&work, i] { work(i); });
  } catch (const std::system_error&) {  // no more threads to be had
  }
  work(0);
}

}  // namespace mjarm
