#include "apps/mjarm/install/unpack.hpp"

#include <gtest/gtest.h>

#include "apps/mjarm/install/mesh_package_test.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm::app {
namespace {

class Unpack : public ::testing::Test {
 protected:
  Result<void> from_archive(const std::string& bytes) {
    return unpack_archive(folder.write("toy.tar.xz", bytes), package.set, sink());
  }
  Result<void> from_wheel(const std::string& bytes, std::uint64_t offset) {
    return unpack_wheel_part(folder.write("toy.whl", bytes), offset, package.set, sink());
  }
  MeshSink sink() {
    got.clear();
    return [this](const MeshFile& mesh, const std::string& content) -> Result<void> {
      got[mesh.name] = content;
      return {};
    };
  }
  std::vector<std::pair<std::string, std::string>> entries() {
    std::vector<std::pair<std::string, std::string>> list;
    for (const auto& [name, content] : package.contents) {
      list.emplace_back("toy_robot/assets/" + name, content);
    }
    return list;
  }

  support::TempFolder folder;
  MeshPackage package = toy_package();
  std::map<std::string, std::string> got;
};

TEST_F(Unpack, BothSourcesGiveTheSame) {
  ASSERT_TRUE(from_archive(package.archive));
  EXPECT_EQ(got, package.contents);
  ASSERT_TRUE(from_wheel(package.wheel, 0));
  EXPECT_EQ(got, package.contents);
  ASSERT_TRUE(from_wheel(package.wheel.substr(5000), 5000));
  EXPECT_EQ(got, package.contents);
}

TEST_F(Unpack, AnyFlippedByteIsSeenOrHarmless) {
  Rng rng(2);
  for (int round = 0; round < 60; ++round) {
    std::string archive = package.archive, wheel = package.wheel;
    const auto flip = [&](std::string& bytes) {
      auto& byte = bytes[rng.below(bytes.size())];
      byte = static_cast<char>(byte ^ 0x10);
    };
    flip(archive);
    flip(wheel);
    EXPECT_TRUE(!from_archive(archive) || got == package.contents);
    EXPECT_TRUE(!from_wheel(wheel, 0) || got == package.contents);
  }
  std::string wheel = package.wheel;
  wheel[package.set.files[2].offset + 100] ^= 1;
  const auto result = from_wheel(wheel, 0);
  ASSERT_FALSE(result);
  EXPECT_NE(result.error().what.find("c.stl"), std::string::npos) << result.error().what;
}

TEST_F(Unpack, TruncatedAtAnyPointIsAnError) {
  for (std::size_t size = 0; size < package.archive.size(); size += 997) {
    EXPECT_FALSE(from_archive(package.archive.substr(0, size)));
  }
  for (std::size_t size = 0; size < package.wheel.size() - 6000; size += 997) {
    EXPECT_FALSE(from_wheel(package.wheel.substr(0, size), 0));
  }
}

TEST_F(Unpack, RefusesToLeaveItsFolder) {
  for (const char* name : {"../evil", "/tmp/evil", "toy_robot/assets/../../../evil",
                           "toy_robot/assets/../../toy_robot/assets/a.obj"}) {
    auto list = entries();
    list.insert(list.begin(), {name, "evil"});
    const auto result = from_archive(tar_xz(list));
    ASSERT_FALSE(result) << name;
    EXPECT_NE(result.error().what.find(name), std::string::npos) << result.error().what;
    EXPECT_TRUE(got.empty());
  }
}

TEST_F(Unpack, PassesOverWhatIsNotAsked) {
  auto list = entries();
  list.emplace_back("toy_robot/assets/more.obj", "more");
  list.emplace_back("a.obj", "elsewhere");
  list.emplace_back("toy_robot/assets/deep/a.obj", "deeper");
  ASSERT_TRUE(from_archive(tar_xz(list)));
  EXPECT_EQ(got, package.contents);
}

TEST_F(Unpack, NamesWhatIsMissingOrOfAnotherSize) {
  auto list = entries();
  list.erase(list.begin() + 1);
  const auto missing = from_archive(tar_xz(list));
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.error().what.find("b.obj"), std::string::npos) << missing.error().what;
  list = entries();
  list[3].second += "x";
  const auto longer = from_archive(tar_xz(list));
  ASSERT_FALSE(longer);
  EXPECT_NE(longer.error().what.find("d.obj"), std::string::npos) << longer.error().what;
}

}  // namespace
}  // namespace mjarm::app
