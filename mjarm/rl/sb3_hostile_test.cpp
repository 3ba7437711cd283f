#include <gtest/gtest.h>

#include <random>

#include "mjarm/core/file.hpp"
#include "mjarm/rl/policy_file_test.hpp"
#include "mjarm/rl/sb3_file_test.hpp"
#include "mjarm/rl/sb3_zip.hpp"

namespace mjarm::rl {
namespace {

using testing::expect_policy_refused;
using testing::expect_refused;
using testing::PlantedTensor;
using testing::policy_around;
using testing::policy_of;
using testing::policy_with;
using testing::small_state;
using testing::torch_entries;
using testing::ZipEntry;

constexpr std::int32_t kHugeSize = 2147483647;

std::string sb3_bytes(const std::string& name) {
  return read_file(testing::test_file(name + ".zip")).value();
}

TEST(HostileSb3Zip, TensorsStayWithinTheirNumbers) {
  const auto planted = [](const auto& change, const std::string& phrase) {
    expect_policy_refused(policy_with(1, change), phrase);
  };
  const std::string beyond = "reaches beyond its numbers";
  planted([](auto& w) { w.strides = {-2, 1}; }, beyond);
  planted([](auto& w) { w.strides = {2, -1}; }, beyond);
  planted([](auto& w) { w.shape = {-3, 2}; }, beyond);
  planted([](auto& w) { w.offset = -1; }, beyond);
  planted([](auto& w) { w.offset = 1; }, beyond);
  planted([](auto& w) { w.offset = kHugeSize; }, beyond);
  planted([](auto& w) { w.strides = {3, 1}; }, beyond);
  planted([](auto& w) { w.shape = {4, 2}; }, beyond);
  planted([](auto& w) { w.shape = {kHugeSize, kHugeSize}, w.strides = {kHugeSize, kHugeSize}; },
          beyond);
  planted([](auto& w) { w.shape = {3, 2, 1}, w.strides = {2, 1, 1}; }, "two dimensions");
  // Strides of 0 take few bytes in the file, and could take all memory.
  planted([](auto& w) { w.shape = {kHugeSize, kHugeSize}, w.strides = {0, 0}; },
          "67108864 numbers");
  planted([](auto& w) { w.shape = {1 << 13, (1 << 13) + 1}, w.strides = {0, 0}; }, "67108864");
  planted([](auto& w) { w.shape = {0, 2}; }, "fits no layer");
  planted([](auto& w) { w.shape = {6}, w.strides = {1}; }, "fits no layer");

  std::vector<ZipEntry> torch = torch_entries(small_state());
  torch[3].content.pop_back();
  expect_policy_refused(policy_around(torch), "another size than 24 bytes");
  torch[3].content += "12345";
  expect_policy_refused(policy_around(torch), "another size than 24 bytes");
  torch.erase(torch.begin() + 3);
  expect_policy_refused(policy_around(torch), "missing");
  expect_policy_refused(policy_with(1, [](auto& w) { w.count = -6; }), "size than -24");
  std::vector<PlantedTensor> state = small_state();
  state[1].storage = "../../data";
  torch = torch_entries(small_state());
  torch[0].content = testing::pickled_state(state);
  expect_policy_refused(policy_around(torch), "missing");
}

TEST(HostileSb3Zip, DamagedArchivesGetOneLine) {
  const std::vector<ZipEntry> torch = torch_entries(small_state());
  const ZipEntry data{.name = "data", .content = "{}"};
  const ZipEntry policy{.name = "policy.pth", .content = testing::zip_of(torch)};
  const auto refused = [](const std::vector<ZipEntry>& entries, const std::string& phrase) {
    expect_policy_refused(testing::zip_of(entries), phrase);
  };
  const auto changed = [](ZipEntry entry, const auto& change) {
    change(entry);
    return entry;
  };
  ASSERT_TRUE(parse_sb3_zip(testing::zip_of({data, policy}), "f"));
  refused({}, "has no \"data\"");
  refused({data}, "has no \"policy.pth\"");
  refused({data, policy, data}, "\"data\" stands in it twice");
  refused({data, changed(policy, [](auto& e) { e.method = 8; })}, "is compressed");
  refused({data, changed(policy, [](auto& e) { e.flags = 1; })}, "compressed or encrypted");
  refused({data, changed(policy, [](auto& e) { e.wrong_crc = true; })}, "damaged (CRC-32)");
  refused({changed(data, [](auto& e) { e.wrong_crc = true; }), policy}, "damaged (CRC-32)");
  refused({data, changed(policy, [](auto& e) { e.size_off = 1; })}, "entry 2");
  refused({data, changed(policy, [](auto& e) { e.size_off = 4000000000; })}, "entry 2");
  refused({changed(data, [](auto& e) { e.local_off = 1; }), policy}, "entry 1");
  refused({changed(data, [](auto& e) { e.local_off = -1; }), policy}, "entry 1");
  refused({changed(data, [](auto& e) { e.local_off = 1 << 30; }), policy}, "entry 1");
  // A bomb: what is said to unpack to 4 GB is not unpacked at all.
  refused({data, changed(policy, [](auto& e) { e.method = 8, e.size_off = 0; })}, "compressed");
  expect_policy_refused("", "no whole zip archive");
  expect_policy_refused("PK\5\6", "no whole zip archive");
  expect_policy_refused(std::string(100, 'x'), "no whole zip archive");
  expect_policy_refused(testing::zip_of({data, policy}) + "x", "no whole zip archive");
  expect_policy_refused("x" + testing::zip_of({data, policy}), "entry 1");
  std::string renamed = testing::zip_of({data, policy});
  renamed[renamed.find("policy.pth")] = 'P';  // before the content only, not in the directory
  expect_policy_refused(renamed, "entry 2");
  // Within policy.pth.
  const auto inner = [&](const std::string& content, const std::string& phrase) {
    refused({data, {.name = "policy.pth", .content = content}}, phrase);
  };
  inner("\x80\x02N.", "policy.pth: is no whole zip archive");
  inner(testing::zip_of({}), "has no \"data.pkl\"");
  std::vector<ZipEntry> more = torch;
  more.push_back({.name = "other/data.pkl", .content = "."});
  inner(testing::zip_of(more), "has no \"data.pkl\"");
  more = torch;
  more[1].content = "big";
  inner(testing::zip_of(more), "not little-endian");
  more = torch;
  more[2].method = 8;
  inner(testing::zip_of(more), "missing or have another size");
  more = torch;
  more[0].content =
      "\x80\x02" + testing::global("os", "system") + "(" + testing::unicode("touch owned") + "tR.";
  inner(testing::zip_of(more), "refused: data.pkl asks for \"os.system\"");
}

TEST(HostileSb3Zip, IsRefusedCutOffAnywhere) {
  const std::string whole = sb3_bytes("sb3_tanh");
  for (std::size_t size = 0; size < whole.size(); ++size) {
    SCOPED_TRACE(size);
    expect_refused(parse_sb3_zip(std::string_view(whole).substr(0, size), "f"), "f: ");
  }
  const std::string torch = testing::zip_of(torch_entries(small_state()));
  for (std::size_t size = 0; size < torch.size(); ++size) {
    SCOPED_TRACE(size);
    const std::string policy =
        testing::zip_of({{.name = "data", .content = "{}"},
                         {.name = "policy.pth", .content = torch.substr(0, size)}});
    expect_refused(parse_sb3_zip(policy, "f"), "f: ");
  }
}

TEST(HostileSb3Zip, ByteFlipsChangeNothingOrAreSeen) {
  const std::string whole = sb3_bytes("sb3_tanh");
  const TensorSet truth = parse_sb3_zip(whole, "f").value();
  std::mt19937_64 random(3);
  int seen = 0;
  for (int round = 0; round < 5000; ++round) {
    std::string bytes = whole;
    bytes[random() % bytes.size()] ^= static_cast<char>(1 + random() % 255);
    const auto read = parse_sb3_zip(bytes, "f");
    if (read) {
      EXPECT_EQ(read->tensors, truth.tensors);
      EXPECT_EQ(read->metadata.at("activation"), truth.metadata.at("activation"));
    } else {
      expect_refused(read, "f: ");
      ++seen;
    }
  }
  EXPECT_GT(seen, 2500);
}

TEST(HostileSb3Zip, ByteFlipsBehindTheChecksumGiveWholeTensorsOrOneLine) {
  const std::string torch = testing::zip_of(torch_entries(small_state()));
  std::mt19937_64 random(4);
  int accepted = 0;
  for (int round = 0; round < 5000; ++round) {
    std::string bytes = torch;
    bytes[random() % bytes.size()] ^= static_cast<char>(1 + random() % 255);
    const auto read = parse_sb3_zip(testing::zip_of({{.name = "data", .content = "{}"},
                                                     {.name = "policy.pth", .content = bytes}}),
                                    "f");
    if (!read) {
      expect_refused(read, "f: ");
      continue;
    }
    ++accepted;
    testing::expect_whole(*read);
    EXPECT_EQ(testing::forward_pass(*read, "actor", {1, 2}).size(), 1u);
  }
  EXPECT_GT(accepted, 0);  // weights may be others
}

}  // namespace
}  // namespace mjarm::rl
