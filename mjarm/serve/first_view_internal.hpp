#pragma once

#include "mjarm/core/result.hpp"
#include "mjarm/model/model.hpp"
#include "mjarm/render/camera.hpp"

namespace mjarm::serve {

/// Where a page looks from at first: as a window would.
/// @return bad_input for a camera that the model does not have.
[[nodiscard]] Result<render::CameraView> first_view(const Model& model,
                                                    const render::Camera& camera);

}  // namespace mjarm::serve
