#include "mjarm/core/user_cache.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "mjarm/core/file.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm {
namespace {

namespace fs = std::filesystem;

/// The only file of a folder.
fs::path only_file(const fs::path& folder) { return fs::directory_iterator(folder)->path(); }

TEST(UserCache, FindsWhatWasKeptAndNothingElse) {
  const support::TempFolder folder;
  const UserCache cache(folder.path() / "a" / "b");
  EXPECT_FALSE(cache.find("robot"));
  cache.keep("robot", std::string("spheres\0", 8));
  cache.keep("other robot", "");
  EXPECT_EQ(cache.find("robot"), std::string("spheres\0", 8));
  EXPECT_EQ(cache.find("other robot"), "");
  EXPECT_FALSE(cache.find("robot "));
  EXPECT_EQ(cache.size(), 64U + 8U + 64U);
}

TEST(UserCache, AChangedFileIsAsGoodAsNone) {
  for (const char* change : {"append", "cut", "flip", "empty"}) {
    const support::TempFolder folder;
    const UserCache cache(folder.path());
    cache.keep("robot", "spheres");
    const fs::path file = only_file(folder.path());
    std::string content = read_file(file).value();
    if (change == std::string_view("append")) content += "x";
    if (change == std::string_view("cut")) content.pop_back();
    if (change == std::string_view("flip")) content[70] ^= 1;
    if (change == std::string_view("empty")) content.clear();
    std::ofstream(file, std::ios::binary | std::ios::trunc) << content;
    EXPECT_FALSE(cache.find("robot")) << change;
    cache.keep("robot", "spheres");
    EXPECT_EQ(cache.find("robot"), "spheres") << change;
  }
}

TEST(UserCache, WhatWasUsedLongestAgoGoes) {
  const support::TempFolder folder;
  const UserCache cache(folder.path(), 1000);
  std::ofstream(folder.path() / "notes.txt") << std::string(5000, 'x');  // of somebody else
  const std::string value(200, 'v');
  const auto age = [&](const char* key, int hours) {  // makes the file of `key`, and older
    cache.keep(key, value);
    for (const auto& file : fs::directory_iterator(folder.path())) {
      const auto old = fs::file_time_type::clock::now() - std::chrono::hours(1);
      if (file.last_write_time() > old) fs::last_write_time(file, old - std::chrono::hours(hours));
    }
  };
  age("first", 3);
  age("second", 2);
  age("third", 1);
  EXPECT_TRUE(cache.find("first"));  // used just now
  cache.keep("fourth", value);
  EXPECT_TRUE(cache.find("first"));
  EXPECT_FALSE(cache.find("second"));
  EXPECT_TRUE(cache.find("third"));
  EXPECT_TRUE(cache.find("fourth"));
  EXPECT_LE(cache.size(), 1000U);
  cache.keep("too large", std::string(2000, 'v'));
  EXPECT_FALSE(cache.find("too large"));
  EXPECT_TRUE(cache.find("fourth"));
  EXPECT_EQ(fs::file_size(folder.path() / "notes.txt"), 5000U);
}

TEST(UserCache, AFolderThatCannotBeIsNoFault) {
  const support::TempFolder folder;
  std::ofstream(folder.path() / "file") << "x";
  const UserCache cache(folder.path() / "file" / "mjarm");
  cache.keep("robot", "spheres");
  EXPECT_FALSE(cache.find("robot"));
  EXPECT_EQ(cache.size(), 0U);
}

}  // namespace
}  // namespace mjarm
