#include "tests/support/messages.hpp"

#include <gtest/gtest.h>

namespace mjarm::app {
namespace {

constexpr Msg kBenchMessages[] = {
#define MJARM_MSG(id, english, chinese) {english, chinese},
#include "all_messages.inc"
#undef MJARM_MSG
};

TEST(BenchMessages, AreSound) { support::expect_sound(kBenchMessages); }

}  // namespace
}  // namespace mjarm::app
