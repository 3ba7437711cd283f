// Where files may lie and what is left behind: folders that are half there, links, several writers.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "mjarm/core/file.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::StartsWith;

std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.push_back(entry.path().filename());
  std::sort(names.begin(), names.end());
  return names;
}

using Names = std::vector<std::string>;

TEST(FilePlaces, FoldersAreMadeWithAllAboveThemAndAgain) {
  const support::TempFolder folder;
  const fs::path deep = folder.path() / "一" / "b c" / "d";
  ASSERT_TRUE(make_folder(deep));
  EXPECT_TRUE(fs::is_directory(deep));
  ASSERT_TRUE(write_file(deep / "kept", "x"));
  EXPECT_TRUE(make_folder(deep));
  EXPECT_TRUE(make_folder(deep / ""));  // written with a slash at its end
  EXPECT_EQ(names_in(deep), Names{"kept"});
  fs::create_directory_symlink(deep, folder.path() / "way");
  EXPECT_TRUE(make_folder(folder.path() / "way"));
  EXPECT_TRUE(make_folder(folder.path() / "way" / "e"));
  EXPECT_TRUE(fs::is_directory(deep / "e"));
}

TEST(FilePlaces, WhatCannotBeAFolderIsNamed) {
  const support::TempFolder folder;
  const fs::path plain = folder.write("plain", "words");
  fs::create_symlink("nowhere", folder.path() / "lost");
  for (const fs::path& path :
       {plain, plain / "below", plain / "far" / "below", folder.path() / "lost"}) {
    const Result<void> made = make_folder(path);
    ASSERT_FALSE(made) << path;
    EXPECT_EQ(made.error().code, Errc::system);
    EXPECT_THAT(made.error().what, StartsWith(path.string() + ": cannot be made a folder: "));
    EXPECT_EQ(made.error().what.find("Success"), std::string::npos) << made.error().what;
  }
  EXPECT_FALSE(make_folder(""));
  EXPECT_EQ(folder.read("plain"), "words");
}

TEST(FilePlaces, WhatGrowsLiesBesideItsPlaceAndMayBeWrittenByOthers) {
  const support::TempFolder folder;
  const fs::path file = folder.write("film.mp4", "old");
  Result<AtomicFile> writer = AtomicFile::create(file);
  ASSERT_TRUE(writer) << writer.error().what;
  const fs::path growing = writer->growing();
  EXPECT_NE(growing, file);
  EXPECT_EQ(growing.parent_path(), file.parent_path());  // one rename away
  std::ofstream(growing) << "by another program";
  ASSERT_TRUE(writer->commit());
  EXPECT_EQ(folder.read("film.mp4"), "by another program");
  EXPECT_EQ(names_in(folder.path()), Names{"film.mp4"});
}

TEST(FilePlaces, AWriterThatIsReplacedTakesItsHalfFileAway) {
  const support::TempFolder folder;
  const fs::path first = folder.path() / "first", second = folder.path() / "second";
  Result<AtomicFile> writer = AtomicFile::create(first);
  ASSERT_TRUE(writer && writer->write("half"));
  Result<AtomicFile> other = AtomicFile::create(second);
  ASSERT_TRUE(other && other->write("whole"));
  EXPECT_EQ(names_in(folder.path()).size(), 2U);
  *writer = std::move(*other);
  EXPECT_EQ(names_in(folder.path()).size(), 1U);
  ASSERT_TRUE(writer->write(" file"));
  ASSERT_TRUE(writer->commit());
  EXPECT_EQ(names_in(folder.path()), Names{"second"});
  EXPECT_EQ(folder.read("second"), "whole file");
}

TEST(FilePlaces, AFileWhoseFolderVanishesMeanwhileIsAnErrorThatNamesIt) {
  const support::TempFolder folder;
  const fs::path file = folder.path() / "gone" / "result";
  ASSERT_TRUE(make_folder(file.parent_path()));
  Result<AtomicFile> writer = AtomicFile::create(file);
  ASSERT_TRUE(writer && writer->write("words"));
  fs::remove_all(file.parent_path());
  const Result<void> done = writer->commit();
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().code, Errc::system);
  EXPECT_THAT(done.error().what, StartsWith(file.string() + ": cannot be written: "));
  EXPECT_TRUE(names_in(folder.path()).empty());
}

