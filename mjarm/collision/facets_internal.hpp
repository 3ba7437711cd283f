#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

namespace mjarm::detail {

/// All points p with normal . p <= offset.
struct Facet {
  Eigen::Vector3d normal;  ///< unit
  double offset = 0;       ///< [m]
};

/// What bounds a convex solid. Facets that look about the same way are kept together, so that of
/// many few need to be looked at, and these several at once.
class Facets {
 public:
  Facets() = default;
  explicit Facets(std::vector<Facet> all);

  [[nodiscard]] std::size_t size() const { return all_.size(); }
  [[nodiscard]] const Facet& operator[](std::size_t index) const { return all_[index]; }
  /// [m] The largest normal . p - offset; minus infinity where there are none. The same to the last
  /// bit as one after the other.
  [[nodiscard]] double farthest(const Eigen::Vector3d& p) const;
  /// Whether that is more than `limit`.
  [[nodiscard]] bool is_beyond(const Eigen::Vector3d& p, double limit) const;
  /// farthest() at places no farther from `middle` than `within`, which should be tiny.
  [[nodiscard]] std::array<double, 6> farthest_beside(
      const Eigen::Vector3d& middle, double within, const std::array<Eigen::Vector3d, 6>& at) const;
  /// [m] How far one may go from `p` along `way` (unit) while farthest(), which is `start` at `p`,
  /// falls by at least `rate` a metre. Rounded.
  [[nodiscard]] double falls_along(const Eigen::Vector3d& p, const Eigen::Vector3d& way,
                                   double start, double rate) const;

 private:
  /// Facets whose normals are within `spread` of one direction.
  struct Cluster {
    Eigen::Vector3d middle;  ///< of the normals
    double spread = 0;
    double offset = 0;                        ///< [m] the least, as seen from center_
    std::size_t first = 0, last = 0;          ///< of rows_
    std::size_t first_facet = 0, facets = 0;  ///< of order_
  };
  /// What a place is like for all clusters.
  struct Seen {
    Eigen::Vector3d q;  ///< from center_
    double far, spare;
  };
  [[nodiscard]] Seen see(const Eigen::Vector3d& p) const;
  [[nodiscard]] static double bound(const Cluster& cluster, const Seen& seen);
  void split(std::size_t first, std::size_t last);
  void add_cluster(std::size_t first, std::size_t last);

  std::vector<Facet> all_;
  std::vector<std::size_t> order_;                    // those of a cluster side by side
  Eigen::Vector3d center_ = Eigen::Vector3d::Zero();  // somewhere in the middle
  double scale_ = 0;                                  // [m] what rounding is measured by
  std::size_t cluster_size_ = 0;
  std::vector<Cluster> clusters_;
  std::vector<double> rows_;  // four normals along x, along y, along z, four offsets, ...
};

}  // namespace mjarm::detail
