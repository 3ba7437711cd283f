#include "mjarm/install/http.hpp"

#include <gtest/gtest.h>

#include "mjarm/core/sha256.hpp"
#include "mjarm/install/mesh_package_test.hpp"
#include "tests/support/http_server.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm::install {
namespace {

using support::HttpServer;
using support::Served;

class Download : public ::testing::Test {
 protected:
  Download() {
    Rng rng(1);
    body = random_bytes(rng, 300000, 256);
    options.connect_timeout = 5;
    options.stall_timeout = 1;
  }
  Result<void> fetch(ByteRange range) {
    return download(server.url() + "/file", range, folder.path() / "part", "test", options);
  }
  std::string got() { return folder.exists("part") ? folder.read("part") : ""; }
  std::string piece(ByteRange range) { return body.substr(range.from, range.size()); }

  HttpServer server;
  support::TempFolder folder;
  HttpOptions options;
  std::string body;
};

TEST(Sha256, OfPublishedVectors) {
  EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  const support::TempFolder folder;
  const auto file = folder.write("a", std::string(1'000'000, 'a'));
  EXPECT_EQ(sha256_of_file(file).value(),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
  EXPECT_FALSE(sha256_of_file(folder.path() / "none"));
}

TEST_F(Download, FetchesOnlyTheRange) {
  server.serve("/file", {.body = body});
  ASSERT_TRUE(fetch({1000, 200000}));
  EXPECT_EQ(got(), piece({1000, 200000}));
  EXPECT_EQ(server.sent(), 199000u);
}

TEST_F(Download, GoesOnWhereItWas) {
  server.serve("/file", {.body = body});
  folder.write("part", piece({1000, 60000}));
  ASSERT_TRUE(fetch({1000, 200000}));
  EXPECT_EQ(got(), piece({1000, 200000}));
  EXPECT_EQ(server.sent(), 140000u);
  ASSERT_TRUE(fetch({1000, 200000}));  // nothing is missing: nothing is asked
  EXPECT_EQ(server.requests().size(), 1u);
}

TEST_F(Download, BeginsAgainWhereThePartIsTooLong) {
  server.serve("/file", {.body = body});
  folder.write("part", body);
  ASSERT_TRUE(fetch({0, 1000}));
  EXPECT_EQ(got(), piece({0, 1000}));
}

TEST_F(Download, ManagesWithoutRanges) {
  server.serve("/file", {.body = body, .ranges = false});
  folder.write("part", piece({1000, 60000}));
  ASSERT_TRUE(fetch({1000, 200000}));
  EXPECT_EQ(got(), piece({1000, 200000}));
}

TEST_F(Download, SurvivesConnectionsThatBreak) {
  for (const bool ranges : {true, false}) {
    folder.write("part", "");
    // Without ranges only what a connection lives through can arrive.
    server.serve(
        "/file",
        {.body = body, .ranges = ranges, .cut_after = ranges ? std::size_t{30000} : body.size()});
    ASSERT_TRUE(fetch({5, 200005}));
    EXPECT_EQ(got(), piece({5, 200005}));
  }
}

TEST_F(Download, EndsWhereTheFileIsTooShort) {
  server.serve("/file", {.body = body.substr(0, 100000)});
  const auto result = fetch({0, 200000});
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, Errc::not_available);
  EXPECT_NE(result.error().what.find("416"), std::string::npos) << result.error().what;
  EXPECT_EQ(got(), body.substr(0, 100000));
}

TEST_F(Download, EndsWhereThePromisedBytesNeverCome) {
  server.serve("/file", {.body = body.substr(0, 1000), .ranges = false, .announce_more = 500});
  EXPECT_FALSE(fetch({0, 1500}));
  EXPECT_LE(server.requests().size(), 4u);
}

TEST_F(Download, TellsWhatTheServerRefuses) {
  for (const int status : {403, 404, 500, 503}) {
    server.serve("/file", {.body = "no", .status = status});
    const auto result = fetch({0, 1000});
    ASSERT_FALSE(result);
    EXPECT_NE(result.error().what.find("/file: "), std::string::npos);
    EXPECT_NE(result.error().what.find("HTTP " + std::to_string(status)), std::string::npos);
    EXPECT_EQ(got(), "");
  }
}

TEST_F(Download, GivesASilentServerUp) {
  server.serve("/file", {.body = "", .silent = true});
  const auto result = fetch({0, 1000});
  ASSERT_FALSE(result);
  EXPECT_EQ(server.requests().size(), 1u);
}

TEST_F(Download, FailsAtOnceWhereNobodyListens) {
  const auto result =
      download("http://127.0.0.1:1/x", {0, 10}, folder.path() / "part", "test", options);
  ASSERT_FALSE(result);
  EXPECT_NE(result.error().what.find("http://127.0.0.1:1/x"), std::string::npos);
}

TEST_F(Download, NamesAFileThatCannotBeWritten) {
  server.serve("/file", {.body = body});
  const auto result =
      download(server.url() + "/file", {0, 10}, folder.path() / "none" / "part", "test", options);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, Errc::system);
  EXPECT_NE(result.error().what.find("none/part"), std::string::npos);
}

TEST_F(Download, ReadsFilesOfThisMachine) {
  const auto file = folder.write("with space #1.bin", body);
  ASSERT_TRUE(download(file_url(file), {70000, 80000}, folder.path() / "part", "test", options));
  EXPECT_EQ(got(), piece({70000, 80000}));
}

TEST_F(Download, ShowsNoPassword) {
  EXPECT_EQ(without_password("https://me:secret@host.example/simple/x"),
            "https://host.example/simple/x");
  std::string url = server.url() + "/none";
  url.insert(7, "me:secret@");
  const auto result = download(url, {0, 10}, folder.path() / "part", "test", options);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().what.find("secret"), std::string::npos) << result.error().what;
}

TEST_F(Download, PagesComeWhole) {
  server.serve("/page/", {.body = "hello", .type = "text/html"});
  const auto page = get_page(server.url() + "/page/", options);
  ASSERT_TRUE(page);
  EXPECT_EQ(page->body, "hello");
  EXPECT_EQ(page->url, server.url() + "/page/");
  EXPECT_FALSE(get_page(server.url() + "/none", options));
}

}  // namespace
}  // namespace mjarm::install
