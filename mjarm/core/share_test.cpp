#include "mjarm/core/share.hpp"

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <fstream>
#include <iterator>
#include <string>

#include "mjarm/core/os_libraries.hpp"

namespace mjarm {
namespace {

/// The system's own list of what this process has mapped.
std::string mapped_files() {
  std::ifstream maps("/proc/self/maps");
  return {std::istreambuf_iterator<char>(maps), {}};
}

#if defined(__linux__)
TEST(LoadedLibrary, IsTheFileThatIsMapped) {
  ASSERT_NE(mj_versionString(), nullptr);  // so that this test is linked to MuJoCo
  const std::filesystem::path file = loaded_library("mujoco");
  ASSERT_TRUE(file.is_absolute()) << file;
  EXPECT_NE(mapped_files().find(file.string()), std::string::npos) << file;
}
#endif

TEST(LoadedLibrary, IsEmptyWhereThereIsNone) { EXPECT_TRUE(loaded_library("nosuchthing").empty()); }

#if defined(__linux__)
TEST(ShareFolders, AreThatOfTheProgramAndThatBesideMujoco) {
  const auto folders = share_folders();
  ASSERT_EQ(folders.size(), 2U);
  const auto program = std::filesystem::canonical("/proc/self/exe").parent_path();
  EXPECT_EQ(folders[0], program.parent_path() / "share" / "mjarm");
  const auto library = loaded_library("mujoco").parent_path();
  EXPECT_EQ(folders[1], library.parent_path() / "share" / "mjarm");
  EXPECT_EQ(share_folder().value(), folders[0]);  // the build tree has it
}
#endif

}  // namespace
}  // namespace mjarm
