// Every hostile file is refused with one line and exit code 2, within bounds of time and memory,
// and leaves nothing behind; so is it by the library.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "mjarm/model/model.hpp"
#include "tests/hostile_files.hpp"
#include "tests/support/run_program.hpp"
#include "tests/support/sanitized.hpp"

namespace mjarm {
namespace hostile {

void PrintTo(const HostileFile& hostile, std::ostream* out) { *out << hostile.label; }

}  // namespace hostile

namespace {

namespace fs = std::filesystem;
using hostile::HostileFile;
using support::kSanitized;
using ::testing::HasSubstr;

/// All that MuJoCo knows about a model.
std::string bytes_of(const Model& model) {
  std::string bytes(static_cast<std::size_t>(mj_sizeModel(model.raw())), '\0');
  mj_saveModel(model.raw(), nullptr, bytes.data(), static_cast<mjtSize>(bytes.size()));
  return bytes;
}

class HostileModel : public ::testing::TestWithParam<HostileFile> {};

std::set<fs::path> files_in(const fs::path& folder) {
  std::set<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) files.insert(entry.path());
  return files;
}

TEST_P(HostileModel, IsRefusedInOneLine) {
  const HostileFile& hostile = GetParam();
  const support::TempFolder folder;
  if (hostile.prepare != nullptr) hostile.prepare(folder);
  const fs::path file = folder.write(hostile.file, hostile.content.text());
  const std::set<fs::path> before = files_in(folder.path());

  const auto result = support::run_program(MJARM_PROGRAM, {"model", "info", file.string()},
                                           {.folder = folder.path()});
  EXPECT_EQ(result.exit_code, 2) << result.err;
  EXPECT_EQ(result.out, "");
  ASSERT_EQ(support::lines_of(result.err).size(), 1U) << result.err;
  EXPECT_LT(result.err.size(), 2000U);
  for (const std::string& word : hostile.words) EXPECT_THAT(result.err, HasSubstr(word));
  EXPECT_EQ(files_in(folder.path()), before) << "a file was left behind";
  if (!kSanitized) {
    EXPECT_LT(result.cpu_seconds, 5.0);
    EXPECT_LT(result.peak_memory, std::size_t{2} << 30);
  }

  const auto model = Model::load(file);
  ASSERT_FALSE(model);
  EXPECT_EQ(model.error().code, Errc::bad_input);
  EXPECT_THAT(result.err, HasSubstr(model.error().what));
}

const auto kLabel = [](const ::testing::TestParamInfo<HostileFile>& test) {
  return test.param.label;
};
INSTANTIATE_TEST_SUITE_P(Text, HostileModel, ::testing::ValuesIn(hostile::hostile_texts()), kLabel);
INSTANTIATE_TEST_SUITE_P(Mjcf, HostileModel, ::testing::ValuesIn(hostile::hostile_mjcf()), kLabel);
INSTANTIATE_TEST_SUITE_P(Reference, HostileModel,
                         ::testing::ValuesIn(hostile::hostile_references()), kLabel);
INSTANTIATE_TEST_SUITE_P(Urdf, HostileModel, ::testing::ValuesIn(hostile::hostile_urdf()), kLabel);

/// The same good model without a fault, so that the faults above are what is refused.
TEST(HostileModelCounterpart, IsLoaded) {
  const support::TempFolder folder;
  for (const std::string& good :
       {hostile::mjcf("<geom size=\"1\"/>"),
        hostile::mjcf("<replicate count=\"100\"><geom size=\"1\"/></replicate>"),
        hostile::mjcf("<body name=\"关节\"><joint range=\"-1 1\"/><geom size=\"1\"/></body>",
                      "<option timestep=\"0.001\"/><size memory=\"10M\" nuserdata=\"5\"/>")}) {
    const auto model = Model::load(folder.write("a.xml", good));
    EXPECT_TRUE(model) << model.error().what;
  }
}

TEST(HostileModelFile, SpecialFilesAreRefused) {
  for (const char* file : {"/dev/zero", "/dev/null", "/dev/random"}) {
    const auto result = support::run_program(MJARM_PROGRAM, {"model", "info", file});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_THAT(result.err, HasSubstr("not a regular file"));
  }
}

TEST(HostileModelFile, OutsideIsReadWhereItIsAllowed) {
  const support::TempFolder folder;
  folder.write("part.xml", "<mujoco><worldbody><geom size=\"1\"/></worldbody></mujoco>");
  const fs::path file =
      folder.write("in/a.xml", "<mujoco><include file=\"../part.xml\"/></mujoco>");
  EXPECT_FALSE(Model::load(file));
  const auto model = Model::load(file, {.allow_outside = true});
  EXPECT_TRUE(model) << model.error().what;
  const auto result =
      support::run_program(MJARM_PROGRAM, {"model", "info", file.string(), "--allow-outside"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
}

/// What goes through the other process comes out as if it had been compiled in this one.
TEST(HostileModelFile, TheGuardChangesNothing) {
  const fs::path models = fs::canonical(find_model_file("car").value()).parent_path();
  const support::TempFolder folder;
  fs::copy(models, folder.path() / "models", fs::copy_options::recursive);
  for (const ShippedModel& shipped : shipped_models()) {
    const fs::path copy =
        folder.path() / "models" / fs::canonical(shipped.file).lexically_relative(models);
    const auto guarded = Model::load(copy, {.allow_outside = true});
    const auto trusted = Model::load(copy, {.allow_outside = true, .trusted = true});
    ASSERT_TRUE(guarded) << guarded.error().what;
    ASSERT_TRUE(trusted) << trusted.error().what;
    EXPECT_EQ(bytes_of(*guarded), bytes_of(*trusted)) << shipped.name;
    EXPECT_TRUE(std::ranges::equal(guarded->warnings(), trusted->warnings()));
  }
}

}  // namespace
}  // namespace mjarm
