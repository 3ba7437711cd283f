#include "mjarm/core/os.hpp"

#include <gtest/gtest.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>

#include "mjarm/core/cpu.hpp"
#include "mjarm/core/messages.hpp"

namespace mjarm {
namespace {

/// Sets environment variables for one test and puts them back.
class Environment {
 public:
  void set(const std::string& name, const std::string& value) {
    keep(name);
    setenv(name.c_str(), value.c_str(), 1);
  }
  void unset(const std::string& name) {
    keep(name);
    unsetenv(name.c_str());
  }
  ~Environment() {
    for (auto it = old_.rbegin(); it != old_.rend(); ++it) {
      if (it->second) {
        setenv(it->first.c_str(), it->second->c_str(), 1);
      } else {
        unsetenv(it->first.c_str());
      }
    }
  }

 private:
  void keep(const std::string& name) { old_.emplace_back(name, environment(name)); }
  std::vector<std::pair<std::string, std::optional<std::string>>> old_;
};

TEST(Os, KnowsItsProgram) {
  const auto path = executable_path();
  ASSERT_TRUE(path);
  EXPECT_TRUE(path->is_absolute());
  EXPECT_TRUE(std::filesystem::exists(*path));
}

TEST(Os, LocaleIsTheFirstThatIsSet) {
  Environment env;
  env.set("LC_ALL", "");
  env.unset("LC_MESSAGES");
  env.set("LANG", "zh_CN.UTF-8");
  EXPECT_EQ(locale_name(), "zh_CN.UTF-8");
  EXPECT_EQ(language_of_locale(), Language::chinese);
  env.set("LC_MESSAGES", "de_DE");
  EXPECT_EQ(locale_name(), "de_DE");
  env.set("LC_ALL", "C");
  EXPECT_EQ(locale_name(), "C");
  EXPECT_EQ(language_of_locale(), Language::english);
}

#if defined(__linux__)
TEST(Os, DisplayIsAnnouncedByTheEnvironment) {
  Environment env;
  env.unset("DISPLAY");
  env.unset("WAYLAND_DISPLAY");
  EXPECT_FALSE(has_display());
  env.set("DISPLAY", "");
  EXPECT_FALSE(has_display());
  env.set("DISPLAY", ":0");
  EXPECT_TRUE(has_display());
}
#endif

TEST(Os, SmallFactsAreSane) {
  EXPECT_GE(core_count(), 1);
  EXPECT_GT(terminal_width(), 0);
  EXPECT_GT(process_id(), 0);
  EXPECT_TRUE(std::filesystem::is_directory(temp_directory()));
  EXPECT_FALSE(environment("MJARM_SURELY_NOT_SET"));
  EXPECT_EQ(system_message(ENOSPC), "No space left on device");
}

#if !defined(_WIN32)
TEST(OsDeathTest, SecondInterruptEndsTheProgram) {
  ::testing::FLAGS_gtest_death_test_style = "threadsafe";
  EXPECT_EXIT(
      {
        catch_interrupts();
        const bool before = interrupted();
        std::raise(SIGINT);
        if (before || !interrupted()) std::_Exit(3);
        std::raise(SIGINT);
        std::_Exit(4);  // not reached
      },
      ::testing::KilledBySignal(SIGINT), "");
}
#endif

TEST(Cpu, LevelHasAName) {
  EXPECT_FALSE(name(simd_level()).empty());
  EXPECT_EQ(name(SimdLevel::avx2), "avx2");
  EXPECT_EQ(name(SimdLevel::avx512), "avx512");
  EXPECT_EQ(name(SimdLevel::neon), "neon");
  EXPECT_EQ(name(SimdLevel::baseline), "baseline");
}

TEST(CpuDeathTest, EnvironmentLowersTheLevel) {
  ::testing::FLAGS_gtest_death_test_style = "threadsafe";
  EXPECT_EXIT(
      {
        setenv("MJARM_SIMD", "baseline", 1);
        std::_Exit(simd_level() == SimdLevel::baseline ? 0 : 1);
      },
      ::testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace mjarm
