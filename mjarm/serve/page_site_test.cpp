#include "mjarm/serve/page_site.hpp"

#include <gtest/gtest.h>

#include "tests/support/temp_folder.hpp"

namespace mjarm::serve {
namespace {

constexpr const char* kToken = "0123456789abcdef0123456789abcdef";

class Site : public ::testing::Test {
 protected:
  Site() {
    folder_.write("index.html", "<!doctype html>");
    folder_.write("page.js", "export {};");
    folder_.write("secret.txt", "secret");
    site_.add_scene({.meshes = {{{0, 0, 0}, {0, 0, 0}}}}, {});
    EXPECT_TRUE(site_.add_page(folder_.path()));
    site_.set_port(8000);
  }
  /// Of a path below the token.
  SiteAnswer get(const std::string& path, SiteRequest request = {}) {
    return at("/" + std::string(kToken) + path, request);
  }
  SiteAnswer at(const std::string& target, SiteRequest request = {}) {
    request.target = target;
    if (request.host.empty()) request.host = "127.0.0.1:8000";
    return site_.answer(request);
  }
  static std::string header(const SiteAnswer& answer, const std::string& name) {
    for (const auto& [key, value] : answer.headers) {
      if (key == name) return value;
    }
    return {};
  }

  support::TempFolder folder_;
  PageSite site_{kToken, "127.0.0.1"};
};

TEST_F(Site, GivesItsFilesAndNothingElse) {
  EXPECT_EQ(*get("/").body, "<!doctype html>");
  EXPECT_EQ(*get("/?v=1").body, "<!doctype html>");
  EXPECT_EQ(header(get("/page.js"), "Content-Type"), "text/javascript; charset=utf-8");
  EXPECT_EQ(header(get("/scene.json"), "Content-Type"), "application/json");
  EXPECT_EQ(get("/mesh/0").status, 200);
  for (const char* path : {"/page.css", "/secret.txt", "/../secret.txt", "/%2e%2e/secret.txt",
                           "/./page.js", "//", "/mesh/99999", "/mesh/-1", "/mesh/", "/mesh/0/",
                           "/PAGE.JS", "/page.js/", "/index.html\\"}) {
    EXPECT_EQ(get(path).status, 404) << path;
  }
}

TEST_F(Site, WithoutTheTokenThereIsNothing) {
  for (const std::string target :
       {"/", "", "*", "/favicon.ico", "/scene.json", "//scene.json", "/0123/scene.json",
        "/0123456789abcdef0123456789abcdee/", "/0123456789ABCDEF0123456789ABCDEF/",
        "/0123456789abcdef0123456789abcdef", "/0123456789abcdef0123456789abcdef0/",
        "http://127.0.0.1:8000/0123456789abcdef0123456789abcdef/"}) {
    const SiteAnswer answer = at(target);
    EXPECT_EQ(answer.status, 404) << target;
    EXPECT_EQ(answer.body->find(kToken), std::string::npos);
  }
}

TEST_F(Site, OnlyNamesOfThisMachineLeadHere) {
  for (const char* host : {"127.0.0.1:8000", "localhost:8000"}) {
    EXPECT_EQ(get("/", {.host = host}).status, 200) << host;
  }
  for (const char* host : {"evil.example:8000", "127.0.0.1", "127.0.0.1:80", "localhost:8000.evil",
                           "127.0.0.1:8000:8000", "192.168.0.1:8000", ":8000", "[::1]:8000",
                           "evil@127.0.0.1:8000", "LOCALHOST:8000 "}) {
    EXPECT_EQ(get("/", {.host = host}).status, 403) << host;
  }
}

TEST_F(Site, PagesOfOthersAreRefused) {
  EXPECT_EQ(get("/", {.origin = "http://127.0.0.1:8000"}).status, 200);
  for (const char* origin : {"http://localhost:8000", "https://127.0.0.1:8000", "null", "",
                             "http://evil.example", "http://127.0.0.1:8001"}) {
    EXPECT_EQ(get("/", {.origin = origin}).status, 403) << origin;
    EXPECT_EQ(get("/live", {.origin = origin, .upgrade = true}).status, 403) << origin;
  }
}

TEST_F(Site, ForOthersANumberNamesItAndNothingElse) {
  PageSite open(kToken, "0.0.0.0");
  open.add_scene({}, {});
  open.set_port(8000);
  const std::string target = "/" + std::string(kToken) + "/scene.json";
  const auto status = [&](const char* host) {
    return open.answer({.target = target, .host = host}).status;
  };
  EXPECT_EQ(status("192.168.0.7:8000"), 200);
  EXPECT_EQ(status("localhost:8000"), 200);
  EXPECT_EQ(status("[fe80::1]:8000"), 200);
  EXPECT_EQ(status("evil.example:8000"), 403);
  EXPECT_EQ(status("1.2.3.4.evil:8000"), 403);
  EXPECT_NE(
      header(open.answer({.target = target, .host = "192.168.0.7:8000"}), "Content-Security-Policy")
          .find("ws://192.168.0.7:8000"),
      std::string::npos);
  EXPECT_TRUE(is_loopback("127.0.0.1") && is_loopback("::1"));
  EXPECT_FALSE(is_loopback("0.0.0.0") || is_loopback("127.evil") || is_loopback("10.0.0.1"));
}

TEST_F(Site, MethodsThatChangeSomethingAreNotAllowed) {
  EXPECT_EQ(get("/", {.method = "HEAD"}).status, 200);
  for (const char* method : {"POST", "PUT", "DELETE", "OPTIONS", "TRACE", "get", ""}) {
    const SiteAnswer answer = get("/", {.method = method});
    EXPECT_EQ(answer.status, 405) << method;
    EXPECT_EQ(header(answer, "Allow"), "GET, HEAD");
  }
  EXPECT_EQ(get("/live").status, 426);
  EXPECT_TRUE(get("/live", {.upgrade = true}).is_live);
  EXPECT_EQ(get("/live", {.method = "HEAD", .upgrade = true}).status, 405);
}

TEST_F(Site, EveryAnswerHasTheHeadersThatKeepAPageIn) {
  for (const SiteAnswer& answer :
       {get("/"), get("/nothing"), at("/"), get("/", {.host = "evil.example:8000"}),
        get("/", {.method = "POST"}), get("/live", {.upgrade = true}), site_.refusal(400)}) {
    EXPECT_NE(header(answer, "Content-Security-Policy").find("frame-ancestors 'none'"),
              std::string::npos);
    EXPECT_EQ(header(answer, "Content-Security-Policy").find("evil"), std::string::npos);
    EXPECT_EQ(header(answer, "X-Content-Type-Options"), "nosniff");
    EXPECT_EQ(header(answer, "Referrer-Policy"), "no-referrer");
  }
}

TEST_F(Site, WhatABrowserHasIsNotSentAgain) {
  const std::string etag = header(get("/scene.json"), "ETag");
  ASSERT_GT(etag.size(), 10U);
  const SiteAnswer again = get("/scene.json", {.if_none_match = etag});
  EXPECT_EQ(again.status, 304);
  EXPECT_TRUE(again.body->empty());
  EXPECT_EQ(header(again, "Cache-Control"), "no-cache");
  const std::string several = "\"a\", W/" + etag + ", \"b\"";
  EXPECT_EQ(get("/scene.json", {.if_none_match = several}).status, 304);
  EXPECT_EQ(get("/scene.json", {.if_none_match = "\"other\""}).status, 200);
}

TEST_F(Site, WithoutThePageItSaysSoAndTheRestWorks) {
  PageSite bare(kToken, "127.0.0.1");
  bare.add_scene({}, {});
  bare.set_port(8000);
  EXPECT_FALSE(bare.add_page(""));
  const std::string top = "/" + std::string(kToken) + "/";
  EXPECT_NE(bare.answer({.target = top, .host = "127.0.0.1:8000"}).body->find("share/mjarm/page"),
            std::string::npos);
  const std::string scene = top + "scene.json";
  EXPECT_EQ(bare.answer({.target = scene, .host = "127.0.0.1:8000"}).status, 200);
  EXPECT_EQ(bare.url(), "http://127.0.0.1:8000" + top);
}

}  // namespace
}  // namespace mjarm::serve
