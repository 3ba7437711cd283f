#include "bench/peers/vamp/vamp_peer.hpp"

#include <cmath>
#include <vamp/collision/environment.hh>
#include <vamp/robots/panda.hh>
#include <vamp/vector.hh>

namespace mjarm::peers {
namespace {

using vamp::robots::Panda;
constexpr std::size_t kLanes = 8;
using Lanes = vamp::FloatVector<kLanes>;

constexpr float kUpright = 1e-4F;

}  // namespace

struct VampWorld {
  vamp::collision::Environment<Lanes> environment;
};

std::shared_ptr<const VampWorld> make_vamp_world(std::span<const VampSolid> solids) {
  vamp::collision::Environment<float> all;
  for (const VampSolid& s : solids) {
    const float *c = s.center, *x = s.axes, *y = x + 3, *z = y + 3;
    const bool upright = std::abs(z[2]) > 1 - kUpright;
    switch (s.kind) {
      case VampSolid::Kind::ball:
        all.spheres.emplace_back(c[0], c[1], c[2], s.size[0]);
        break;
      case VampSolid::Kind::box:
        (upright ? all.z_aligned_cuboids : all.cuboids)
            .emplace_back(c[0], c[1], c[2], x[0], x[1], x[2], y[0], y[1], y[2], z[0], z[1], z[2],
                          s.size[0], s.size[1], s.size[2]);
        break;
      case VampSolid::Kind::capsule: {
        const float h = s.size[1];
        (upright ? all.z_aligned_capsules : all.capsules)
            .emplace_back(c[0] + h * z[0], c[1] + h * z[1], c[2] + h * z[2], -2 * h * z[0],
                          -2 * h * z[1], -2 * h * z[2], s.size[0], 1 / (4 * h * h));
        break;
      }
    }
  }
  all.sort();
  return std::make_shared<VampWorld>(VampWorld{vamp::collision::Environment<Lanes>(all)});
}

std::size_t count_free_blocks(const VampWorld& world, const float* q, std::size_t blocks) {
  std::size_t count = 0;
  for (std::size_t b = 0; b < blocks; ++b) {
    Panda::ConfigurationBlock<kLanes> block;
    for (std::size_t i = 0; i < Panda::dimension; ++i, q += kLanes) {
      alignas(4 * kLanes) float row[kLanes];
      for (std::size_t k = 0; k < kLanes; ++k) row[k] = q[k];
      block[i] = Lanes(row);
    }
    count += Panda::fkcc<kLanes>(world.environment, block) ? 1 : 0;
  }
  return count;
}

}  // namespace mjarm::peers
