// No request takes more than 2 GB: what is too much is one line.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <string>
#include <utility>
#include <vector>

#include "apps/mjarm/commands/program_test.hpp"
#include "tests/support/sanitized.hpp"

namespace mjarm::app {
namespace {

using ::testing::HasSubstr;

constexpr std::size_t kMega = std::size_t{1} << 20;

/// A small file that unpacks to `begin`, then `mega` MiB of `fill`, then `end`.
std::string bomb(const support::TempFolder& folder, const std::string& begin, std::size_t mega,
                 const std::string& fill, const std::string& end) {
  const std::string path = (folder.path() / "bomb.json.gz").string();
  std::string block;
  while (block.size() < kMega) block += fill;
  const gzFile file = gzopen(path.c_str(), "wb1");
  gzwrite(file, begin.data(), static_cast<unsigned>(begin.size()));
  for (std::size_t i = 0; i < mega; ++i) {
    gzwrite(file, block.data(), static_cast<unsigned>(block.size()));
  }
  gzwrite(file, end.data(), static_cast<unsigned>(end.size()));
  gzclose(file);
  return path;
}

TEST(Memory, APackedFileIsBoundedByWhatItUnpacksTo) {
  // Sanitizers have memory of their own for the bytes of a program.
  constexpr std::size_t kMost = (support::kSanitized ? 1600 : 800) * kMega;
  const support::TempFolder folder;
  for (const auto& [mega, fill] : {std::pair<std::size_t, std::string>{160, " "}, {20, "0,"}}) {
    const std::string file = bomb(folder, "{\"problems\":[", mega, fill, "0]}");
    for (const std::string command : {"plan", "verify"}) {
      std::vector<std::string> arguments{command, "--in", file};
      if (command == "verify") {
        arguments.push_back(folder.write("paths.json", "{\"a\":[[0]]}").string());
      }
      const auto result = mjarm(arguments);
      EXPECT_EQ(result.exit_code, 2) << result.err;
      EXPECT_THAT(only_line(result), HasSubstr("bomb.json.gz"));
      EXPECT_LT(result.peak_memory, kMost) << command;
    }
  }
}

TEST(Memory, SamplesAreBoundedByTheirNumbers) {
  const auto result = mjarm({"time", "--problem", "p2p", "--points",
                             "0,-1.5,1.5,0,0,0;1,-1.5,1.5,0,0,0", "--dt", "0.0000002"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(only_line(result), HasSubstr("is the least"));
  EXPECT_LT(result.peak_memory, 800 * kMega);
}

TEST(Memory, ThreadsDoNotHoldTheWholeFile) {
  if (support::kSanitized) GTEST_SKIP() << "what is freed is kept for a while by the sanitizer";
  const support::TempFolder folder;
  std::string lines;
  const std::string pose =
      R"({"pos":[0.3,0.2,0.4],"quat":[0,1,0,0],"note":")" + std::string(kMega / 2, 'x') + "\"}\n";
  for (int i = 0; i < 120; ++i) lines += pose;
  const std::string file = folder.write("poses.jsonl", lines).string();
  const auto one = mjarm({"ik", "--robot", "ur5e", "--in", file, "--out", "/dev/null"});
  const auto many =
      mjarm({"ik", "--robot", "ur5e", "--in", file, "--out", "/dev/null", "--threads", "1024"});
  EXPECT_EQ(many.exit_code, one.exit_code) << many.err;
  EXPECT_LT(many.peak_memory, one.peak_memory + 40 * kMega);
}

}  // namespace
}  // namespace mjarm::app
