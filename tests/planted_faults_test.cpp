// Good models are passed in silence: no error and no warning.
#include "tests/planted_faults.hpp"

#include "tests/support/rounds.hpp"
#include "tests/support/run_program.hpp"
#include "tests/support/test_data.hpp"

namespace mjarm::planted {
namespace {

/// Nothing above a note may be said about a good model.
void expect_silence(const fs::path& file) {
  const auto report = check_model(file);
  ASSERT_TRUE(report) << report.error().what;
  EXPECT_TRUE(report->loads);
  EXPECT_EQ(report->count(kError) + report->count(kWarning), 0) << all_of(*report);
}

TEST(GoodModels, OursArePassedInSilence) {
  const support::TempFolder folder;
  folder.write("small.xml", kSmallArm);
  expect_silence(folder.path() / "small.xml");
  int files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(testing::models_folder())) {
    const fs::path& file = entry.path();
    if (file.extension() != ".xml" && file.extension() != ".urdf") continue;
    // Parts are included by the others.
    if (support::read_data(file).find("<mujocoinclude") != std::string::npos) continue;
    SCOPED_TRACE(file);
    expect_silence(file);
    ++files;
  }
  EXPECT_GE(files, 10);
}

TEST(GoodModels, MenagerieIsPassedInSilence) {
  if (!testing::is_long()) GTEST_SKIP() << testing::kLongOnly;
  MJARM_TEST_FILE(ur5e, "menagerie/universal_robots_ur5e.tar.xz");
  MJARM_TEST_FILE(panda, "menagerie/franka_emika_panda.tar.xz");
  const support::TempFolder folder;
  for (const fs::path& archive : {ur5e, panda}) {
    const auto result = support::run_program(
        "/bin/sh",
        {"-c", "exec tar -xJf \"$1\" -C \"$2\"", "sh", archive.string(), folder.path().string()});
    ASSERT_EQ(result.exit_code, 0) << result.err;
  }
  for (const char* file : {"universal_robots_ur5e/ur5e.xml", "universal_robots_ur5e/scene.xml",
                           "franka_emika_panda/panda.xml", "franka_emika_panda/panda_nohand.xml",
                           "franka_emika_panda/hand.xml", "franka_emika_panda/scene.xml"}) {
    SCOPED_TRACE(file);
    expect_silence(folder.path() / file);
  }
}

}  // namespace
}  // namespace mjarm::planted
