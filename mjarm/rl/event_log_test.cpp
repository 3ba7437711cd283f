#include "mjarm/rl/event_log.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "mjarm/core/file.hpp"
#include "mjarm/rl/crc32c_internal.hpp"
#include "mjarm/rl/policy_file_test.hpp"
#include "mjarm/rl/protobuf_fields_test.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm::rl {
namespace {

using support::TempFolder;
using testing::expect_refused;

const std::vector<std::string> kLogTags = {"train/reward", "eval/success"};
constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();
constexpr const char* kEventsName = "events.out.tfevents.0.test";

struct ReadEvent {
  double wall_time = 0;
  std::int64_t step = 0;
  std::string version;
  std::vector<std::pair<std::string, float>> scalars;
  bool operator==(const ReadEvent&) const = default;
};

/// The checksum bit by bit, as RFC 3720 defines it.
std::uint32_t slow_masked_crc(std::string_view bytes) {
  std::uint32_t crc = 0xFFFFFFFFu;
  for (const char byte : bytes) {
    crc ^= static_cast<unsigned char>(byte);
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ ((crc & 1) != 0 ? 0x82F63B78u : 0);
  }
  crc = ~crc;
  return (crc >> 15 | crc << 17) + 0xA282EAD8u;
}

/// A reader of its own: every record must be whole.
std::vector<ReadEvent> read_events(std::string_view bytes) {
  std::vector<ReadEvent> events;
  while (!bytes.empty()) {
    const auto size = load_little<std::uint64_t>(bytes);
    EXPECT_EQ(load_little<std::uint32_t>(bytes, 8), slow_masked_crc(bytes.substr(0, 8)));
    const std::string_view data = bytes.substr(12, size);
    EXPECT_EQ(load_little<std::uint32_t>(bytes, 12 + size), slow_masked_crc(data));
    bytes.remove_prefix(16 + size);
    ReadEvent event;
    event.wall_time = load_little<double>(testing::only(data, 1).bytes);
    for (const auto& step : testing::all_of(data, 2)) {
      event.step = static_cast<std::int64_t>(step.integer);
    }
    for (const auto& version : testing::all_of(data, 3)) event.version = version.bytes;
    for (const auto& summary : testing::all_of(data, 5)) {
      for (const auto& value : testing::all_of(summary.bytes, 1)) {
        event.scalars.emplace_back(testing::only(value.bytes, 1).bytes,
                                   load_little<float>(testing::only(value.bytes, 2).bytes));
      }
    }
    events.push_back(event);
  }
  return events;
}

/// Row `i` of a training that never ends.
std::vector<double> log_row(std::int64_t i) {
  return {0.1 * static_cast<double>(i), i % 3 == 0 ? 1.0 / static_cast<double>(i) : kNotMeasured};
}

template <class Log>
void append_rows(Log& log, std::int64_t first, std::int64_t last) {
  for (std::int64_t i = first; i <= last; ++i) {
    const auto done = log.append(300 * i, log_row(i));
    ASSERT_TRUE(done) << done.error().what;
  }
}

TEST(Crc32c, OfKnownBytes) {
  std::string rising;
  for (int i = 0; i < 32; ++i) rising += static_cast<char>(i);
  EXPECT_EQ(crc32c(""), 0u);
  EXPECT_EQ(crc32c("123456789"), 0xE3069283u);
  EXPECT_EQ(crc32c(std::string(32, '\0')), 0x8A9136AAu);  // RFC 3720, B.4
  EXPECT_EQ(crc32c(std::string(32, '\xFF')), 0x62A8AB43u);
  EXPECT_EQ(crc32c(rising), 0x46DD794Eu);
  EXPECT_EQ(masked_crc32c(rising), slow_masked_crc(rising));
}

TEST(EventLog, HoldsEveryRowAsSoonAsItIsAppended) {
  const TempFolder folder;
  auto log = EventLog::open(folder.path() / kEventsName, kLogTags);
  ASSERT_TRUE(log) << log.error().what;
  EXPECT_EQ(read_events(folder.read(kEventsName)).size(), 1u);
  ASSERT_TRUE(log->append(0, std::vector{1.5, 0.25}));
  ASSERT_TRUE(log->append(std::int64_t{1} << 40, std::vector{kNotMeasured, -2.0}, 1e9 + 0.5));
  ASSERT_TRUE(log->append((std::int64_t{1} << 40) + 1, std::vector{kNotMeasured, 1e300}));
  // Nobody closed it.
  const std::vector<ReadEvent> expected = {
      {0, 0, "brain.Event:2", {}},
      {0, 0, "", {{"train/reward", 1.5f}, {"eval/success", 0.25f}}},
      {1e9 + 0.5, std::int64_t{1} << 40, "", {{"eval/success", -2.f}}},
      {0, (std::int64_t{1} << 40) + 1, "", {}}};
  EXPECT_EQ(read_events(folder.read(kEventsName)), expected);
}

TEST(EventLog, GoesOnAfterACheckpointAsIfNothingHadHappened) {
  const TempFolder folder;
  auto whole = EventLog::open(folder.path() / "whole", kLogTags);
  append_rows(*whole, 1, 9);
  {
    auto log = EventLog::open(folder.path() / kEventsName, kLogTags);
    append_rows(*log, 1, 7);
  }
  auto resumed = EventLog::open(folder.path() / kEventsName, kLogTags, 300 * 4);
  ASSERT_TRUE(resumed) << resumed.error().what;
  EXPECT_EQ(read_events(folder.read(kEventsName)).back().step, 300 * 4);
  append_rows(*resumed, 5, 9);
  EXPECT_EQ(folder.read(kEventsName), folder.read("whole"));
  // A later checkpoint than the last row drops none.
  ASSERT_TRUE(EventLog::open(folder.path() / kEventsName, kLogTags, 300 * 100));
  EXPECT_EQ(folder.read(kEventsName), folder.read("whole"));
  // Where there is no file, a resumed training begins one.
  ASSERT_TRUE(EventLog::open(folder.path() / "new", kLogTags, 300));
  EXPECT_EQ(read_events(folder.read("new")).size(), 1u);
  // A new training keeps nothing.
  ASSERT_TRUE(EventLog::open(folder.path() / kEventsName, kLogTags));
  EXPECT_EQ(read_events(folder.read(kEventsName)).size(), 1u);
}

TEST(EventLog, DropsATornRecordWhereverItIsTorn) {
  const TempFolder folder;
  auto log = EventLog::open(folder.path() / kEventsName, kLogTags);
  append_rows(*log, 1, 3);
  const std::string whole = folder.read(kEventsName);
  const auto events = read_events(whole);
  for (std::size_t size = 0; size <= whole.size(); ++size) {
    SCOPED_TRACE(size);
    folder.write("torn", whole.substr(0, size));
    auto resumed = EventLog::open(folder.path() / "torn", kLogTags, 300 * 100);
    ASSERT_TRUE(resumed) << resumed.error().what;
    const auto left = read_events(folder.read("torn"));
    ASSERT_GE(left.size(), 1u);
    ASSERT_LE(left.size(), events.size());
    EXPECT_TRUE(std::equal(left.begin(), left.end(), events.begin()));
    append_rows(*resumed, static_cast<std::int64_t>(left.size()), 3);
    EXPECT_EQ(folder.read("torn"), whole);
  }
}

TEST(EventLog, DropsEverythingFromADamagedByteOn) {
  const TempFolder folder;
  auto log = EventLog::open(folder.path() / kEventsName, kLogTags);
  append_rows(*log, 1, 3);
  const std::string whole = folder.read(kEventsName);
  for (std::size_t at = 0; at < whole.size(); ++at) {
    SCOPED_TRACE(at);
    std::string bytes = whole;
    bytes[at] ^= 4;
    folder.write("flipped", bytes);
    const auto resumed = EventLog::open(folder.path() / "flipped", kLogTags, 300 * 100);
    if (resumed) {
      const std::string left = folder.read("flipped");
      EXPECT_LE(left.size(), at);
      EXPECT_TRUE(whole.starts_with(left));
    } else {
      EXPECT_EQ(folder.read("flipped"), bytes);
    }
  }
}

TEST(EventLog, TouchesNoOtherFile) {
  const TempFolder folder;
  folder.write(kEventsName, "my thesis");
  const std::string path = (folder.path() / kEventsName).string();
  expect_refused(EventLog::open(path, kLogTags, 300), path, "is no TensorBoard event file");
  EXPECT_EQ(folder.read(kEventsName), "my thesis");
}

TEST(EventLog, SaysWhenTheDiskIsFullOrARowIsNone) {
  const TempFolder folder;
  const auto full = EventLog::open("/dev/full", kLogTags);
  ASSERT_FALSE(full);
  EXPECT_EQ(full.error().code, Errc::system);
  const auto nowhere = EventLog::open(folder.path() / "no" / kEventsName, kLogTags);
  ASSERT_FALSE(nowhere);
  EXPECT_EQ(nowhere.error().code, Errc::system);
  auto log = EventLog::open(folder.path() / kEventsName, kLogTags);
  EXPECT_FALSE(log->append(1, std::vector{1.0}));
  EXPECT_EQ(read_events(folder.read(kEventsName)).size(), 1u);
}

TEST(CsvLog, HoldsTheSameRows) {
  const TempFolder folder;
  auto log = CsvLog::open(folder.path() / "log.csv", kLogTags);
  ASSERT_TRUE(log) << log.error().what;
  ASSERT_TRUE(log->append(0, std::vector{1.5, 0.25}));
  ASSERT_TRUE(log->append(300, std::vector{0.1, kNotMeasured}));
  EXPECT_EQ(folder.read("log.csv"), "step,train/reward,eval/success\n0,1.5,0.25\n300,0.1,\n");
  EXPECT_FALSE(log->append(600, std::vector{0.1}));
  const auto full = CsvLog::open("/dev/full", kLogTags);
  ASSERT_FALSE(full);
  EXPECT_EQ(full.error().code, Errc::system);
}

TEST(CsvLog, GoesOnAfterACheckpointAsIfNothingHadHappened) {
  const TempFolder folder;
  auto log = CsvLog::open(folder.path() / "whole.csv", kLogTags);
  append_rows(*log, 1, 5);
  const std::string whole = folder.read("whole.csv");
  for (std::size_t size = 0; size <= whole.size(); ++size) {
    SCOPED_TRACE(size);
    folder.write("log.csv", whole.substr(0, size));
    auto resumed = CsvLog::open(folder.path() / "log.csv", kLogTags, 300 * 3);
    ASSERT_TRUE(resumed) << resumed.error().what;
    const std::string left = folder.read("log.csv");
    EXPECT_TRUE(whole.starts_with(left));
    append_rows(*resumed, std::count(left.begin(), left.end(), '\n'), 5);
    EXPECT_EQ(folder.read("log.csv"), whole);
  }
  const std::string path = (folder.path() / "whole.csv").string();
  expect_refused(CsvLog::open(path, {"other"}, 300), path, "other columns");
  EXPECT_EQ(folder.read("whole.csv"), whole);
  ASSERT_TRUE(CsvLog::open(path, {"other"}));
  EXPECT_EQ(folder.read("whole.csv"), "step,other\n");
}

}  // namespace
}  // namespace mjarm::rl
