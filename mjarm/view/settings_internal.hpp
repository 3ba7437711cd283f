#pragma once

#include "mjarm/render/scene.hpp"
#include "mjarm/view/settings.hpp"

namespace mjarm {

/// What `scene` shows as it stands.
[[nodiscard]] ViewSettings settings_of(Scene& scene);
/// Makes `scene` show that.
void apply(const ViewSettings& settings, Scene& scene);
/// True where drawing needs contacts and forces.
[[nodiscard]] bool needs_dynamics(const ViewSettings& settings);

}  // namespace mjarm
