#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>

#include "mjarm/collision/facets_internal.hpp"

namespace mjarm::detail {
namespace {

constexpr std::size_t kFacetLanes = 4;     // facets of a block
constexpr std::size_t kLeastCluster = 16;  // facets that are not parted
constexpr std::size_t kMaxClusters = 256;
constexpr double kFacetRounding = 1e-12;  // far more than that of a few products of doubles
constexpr double kNoFacet = std::numeric_limits<double>::infinity();

typedef double Two __attribute__((vector_size(16)));

Two load_two(const double* from) {
  Two out;
  std::memcpy(&out, from, sizeof out);
  return out;
}

/// In the order of farthest_in(), so that nothing is rounded in another way.
double beyond(const Facet& facet, const Eigen::Vector3d& p) {
  const Eigen::Vector3d& n = facet.normal;
  return n.x() * p.x() + n.y() * p.y() + n.z() * p.z() - facet.offset;
}

/// The largest normal . p - offset of blocks of rows.
double farthest_in(const double* at, const double* end, const Eigen::Vector3d& p) {
  const Two x = Two{} + p.x(), y = Two{} + p.y(), z = Two{} + p.z();
  std::array<Two, 2> max{Two{} - kNoFacet, Two{} - kNoFacet};
  for (; at != end; at += 4 * kFacetLanes) {
    for (std::size_t k = 0; k < 2; ++k) {
      const double* const pair = at + 2 * k;
      const Two beyond = load_two(pair) * x + load_two(pair + kFacetLanes) * y +
                         load_two(pair + 2 * kFacetLanes) * z - load_two(pair + 3 * kFacetLanes);
      max[k] = max[k] < beyond ? beyond : max[k];
    }
  }
  return std::max(std::max(max[0][0], max[0][1]), std::max(max[1][0], max[1][1]));
}

}  // namespace

Facets::Facets(std::vector<Facet> all) : all_(std::move(all)) {
  if (all_.empty()) return;
  for (const Facet& facet : all_) {
    center_ += facet.offset * facet.normal / static_cast<double>(all_.size());
    scale_ = std::max(scale_, std::abs(facet.offset));
  }
  scale_ += center_.norm();
  cluster_size_ = std::max(kLeastCluster, 2 * all_.size() / kMaxClusters + 1);
  order_.resize(all_.size());
  std::iota(order_.begin(), order_.end(), std::size_t{0});
  split(0, order_.size());
}

/// Parts [first, last) of order_ where normals spread most until few are left.
void Facets::split(std::size_t first, std::size_t last) {
  if (last - first <= cluster_size_) return add_cluster(first, last);
  Eigen::Vector3d low = all_[order_[first]].normal, high = low;
  for (std::size_t k = first; k < last; ++k) {
    low = low.cwiseMin(all_[order_[k]].normal);
    high = high.cwiseMax(all_[order_[k]].normal);
  }
  Eigen::Index axis = 0;
  (high - low).maxCoeff(&axis);
  const std::size_t half = first + (last - first) / 2;
  const auto at = [&](std::size_t k) { return order_.begin() + static_cast<std::ptrdiff_t>(k); };
  std::nth_element(at(first), at(half), at(last), [&](std::size_t a, std::size_t b) {
    return all_[a].normal[axis] < all_[b].normal[axis];
  });
  split(first, half);
  split(half, last);
}

void Facets::add_cluster(std::size_t first, std::size_t last) {
  Cluster out{Eigen::Vector3d::Zero(), 0, kNoFacet, rows_.size(), 0, first, last - first};
  for (std::size_t k = first; k < last; ++k) {
    out.middle += all_[order_[k]].normal / static_cast<double>(last - first);
  }
  for (std::size_t k = first; k < last; ++k) {
    const auto& [normal, offset] = all_[order_[k]];
    out.spread = std::max(out.spread, (normal - out.middle).norm());
    out.offset = std::min(out.offset, offset - normal.dot(center_));
    const std::size_t lane = (k - first) % kFacetLanes;
    // Lanes without a facet have one that is farther from everything than any other.
    if (lane == 0) {
      rows_.resize(rows_.size() + 3 * kFacetLanes, 0);
      rows_.resize(rows_.size() + kFacetLanes, kNoFacet);
    }
    double* const block = rows_.data() + rows_.size() - 4 * kFacetLanes;
    for (std::size_t i = 0; i < 3; ++i) {
      block[i * kFacetLanes + lane] = normal[static_cast<Eigen::Index>(i)];
    }
    block[3 * kFacetLanes + lane] = offset;
  }
  out.last = rows_.size();
  clusters_.push_back(out);
}

/// normal . p - offset = normal . q - (offset - normal . center), q = p - center, and normal . q is
/// at most middle . q + spread |q|.
Facets::Seen Facets::see(const Eigen::Vector3d& p) const {
  const Eigen::Vector3d q = p - center_;
  const double far = q.norm();
  return {q, far, kFacetRounding * (1 + far + scale_)};
}

double Facets::bound(const Cluster& c, const Seen& seen) {
  return c.middle.x() * seen.q.x() + c.middle.y() * seen.q.y() + c.middle.z() * seen.q.z() +
         c.spread * seen.far - c.offset + seen.spare;
}

double Facets::farthest(const Eigen::Vector3d& p) const {
  const auto look = [&](const Cluster& cluster) {
    return farthest_in(rows_.data() + cluster.first, rows_.data() + cluster.last, p);
  };
  if (clusters_.empty()) return -kNoFacet;
  if (clusters_.size() == 1) return look(clusters_.front());
  // Clusters that cannot have the largest are left out.
  const Seen seen = see(p);
  std::array<double, kMaxClusters> bounds;
  std::size_t best = 0;
  for (std::size_t k = 0; k < clusters_.size(); ++k) {
    bounds[k] = bound(clusters_[k], seen);
    if (bounds[k] > bounds[best]) best = k;
  }
  double max = look(clusters_[best]);
  for (std::size_t k = 0; k < clusters_.size(); ++k) {
    if (k != best && bounds[k] > max) max = std::max(max, look(clusters_[k]));
  }
  return max;
}

bool Facets::is_beyond(const Eigen::Vector3d& p, double limit) const {
  const Seen seen = see(p);
  return std::ranges::any_of(clusters_, [&](const Cluster& c) {
    return bound(c, seen) > limit &&
           farthest_in(rows_.data() + c.first, rows_.data() + c.last, p) > limit;
  });
}

std::array<double, 6> Facets::farthest_beside(const Eigen::Vector3d& middle, double within,
                                              const std::array<Eigen::Vector3d, 6>& at) const {
  // Only those can be the farthest there that nearly are in the middle.
  const Seen seen = see(middle);
  const double least = farthest(middle) - 2 * within * (1 + 1e-3) - seen.spare;
  constexpr std::size_t kFewFacets = 32;
  std::array<const Facet*, kFewFacets> near;
  std::size_t count = 0;
  std::array<double, 6> out;
  for (const Cluster& c : clusters_) {
    if (bound(c, seen) < least) continue;
    for (std::size_t k = c.first_facet; k < c.first_facet + c.facets; ++k) {
      const Facet& facet = all_[order_[k]];
      if (beyond(facet, middle) < least) continue;
      if (count == kFewFacets) {
        for (std::size_t i = 0; i < at.size(); ++i) out[i] = farthest(at[i]);
        return out;
      }
      near[count++] = &facet;
    }
  }
  for (std::size_t i = 0; i < at.size(); ++i) {
    out[i] = -kNoFacet;
    for (std::size_t k = 0; k < count; ++k) out[i] = std::max(out[i], beyond(*near[k], at[i]));
  }
  return out;
}

double Facets::falls_along(const Eigen::Vector3d& p, const Eigen::Vector3d& way, double start,
                           double rate) const {
  // Facet k allows t as long as its own value a + t b is at most start - t rate.
  double out = kNoFacet;
  for (const Facet& facet : all_) {
    const double left = start - beyond(facet, p), pace = facet.normal.dot(way) + rate;
    if (pace > 0 && left < out * pace) out = std::max(left, 0.0) / pace;
  }
  return out;
}

}  // namespace mjarm::detail
