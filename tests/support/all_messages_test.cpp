#include <gtest/gtest.h>

#include "tests/support/messages.hpp"

namespace mjarm {
namespace {

constexpr Msg kAllMessages[] = {
#define MJARM_MSG(id, english, chinese) {english, chinese},
#include "all_messages.inc"
#undef MJARM_MSG
};

TEST(AllMessages, AreSound) { support::expect_sound(kAllMessages); }

}  // namespace
}  // namespace mjarm
