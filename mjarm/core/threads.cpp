#include "mjarm/core/threads.hpp"

#include <algorithm>
#include <system_error>
#include <thread>
#include <vector>

#include "mjarm/core/os.hpp"

namespace mjarm {

void run_in_threads(int threads, const std::function<void(int thread)>& work) {
  // More than a few a core bring nothing, and each takes memory of its own.
  threads = std::min(threads, std::max(16, 2 * core_count()));
  std::vector<std::jthread> others;
  try {
    for (int i = 1; i < threads; ++i) others.emplace_back([&work, i] { work(i); });
  } catch (const std::system_error&) {  // no more threads to be had
  }
  work(0);
}

}  // namespace mjarm
