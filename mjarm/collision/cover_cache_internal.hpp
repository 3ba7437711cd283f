#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mjarm/collision/cover_fit_internal.hpp"
#include "mjarm/collision/cover_pairs_internal.hpp"

/// What cover_model() takes longest for, in UserCache: the spheres of a robot, which are the same
/// in every scene, and what can meet what in one.
namespace mjarm::detail {

/// Of spheres round `covers` that stick out by `bound`.
[[nodiscard]] std::string key_of_covers(const std::vector<std::vector<CoverSolid>>& covers,
                                        double bound);
[[nodiscard]] std::string bytes_of(const std::vector<FittedCover>& covers);
/// None where these are not the bytes of so many covers.
[[nodiscard]] std::optional<std::vector<FittedCover>> covers_of(const std::string& bytes,
                                                                std::size_t count);

[[nodiscard]] std::string bytes_of(const Meetings& meetings);
/// None where these are not the bytes of meetings of these groups.
[[nodiscard]] std::optional<Meetings> meetings_of(const std::string& bytes,
                                                  const GeomGroups& groups);

}  // namespace mjarm::detail
