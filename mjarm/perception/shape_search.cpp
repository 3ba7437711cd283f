#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>
#include <utility>

#include "mjarm/core/linear_algebra.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/perception/fit_poses_internal.hpp"
#include "mjarm/perception/shape_search_internal.hpp"

namespace mjarm::perception {
namespace {

constexpr float kFineLimit = 4;   // [sigma]
constexpr double kModel = 0.001;  // [m] that the shape itself may be off
constexpr int kStarts = 300;
constexpr std::size_t kCoarse = 4;  // poses that are left of them
constexpr double kFar = 0.02;       // [m] as far as anything pulls at first
constexpr double kSame = 0.003;     // [m] of surface_distance: the same pose, up to symmetry

/// Evenly spread over all orientations (M. Alexa, Super-Fibonacci spirals, CVPR 2022).
Eigen::Matrix3d orientation(int i, int n) {
  constexpr double kPsi = 1.533751168755204288118041;
  const double s = i + 0.5;
  const double t = s / n;
  const double a = 2 * std::numbers::pi * s / std::numbers::sqrt2;
  const double b = 2 * std::numbers::pi * s / kPsi;
  const double r = std::sqrt(t);
  const double R = std::sqrt(1 - t);
  return to_matrix(Quat(R * std::cos(b), r * std::sin(a), r * std::cos(a), R * std::sin(b)));
}

/// Mean of the points [m] that inverse depth shows in pixels that `counts` picks; zero for none.
template <class Counts>
Eigen::Vector3d mean_point(const FitView& view, const std::vector<float>& inverse,
                           Counts&& counts) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int n = 0;
  std::size_t i = 0;
  for (int y = 0; y < view.lens.height; ++y) {
    for (int x = 0; x < view.lens.width; ++x, ++i) {
      if (!counts(i)) continue;
      sum += view.lens.ray({x, y}) / inverse[i];
      ++n;
    }
  }
  return n > 0 ? Eigen::Vector3d(sum / n) : Eigen::Vector3d::Zero();
}

Pose with_centre(const ShapeModel& shape, const Eigen::Matrix3d& R,
                 const Eigen::Vector3d& centre_C) {
  return {.p = centre_C - R * shape.centre, .R = R};
}

/// A pose moved about the shape's centre.
Pose turned_about_centre(const ShapeModel& shape, const Pose& X_CO, const Eigen::VectorXd& x) {
  const Pose X{.p = X_CO * shape.centre, .R = X_CO.R};
  const Pose to = moved(X, x);
  return with_centre(shape, to.R, to.p);
}

/// Residual of a shape that stands lower than the table: as if each pixel were off by a sigma for
/// each 3 mm that it is sunk.
float sunk_residual(const DepthScene& scene, const FitView& view, const ShapeModel& shape,
                    const Pose& X_CO) {
  constexpr double kFree = 0.0015;  // [m]
  constexpr double kSigma = 0.003;  // [m]
  const double sunk = sunk_depth(scene, shape.coarse.surface, X_CO) - kFree;
  return sunk > 0 ? static_cast<float>(std::sqrt(view.cluster_pixels) * sunk / kSigma) : 0;
}

bool is_better(const Start& a, const Start& b) { return a.cost < b.cost; }

/// Whether anything else may hide a part of the cluster.
bool is_hidden(const FitView& view) {
  return std::ranges::find(view.kind, FitView::other) != view.kind.end();
}

/// Orientations, each so placed that what is seen of it, where nothing else hides it, has the
/// cluster's mean; the best first.
std::vector<Start> starts_of(const DepthScene& scene, const FitView& view, const ShapeModel& shape,
                             const std::vector<Eigen::Matrix3d>& orientations, float limit,
                             Raster& raster) {
  const int shifts = is_hidden(view) ? 3 : 1;
  const Eigen::Vector3d seen_C = mean_point(
      view, view.inverse, [&](std::size_t i) { return view.kind[i] == FitView::cluster; });
  std::vector<Start> out;
  std::vector<float> r;
  for (const Eigen::Matrix3d& R_CO : orientations) {
    Pose X_CO = with_centre(shape, R_CO, seen_C + 0.5 * shape.radius * seen_C.normalized());
    for (int k = 0; k < shifts; ++k) {
      raster.clear(view.lens);
      raster.draw(shape.coarse.surface, X_CO, shape.coarse.sides);
      const std::vector<float>& drawn = raster.inverse();
      const Eigen::Vector3d drawn_C = mean_point(view, drawn, [&](std::size_t at) {
        const bool behind = view.kind[at] == FitView::other && view.inverse[at] > drawn[at];
        return drawn[at] > view.table_inverse[at] && !behind;
      });
      if (drawn_C.z() > 0) X_CO.p += seen_C - drawn_C;
    }
    raster.clear(view.lens);
    raster.draw(shape.coarse.surface, X_CO, shape.coarse.sides);
    residuals_of(view, raster.inverse(), limit, r);
    r.push_back(sunk_residual(scene, view, shape, X_CO));
    out.push_back({X_CO, cost_of(r)});
  }
  std::stable_sort(out.begin(), out.end(), is_better);
  return out;
}

/// Orientations that are easily taken for that one: turned by quarters about the shape's axes.
std::vector<Eigen::Matrix3d> quarter_turns(const ShapeModel& shape, const Eigen::Matrix3d& R_CO) {
  std::vector<Eigen::Matrix3d> out;
  std::array<int, 3> to{0, 1, 2};
  do {
    for (int signs = 0; signs < 8; ++signs) {
      Eigen::Matrix3d turn = Eigen::Matrix3d::Zero();
      for (int k = 0; k < 3; ++k) {
        turn(k, to[static_cast<std::size_t>(k)]) = (signs >> k & 1) != 0 ? -1 : 1;
      }
      if (turn.determinant() < 0 || turn.isIdentity()) continue;
      out.push_back(R_CO * shape.axes * turn * shape.axes.transpose());
    }
  } while (std::next_permutation(to.begin(), to.end()));
  return out;
}

/// One pixel of the view, as metres and as turns of the shape.
Eigen::VectorXd steps_of(const FitView& view, const ShapeModel& shape, double pixels) {
  const double metres = std::max(2e-4, pixels / (view.middle * view.lens.fx));
  Eigen::VectorXd step(6);
  step << Eigen::Vector3d::Constant(metres),
      Eigen::Vector3d::Constant(metres / (0.6 * shape.radius));
  return step;
}

Start refined(const DepthScene& scene, const FitView& view, const ShapeModel& shape,
              const DrawnSurface& drawn, const Start& start, float limit, double pixels,
              Raster& raster) {
  constexpr int kSteps = 6;
  const Pose X_CO = start.X_CO;
  const auto draw = [&](const Eigen::VectorXd& x, Raster& into) {
    const Pose X = turned_about_centre(shape, X_CO, x);
    into.draw(drawn.surface, X, drawn.sides);
    return sunk_residual(scene, view, shape, X);
  };
  const ImageFit fit =
      fit_image(view, draw, Eigen::VectorXd::Zero(6),
                {.limit = limit, .step = steps_of(view, shape, pixels), .steps = kSteps}, raster);
  return {turned_about_centre(shape, X_CO, fit.x), fit.cost};
}

/// The best of what is found from a little beside: outlines in whole pixels make shallow minima.
Start best_near(const DepthScene& scene, const FitView& view, const ShapeModel& shape,
                const Start& start, Raster& raster) {
  constexpr double kTurn = 0.04;  // [rad]
  Start best = start;
  for (int k = 0; k < 6; ++k) {
    Eigen::VectorXd x = Eigen::VectorXd::Zero(6);
    x[3 + k / 2] = k % 2 == 0 ? kTurn : -kTurn;
    Start near{turned_about_centre(shape, start.X_CO, x), 0};
    for (const double pixels : {2, 1}) {
      near = refined(scene, view, shape, shape.fine, near, kFineLimit, pixels, raster);
    }
    if (near.cost < best.cost) best = near;
  }
  return best;
}

/// So many of them, the best first, that differ by more than symmetry and half a pixel.
std::vector<Start> distinct(const FitView& view, const ShapeModel& shape, std::vector<Start> starts,
                            std::size_t kept) {
  std::stable_sort(starts.begin(), starts.end(), is_better);
  const double same = std::max(kSame, 0.5 / (view.middle * view.lens.fx));
  std::vector<Start> out;
  for (const Start& start : starts) {
    if (out.size() == kept) break;
    const bool known = std::any_of(out.begin(), out.end(), [&](const Start& other) {
      return surface_distance(shape, start.X_CO, other.X_CO) < same;
    });
    if (!known) out.push_back(start);
  }
  return out;
}

/// Refines the first ones.
std::vector<Start> first_refined(const DepthScene& scene, const FitView& view,
                                 const ShapeModel& shape, std::vector<Start> starts,
                                 std::size_t tried, float limit, Raster& raster) {
  starts.resize(std::min(starts.size(), tried));
  for (Start& start : starts)
    start = refined(scene, view, shape, shape.coarse, start, limit, 1, raster);
  return starts;
}

/// The cluster with a rim of a share of its size.
Cluster grown(Cluster box, double share) {
  const int rim = 4 + static_cast<int>(share * std::max(box.x1 - box.x0, box.y1 - box.y0));
  return {box.pixels, box.middle, box.x0 - rim, box.y0 - rim, box.x1 + rim, box.y1 + rim};
}

/// The cluster and what is about it, with so many pixels a side.
FitView rough_view(const DepthScene& scene, int cluster, int side) {
  return view_of(scene, cluster, grown(scene.clusters[static_cast<std::size_t>(cluster)], 0.3),
                 side);
}

float far_limit(const FitView& view) {
  return static_cast<float>(DepthModel::from_metres(kFar, view.middle) / view.sigma);
}

/// The box in the picture round a shape and a cluster, within so much of the picture's surroundings
/// that nothing grows without bounds.
Cluster box_round(const DepthScene& scene, const ShapeModel& shape, const Pose& X_CO, Cluster box) {
  constexpr double kNearest = 0.01;  // [m]
  for (const Eigen::Vector3d& vertex : shape.fine.surface.vertices) {
    const Eigen::Vector3d p_C = X_CO * vertex;
    if (p_C.z() < kNearest) continue;
    const Eigen::Array2d at = scene.lens.project(p_C).array();
    const double width = scene.lens.width;
    const double height = scene.lens.height;
    box.x0 = std::min(box.x0, static_cast<int>(std::clamp(at.x(), -width, 2 * width)));
    box.x1 = std::max(box.x1, static_cast<int>(std::clamp(at.x(), -width, 2 * width)));
    box.y0 = std::min(box.y0, static_cast<int>(std::clamp(at.y(), -height, 2 * height)));
    box.y1 = std::max(box.y1, static_cast<int>(std::clamp(at.y(), -height, 2 * height)));
  }
  return grown(box, 0);
}

/// [m] Standard deviation of the surface along the motion that changes the picture least, among
/// those that are no symmetry of the shape.
double uncertainty_of(const ShapeModel& shape, const Pose& X_CO,
                      const Eigen::MatrixXd& information) {
  const SymmetricEigen motion = symmetric_eigen(normal_motion(shape, X_CO));
  const double tiny = 3e-3 * shape.radius * shape.radius;  // a round side is flat faces here
  Eigen::MatrixXd W(6, 0);
  for (Eigen::Index k = 0; k < 6; ++k) {
    if (motion.values[k] < tiny) continue;
    W.conservativeResize(6, W.cols() + 1);
    W.col(W.cols() - 1) = motion.vectors.col(k) / std::sqrt(motion.values[k]);
  }
  const double least = symmetric_eigen(W.transpose() * information * W).values[0];
  return 1 / std::sqrt(std::max(least, 1e-6));
}

}  // namespace

