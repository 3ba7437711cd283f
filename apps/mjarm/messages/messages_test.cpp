#include "tests/support/messages.hpp"

#include <gtest/gtest.h>

namespace mjarm::app {
namespace {

constexpr Msg kProgramMessages[] = {
#define MJARM_MSG(id, english, chinese) {english, chinese},
#include "all_messages.inc"
#undef MJARM_MSG
};

TEST(ProgramMessages, AreSound) { support::expect_sound(kProgramMessages); }

}  // namespace
}  // namespace mjarm::app
