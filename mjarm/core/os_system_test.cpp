#include "mjarm/core/os_system.hpp"

#include <gtest/gtest.h>

#include <fstream>

namespace mjarm {
namespace {

#if defined(__linux__)
TEST(OsSystem, IsWhatTheKernelSays) {
  std::string release;
  std::ifstream("/proc/sys/kernel/osrelease") >> release;
  ASSERT_FALSE(release.empty());
  const OperatingSystem system = operating_system();
  EXPECT_TRUE(system.name.starts_with("Linux " + release + " ")) << system.name;
  EXPECT_EQ(system.is_wsl, is_wsl_release(release));
}
#endif

TEST(OsSystem, KnowsTheKernelsOfWsl) {
  EXPECT_TRUE(is_wsl_release("5.15.153.1-microsoft-standard-WSL2"));
  EXPECT_TRUE(is_wsl_release("4.4.0-19041-Microsoft"));
  EXPECT_FALSE(is_wsl_release("6.1.0-18-amd64"));
}

}  // namespace
}  // namespace mjarm
