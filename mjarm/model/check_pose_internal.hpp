#pragma once

#include <vector>

#include "mjarm/model/check_internal.hpp"

namespace mjarm {

/// Full configuration of the model with the arm at home (nq,).
[[nodiscard]] std::vector<double> home_qpos(const CheckContext& context);

}  // namespace mjarm
