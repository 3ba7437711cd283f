#include "mjarm/serve/page_server.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cstring>
#include <fstream>
#include <functional>
#include <memory>
#include <thread>

#include "mjarm/model/shipped_test.hpp"
#include "mjarm/serve/page_client_test.hpp"
#include "mjarm/serve/show_in_page.hpp"

namespace mjarm::serve {
namespace {

using mjarm::testing::Answer;
using mjarm::testing::Client;
using ::testing::HasSubstr;

constexpr const char* kSecret = "00112233445566778899aabbccddeeff";

/// [bytes] That the process holds in memory.
std::size_t memory_in_use() {
  std::size_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages >> pages;
  return pages * 4096;
}

class Server : public ::testing::Test {
 protected:
  void SetUp() override {
    drawn_.meshes.push_back({{0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 1, 2}});
    site_.add_scene(drawn_, facts_);
    (void)site_.add_page("");
    start({});
  }
  void start(const ServerOptions& options) {
    server_.reset();
    Result<PageServer> server = PageServer::start(site_, &feed_, options);
    ASSERT_TRUE(server) << server.error().what;
    server_ = std::make_unique<PageServer>(std::move(*server));
  }
  void TearDown() override {
    // Nobody can hold the server up when it ends.
    const auto begin = std::chrono::steady_clock::now();
    server_->stop("over");
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(5));
  }
  static std::string path(const std::string& name) {
    return "/" + std::string(kSecret) + "/" + name;
  }
  std::unique_ptr<Client> client() { return std::make_unique<Client>(server_->port()); }
  /// A page that has been said hello to.
  std::unique_ptr<Client> page() {
    auto opened = client();
    EXPECT_FALSE(opened->open(path("live")));
    const std::optional<std::string> hello = opened->receive();
    EXPECT_TRUE(hello && hello->starts_with(R"({"type":"hello","protocol":1)"));
    return opened;
  }
  void post(double time, std::size_t spheres = 0) {
    view::ViewFrame frame;
    frame.snapshot = sim_.snapshot();
    frame.snapshot.time = time;
    frame.status = "at " + std::to_string(time);
    frame.overlay.spheres.assign(spheres, {{time, 0, 0}});
    link_.frames.post(frame);
  }
  bool until(const std::function<bool()>& holds) {
    for (int i = 0; i < 2000; ++i) {
      if (holds()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return false;
  }

  mjarm::testing::TestArm robot_ = mjarm::testing::shipped_arm("ur5e");
  Sim sim_{robot_.model};
  DrawnModel drawn_ = drawn_model(robot_.model);
  SceneFacts facts_{.nq = robot_.model.nq(), .can_target = true, .jog_dofs = {0, 1, 2}};
  view::ViewLink link_;
  view::TargetLink target_;
  PageSite site_{kSecret, "127.0.0.1"};
  LiveFeed feed_{robot_.model, drawn_, facts_, link_, &target_, false};
  std::unique_ptr<PageServer> server_;
};

TEST_F(Server, GivesTheSceneOverOneConnection) {
  auto browser = client();
  const Answer scene = browser->request(path("scene.json"));
  EXPECT_EQ(scene.status, 200);
  EXPECT_TRUE(parse_json_object(scene.body));
  EXPECT_THAT(scene.policy, HasSubstr("ws://" + browser->host()));
  const Answer head = browser->request(path("scene.json"), "HEAD");
  EXPECT_EQ(head.status, 200);
  EXPECT_TRUE(head.body.empty());
  EXPECT_EQ(head.length, std::to_string(scene.body.size()));
  EXPECT_EQ(browser->request(path("scene.json"), "GET", {{"If-None-Match", scene.etag}}).status,
            304);
  EXPECT_EQ(browser->request(path("mesh/0")).body, mesh_bytes(drawn_.meshes[0]));
  EXPECT_EQ(browser->request(path("nothing")).status, 404);
  EXPECT_EQ(browser->request("/scene.json").status, 404);
  EXPECT_EQ(browser->request(path("../scene.json")).status, 404);
  EXPECT_EQ(browser->request(path("scene.json"), "GET", {{"Host", "evil.example"}}).status, 403);
  EXPECT_EQ(browser->request(path("scene.json"), "GET", {{"Origin", "http://evil"}}).status, 403);
  EXPECT_EQ(browser->request(path("scene.json"), "POST").status, 405);
  EXPECT_EQ(browser->request(path("scene.json"), "POST", {}, "x=1").status, 405);
  EXPECT_EQ(browser->request(path("scene.json")).status, 0);  // with its body unread
}

TEST_F(Server, NonsenseIsAnsweredOrDropped) {
  const std::string nonsense[] = {"\r\n\r\n",
                                  "GET\r\n\r\n",
                                  "\x16\x03\x01\x02",
                                  "GET / HTTP/9.9\r\n\r\n",
                                  "GET / HTTP/1.1\r\nHost\r\n\r\n",
                                  "GET / HTTP/1.1\r\nHost: a\r\nHost: b\r\n\r\n",
                                  "GET " + std::string(100'000, 'a') + " HTTP/1.1\r\n\r\n",
                                  "GET / HTTP/1.1\r\nX: " + std::string(100'000, 'a') + "\r\n\r\n",
                                  "POST / HTTP/1.1\r\nContent-Length: 999999999999\r\n\r\n",
                                  "POST / HTTP/1.1\r\nContent-Length: -1\r\n\r\n",
                                  "POST / HTTP/1.1\r\nTransfer-Encoding: chunked\r\n\r\nzz\r\n"};
  for (int round = 0; round < 3; ++round) {
    for (const std::string& bytes : nonsense) {
      auto rude = client();
      mjarm::testing::ErrorCode ignored;
      boost::asio::write(rude->raw(), boost::asio::buffer(bytes), ignored);
      if (round > 0) rude->vanish();
    }
  }
  EXPECT_EQ(client()->request(path("scene.json")).status, 200);
}

TEST_F(Server, APageNeedsTokenHostAndOrigin) {
  const auto refused = [this](const std::string& target, const std::string& origin,
                              const std::string& host) {
    EXPECT_TRUE(client()->open(target, origin, host)) << target << origin << host;
  };
  refused("/live", "", "");
  refused("/00112233445566778899aabbccddeefe/live", "", "");
  refused(path("live"), "http://evil.example", "");
  refused(path("live"), "null", "");
  refused(path("live"), "", "evil.example:80");
  refused(path("scene.json"), "", "");
  auto opened = client();
  EXPECT_FALSE(opened->open(path("live"), "http://" + opened->host()));
}

TEST_F(Server, TellsAllAsItStandsAndThenWhatChanges) {
  post(1.5);
  auto first = page();
  for (const char* type : {"status", "overlay", "plots", "panels", "target"}) {
    auto other = page();
    EXPECT_TRUE(other->receive(type)) << type;
  }
  const std::optional<std::string> frame = first->receive("frame");
  ASSERT_TRUE(frame);
  double time = 0;
  std::memcpy(&time, frame->data() + 8, sizeof(time));
  EXPECT_EQ(time, 1.5);
  post(2.5);
  std::optional<std::string> status;
  do status = first->receive("status");
  while (status && status->find("at 2.5") == std::string::npos);
  EXPECT_TRUE(status);
}

TEST_F(Server, WhatTheUserDoesArrives) {
  post(1);
  auto user = page();
  ASSERT_TRUE(user->receive("frame"));
  EXPECT_FALSE(user->send(R"({"type":"joint","dof":1,"value":-0.5})"));
  EXPECT_FALSE(
      user->send(R"({"type":"drag","pos":[0.1,0.2,0.3],"quat":[1,0,0,0],"held":true,"number":4})"));
  ASSERT_TRUE(until([this] { return target_.drags.size() == 1; }));
  const auto events = link_.events.take();
  ASSERT_EQ(events.size(), 1U);
  const auto& joint = std::get<view::JointEvent>(events[0]);
  EXPECT_EQ(joint.dof, 1);
  EXPECT_EQ(joint.value, -0.5);
  const auto drags = target_.drags.take();
  EXPECT_EQ(drags[0].X_WT.p, Eigen::Vector3d(0.1, 0.2, 0.3));
  EXPECT_EQ(drags[0].number, 4);
  // The look that answers it comes back.
  view::TargetLook look{.shown = true, .number = 4};
  target_.looks.post(look);
  std::optional<std::string> answer;
  do answer = user->receive("target");
  while (answer && answer->find("\"number\":4") == std::string::npos);
  EXPECT_TRUE(answer);
  // What he held is let go of where he vanishes.
  user->vanish();
  ASSERT_TRUE(until([this] { return target_.drags.size() == 1; }));
  EXPECT_FALSE(target_.drags.take()[0].held);
}

TEST_F(Server, NoNumberIsRefusedAndAfterAHundredThePageIsDropped) {
  auto user = page();
  for (const char* text :
       {R"({"type":"speed","speed":NaN})", R"({"type":"speed","speed":1e999})", "", "{}", "\x01",
        R"({"type":"drag","pos":[0,0,NaN],"quat":[1,0,0,0],"held":true,"number":1})"}) {
    EXPECT_FALSE(user->send(text));
    EXPECT_TRUE(user->receive("error")) << text;
  }
  EXPECT_FALSE(user->send("{\"type\":\"reset\"}", false));  // binary
  EXPECT_TRUE(user->receive("error"));
  EXPECT_EQ(link_.events.size(), 0U);
  for (int i = 0; i < 93; ++i) (void)user->send("?");
  int errors = 0;
  while (user->receive("error")) ++errors;
  EXPECT_EQ(errors, 93);
  EXPECT_EQ(user->close_code(), 1008);
  EXPECT_TRUE(until([this] { return server_->pages() == 0; }));
}

TEST_F(Server, TooLongAMessageEndsThePage) {
  auto user = page();
  (void)user->send(R"({"type":")" + std::string(70'000, 'a') + R"("})");
  EXPECT_FALSE(user->receive("error"));
  EXPECT_TRUE(until([this] { return server_->pages() == 0; }));
}

TEST_F(Server, SixteenPagesAreEnough) {
  post(1);
  std::vector<std::unique_ptr<Client>> pages;
  for (int i = 0; i < 16; ++i) pages.push_back(page());
  EXPECT_EQ(server_->pages(), 16);
  EXPECT_TRUE(client()->open(path("live")));
  EXPECT_EQ(client()->request(path("scene.json")).status, 200);
  for (auto& each : pages) EXPECT_TRUE(each->receive("frame"));
  pages[3]->vanish();
  pages[7].reset();
  EXPECT_TRUE(until([this] { return server_->pages() == 14; }));
  EXPECT_TRUE(page()->receive("frame"));
}

TEST_F(Server, WhoDoesNotReadHoldsNobodyUp) {
  start({.silent_seconds = 600});
  post(0);
  auto sleeper = page();
  auto awake = page();
  const std::size_t before = memory_in_use();
  // A hundred kilobytes and more in each overlay.
  int seen = 0;
  double last = 0;
  for (int i = 1; i <= 100; ++i) {
    post(i, 2'000);
    const std::optional<std::string> frame = awake->receive("frame");
    ASSERT_TRUE(frame);
    std::memcpy(&last, frame->data() + 8, sizeof(last));
    ++seen;
  }
  EXPECT_EQ(seen, 100);
  EXPECT_GE(last, 98);
  EXPECT_LT(memory_in_use(), before + (std::size_t{64} << 20));
  // He wakes up, and soon sees what is now.
  post(1000);
  for (int i = 0; i < 200 && last < 1000; ++i) {
    const std::optional<std::string> frame = sleeper->receive("frame");
    ASSERT_TRUE(frame);
    std::memcpy(&last, frame->data() + 8, sizeof(last));
  }
  EXPECT_EQ(last, 1000);
}

TEST_F(Server, WhoIsSilentIsDropped) {
  start({.request_seconds = 0.3, .silent_seconds = 1});
  auto slow = client();  // never asks for anything
  auto silent = page();  // never answers a ping, for nobody reads
  EXPECT_TRUE(until([this] { return server_->pages() == 0; }));
  EXPECT_EQ(slow->request(path("scene.json")).status, 0);
  EXPECT_EQ(client()->request(path("scene.json")).status, 200);
}

TEST_F(Server, AFloodIsReadNoFasterThanTheSimulationFollows) {
  auto user = page();
  const std::size_t before = memory_in_use();
  std::atomic<bool> done{false};
  std::thread flood([&] {
    for (int i = 0; i < 10'000 && !done; ++i) {
      mjarm::testing::ErrorCode error = user->send(R"({"type":"reset"})");
      if (error) return;
    }
  });
  EXPECT_TRUE(until([this] { return link_.events.size() >= 1000; }));
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  EXPECT_LE(link_.events.size(), 1001U);
  EXPECT_EQ(client()->request(path("scene.json")).status, 200);
  EXPECT_LT(memory_in_use(), before + (std::size_t{32} << 20));
  (void)link_.events.take();
  EXPECT_TRUE(until([this] { return link_.events.size() > 0; }));  // and goes on
  done = true;
  std::atomic<bool> through{false};
  std::thread reader([&] {
    while (!through) (void)link_.events.take();
  });
  flood.join();
  through = true;
  reader.join();
}

TEST_F(Server, ATakenPortIsOneLineWithAFreeOne) {
  PageSite site(kSecret, "127.0.0.1");
  const Result<PageServer> second = PageServer::start(site, &feed_, {.port = server_->port()});
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().code, Errc::impossible);
  EXPECT_THAT(second.error().what, HasSubstr(std::to_string(server_->port())));
  EXPECT_THAT(second.error().what, HasSubstr("--port "));
  EXPECT_EQ(second.error().what.find('\n'), std::string::npos);
  for (const ServerOptions& wrong : {ServerOptions{.address = "nowhere"},
                                     ServerOptions{.port = 65536}, ServerOptions{.port = -1}}) {
    const Result<PageServer> none = PageServer::start(site, &feed_, wrong);
    ASSERT_FALSE(none);
    EXPECT_EQ(none.error().code, Errc::usage);
  }
}

/// A recorded run is a page and nothing that lives; what it may do it says itself.
TEST(RecordedSite, IsOnePage) {
  PageSite site(kSecret, "127.0.0.1");
  site.add_run("<!doctype html>run");
  Result<PageServer> server = PageServer::start(site, nullptr, {});
  ASSERT_TRUE(server) << server.error().what;
  const std::string root = "/" + std::string(kSecret) + "/";
  const Answer page = Client(server->port()).request(root);
  EXPECT_EQ(page.body, "<!doctype html>run");
  EXPECT_EQ(page.policy, "frame-ancestors 'none'");
  EXPECT_TRUE(Client(server->port()).open(root + "live"));
  EXPECT_EQ(Client(server->port()).request(root + "scene.json").status, 404);
  EXPECT_EQ(Client(server->port()).request("/").status, 404);
  server->stop("over");
}

TEST_F(Server, AtTheEndThePageIsTold) {
  post(1);
  auto user = page();
  ASSERT_TRUE(user->receive("frame"));
  server_->stop("that was it");
  const std::optional<std::string> bye = user->receive("bye");
  ASSERT_TRUE(bye);
  EXPECT_THAT(*bye, HasSubstr("that was it"));
  EXPECT_FALSE(user->receive());
  EXPECT_EQ(user->close_code(), 1001);
}

/// Where a simulation stands after so many steps, with its frames served.
std::vector<double> simulated(int pages) {
  const auto robot = mjarm::testing::shipped_arm("ur5e");
  std::vector<double> state;
  std::string url;
  std::vector<std::thread> readers;
  const auto read = [&url] {
    const std::size_t colon = url.rfind(':');
    const std::size_t slash = url.find('/', colon);
    Client client(std::stoi(url.substr(colon + 1, slash - colon - 1)));
    if (client.open(url.substr(slash) + "live")) return;
    while (client.receive()) {
    }
  };
  PageOptions options;
  options.on_open = [&](const std::string& opened) {
    url = opened;
    for (int i = 0; i < pages; ++i) readers.emplace_back(read);
  };
  const Result<void> shown =
      show_in_page(robot.model, "test", {}, options, [&](view::ViewLink& link) {
        Sim sim(robot.model);
        sim.place(robot.arm, as_span(robot.arm.home));
        const std::vector<double> ctrl(sim.ctrl().begin(), sim.ctrl().end());
        view::ViewFrame frame;
        for (int i = 0; i < 3000; ++i) {
          EXPECT_TRUE(sim.step(ctrl));
          if (!link.frames.is_empty()) continue;
          frame.snapshot = sim.snapshot();
          link.frames.post(frame);
        }
        state = sim.snapshot().state;
      });
  EXPECT_TRUE(shown) << (shown ? "" : shown.error().what);
  for (std::thread& reader : readers) reader.join();
  return state;
}

TEST(ShowInPage, PagesChangeNothingInTheSimulation) {
  const std::vector<double> alone = simulated(0);
  EXPECT_FALSE(alone.empty());
  EXPECT_EQ(simulated(3), alone);
}

TEST(ShowInPage, EndsAfterItsTime) {
  const Model model = mjarm::testing::shipped("car");
  bool closed = false;
  const Result<void> shown =
      show_in_page(model, "test", {.camera = {}}, {.seconds = 0.1}, [&](view::ViewLink& link) {
        while (!link.closed) std::this_thread::sleep_for(std::chrono::milliseconds(1));
        closed = true;
      });
  EXPECT_TRUE(shown);
  EXPECT_TRUE(closed);
  const Result<void> wrong =
      show_in_page(model, "test", {.camera = {.name = "none"}}, {}, [](view::ViewLink&) {});
  EXPECT_FALSE(wrong);
}

TEST(PageShower, IsAPageInThePlaceOfAWindow) {
  const Model model = mjarm::testing::shipped("ur5e");
  std::string url;
  PageOptions options;
  options.on_open = [&url](const std::string& opened) { url = opened; };
  view::run_beside(page_shower(options), [&] {
    EXPECT_TRUE(view::RemoteWindow::is_possible());
    const Result<view::RemoteWindow> window = view::RemoteWindow::open(model, "remote", {});
    ASSERT_TRUE(window) << window.error().what;
    EXPECT_TRUE(window->is_open());
    EXPECT_THAT(url, HasSubstr("http://127.0.0.1:"));
  });
  EXPECT_FALSE(view::RemoteWindow::is_possible());
}

}  // namespace
}  // namespace mjarm::serve
