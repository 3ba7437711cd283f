#pragma once

#include <vector>

#include "mjarm/perception/image_fit_internal.hpp"
#include "mjarm/perception/shape_model_internal.hpp"

namespace mjarm::perception {

/// A pose of a shape and how well it explains a cluster.
struct ShapeFit {
  Pose X_CO;
  double cost = 0;         ///< half the sum of squared residuals in sigma, cut off at 4
  double seen = 0;         ///< share of its pixels that are seen where they should be
  double outside = 0;      ///< share of its pixels outside of the picture
  double missing = 0;      ///< share of its pixels through which something farther is seen
  double unexplained = 0;  ///< share of the cluster's pixels that it does not explain
  double residual = 0;     ///< [m] root mean square of depth over the pixels seen
  double misfit = 0;  ///< the same as a share of what noise and a shape that is 1 mm off explain
  double uncertainty = 0;  ///< [m] standard deviation of its surface in the least certain direction
};

/// Whether two poses are the same, up to the shape's symmetry and a few millimetres.
[[nodiscard]] bool is_same(const ShapeModel& shape, const Pose& A, const Pose& B);

/// A pose to refine. Costs of one cluster can be compared from shape to shape.
struct Start {
  Pose X_CO;
  double cost = 0;
};

/// All orientations of the shape, each placed where the cluster is, the best first.
[[nodiscard]] std::vector<Start> rough_search(const DepthScene& scene, int cluster,
                                              const ShapeModel& shape, Raster& raster);

/// The first of them, refined in a coarse picture: up to four that differ by more than the shape's
/// symmetry, the best first.
[[nodiscard]] std::vector<Start> coarse_search(const DepthScene& scene, int cluster,
                                               const ShapeModel& shape, std::vector<Start> starts,
                                               Raster& raster);

/// The same in the fine picture: the best one, and the next one where there is one that comes near.
[[nodiscard]] std::vector<ShapeFit> fine_search(const DepthScene& scene, int cluster,
                                                const ShapeModel& shape, std::vector<Start> starts,
                                                Raster& raster);

/// [m] How far the lowest vertex is below the table; 0 where none is.
[[nodiscard]] double sunk_depth(const DepthScene& scene, const Surface& surface, const Pose& X_CO);

/// How well the scene agrees with a pose of the shape; `cluster` is -1 where nothing has to be
/// explained.
[[nodiscard]] ShapeFit check_shape(const DepthScene& scene, int cluster, const ShapeModel& shape,
                                   const Pose& X_CO, Raster& raster);

}  // namespace mjarm::perception
