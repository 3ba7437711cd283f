#include "mjarm/model/mujoco_library.hpp"

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

namespace mjarm {
namespace {

TEST(MujocoLibrary, TellsWhatIsLoaded) {
  const MujocoLibrary library = mujoco_library();
  EXPECT_EQ(library.version, mj_versionString());
  // Headers and library of one machine belong together; the number is read apart by us.
  EXPECT_EQ(library.built_against, library.version);
  EXPECT_NE(library.file.filename().string().find("mujoco"), std::string::npos) << library.file;
  EXPECT_TRUE(std::filesystem::exists(library.file));
}

TEST(MujocoLibrary, FitsWithinItsSeries) {
  EXPECT_TRUE((MujocoLibrary{"4.0.0", "4.0.1", {}}.fits()));
  EXPECT_FALSE((MujocoLibrary{"4.1.0", "4.0.1", {}}.fits()));
  EXPECT_FALSE((MujocoLibrary{"14.0.1", "4.0.1", {}}.fits()));
}

}  // namespace
}  // namespace mjarm
