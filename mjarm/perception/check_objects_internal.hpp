#pragma once

#include <span>

#include "mjarm/perception/find_objects.hpp"

namespace mjarm::perception {

/// @return bad_input that names the first object, or option, that cannot be.
[[nodiscard]] Result<void> check_objects(std::span<const KnownObject> objects);
[[nodiscard]] Result<void> check_options(const FindOptions& options);

}  // namespace mjarm::perception
