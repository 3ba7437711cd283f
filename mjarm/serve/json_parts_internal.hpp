#pragma once

#include <Eigen/Core>

#include "mjarm/core/json_writer.hpp"
#include "mjarm/core/pose.hpp"
#include "mjarm/render/overlay.hpp"

/// What several messages of a page are made of.
namespace mjarm::serve {

/// To six digits: more are not to be seen, and make a message twice as long.
[[nodiscard]] double shortened(double value);

/// `"rgba":[...]`
void add_color(JsonWriter& json, const render::Rgba& color);
/// The three numbers of a point, shortened.
void add_point(JsonWriter& json, const Eigen::Vector3d& p);
/// `"pos":[3],"quat":[4]`, shortened.
void add_place(JsonWriter& json, const Pose& X);
/// Seven numbers: x, y, z, w, x, y, z; no brackets.
void add_seven(JsonWriter& json, const Pose& X);

}  // namespace mjarm::serve
