#pragma once

#include "mjarm/render/scene.hpp"
#include "mjarm/view/settings.hpp"

namespace mjarm::view {

/// What `scene` shows as it stands.
[[nodiscard]] ViewSettings settings_of(render::Scene& scene);
/// Makes `scene` show that.
void apply(const ViewSettings& settings, render::Scene& scene);
/// True where drawing needs contacts and forces.
[[nodiscard]] bool needs_dynamics(const ViewSettings& settings);

}  // namespace mjarm::view
