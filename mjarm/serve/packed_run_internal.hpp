#pragma once

#include <span>
#include <string>
#include <vector>

#include "mjarm/model/drawn_model.hpp"
#include "mjarm/sim/body_record.hpp"

namespace mjarm::serve {

/// The bodies that do not stand still in a record, ascending.
[[nodiscard]] std::vector<int> moving_bodies(const BodyRecord& record);

/// Meshes and record as few bytes, deflated (zlib). One after the other:
///   each mesh: f64 unit [m]; x, then y, then z of all its vertices in that unit; its corners.
///   the record: f64 times [s], shape (n,); f64 qpos, shape (nq, n); for each of `bodies` x, y and
///   z in 10 um and w, x, y and z of its quaternion in 1/32767, shape (7, n).
/// Whole numbers are differences to the one before (the first to 0) in "zigzag" order (0, -1, 1,
/// -2, ...), seven bits a byte, the lowest first, the eighth set where more follow; so is each row.
/// All is little endian.
[[nodiscard]] std::string packed_run(std::span<const DrawnMesh> meshes, const BodyRecord& record,
                                     std::span<const int> bodies);

/// As few bytes as zlib makes of them.
[[nodiscard]] std::string deflated(const std::string& content);

}  // namespace mjarm::serve
