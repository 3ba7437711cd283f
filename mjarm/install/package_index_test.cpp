#include <gtest/gtest.h>

#include <cstdlib>
#include <optional>

#include "mjarm/core/os.hpp"
#include "mjarm/core/rng.hpp"
#include "mjarm/install/package_index_internal.hpp"
#include "tests/support/http_server.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm::install {
namespace {

using support::HttpServer;

constexpr const char* kBase = "https://index.example/simple/toy/";

TEST(FindEntry, InHtml) {
  const Page page{kBase,
                  "<a href=\"../../files/toy-1.tar.gz#sha256=11\">x</a>\n"
                  "<a href='https://other.example/a%20b/toy-1.whl?k=1&amp;l=2#sha256=ab'>y</a>"
                  "<a href=\"toy-2.whl\">z</a>"};
  const IndexEntry first = find_entry(page, "toy-1.tar.gz");
  EXPECT_EQ(first.url, "https://index.example/files/toy-1.tar.gz");
  EXPECT_EQ(first.sha256, "11");
  const IndexEntry second = find_entry(page, "toy-1.whl");
  EXPECT_EQ(second.url, "https://other.example/a%20b/toy-1.whl?k=1&l=2");
  EXPECT_EQ(second.sha256, "ab");
  EXPECT_EQ(find_entry(page, "toy-2.whl").url, "https://index.example/simple/toy/toy-2.whl");
  EXPECT_EQ(find_entry(page, "toy-2.whl").sha256, "");
  EXPECT_EQ(find_entry(page, "oy-2.whl").url, "");
}

TEST(FindEntry, BearsAnyPage) {
  for (const char* body : {"", "{}", "href=", "<a href=\"", "<a href=g", "<a href='#sha256=1'>",
                           "href=\"\"", "<a href='https://[::1/g#sha256=1'>"}) {
    EXPECT_EQ(find_entry({kBase, body}, "g").url, "") << body;
  }
  Rng rng(3);
  const std::string alphabet = "\":,#=&;<> ahref'/\\files\x01\xff";
  for (int round = 0; round < 3000; ++round) {
    std::string body;
    for (int i = 0; i < 60; ++i) {
      body += alphabet[rng.below(alphabet.size())];
    }
    (void)find_entry({kBase, body}, "f");
  }
}

TEST(FindInIndex, ChecksTheHashAndTellsWhatIsMissing) {
  HttpServer server;
  server.serve("/simple/toy/",
               {.body = "<a href=\"/toy-1.whl#sha256=ab\">toy</a>", .type = "text/html"});
  const IndexSettings index{.url = server.url() + "/simple", .http = {}};
  EXPECT_EQ(find_in_index(index, "toy", "toy-1.whl", "ab").value(), server.url() + "/toy-1.whl");
  const auto other = find_in_index(index, "toy", "toy-1.whl", "cd");
  ASSERT_FALSE(other);
  EXPECT_NE(other.error().what.find("cd"), std::string::npos);
  const auto missing = find_in_index(index, "toy", "toy-2.whl", "ab");
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.error().what.find("toy-2.whl"), std::string::npos);
  EXPECT_FALSE(find_in_index(index, "none", "toy-2.whl", "ab"));
}

/// pip's settings for one test; the machine's own do not reach it.
class PipSettings : public ::testing::Test {
 protected:
  PipSettings() {
    for (const char* name :
         {"PIP_INDEX_URL", "PIP_CERT", "PIP_PROXY", "PIP_CONFIG_FILE", "REQUESTS_CA_BUNDLE",
          "CURL_CA_BUNDLE", "SSL_CERT_FILE", "VIRTUAL_ENV", "XDG_CONFIG_HOME"}) {
      set(name, std::nullopt);
    }
    set("XDG_CONFIG_DIRS", folder.path().string());
    set("HOME", folder.path().string());
  }
  ~PipSettings() override {
    for (auto it = old_.rbegin(); it != old_.rend(); ++it) put(it->first, it->second);
  }
  void set(const std::string& name, const std::optional<std::string>& value) {
    old_.emplace_back(name, environment(name));
    put(name, value);
  }
  support::TempFolder folder;

 private:
  static void put(const std::string& name, const std::optional<std::string>& value) {
    if (value) {
      setenv(name.c_str(), value->c_str(), 1);
    } else {
      unsetenv(name.c_str());
    }
  }
  std::vector<std::pair<std::string, std::optional<std::string>>> old_;
};

TEST_F(PipSettings, TheEnvironmentCountsMost) {
  folder.write(".config/pip/pip.conf", "[global]\nindex-url = https://file.example/simple\n");
  set("PIP_INDEX_URL", "https://env.example/simple/");
  set("PIP_CERT", "/certs/a.pem");
  set("SSL_CERT_FILE", "/certs/b.pem");
  set("PIP_PROXY", "http://proxy.example:3128");
  const IndexSettings settings = index_settings();
  EXPECT_EQ(settings.url, "https://env.example/simple");
  EXPECT_EQ(settings.http.ca_bundle, "/certs/a.pem");
  EXPECT_EQ(settings.http.proxy, "http://proxy.example:3128");
}

TEST_F(PipSettings, FilesCountInTheirOrder) {
  folder.write("pip/pip.conf", "[global]\nindex-url = https://all.example/simple\n");
  EXPECT_EQ(index_settings().url, "https://all.example/simple");
  folder.write(".pip/pip.conf",
               "# words\n; more\n[other]\nindex-url=https://wrong.example\n[global]\n"
               "Index_URL: https://old.example/simple\ncert=/certs/old.pem\n");
  EXPECT_EQ(index_settings().url, "https://old.example/simple");
  EXPECT_EQ(index_settings().http.ca_bundle, "/certs/old.pem");
  folder.write(".config/pip/pip.conf",
               "[install]\r\nindex-url = https://install.example/simple\r\n"
               "[global]\r\nindex-url = https://user.example/simple\r\n");
  EXPECT_EQ(index_settings().url, "https://install.example/simple");
  set("PIP_CONFIG_FILE",
      folder.write("named", "[global]\nindex-url=https://named.example").string());
  EXPECT_EQ(index_settings().url, "https://named.example");
  set("PIP_CONFIG_FILE", "/dev/null");
  EXPECT_EQ(index_settings().url, "https://pypi.org/simple");
}

TEST_F(PipSettings, CertificatesOfOtherPrograms) {
  set("PIP_CONFIG_FILE", "/dev/null");
  EXPECT_EQ(index_settings().http.ca_bundle, "");
  set("SSL_CERT_FILE", "/certs/c.pem");
  EXPECT_EQ(index_settings().http.ca_bundle, "/certs/c.pem");
  set("REQUESTS_CA_BUNDLE", "/certs/a.pem");
  EXPECT_EQ(index_settings().http.ca_bundle, "/certs/a.pem");
}

}  // namespace
}  // namespace mjarm::install
