#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "apps/mjarm/commands/program_test.hpp"
#include "mjarm/core/os.hpp"

namespace mjarm::app {
namespace {

namespace fs = std::filesystem;

/// `mjarm models install` with a data folder of its own. No server is there unless a test wants it.
class Models : public ::testing::Test {
 protected:
  support::ProgramResult models(std::vector<std::string> arguments, bool network = false) {
    arguments.insert(arguments.begin(), {"models", "install"});
    return run(arguments, network);
  }
  support::ProgramResult run(const std::vector<std::string>& arguments, bool network = false) {
    support::RunOptions options;
    options.folder = folder.path();
    options.environment = {{"XDG_DATA_HOME", (folder.path() / "data").string()}};
    if (!network) {
      options.environment.emplace_back("PIP_INDEX_URL", "http://me:secret@127.0.0.1:1/simple");
    }
    return mjarm(arguments, options);
  }
  support::TempFolder folder;
};

TEST_F(Models, ListsWhatIsNotThere) {
  const auto list = models({"--list"});
  EXPECT_EQ(list.exit_code, 0);
  EXPECT_EQ(list.err, "");
  EXPECT_NE(list.out.find("ur5e"), std::string::npos);
  EXPECT_NE(list.out.find("panda"), std::string::npos);
  EXPECT_NE(list.out.find("not installed"), std::string::npos);
  const auto scene = models({"--list", "--json", "panda"});
  const auto entries = nlohmann::json::parse(scene.out);
  ASSERT_EQ(entries.size(), 1u);
  EXPECT_EQ(entries[0]["state"], "absent");
  EXPECT_EQ(entries[0]["meshes"], 67);
  EXPECT_FALSE(folder.exists("data"));
}

TEST_F(Models, RefusesNamesAndOptionsThatMakeNoSense) {
  const auto name = models({"ur5"});
  EXPECT_EQ(name.exit_code, 2);
  EXPECT_NE(only_line(name).find("did you mean \"ur5e\"?"), std::string::npos) << name.err;
  EXPECT_EQ(models({"--list", "--remove"}).exit_code, 2);
  EXPECT_EQ(models({"--list", "--from", "."}).exit_code, 2);
  const auto from = models({"--from", "nowhere"});
  EXPECT_EQ(from.exit_code, 2);
  EXPECT_NE(only_line(from).find("nowhere: no such folder"), std::string::npos) << from.err;
  const auto nothing = run({"models"});
  EXPECT_EQ(nothing.exit_code, 2);
  EXPECT_NE(only_line(nothing).find("install"), std::string::npos);
  EXPECT_FALSE(folder.exists("data"));
}

TEST_F(Models, WithoutAnyServerSaysSoAndLeavesNoModel) {
  const auto result = models({"panda"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(only_line(result).find("127.0.0.1:1/simple/genesis-world/"), std::string::npos);
  EXPECT_EQ(result.err.find("secret"), std::string::npos) << result.err;
  EXPECT_TRUE(fs::is_empty(folder.path() / "data/mjarm"));
}

TEST_F(Models, AFolderThatCannotBeMadeIsNamed) {
  folder.write("data", "a file");
  const auto result = models({"ur5e"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(only_line(result).find("data/mjarm: cannot be written"), std::string::npos);
}

TEST_F(Models, RemovesNothingWhereNothingIs) {
  const auto result = models({"--remove"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_NE(result.out.find("ur5e: is not installed"), std::string::npos);
  EXPECT_FALSE(folder.exists("data"));
}

TEST_F(Models, DemosSayHowToGetMeshes) {
  const auto result = run({"demo", "ellipse", "--headless", "--meshes", "--out", "out"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(only_line(result).find("mjarm models install ur5e"), std::string::npos);
  EXPECT_FALSE(folder.exists("out"));
  const auto car = run({"demo", "car", "--headless", "--meshes", "--out", "out"});
  EXPECT_EQ(car.exit_code, 2);
  EXPECT_NE(only_line(car).find("known: ur5e, panda"), std::string::npos) << car.err;
}

TEST_F(Models, SpeaksChinese) {
  const auto result = run({"--lang", "zh", "models", "install", "--list"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_NE(result.out.find("未安装"), std::string::npos) << result.out;
}

TEST_F(Models, DoctorTellsHowToGetMeshes) {
  const auto facts = nlohmann::json::parse(run({"doctor", "--json"}).out);
  EXPECT_TRUE(facts["meshes"].empty());
  EXPECT_NE(run({"doctor"}).out.find("mjarm models install"), std::string::npos);
}

void flip_middle(const fs::path& file) {
  std::FILE* stream = std::fopen(file.c_str(), "r+b");
  ASSERT_NE(stream, nullptr);
  std::fseek(stream, static_cast<long>(fs::file_size(file) / 2), SEEK_SET);
  const int byte = std::fgetc(stream);
  std::fseek(stream, -1, SEEK_CUR);
  std::fputc(byte ^ 1, stream);
  std::fclose(stream);
}

TEST_F(Models, FromTheRealPackageIndex) {
  if (!environment("MJARM_TEST_NETWORK")) {
    GTEST_SKIP() << "MJARM_TEST_NETWORK is not set: nothing is fetched from the real servers";
  }
  const auto install = models({}, true);
  ASSERT_EQ(install.exit_code, 0) << install.err;
  EXPECT_NE(models({}, true).out.find("already installed"), std::string::npos);
  EXPECT_EQ(models({"--list"}).exit_code, 0);
  for (const std::string robot : {"ur5e", "panda"}) {
    const auto demo = run({"demo", "letters", "--headless", "--meshes", "--text", "I", "--robot",
                           robot, "--out", "out"});
    EXPECT_NE(demo.exit_code, 2) << demo.err;
    EXPECT_TRUE(folder.exists("out/report.json"));
  }
  flip_middle(folder.path() / "data/mjarm/models/franka_emika_panda/assets/link3_0.obj");
  const auto list = models({"--list"});
  EXPECT_EQ(list.exit_code, 1);
  EXPECT_NE(only_line(list).find("link3_0.obj"), std::string::npos);
  EXPECT_EQ(run({"demo", "letters", "--meshes", "--robot", "panda"}).exit_code, 1);
  EXPECT_EQ(models({"panda"}, true).exit_code, 0);
  EXPECT_EQ(models({"--list"}).exit_code, 0);
  EXPECT_EQ(models({"--remove"}).exit_code, 0);
  EXPECT_TRUE(fs::is_empty(folder.path() / "data/mjarm"));
}

}  // namespace
}  // namespace mjarm::app
