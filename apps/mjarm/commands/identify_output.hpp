#pragma once

#include <string>

#include "mjarm/identification/identify.hpp"

namespace mjarm::app {

/// Tables of what was found, in the user's language.
[[nodiscard]] std::string identification_text(const Identification& found, const Arm& arm);
/// The same as a JSON document.
[[nodiscard]] std::string identification_json(const Identification& found, const Arm& arm);

}  // namespace mjarm::app
