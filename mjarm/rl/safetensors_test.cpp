#include "mjarm/rl/safetensors.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "mjarm/core/byte_order.hpp"
#include "mjarm/core/file.hpp"
#include "mjarm/rl/policy_file_test.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm::rl {
namespace {

using testing::expect_refused;

/// What make_safetensors.py saved.
TensorSet library_set() {
  TensorSet set;
  set.tensors["weight"] = {{2, 3}, std::vector{0.f, 0.25f, 0.5f, 0.75f, 1.f, 1.25f}};
  set.tensors["bias"] = {{2}, std::vector{-1.5f, 3e-9f}};
  set.tensors["scalar"] = {{}, std::vector{0.1}};
  set.tensors["many"] = {{2}, std::vector<std::int64_t>{std::int64_t{1} << 62, -7}};
  set.tensors["none"] = {{0, 3}, std::vector<float>{}};
  set.tensors["a \"name\"\n\xC3\xA9"] = {{1}, std::vector{1.f}};
  set.metadata["activation"] = "tanh";
  return set;
}

/// A file with this header before `data` zeros.
std::string file_with(const std::string& header, std::size_t data) {
  std::string bytes;
  append_little<std::uint64_t>(bytes, header.size());
  return bytes + header + std::string(data, '\0');
}

std::string file_of_length(std::uint64_t length, const std::string& rest) {
  std::string bytes;
  append_little(bytes, length);
  return bytes + rest;
}

TEST(Safetensors, ReadsWhatTheLibraryWroteAndWritesTheSameBytes) {
  const auto read = load_safetensors(testing::test_file("library.safetensors"));
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_EQ(*read, library_set());
  const auto bytes = to_safetensors(*read, "x");
  ASSERT_TRUE(bytes);
  EXPECT_EQ(*bytes, read_file(testing::test_file("library.safetensors")).value());
}

TEST(Safetensors, RoundTripsRandomSets) {
  std::mt19937_64 random(5);
  for (int round = 0; round < 200; ++round) {
    TensorSet set;
    for (std::uint64_t i = random() % 7; i-- > 0;) {
      Tensor tensor;
      std::size_t count = 1;
      for (std::uint64_t d = random() % 4; d-- > 0;) {
        tensor.shape.push_back(static_cast<std::int64_t>(random() % 5));
        count *= static_cast<std::size_t>(tensor.shape.back());
      }
      const auto fill = [&](auto number) {
        std::vector<decltype(number)> values(count);
        for (auto& value : values) value = static_cast<decltype(number)>(random() >> 3);
        tensor.values = values;
      };
      const std::uint64_t type = random() % 3;
      if (type == 0) fill(0.f);
      if (type == 1) fill(0.0);
      if (type == 2) fill(std::int64_t{0});
      set.tensors["t" + std::to_string(random() % 100)] = tensor;
    }
    for (std::uint64_t i = random() % 3; i-- > 0;) {
      set.metadata["k\"\\" + std::to_string(i)] = std::string(random() % 9, '\x01');
    }
    const auto bytes = to_safetensors(set, "x");
    ASSERT_TRUE(bytes);
    EXPECT_EQ(load_little<std::uint64_t>(*bytes) % 8, 0u);  // numbers are aligned
    const auto read = parse_safetensors(*bytes, "x");
    ASSERT_TRUE(read) << read.error().what;
    EXPECT_EQ(*read, set);
  }
}

TEST(Safetensors, KeepsNumbersToTheLastBit) {
  TensorSet set;
  const float inf = std::numeric_limits<float>::infinity();
  set.tensors["x"] = {{4}, std::vector{-0.f, inf, 1e-45f, 3.4028235e38f}};
  set.tensors["y"] = {{2}, std::vector{5e-324, -1.7976931348623157e308}};
  const auto read = parse_safetensors(to_safetensors(set, "x").value(), "x");
  ASSERT_TRUE(read);
  EXPECT_EQ(*read, set);
  EXPECT_TRUE(std::signbit(std::get<std::vector<float>>(read->tensors.at("x").values)[0]));
}

TEST(Safetensors, SavesInOneStepAndNamesTheFile) {
  const support::TempFolder folder;
  const auto path = folder.path() / "policy.safetensors";
  ASSERT_TRUE(save_safetensors(path, library_set()));
  EXPECT_EQ(load_safetensors(path).value(), library_set());
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
  expect_refused(load_safetensors(folder.path() / "no"), (folder.path() / "no").string());
  const auto full = save_safetensors("/dev/full", library_set());
  ASSERT_FALSE(full);
  EXPECT_EQ(full.error().code, Errc::system);
}

TEST(Safetensors, RefusesToWriteWhatItCouldNotRead) {
  TensorSet set;
  set.tensors["x"] = {{3}, std::vector{1.f}};
  expect_refused(to_safetensors(set, "f"), "f: ", "tensor \"x\" cannot be written");
  set.tensors["x"].shape = {-1};
  expect_refused(to_safetensors(set, "f"), "f: ", "cannot be written");
  set.tensors["x"].shape = std::vector<std::int64_t>(9, 1);
  expect_refused(to_safetensors(set, "f"), "f: ", "cannot be written");
  set.tensors = {{"__metadata__", {{1}, std::vector{1.f}}}};
  expect_refused(to_safetensors(set, "f"), "f: ", "cannot be written");
  set.tensors = {{"\xFF", {{1}, std::vector{1.f}}}};
  expect_refused(to_safetensors(set, "f"), "f: ", "cannot be written");
  set.tensors.clear();
  set.metadata["k"] = "\xC3";
  expect_refused(to_safetensors(set, "f"), "f: ", "not UTF-8");
}

struct PlantedFile {
  std::string bytes;
  std::string phrase;
};

std::string one_tensor(const std::string& type, const std::string& shape,
                       const std::string& offsets) {
  return R"({"x":{"dtype":)" + type + R"(,"shape":)" + shape + R"(,"data_offsets":)" + offsets +
         "}}";
}

std::string two_tensors(const std::string& first, const std::string& second) {
  return R"({"a":{"dtype":"F32","shape":[2],"data_offsets":)" + first +
         R"(},"b":{"dtype":"F32","shape":[2],"data_offsets":)" + second + "}}";
}

std::vector<PlantedFile> planted_headers() {
  const std::string huge = "18446744073709551615";
  return {
      {"", "0 bytes, too few"},
      {"1234567", "7 bytes, too few"},
      {file_of_length(0, ""), "JSON"},
      {file_of_length(1, ""), "header should have 1 bytes"},
      {file_of_length(~std::uint64_t{0}, "{}"), huge},
      {file_of_length(std::uint64_t{1} << 63, "{}"), "header should have"},
      {file_of_length(3, "{}"), "header should have 3 bytes, of 2"},
      {file_with(std::string((std::size_t{4} << 20) + 1, ' '), 0), "more than the 4194304"},
      {file_with("", 4), "not valid JSON"},
      {file_with("null", 0), "not a JSON object"},
      {file_with("[]", 0), "not a JSON object"},
      {file_with("{", 0), "not valid JSON (at byte 2)"},
      {file_with("{}}", 0), "not valid JSON"},
      {file_with("{\"a\":1,}", 0), "not valid JSON"},
      {file_with("{'a':1}", 0), "not valid JSON"},
      {file_with("{\"\xFF\":1}", 0), "not valid JSON"},
      {file_with("{\"a\":1e999}", 0), "not valid JSON"},
      {file_with(std::string(100000, '['), 0), "deeper than 3"},
      {file_with("{\"a\":" + std::string(99999, '[') + std::string(99999, ']') + "}", 0),
       "nests deeper than 3 levels"},
      {file_with(one_tensor("\"F32\"", "[[1]]", "[0,4]"), 4), "nests deeper"},
      {file_with("{}", 1), "1 bytes follow"},
      {file_with("{\"__metadata__\":7}", 0), "__metadata__"},
      {file_with("{\"__metadata__\":{\"a\":7}}", 0), "__metadata__"},
      {file_with("{\"__metadata__\":{\"a\":\"1\",\"a\":\"2\"}}", 0), "names \"a\" twice"},
      {file_with("{\"__metadata__\":{},\"__metadata__\":{}}", 0), "twice"},
  };
}

std::vector<PlantedFile> planted_tensors() {
  const std::string f = "\"F32\"";
  return {
      {file_with("{\"x\":7}", 0), "tensor \"x\" needs dtype"},
      {file_with("{\"x\":[]}", 0), "tensor \"x\" needs dtype"},
      {file_with("{\"x\":{}}", 0), "tensor \"x\" needs dtype"},
      {file_with("{\"x\":{\"dtype\":\"F32\",\"shape\":[1]}}", 4), "needs dtype"},
      {file_with("{\"x\":{\"dtype\":\"F32\",\"shape\":[1],\"offsets\":[0,4]}}", 4), "needs dtype"},
      {file_with("{\"x\":{\"dtype\":\"F32\",\"shape\":[1],\"data_offsets\":[0,4],\"y\":1}}", 4),
       "nothing else"},
      {file_with("{\"x\":{\"dtype\":\"F32\",\"shape\":[1],\"shape\":[1],\"data_offsets\":[0,4]}}",
                 4),
       "names \"shape\" twice"},
      {file_with(R"({"a\nb":7})", 0), R"(tensor "a\nb" needs)"},
      {file_with("{\"" + std::string(5000, 'n') + "\":7}", 0), "nnn\"... needs"},
      {file_with(one_tensor("7", "[1]", "[0,4]"), 4), "needs dtype"},
      {file_with(one_tensor("\"F16\"", "[2]", "[0,4]"), 4), "type \"F16\""},
      {file_with(one_tensor("\"f32\"", "[1]", "[0,4]"), 4), "type \"f32\""},
      {file_with(one_tensor("\"\"", "[1]", "[0,4]"), 4), "type \"\""},
      {file_with(one_tensor(f, "1", "[0,4]"), 4), "shape must"},
      {file_with(one_tensor(f, "[-1]", "[0,4]"), 4), "shape must"},
      {file_with(one_tensor(f, "[1.0]", "[0,4]"), 4), "shape must"},
      {file_with(one_tensor(f, "[\"1\"]", "[0,4]"), 4), "shape must"},
      {file_with(one_tensor(f, "[null]", "[0,4]"), 4), "shape must"},
      {file_with(one_tensor(f, "[9223372036854775808]", "[0,4]"), 4), "shape must"},
      {file_with(one_tensor(f, "[1,1,1,1,1,1,1,1,1]", "[0,4]"), 4), "at most 8"},
      {file_with(one_tensor(f, "[4294967296,4294967296]", "[0,0]"), 0), "0 bytes, which is not"},
      {file_with(one_tensor(f, "[4294967296,4294967297]", "[0,4]"), 4), "4 bytes, which is not"},
      {file_with(one_tensor(f, "[4611686018427387904]", "[0,0]"), 0), "which is not"},
      {file_with(one_tensor(f, "[1]", "[0]"), 4), "data_offsets must"},
      {file_with(one_tensor(f, "[1]", "[0,4,8]"), 4), "data_offsets must"},
      {file_with(one_tensor(f, "[1]", "{}"), 4), "data_offsets must"},
      {file_with(one_tensor(f, "[1]", "[4,0]"), 4), "data_offsets must"},
      {file_with(one_tensor(f, "[1]", "[-4,0]"), 4), "data_offsets must"},
      {file_with(one_tensor(f, "[1]", "[0,4.0]"), 4), "data_offsets must"},
      {file_with(one_tensor(f, "[1]", "[0,8]"), 4), "ends at byte 8 of the data, which has 4"},
      {file_with(one_tensor(f, "[1]", "[0,9223372036854775807]"), 4), "ends at byte"},
      {file_with(one_tensor(f, "[2]", "[0,4]"), 4), "4 bytes, which is not"},
      {file_with(one_tensor(f, "[]", "[0,8]"), 8), "8 bytes, which is not"},
      {file_with(one_tensor(f, "[1]", "[0,5]"), 5), "5 bytes, which is not"},
      {file_with(one_tensor("\"F64\"", "[1]", "[0,4]"), 4), "which is not"},
      {file_with(one_tensor("\"I64\"", "[0]", "[0,8]"), 8), "which is not"},
      {file_with(one_tensor(f, "[1]", "[4,8]"), 8), "begins at byte 4 of the data instead of 0"},
      {file_with(one_tensor(f, "[1]", "[0,4]"), 5), "1 bytes follow"},
      {file_with(two_tensors("[0,8]", "[8,16]"), 24), "8 bytes follow"},
      {file_with(two_tensors("[0,8]", "[4,12]"), 12), "tensor \"b\" begins at byte 4"},
      {file_with(two_tensors("[0,8]", "[0,8]"), 8), "tensor \"b\" begins at byte 0"},
      {file_with(two_tensors("[8,16]", "[4,12]"), 16), "begins"},
      {file_with(two_tensors("[0,8]", "[12,20]"), 20),
       "begins at byte 12 of the data instead of 8"},
      {file_with(two_tensors("[0,8]", "[8,16]"), 15), "ends at byte 16"},
  };
}

TEST(Safetensors, EveryPlantedFaultGetsOneLine) {
  std::vector<PlantedFile> all = planted_headers();
  for (PlantedFile& more : planted_tensors()) all.push_back(std::move(more));
  EXPECT_GE(all.size(), 60u);
  for (const PlantedFile& planted : all) {
    SCOPED_TRACE(planted.phrase);
    expect_refused(parse_safetensors(planted.bytes, "f.safetensors"),
                   "f.safetensors: ", planted.phrase);
  }
  // The same without a fault is fine.
  EXPECT_TRUE(parse_safetensors(file_with(one_tensor("\"F32\"", "[1]", "[0,4]") + "   ", 4), "f"));
  EXPECT_TRUE(parse_safetensors(file_with(two_tensors("[8,16]", "[0,8]"), 16), "f"));
  EXPECT_TRUE(parse_safetensors(file_with("{}", 0), "f"));
}

TEST(Safetensors, IsRefusedCutOffAnywhere) {
  const std::string whole = read_file(testing::test_file("library.safetensors")).value();
  for (std::size_t size = 0; size < whole.size(); ++size) {
    SCOPED_TRACE(size);
    expect_refused(parse_safetensors(std::string_view(whole).substr(0, size), "f"), "f: ");
  }
}

TEST(Safetensors, ByteFlipsNeverGiveWrongSizes) {
  const std::string whole = read_file(testing::test_file("library.safetensors")).value();
  std::mt19937_64 random(11);
  int accepted = 0;
  for (int round = 0; round < 5000; ++round) {
    std::string bytes = whole;
    for (std::uint64_t i = 1 + random() % 3; i-- > 0;) {
      bytes[random() % bytes.size()] ^= static_cast<char>(1 + random() % 255);
    }
    const auto read = parse_safetensors(bytes, "f");
    if (!read) {
      expect_refused(read, "f: ");
      continue;
    }
    ++accepted;
    testing::expect_whole(*read);
    std::size_t numbers = 0;
    for (const auto& [name, tensor] : read->tensors) {
      numbers += testing::value_count_of(tensor) * (tensor.values.index() == 0 ? 4 : 8);
    }
    EXPECT_EQ(numbers, 60u);
  }
  EXPECT_GT(accepted, 0);  // numbers and names may be others
}

}  // namespace
}  // namespace mjarm::rl