TEST(FilePlaces, AFolderThatTookThePlaceMeanwhileStays) {
  const support::TempFolder folder;
  const fs::path file = folder.path() / "place";
  Result<AtomicFile> writer = AtomicFile::create(file);
  ASSERT_TRUE(writer && writer->write("words"));
  ASSERT_TRUE(make_folder(file / "inside"));
  EXPECT_FALSE(writer->commit());
  EXPECT_EQ(names_in(folder.path()), Names{"place"});
  EXPECT_TRUE(fs::is_directory(file / "inside"));
}

TEST(FilePlaces, LinksAreFollowedThroughLinks) {
  const support::TempFolder folder;
  ASSERT_TRUE(make_folder(folder.path() / "data"));
  const fs::path real = folder.write("data/real", "old");
  fs::create_symlink("data/real", folder.path() / "near");
  fs::create_symlink("near", folder.path() / "far");
  ASSERT_TRUE(write_file(folder.path() / "far", "new"));
  EXPECT_TRUE(fs::is_symlink(folder.path() / "far"));
  EXPECT_TRUE(fs::is_symlink(folder.path() / "near"));
  EXPECT_EQ(folder.read("data/real"), "new");
  EXPECT_EQ(read_file(folder.path() / "far").value(), "new");
  // A link that leads round in a circle is no file that is missing.
  fs::create_symlink("circle", folder.path() / "circle");
  for (const auto& refused : {write_file(folder.path() / "circle", "x").error(),
                              read_file(folder.path() / "circle").error()}) {
    EXPECT_THAT(refused.what, HasSubstr("circle: cannot be "));
  }
  EXPECT_EQ(names_in(folder.path() / "data"), Names{"real"});
}

TEST(FilePlaces, WhoMayNotReadOrWriteIsToldSo) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may do everything";
  const support::TempFolder folder;
  const fs::path secret = folder.write("secret", "words");
  fs::permissions(secret, fs::perms::none);
  EXPECT_THAT(read_file(secret).error().what,
              HasSubstr("secret: cannot be read: Permission denied"));
  fs::permissions(folder.path(), fs::perms::owner_read | fs::perms::owner_exec);
  const Result<void> written = write_file(folder.path() / "new", "x");
  const Result<void> made = make_folder(folder.path() / "inner");
  fs::permissions(folder.path(), fs::perms::owner_all);
  ASSERT_FALSE(written);
  EXPECT_THAT(written.error().what, HasSubstr("new: cannot be written: Permission denied"));
  ASSERT_FALSE(made);
  EXPECT_THAT(made.error().what, HasSubstr("Permission denied"));
}

TEST(FilePlaces, OfManyWritersOneWinsWhole) {
  const support::TempFolder folder;
  const fs::path file = folder.path() / "result";
  constexpr int kWriters = 4, kRounds = 25;
  constexpr std::size_t kSize = 50'000;
  std::vector<int> bad(kWriters + 1, 0);
  std::vector<std::thread> threads;
  ASSERT_TRUE(write_file(file, std::string(kSize, 'z')));
  for (int i = 0; i < kWriters; ++i) {
    threads.emplace_back([&, i] {
      for (int n = 0; n < kRounds; ++n) {
        bad[i] += write_file(file, std::string(kSize, static_cast<char>('a' + i))) ? 0 : 1;
      }
    });
  }
  threads.emplace_back([&] {
    for (int n = 0; n < kRounds; ++n) {
      const Result<std::string> seen = read_file(file);
      bad[kWriters] += seen && *seen == std::string(kSize, seen->at(0)) ? 0 : 1;
    }
  });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(bad, std::vector<int>(kWriters + 1, 0));
  EXPECT_EQ(names_in(folder.path()), Names{"result"});
}

TEST(AtomicFile, WritesThroughALinkToAFileThatIsNotThereYet) {
  const support::TempFolder folder;
  const std::filesystem::path link = folder.path() / "link";
  std::filesystem::create_symlink("later", link);
  ASSERT_TRUE(write_file(link, "x"));
  EXPECT_TRUE(std::filesystem::is_symlink(link));
  EXPECT_EQ(read_file(folder.path() / "later").value(), "x");
}

}  // namespace
}  // namespace mjarm