double sunk_depth(const DepthScene& scene, const Surface& surface, const Pose& X_CO) {
  const double steep = scene.table_a.norm();
  if (steep == 0) return 0;
  double most = 0;
  for (const Eigen::Vector3d& v : surface.vertices) {
    most = std::max(most, scene.table_a.dot(X_CO * v) - 1);
  }
  return most / steep;
}

ShapeFit check_shape(const DepthScene& scene, int cluster, const ShapeModel& shape,
                     const Pose& X_CO, Raster& raster) {
  constexpr int kMaxSide = 110;
  const Cluster none{0, 0, scene.lens.width, scene.lens.height, 0, 0};
  const Cluster box = box_round(
      scene, shape, X_CO, cluster >= 0 ? scene.clusters[static_cast<std::size_t>(cluster)] : none);
  FitView view = view_of(scene, cluster, box, kMaxSide);
  raster.clear(view.lens);
  raster.draw(shape.fine.surface, X_CO, shape.fine.sides);
  const std::vector<float> drawn = raster.inverse();
  int pixels = 0, seen = 0, outside = 0, missing = 0, explained = 0;
  double squares = 0, misfit = 0;
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    if (drawn[i] <= view.table_inverse[i]) continue;
    if (view.kind[i] == FitView::none) continue;
    ++pixels;
    if (view.kind[i] == FitView::outside) {
      ++outside;
      continue;
    }
    const double q = view.inverse[i];
    const double off = drawn[i] - q;  // > 0: something farther is seen
    const double gate = kFineLimit * scene.model.sigma + DepthModel::from_metres(0.002, q);
    if (std::abs(off) <= gate) {
      ++seen;
      explained += view.kind[i] == FitView::cluster ? 1 : 0;
      squares += std::pow(off / (q * q), 2);
      const double may = std::hypot(scene.model.sigma, DepthModel::from_metres(kModel, q));
      misfit += std::pow(off / may, 2);
    } else if (off > 0) {
      ++missing;
    }
  }
  const auto share = [](int a, int b) { return b > 0 ? static_cast<double>(a) / b : 0; };
  ShapeFit out{.X_CO = X_CO};
  out.seen = share(seen, pixels);
  out.outside = share(outside, pixels);
  out.missing = share(missing, pixels);
  out.unexplained = 1 - share(explained, view.cluster_pixels);
  out.residual = seen > 0 ? std::sqrt(squares / seen) : 0;
  out.misfit = seen > 0 ? std::sqrt(misfit / seen) : 0;
  if (view.middle > 0) {
    const auto draw = [&](const Eigen::VectorXd& x, Raster& into) {
      into.draw(shape.fine.surface, turned_about_centre(shape, X_CO, x), shape.fine.sides);
      return 0.0F;
    };
    const ImageFit fit =
        fit_image(view, draw, Eigen::VectorXd::Zero(6),
                  {.limit = kFineLimit, .step = steps_of(view, shape, 1), .steps = 0}, raster);
    out.cost = fit.cost;
    out.uncertainty = uncertainty_of(shape, X_CO, fit.information);
  }
  return out;
}

