#pragma once

#include "mjarm/core/messages.hpp"

namespace mjarm::msg {
#define MJARM_MSG(id, english, chinese) inline constexpr Msg id{english, chinese};
#include "apps/mjarm/messages/cloning.inc"
#undef MJARM_MSG
}  // namespace mjarm::msg
