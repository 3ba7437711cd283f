#include "mjarm/install/hanzi_package.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <cstring>

#include "mjarm/core/file.hpp"
#include "mjarm/core/sha256.hpp"
#include "mjarm/install/inflate_internal.hpp"
#include "mjarm/install/mesh_package_test.hpp"
#include "mjarm/install/npm_archive_internal.hpp"
#include "tests/support/http_server.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm::install {
namespace {

using ::testing::HasSubstr;
namespace fs = std::filesystem;

/// One file as a tar archive holds it.
std::string tar_entry(const std::string& name, const std::string& content) {
  std::string header(512, '\0');
  name.copy(header.data(), 100);
  std::snprintf(header.data() + 124, 12, "%011zo", content.size());
  header[156] = '0';
  std::memcpy(header.data() + 257, "ustar", 5);
  std::string padded = content;
  padded.resize((content.size() + 511) / 512 * 512);
  return header + padded;
}

std::string gzipped(const std::string& content) { return deflated(content, 16 + MAX_WBITS); }

/// A small package of our own, on a server of our own.
class Hanzi : public ::testing::Test {
 protected:
  Hanzi() {
    archive = gzipped(
        tar_entry("package/package.json", "{\"name\": \"x\"}") +
        tar_entry("package/ARPHICPL.TXT", "a licence") +
        tar_entry("package/上.json", R"({"medians": [[[1, 2], [3, -4.5]], [[5, 6], [7, 8]]]})") +
        tar_entry("package/一.json", R"({"strokes": [], "medians": [[[1, 2], [3, 4]]]})") +
        tar_entry("package/index.js", "x") + std::string(1024, '\0'));
    package.size = archive.size();
    package.sha256 = sha256(archive);
    package.strokes_sha256 = sha256(strokes);
    fs::create_directories(data);
  }
  Result<void> install() {
    server.serve("/files/" + package.file, {.body = archive});
    HttpOptions http;
    http.stall_timeout = 2;
    return install_hanzi(data, http, server.url() + "/files", package);
  }
  InstallState::Kind kind() { return check_hanzi(data, package).kind; }

  std::string strokes = "一 1,2 3,4\n上 1,2 3,-5;5,6 7,8\n";
  std::string archive;
  HanziPackage package;
  support::HttpServer server;
  support::TempFolder folder;
  fs::path data = folder.path() / "mjarm";
};

TEST_F(Hanzi, KeepsMiddleLinesAndLicence) {
  EXPECT_EQ(kind(), InstallState::Kind::absent);
  const auto done = install();
  ASSERT_TRUE(done.has_value()) << done.error().what;
  EXPECT_EQ(kind(), InstallState::Kind::whole);
  EXPECT_EQ(folder.read("mjarm/hanzi/strokes.txt"), strokes);
  EXPECT_EQ(folder.read("mjarm/hanzi/ARPHICPL.TXT"), "a licence");
  EXPECT_FALSE(fs::exists(data / "unfinished"));
}

TEST_F(Hanzi, AnotherFileIsRefusedAndNothingStays) {
  archive[archive.size() / 2] = static_cast<char>(archive[archive.size() / 2] ^ 1);
  const auto done = install();
  ASSERT_FALSE(done.has_value());
  EXPECT_THAT(done.error().what, HasSubstr(package.file));
  EXPECT_EQ(kind(), InstallState::Kind::absent);
  EXPECT_TRUE(fs::is_empty(data));
}

TEST_F(Hanzi, GoesOnWithWhatWasFetched) {
  fs::create_directories(data / "unfinished/hanzi");
  const std::string part = "mjarm/unfinished/hanzi/" + package.file + ".part";
  folder.write(part, archive.substr(0, 100));
  EXPECT_TRUE(install().has_value());
  EXPECT_EQ(kind(), InstallState::Kind::whole);
  ASSERT_TRUE(remove_hanzi(data).value());
  // A part that was damaged since is fetched anew.
  fs::create_directories(data / "unfinished/hanzi");
  folder.write(part, std::string(100, 'x'));
  const auto done = install();
  EXPECT_TRUE(done.has_value()) << done.error().what;
  EXPECT_EQ(kind(), InstallState::Kind::whole);
}

TEST_F(Hanzi, WhatWasChangedIsFoundAndMended) {
  ASSERT_TRUE(install().has_value());
  folder.write("mjarm/hanzi/strokes.txt", "一 1,2 3,5\n");
  EXPECT_EQ(kind(), InstallState::Kind::damaged);
  ASSERT_TRUE(install().has_value());
  EXPECT_EQ(kind(), InstallState::Kind::whole);
  fs::remove(data / "hanzi/ARPHICPL.TXT");
  EXPECT_EQ(kind(), InstallState::Kind::damaged);
  EXPECT_TRUE(remove_hanzi(data).value());
  EXPECT_FALSE(remove_hanzi(data).value());
  EXPECT_TRUE(fs::exists(data));
}

TEST(Inflated, IsNoMoreThanItIsTold) {
  const std::string content(100000, 'a'), packed = gzipped(content);
  EXPECT_EQ(inflated(packed, Packing::gzip, 200000), content);
  EXPECT_EQ(inflated(packed, Packing::gzip, 50000), "");
  EXPECT_EQ(inflated(packed.substr(0, packed.size() / 2), Packing::gzip, 200000), "");
  EXPECT_EQ(inflated("no gzip", Packing::gzip, 1000), "");
  EXPECT_EQ(inflated(packed, Packing::gzip, content.size()), content);
  EXPECT_EQ(inflated(packed, Packing::gzip, content.size() - 1), "");
}

TEST(NpmArchive, StopsAtWhatIsNoHeader) {
  int files = 0;
  const auto count = [&](std::string_view, std::string_view) { ++files; };
  const std::string one = tar_entry("a", "text");
  for_each_file(one + one, count);
  EXPECT_EQ(files, 2);
  std::string huge = one;
  std::memcpy(huge.data() + 124, "77777777777", 11);
  files = 0;
  for_each_file(one + huge + one, count);
  EXPECT_EQ(files, 1);
  for_each_file("short", count);
  EXPECT_EQ(files, 1);
}

}  // namespace
}  // namespace mjarm::install
