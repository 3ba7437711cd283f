#include "mjarm/core/file.hpp"

#include <gtest/gtest.h>

#include <iterator>
#include <string>

#include "tests/support/temp_folder.hpp"

namespace mjarm {
namespace {

namespace fs = std::filesystem;

int entries(const fs::path& folder) {
  return static_cast<int>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

TEST(File, ReadsWhatWasWritten) {
  const support::TempFolder folder;
  const fs::path file = folder.path() / "a b.txt";
  const std::string content("one\ntwo\0three", 13);
  ASSERT_TRUE(write_file(file, content));
  EXPECT_EQ(read_file(file).value(), content);
  ASSERT_TRUE(write_file(file, ""));
  EXPECT_EQ(read_file(file).value(), "");
  EXPECT_EQ(entries(folder.path()), 1);
}

TEST(File, ReadErrorsNameThePath) {
  const support::TempFolder folder;
  const auto missing = read_file(folder.path() / "none.txt");
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, Errc::bad_input);
  EXPECT_NE(missing.error().what.find("none.txt: no such file"), std::string::npos);
  const auto a_folder = read_file(folder.path());
  ASSERT_FALSE(a_folder);
  EXPECT_EQ(a_folder.error().code, Errc::bad_input);
  EXPECT_NE(a_folder.error().what.find("folder"), std::string::npos);
}

TEST(File, ReadIsBounded) {
  const support::TempFolder folder;
  const fs::path file = folder.write("ten", "0123456789");
  EXPECT_EQ(read_file(file, 10).value(), "0123456789");
  const auto too_large = read_file(file, 9);
  ASSERT_FALSE(too_large);
  EXPECT_EQ(too_large.error().code, Errc::bad_input);
  EXPECT_FALSE(read_file("/dev/zero", 1000));
}

TEST(File, AppearsOnlyWhenCommitted) {
  const support::TempFolder folder;
  const fs::path file = folder.path() / "result";
  {
    auto writer = AtomicFile::create(file);
    ASSERT_TRUE(writer);
    ASSERT_TRUE(writer->write("half"));
    EXPECT_FALSE(fs::exists(file));
  }
  EXPECT_EQ(entries(folder.path()), 0);
  auto writer = AtomicFile::create(file);
  ASSERT_TRUE(writer);
  ASSERT_TRUE(writer->write("whole"));
  AtomicFile moved = std::move(*writer);
  ASSERT_TRUE(moved.commit());
  EXPECT_EQ(folder.read("result"), "whole");
  EXPECT_EQ(entries(folder.path()), 1);
}

TEST(File, AbandonedWriteKeepsTheOldFile) {
  const support::TempFolder folder;
  const fs::path file = folder.write("result", "old");
  {
    auto writer = AtomicFile::create(file);
    ASSERT_TRUE(writer);
    ASSERT_TRUE(writer->write("new"));
  }
  EXPECT_EQ(folder.read("result"), "old");
  EXPECT_EQ(entries(folder.path()), 1);
}

#if defined(__linux__)
TEST(File, KeepsPermissionsAndLinks) {
  const support::TempFolder folder;
  const fs::path file = folder.write("real", "old");
  fs::permissions(file, fs::perms::owner_read | fs::perms::owner_write);
  fs::create_symlink("real", folder.path() / "link");
  ASSERT_TRUE(write_file(folder.path() / "link", "new"));
  EXPECT_TRUE(fs::is_symlink(folder.path() / "link"));
  EXPECT_EQ(folder.read("real"), "new");
  EXPECT_EQ(fs::status(file).permissions(), fs::perms::owner_read | fs::perms::owner_write);
}
#endif

TEST(File, WriteErrorsNameThePath) {
  const support::TempFolder folder;
  const fs::path plain = folder.write("plain", "x");
  for (const fs::path& path : {folder.path() / "no" / "such" / "folder.txt", plain / "below"}) {
    const auto written = write_file(path, "text");
    ASSERT_FALSE(written) << path;
    EXPECT_EQ(written.error().code, Errc::system);
    EXPECT_EQ(written.error().what.find(path.string() + ": "), 0u) << written.error().what;
  }
  const auto to_folder = write_file(folder.path(), "text");
  ASSERT_FALSE(to_folder);
  EXPECT_EQ(to_folder.error().code, Errc::bad_input);
  EXPECT_EQ(entries(folder.path()), 1);
}

TEST(File, FullDiskIsReported) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  const auto written = write_file("/dev/full", "text");
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, Errc::system);
  EXPECT_NE(written.error().what.find("No space left"), std::string::npos) << written.error().what;
  EXPECT_TRUE(fs::exists("/dev/full"));
  EXPECT_TRUE(write_file("/dev/null", "text"));
}

}  // namespace
}  // namespace mjarm
