#pragma once

#include <cstddef>
#include <memory>
#include <span>

/// VAMP's checks of states of the Panda, for `collision_bench`. Plain types only: VAMP is compiled
/// with other instructions than the rest.
namespace mjarm::peers {

struct VampSolid {
  enum class Kind { ball, box, capsule } kind;
  float center[3];
  float axes[9];  ///< columns, one after the other
  float size[3];  ///< radius; half extents; radius and half length along the third axis
};

struct VampWorld;  // its environment

std::shared_ptr<const VampWorld> make_vamp_world(std::span<const VampSolid> solids);

/// How many of blocks of eight states have no state in collision. A block ends with its first hit.
/// @param q  (blocks, 7, 8): the same joint of eight states side by side.
std::size_t count_free_blocks(const VampWorld& world, const float* q, std::size_t blocks);

}  // namespace mjarm::peers
