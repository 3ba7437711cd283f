#include <gtest/gtest.h>

#include "mjarm/install/mesh_package_test.hpp"
#include "mjarm/install/unpack_internal.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm::install {
namespace {

class Unpack : public ::testing::Test {
 protected:
  Result<void> from(const std::string& bytes, std::uint64_t offset = 0) {
    got.clear();
    const auto take = [this](const MeshFile& mesh, const std::string& content) -> Result<void> {
      got[mesh.name] = content;
      return {};
    };
    return unpack(folder.write("toy.whl", bytes), offset, package.set, take);
  }

  support::TempFolder folder;
  MeshPackage package = toy_package();
  std::map<std::string, std::string> got;
};

TEST_F(Unpack, GivesTheMeshesFromAnyPartThatHoldsThem) {
  for (const std::size_t offset : {0, 1, 4999, 5000}) {
    ASSERT_TRUE(from(package.wheel.substr(offset), offset));
    EXPECT_EQ(got, package.contents);
  }
  EXPECT_FALSE(from(package.wheel, 1));
}

TEST_F(Unpack, AnyFlippedByteIsSeenOrHarmless) {
  Rng rng(2);
  for (int round = 0; round < 60; ++round) {
    std::string wheel = package.wheel;
    char& byte = wheel[rng.below(wheel.size())];
    byte = static_cast<char>(byte ^ 0x10);
    EXPECT_TRUE(!from(wheel) || got == package.contents);
  }
  std::string wheel = package.wheel;
  wheel[package.set.files[2].offset + 100] ^= 1;
  const auto result = from(wheel);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, Errc::not_available);
  EXPECT_NE(result.error().what.find("c.stl"), std::string::npos) << result.error().what;
}

TEST_F(Unpack, TruncatedAtAnyPointIsAnError) {
  for (std::size_t size = 0; size < package.wheel.size() - 6000; size += 997) {
    EXPECT_FALSE(from(package.wheel.substr(0, size)));
  }
}

TEST_F(Unpack, OneMeshInThePlaceOfAnotherIsRefused) {
  std::swap(package.set.files[0].name, package.set.files[1].name);
  std::swap(package.set.files[0].sha256, package.set.files[1].sha256);
  const auto result = from(package.wheel);
  ASSERT_FALSE(result);
  EXPECT_NE(result.error().what.find("b.obj"), std::string::npos) << result.error().what;
  EXPECT_TRUE(got.empty());
}

TEST_F(Unpack, AMeshOfAnotherSizeIsRefused) {
  for (const int more : {-1, 1}) {
    MeshPackage other = package;
    other.set.files[3].size += static_cast<std::uint64_t>(more);
    std::swap(package, other);
    const auto result = from(package.wheel);
    std::swap(package, other);
    ASSERT_FALSE(result);
    EXPECT_NE(result.error().what.find("d.obj"), std::string::npos) << result.error().what;
  }
}

}  // namespace
}  // namespace mjarm::install
