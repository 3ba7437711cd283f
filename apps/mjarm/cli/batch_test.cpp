// Files of requests: order, threads, what is written where, and what is left where one is wrong.
#include "apps/mjarm/cli/batch.hpp"

#include <gmock/gmock.h>

#include <filesystem>

#include "tests/support/run_program.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm::app {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using Why = std::optional<std::string>;

/// Doubles a number; 13 cannot be done, and what is no number is malformed.
Result<Why> twice(std::string_view request, std::string& out) {
  if (request.find_first_not_of("0123456789") != std::string_view::npos) {
    return fail(Errc::bad_input, "no number: " + std::string(request));
  }
  const int value = std::stoi(std::string(request));
  out += std::to_string(2 * value);
  if (value == 13) return Why("unlucky");
  return Why();
}

class Batch : public ::testing::Test {
 protected:
  Result<BatchResult> answer(const std::string& requests, int threads = 1,
                             const AnswerLine& how = twice) {
    const std::string in = folder_.write("in.txt", requests).string();
    return run_batch({.in = in, .out = out_, .threads = threads}, "doubling", how);
  }
  /// Names of all files of the folder, in order.
  [[nodiscard]] std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path())) {
      names.push_back(entry.path().filename().string());
    }
    std::ranges::sort(names);
    return names;
  }

  support::TempFolder folder_;
  std::string out_ = (folder_.path() / "out.txt").string();
};

std::string numbers_to(int count) {
  std::string lines;
  for (int i = 0; i < count; ++i) lines += std::to_string(i) + "\n";
  return lines;
}

TEST_F(Batch, EveryAnswerStandsInTheLineOfItsRequestForAnyNumberOfThreads) {
  constexpr int kCount = 1000;  // more than a block of any of these
  std::string expected;
  for (int i = 0; i < kCount; ++i) expected += std::to_string(2 * i) + "\n";
  for (const int threads : {1, 2, 3, 16}) {
    const auto done = answer(numbers_to(kCount), threads);
    ASSERT_TRUE(done) << done.error().what;
    EXPECT_EQ(done->requests, static_cast<std::uint64_t>(kCount));
    EXPECT_EQ(folder_.read("out.txt"), expected);
    EXPECT_EQ(done->failed, 1U);
    EXPECT_EQ(done->first_failure, folder_.path() / "in.txt:14");
    EXPECT_EQ(done->first_why, "unlucky");
  }
}

TEST_F(Batch, AMalformedLineIsNamedAndNothingIsWritten) {
  for (const int threads : {1, 4}) {
    folder_.write("out.txt", "old");
    // The place counts blank lines, the first wrong line is told, whatever thread meets the second.
    const auto done = answer("1\n\n  \r\n2\nthree\n4\nfive\n", threads);
    ASSERT_FALSE(done);
    EXPECT_EQ(done.error().code, Errc::bad_input);
    EXPECT_EQ(done.error().what, (folder_.path() / "in.txt:5: no number: three").string());
    EXPECT_EQ(folder_.read("out.txt"), "old");
    EXPECT_THAT(files(), ElementsAre("in.txt", "out.txt"));
  }
}

TEST_F(Batch, AMalformedLastLineOfManyBlocksLeavesNothingEither) {
  const auto done = answer(numbers_to(500) + "x", 2);
  ASSERT_FALSE(done);
  EXPECT_THAT(done.error().what, HasSubstr("in.txt:501: "));
  EXPECT_THAT(files(), ElementsAre("in.txt"));
}

TEST_F(Batch, FilesWithoutRequestsGiveEmptyAnswers) {
  for (const char* empty : {"", "\n", "\r\n\r\n", " \t\n", "\xEF\xBB\xBF"}) {
    const auto done = answer(empty);
    ASSERT_TRUE(done) << done.error().what;
    EXPECT_EQ(done->requests, 0U);
    EXPECT_EQ(folder_.read("out.txt"), "");
  }
}

