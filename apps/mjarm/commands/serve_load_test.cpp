#include <gtest/gtest.h>
#include <signal.h>

#include <atomic>
#include <chrono>
#include <fstream>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "mjarm/serve/page_client_test.hpp"
#include "tests/support/rounds.hpp"
#include "tests/support/run_program.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm::app {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using std::chrono::steady_clock;

/// A demo of two seconds that begins once a page is open, and is served until it gets Ctrl-C.
class ServedDemo {
 public:
  explicit ServedDemo(const support::TempFolder& folder)
      : folder_(folder), runner_([this] {
          const std::string here = folder_.path().string();
          result_ = support::run_program(
              "/bin/sh", {"-c", "cd '" + here +
                                    "' || exit; '" MJARM_PROGRAM
                                    "' demo car --seconds 2 --serve --no-timing --out served "
                                    "> address & echo $! > pid; wait $!"});
        }) {}
  ~ServedDemo() {
    if (runner_.joinable()) (void)end();
  }
  ServedDemo(const ServedDemo&) = delete;
  ServedDemo& operator=(const ServedDemo&) = delete;

  /// Waits for a file that is made meanwhile; its first word.
  std::string word_of(const std::string& name) const {
    std::string word;
    for (const auto last = steady_clock::now() + seconds(60);
         word.empty() && steady_clock::now() < last;) {
      std::ifstream(folder_.path() / name) >> word;
      if (word.empty()) std::this_thread::sleep_for(milliseconds(20));
    }
    return word;
  }
  [[nodiscard]] int pid() const { return std::stoi("0" + word_of("pid")); }
  /// [MB] that it holds in memory.
  [[nodiscard]] double memory() const {
    double pages = 0;
    std::ifstream("/proc/" + std::to_string(pid()) + "/statm") >> pages >> pages;
    return pages * 4096 / 1e6;
  }
  support::ProgramResult end() {
    if (const int id = pid(); id > 0) ::kill(id, SIGINT);
    runner_.join();
    return result_;
  }

 private:
  const support::TempFolder& folder_;
  support::ProgramResult result_;
  std::thread runner_;
};

/// What no page would say.
std::string nonsense(int i) {
  switch (i % 5) {
    case 0:
      return "{\"type\":\"joint\",\"dof\":0,\"value\":1e999}";
    case 1:
      return std::string(60'000, 'x');
    case 2:
      return "{\"type\":\"push\",\"body\":-1,\"point\":[null],\"force\":[0,0,0]}";
    case 3:
      return "[[[[[[[[";
    default:
      return "{\"type\":\"step\",\"steps\":1,\"more\":2}";
  }
}

/// One page that looks on, and one after the other that talks nonsense until it is sent away.
void be_a_nuisance(int port, const std::string& live, steady_clock::time_point end,
                   std::atomic<int>& left, const std::atomic<bool>& ran) {
  testing::Client looking(port);
  if (looking.open(live)) return;
  while (steady_clock::now() < end || left > 0) {
    if (left > 0) {
      testing::Client talking(port);
      if (!talking.open(live)) {
        for (int i = 0; i < 100 && left-- > 0 && !talking.send(nonsense(i)); ++i) continue;
      }
    }
    // While it runs a page may be slow; then it is told something only where it asks.
    if (!ran) {
      std::this_thread::sleep_for(milliseconds(20));
    } else if (!looking.send("{\"type\":\"step\",\"steps\":-1}")) {
      (void)looking.receive("frame");
    }
  }
}

/// Ten pages and thousands of messages that make no sense: the run is the same as without anybody,
/// and the memory stays as it is.
TEST(ServeLoad, PagesAndNonsenseChangeNothing) {
  const support::TempFolder folder;
  ServedDemo demo(folder);
  const std::string url = demo.word_of("address");
  ASSERT_TRUE(url.starts_with("http://127.0.0.1:")) << url;
  const std::size_t slash = url.find('/', 7);
  const int port = std::stoi(url.substr(17, slash - 17));
  const std::string live = url.substr(slash) + "live";
  const bool is_long = testing::is_long();
  const auto begin = steady_clock::now();
  const auto end = begin + seconds(is_long ? 600 : 4);
  std::atomic<int> left{is_long ? 10'000 : 1'000};
  std::atomic<bool> ran{false};
  std::vector<std::thread> pages;
  for (int i = 0; i < 10; ++i) {
    pages.emplace_back([&] { be_a_nuisance(port, live, end, left, ran); });
  }
  EXPECT_NE(demo.word_of("served/report.json"), "");
  ran = true;
  std::this_thread::sleep_for((end - begin) / 4);
  const double before = demo.memory();
  for (std::thread& page : pages) page.join();
  const double after = demo.memory();
  EXPECT_LE(left, 0);
  EXPECT_GT(before, 10);
  EXPECT_LT(after - before, 8) << before << " MB";
  const support::ProgramResult served = demo.end();
  const auto alone = support::run_program(
      MJARM_PROGRAM, {"demo", "car", "--seconds", "2", "--headless", "--no-timing", "--out",
                      (folder.path() / "alone").string()});
  // In two seconds the car does not get far, which is told.
  EXPECT_EQ(alone.exit_code, 1) << alone.err;
  EXPECT_EQ(served.exit_code, 1) << served.err;
  EXPECT_EQ(folder.read("served/log.csv"), folder.read("alone/log.csv"));
  EXPECT_EQ(folder.read("served/report.json"), folder.read("alone/report.json"));
}

}  // namespace
}  // namespace mjarm::app
