#pragma once

#include <span>

struct mjModel_;

namespace mjarm {

/// The keyframe a model stands in before anything moves it, its arms and all else alike: `home`,
/// else the only one, whatever it is called.
/// @return its number, -1 where there is none.
[[nodiscard]] int home_keyframe(const mjModel_* model) noexcept;

/// Its configuration, else the initial one; shape (nq,), belongs to the model.
[[nodiscard]] std::span<const double> home_configuration(const mjModel_* model) noexcept;

}  // namespace mjarm
