#include "mjarm/core/line_reader.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/support/temp_folder.hpp"

namespace mjarm {
namespace {

class LineReaderTest : public ::testing::Test {
 protected:
  std::string file(const std::string& content) {
    return folder_.write("in.jsonl", content).string();
  }

  support::TempFolder folder_;
};

TEST_F(LineReaderTest, SkipsBlankLinesAndKnowsPlaces) {
  const std::string path = file(
      "\xEF\xBB\xBF"
      "a\n\n \t\r\nb\r\nc");
  Result<LineReader> reader = LineReader::open(path);
  ASSERT_TRUE(reader);
  EXPECT_FALSE(reader->is_stream());
  EXPECT_EQ(reader->count_lines(), 4u);
  std::vector<std::string> lines, places;
  for (;;) {
    const auto line = reader->next();
    ASSERT_TRUE(line);
    if (!*line) break;
    lines.emplace_back(**line);
    places.push_back(reader->place());
  }
  EXPECT_EQ(lines, (std::vector<std::string>{"a", "b", "c"}));
  EXPECT_EQ(places, (std::vector<std::string>{path + ":1", path + ":4", path + ":5"}));
}

TEST_F(LineReaderTest, ALineMayBeAsLongAsItsLimit) {
  const std::string path = file("12345\n123456\n");
  Result<LineReader> reader = LineReader::open(path, 5);
  ASSERT_TRUE(reader);
  EXPECT_EQ(**reader->next(), "12345");
  const auto longer = reader->next();
  ASSERT_FALSE(longer);
  EXPECT_EQ(longer.error().what, path + ":2: the line is longer than 5 bytes");
}

TEST_F(LineReaderTest, SaysWhyAFileCannotBeRead) {
  EXPECT_NE(LineReader::open((folder_.path() / "none").string()).error().what.find("no such file"),
            std::string::npos);
  EXPECT_NE(LineReader::open(folder_.path().string()).error().what.find("folder"),
            std::string::npos);
}

TEST_F(LineReaderTest, JsonLinesStopAtTheFirstThatIsRefused) {
  const std::string path = file("{\"x\":1}\n{\"x\":2}\n[3]\n");
  std::vector<double> taken;
  const auto take = [&](const JsonValue& object) -> Result<void> {
    taken.push_back(object.find("x")->number());
    return taken.back() < 2 ? Result<void>() : fail(Errc::impossible, "enough");
  };
  const Result<void> stopped = read_json_lines(path, 100, take);
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().code, Errc::impossible);
  EXPECT_EQ(stopped.error().what, path + ":2: enough");
  EXPECT_EQ(taken, (std::vector<double>{1, 2}));
  const auto any = [](const JsonValue&) -> Result<void> { return {}; };
  EXPECT_EQ(read_json_lines(path, 100, any).error().what,
            path + ":3: a JSON object {...} is expected");
  EXPECT_FALSE(read_json_lines(path, 3, any));
}

}  // namespace
}  // namespace mjarm