TEST_F(Batch, ALineThatIsTooLongIsRefusedWithItsPlace) {
  const std::string in = folder_.write("in.txt", "1\n" + std::string(101, '1') + "\n").string();
  const auto done = run_batch({.in = in, .out = out_, .longest_line = 100}, "doubling", twice);
  ASSERT_FALSE(done);
  EXPECT_THAT(done.error().what, HasSubstr("in.txt:2: "));
  EXPECT_THAT(files(), ElementsAre("in.txt"));
  folder_.write("in.txt", std::string(100, ' ').replace(99, 1, "7") + "\r\n");
  const auto fits = run_batch({.in = in, .out = out_, .longest_line = 101}, "doubling",
                              [](std::string_view, std::string&) { return Result<Why>(Why()); });
  EXPECT_TRUE(fits) << fits.error().what;
}

TEST_F(Batch, TheInputMayBecomeTheOutput) {
  const std::string in = folder_.write("in.txt", "1\n2\n").string();
  const auto done = run_batch({.in = in, .out = in}, "doubling", twice);
  ASSERT_TRUE(done) << done.error().what;
  EXPECT_EQ(folder_.read("in.txt"), "2\n4\n");
}

TEST_F(Batch, ALinkStaysALinkToTheNewAnswers) {
  folder_.write("real.txt", "old");
  std::filesystem::create_symlink("real.txt", out_);
  ASSERT_TRUE(answer("4\n"));
  EXPECT_TRUE(std::filesystem::is_symlink(out_));
  EXPECT_EQ(folder_.read("real.txt"), "8\n");
}

TEST_F(Batch, FilesThatCannotBeOpenedAreNamed) {
  const auto nowhere = run_batch({.in = "no/such/in.txt", .out = out_}, "doubling", twice);
  ASSERT_FALSE(nowhere);
  EXPECT_EQ(nowhere.error().code, Errc::bad_input);
  EXPECT_THAT(nowhere.error().what, HasSubstr("no/such/in.txt"));
  out_ = (folder_.path() / "no/such/out.txt").string();
  const auto unwritable = answer("1\n");
  ASSERT_FALSE(unwritable);
  EXPECT_EQ(unwritable.error().code, Errc::system);
  EXPECT_THAT(unwritable.error().what, HasSubstr("no/such/out.txt"));
  EXPECT_THAT(files(), ElementsAre("in.txt"));
}

BatchOptions to(const std::string& out) { return {.in = {}, .out = out}; }

TEST_F(Batch, OneAnswerAloneGoesWhereManyWould) {
  ASSERT_TRUE(write_answer(to(out_), "{}"));
  EXPECT_EQ(folder_.read("out.txt"), "{}\n");
  ASSERT_TRUE(write_answer(to(out_), "[]"));
  EXPECT_EQ(folder_.read("out.txt"), "[]\n");
  ::testing::internal::CaptureStdout();
  ASSERT_TRUE(write_answer(to("-"), "a"));
  ASSERT_TRUE(write_answer(to(""), "b"));
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "a\nb\n");
}

TEST_F(Batch, ExitCodesFollowWhatCouldNotBeDone) {
  constexpr Msg kOne{"no: {}", "不：{}"}, kSome{"{}: {} ({} of {})", "{}：{}（{}/{}）"};
  ::testing::internal::CaptureStderr();
  EXPECT_EQ(finish_one(to(out_), "1", std::nullopt, kOne).value(), 0);
  EXPECT_EQ(finish_all({3, 0, "", ""}, kSome), 0);
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
  ::testing::internal::CaptureStderr();
  EXPECT_EQ(finish_one(to(out_), "2", "far", kOne).value(), 1);
  EXPECT_EQ(finish_all({3, 2, "f:1", "near"}, kSome), 1);
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "no: far\nf:1: near (2 of 3)\n");
  // What cannot be done is answered all the same.
  EXPECT_EQ(folder_.read("out.txt"), "2\n");
}

TEST(OneSource, IsExactlyOne) {
  EXPECT_TRUE(one_source("x", "", "--q"));
  EXPECT_TRUE(one_source("", "1", "--q"));
  for (const auto& [in, one] : {std::pair("", ""), {"x", "1"}}) {
    const auto refused = one_source(in, one, "--q");
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, Errc::usage);
    EXPECT_EQ(refused.error().what, "exactly one of --in and --q is needed");
  }
}

}  // namespace
}  // namespace mjarm::app