bool is_same(const ShapeModel& shape, const Pose& A, const Pose& B) {
  return surface_distance(shape, A, B) < kSame;
}

std::vector<Start> rough_search(const DepthScene& scene, int cluster, const ShapeModel& shape,
                                Raster& raster) {
  const FitView view = rough_view(scene, cluster, 20);
  std::vector<Eigen::Matrix3d> all;
  for (int i = 0; i < kStarts; ++i) all.push_back(orientation(i, kStarts));
  return starts_of(scene, view, shape, all, far_limit(view), raster);
}

std::vector<Start> coarse_search(const DepthScene& scene, int cluster, const ShapeModel& shape,
                                 std::vector<Start> starts, Raster& raster) {
  const FitView view = rough_view(scene, cluster, 28);
  const float limit = far_limit(view);
  starts = first_refined(scene, view, shape, std::move(starts), 8, limit, raster);
  std::vector<Start> best = distinct(view, shape, std::move(starts), kCoarse);
  std::vector<Eigen::Matrix3d> turns;
  for (std::size_t k = 0; k < std::min<std::size_t>(best.size(), 2); ++k) {
    std::ranges::move(quarter_turns(shape, best[k].X_CO.R), std::back_inserter(turns));
  }
  std::vector<Start> turned = starts_of(scene, view, shape, turns, limit, raster);
  turned = first_refined(scene, view, shape, std::move(turned), kCoarse, limit, raster);
  std::ranges::move(turned, std::back_inserter(best));
  return distinct(view, shape, std::move(best), kCoarse);
}

