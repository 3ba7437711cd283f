#include "mjarm/serve/run_page.hpp"

#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <cstring>

#include "mjarm/core/base64.hpp"
#include "mjarm/core/json.hpp"
#include "mjarm/core/sha256.hpp"
#include "mjarm/model/shipped_test.hpp"
#include "mjarm/serve/packed_run_internal.hpp"
#include "mjarm/serve/page_site.hpp"

namespace mjarm::serve {
namespace {

/// Reads what was packed, as its docstring says.
class Reader {
 public:
  explicit Reader(const std::string& packed) : bytes_(std::size_t{16} << 20, '\0') {
    uLongf size = bytes_.size();
    EXPECT_EQ(uncompress(reinterpret_cast<Bytef*>(bytes_.data()), &size,
                         reinterpret_cast<const Bytef*>(packed.data()), packed.size()),
              Z_OK);
    bytes_.resize(size);
  }
  double real() {
    double value = 0;
    std::memcpy(&value, bytes_.data() + at_, sizeof(value));
    at_ += sizeof(value);
    return value;
  }
  std::vector<double> row(std::size_t count, double unit) {
    std::vector<double> out;
    std::int64_t value = 0;
    for (std::size_t i = 0; i < count; ++i) {
      std::uint64_t rest = 0;
      for (int shift = 0;; shift += 7) {
        const auto byte = static_cast<unsigned char>(bytes_.at(at_++));
        rest |= std::uint64_t{byte & 0x7FU} << shift;
        if (byte < 0x80) break;
      }
      value += static_cast<std::int64_t>(rest >> 1U) ^ -static_cast<std::int64_t>(rest & 1U);
      out.push_back(static_cast<double>(value) * unit);
    }
    return out;
  }
  [[nodiscard]] bool at_end() const { return at_ == bytes_.size(); }

 private:
  std::string bytes_;
  std::size_t at_ = 0;
};

class RecordedCar : public ::testing::Test {
 protected:
  RecordedCar() {
    record_.add(sim_.snapshot());
    const std::vector<double> ctrl(sim_.ctrl().size(), 1);
    for (int i = 0; i < 1000; ++i) {
      EXPECT_TRUE(sim_.step(ctrl));
      if (record_.is_due(sim_.time())) record_.add(sim_.snapshot());
    }
  }
  Model model_ = testing::shipped("car");
  Sim sim_{model_};
  BodyRecord record_{model_};
};

TEST_F(RecordedCar, IsPackedToWhatCanBeSeen) {
  const DrawnMesh mesh{{0, 0, 0.5F, 1, -2, 0.25F, 0.125F, 0, 0}, {0, 1, 2, 2, 1, 0}};
  const std::vector<int> bodies = moving_bodies(record_);
  ASSERT_FALSE(bodies.empty());
  Reader reader(packed_run({&mesh, 1}, record_, bodies));
  const double unit = reader.real();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::vector<double> row = reader.row(3, unit);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(row[i], mesh.xyz[3 * i + axis], 2.0 / 65535);
  }
  EXPECT_EQ(reader.row(6, 1), (std::vector<double>{0, 1, 2, 2, 1, 0}));
  for (std::size_t i = 0; i < record_.size(); ++i) EXPECT_EQ(reader.real(), record_.time(i));
  for (std::size_t j = 0; j < static_cast<std::size_t>(model_.nq()); ++j) {
    for (std::size_t i = 0; i < record_.size(); ++i) {
      EXPECT_EQ(reader.real(), record_.qpos(i)[j]);
    }
  }
  for (const int body : bodies) {
    const auto b = static_cast<std::size_t>(body);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::vector<double> row = reader.row(record_.size(), 1e-5);
      for (std::size_t i = 0; i < row.size(); ++i) {
        EXPECT_NEAR(row[i], record_.p_W(i)[3 * b + axis], 6e-6);
      }
    }
    std::vector<std::vector<double>> quat;
    for (int part = 0; part < 4; ++part) quat.push_back(reader.row(record_.size(), 1.0 / 32767));
    for (std::size_t i = 0; i < record_.size(); ++i) {
      double dot = 0;
      for (std::size_t part = 0; part < 4; ++part)
        dot += quat[part][i] * record_.quat(i)[4 * b + part];
      EXPECT_NEAR(std::abs(dot), 1, 1e-4);
    }
  }
  EXPECT_TRUE(reader.at_end());
}

TEST_F(RecordedCar, WhatStandsStillIsNotKept) {
  EXPECT_LT(moving_bodies(record_).size(), static_cast<std::size_t>(record_.bodies() - 1) + 1);
  BodyRecord still(model_);
  still.add(Sim(model_).snapshot());
  EXPECT_TRUE(moving_bodies(still).empty());
}

std::string between(const std::string& text, const std::string& from, const std::string& to) {
  const std::size_t begin = text.find(from);
  EXPECT_NE(begin, std::string::npos) << from;
  if (begin == std::string::npos) return {};
  return text.substr(begin + from.size(), text.find(to, begin + from.size()) - begin - from.size());
}

TEST_F(RecordedCar, IsAPageThatRunsItsOwnScriptAlone) {
  if (!page_folder()) GTEST_SKIP() << "the page is not built (./dev page)";
  const view::RecordedRun run{.model = model_,
                              .title = "</script><script>alert(1)</script>",
                              .bodies = record_,
                              .overlay = {},
                              .plots = {},
                              .line = "<b>",
                              .camera = {}};
  const Result<std::string> page = run_page(run);
  ASSERT_TRUE(page) << page.error().what;
  const std::string policy = between(*page, "Content-Security-Policy\" content=\"", "\"");
  EXPECT_TRUE(policy.starts_with("default-src 'none'; script-src 'sha256-")) << policy;
  for (const auto& [from, to] :
       {std::pair{"<script type=\"module\">", "</script>"}, {"<style>", "</style>"}}) {
    const std::string hash = base64(sha256_bytes(between(*page, from, to)));
    EXPECT_NE(policy.find("'sha256-" + hash + "'"), std::string::npos) << policy;
  }
  EXPECT_EQ(page->find("alert(1)</script>"), std::string::npos);
  EXPECT_EQ(page->find("src=\"./"), std::string::npos);
  EXPECT_EQ(page->find("href=\"./"), std::string::npos);
  const auto data = JsonObject::parse(between(*page, "id=\"run\">", "</script>"));
  ASSERT_TRUE(data) << describe(data.error());
  EXPECT_LT(page->size(), std::size_t{4} << 20);
}

TEST_F(RecordedCar, WhereNothingWasRecordedThereIsNoPage) {
  if (!page_folder()) GTEST_SKIP() << "the page is not built (./dev page)";
  const BodyRecord none(model_);
  EXPECT_FALSE(run_page({.model = model_, .title = "", .bodies = none}));
}

}  // namespace
}  // namespace mjarm::serve