std::vector<ShapeFit> fine_search(const DepthScene& scene, int cluster, const ShapeModel& shape,
                                  std::vector<Start> starts, Raster& raster) {
  const Cluster& box = scene.clusters[static_cast<std::size_t>(cluster)];
  const FitView middle = rough_view(scene, cluster, 56);
  const float limit = 2 * kFineLimit;
  starts = first_refined(scene, middle, shape, std::move(starts), kCoarse, limit, raster);
  starts = distinct(middle, shape, std::move(starts), 2);
  std::vector<ShapeFit> out;
  for (const Start& start : starts) {
    // What was far behind stays there.
    if (!out.empty() && start.cost > 2 * starts.front().cost) break;
    const FitView fine = view_of(scene, cluster, box_round(scene, shape, start.X_CO, box), 110);
    Start last = start;
    for (const double pixels : {6, 2, 1}) {
      last = refined(scene, fine, shape, shape.fine, last, kFineLimit, pixels, raster);
    }
    last = best_near(scene, fine, shape, last, raster);
    if (!out.empty() && is_same(shape, last.X_CO, out.front().X_CO)) continue;
    out.push_back(check_shape(scene, cluster, shape, last.X_CO, raster));
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const ShapeFit& a, const ShapeFit& b) { return a.cost < b.cost; });
  return out;
}

}  // namespace mjarm::perception
