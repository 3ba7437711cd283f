#include <Eigen/LU>
#include <array>
#include <cmath>
#include <utility>

#include "mjarm/perception/depth_scene_internal.hpp"

namespace mjarm::perception {
namespace {

constexpr int kFewestOfCluster = 60;  // [px]
constexpr double kAbove = 0.003;      // [m] and four sigma in front of the table: something on it

struct RayDepth {
  Eigen::Vector3d ray;
  double inverse;
};

/// Every 16th pixel of every 16th row.
std::vector<RayDepth> sparse(const DepthScene& scene) {
  constexpr int kStride = 16;
  std::vector<RayDepth> out;
  for (int y = kStride / 2; y < scene.lens.height; y += kStride) {
    for (int x = kStride / 2; x < scene.lens.width; x += kStride) {
      const float q = scene.inverse[static_cast<std::size_t>(y * scene.lens.width + x)];
      if (q > 0) out.push_back({scene.lens.ray({x, y}), q});
    }
  }
  return out;
}

bool is_near(const RayDepth& at, const Eigen::Vector3d& a, double sigma) {
  constexpr double kFlat = 0.002;  // [m] that a table may be uneven
  const double gate = 3 * sigma + DepthModel::from_metres(kFlat, at.inverse);
  return std::abs(a.dot(at.ray) - at.inverse) < gate;
}

/// True for planes that are level to within 15 degrees, with the camera above.
bool is_level(const Eigen::Vector3d& a, const Pose& X_WC) {
  constexpr double kCos = 0.966;
  return (X_WC.R * -a).normalized().z() > kCos;
}

/// The level plane that holds most of the points, by least squares in 1/z.
std::optional<Eigen::Vector3d> level_plane(const DepthScene& scene, Rng& rng) {
  constexpr int kTries = 150;
  constexpr double kLeastShare = 0.1;
  const std::vector<RayDepth> points = sparse(scene);
  if (points.size() < 10) return {};
  std::optional<Eigen::Vector3d> best;
  std::ptrdiff_t most =
      static_cast<std::ptrdiff_t>(kLeastShare * static_cast<double>(points.size()));
  for (int i = 0; i < kTries; ++i) {
    Eigen::Matrix3d rays;
    Eigen::Vector3d inverses;
    for (int k = 0; k < 3; ++k) {
      const RayDepth& point = points[rng.below(points.size())];
      rays.row(k) = point.ray.transpose();
      inverses[k] = point.inverse;
    }
    if (std::abs(rays.determinant()) < 1e-4) continue;
    const Eigen::Vector3d a = rays.inverse() * inverses;
    if (!is_level(a, scene.X_WC)) continue;
    const auto count = std::count_if(points.begin(), points.end(), [&](const RayDepth& point) {
      return is_near(point, a, scene.model.sigma);
    });
    if (count > most) {
      most = count;
      best = a;
    }
  }
  for (int round = 0; best && round < 4; ++round) {
    Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    for (const RayDepth& point : points) {
      if (!is_near(point, *best, scene.model.sigma)) continue;
      A += point.ray * point.ray.transpose();
      b += point.inverse * point.ray;
    }
    best = A.inverse() * b;
  }
  return best;
}

Plane in_world(const Eigen::Vector3d& a, const Pose& X_WC) {
  const Eigen::Vector3d n_W = X_WC.R * -a.normalized();
  return {.normal_W = n_W, .offset = n_W.dot(X_WC.p) - 1 / a.norm()};
}

/// Zero where the camera is not above the plane.
Eigen::Vector3d in_camera(const Plane& plane, const Pose& X_WC) {
  const double above = plane.height(X_WC.p);
  if (!(above > 0)) return Eigen::Vector3d::Zero();
  return -(X_WC.R.transpose() * plane.normal_W) / above;
}

/// Table, beyond, nothing, or (kOnTable) above the table.
constexpr std::int16_t kOnTable = 0;

void label_pixels(DepthScene& scene) {
  std::size_t i = 0;
  for (int y = 0; y < scene.lens.height; ++y) {
    for (int x = 0; x < scene.lens.width; ++x, ++i) {
      const double q = scene.inverse[i];
      const double t = scene.table_at(scene.lens.ray({x, y}));
      const double band = 4 * scene.model.sigma + DepthModel::from_metres(kAbove, q);
      const std::int16_t beside = q < t - band ? std::int16_t{kBeyond} : std::int16_t{kTable};
      const std::int16_t placed = q > t + band ? kOnTable : beside;
      scene.label[i] = q > 0 ? placed : std::int16_t{kNothing};
    }
  }
}

/// Another hue, however bright both are lit; dark pixels have none.
bool hue_changes(const render::Image& color, std::size_t a, std::size_t b) {
  constexpr int kDark = 60;        // of 765
  constexpr double kChange = 0.1;  // of the shares of red and green in all
  const auto* A = &color.rgb[3 * a];
  const auto* B = &color.rgb[3 * b];
  const int sum_a = A[0] + A[1] + A[2];
  const int sum_b = B[0] + B[1] + B[2];
  if (sum_a < kDark || sum_b < kDark) return false;
  const auto change = [&](int k) {
    return std::abs(static_cast<double>(A[k]) / sum_a - static_cast<double>(B[k]) / sum_b);
  };
  return change(0) + change(1) > kChange;
}

/// Gives each connected piece of what is above the table its number: neighbours belong together
/// unless depth jumps or hue changes.
class Gatherer {
 public:
  Gatherer(DepthScene& scene, double jump, const render::Image* color)
      : scene_(scene), jump_(jump), color_(color), todo_(scene.label.size(), 0) {
    for (std::size_t i = 0; i < todo_.size(); ++i) {
      todo_[i] = scene.label[i] >= 0 || scene.label[i] == kSpeck ? 1 : 0;
    }
  }

  void run() {
    for (std::size_t i = 0; i < todo_.size(); ++i) {
      if (todo_[i] != 0) gather(static_cast<int>(i));
    }
  }

 private:
  void gather(int first) {
    constexpr std::size_t kMostClusters = 1000;
    const int width = scene_.lens.width;
    piece_.assign(1, first);
    todo_[static_cast<std::size_t>(first)] = 0;
    for (std::size_t done = 0; done < piece_.size(); ++done) {
      const int at = piece_[done];
      const int x = at % width;
      if (x > 0) visit(at, at - 1);
      if (x + 1 < width) visit(at, at + 1);
      if (at >= width) visit(at, at - width);
      if (at + width < static_cast<int>(todo_.size())) visit(at, at + width);
    }
    const bool counts = static_cast<int>(piece_.size()) >= kFewestOfCluster &&
                        scene_.clusters.size() < kMostClusters;
    const auto label =
        static_cast<std::int16_t>(counts ? static_cast<int>(scene_.clusters.size()) : int{kSpeck});
    Cluster cluster{static_cast<int>(piece_.size()), 0, width, scene_.lens.height, 0, 0};
    for (const int at : piece_) {
      scene_.label[static_cast<std::size_t>(at)] = label;
      cluster.middle += scene_.inverse[static_cast<std::size_t>(at)];
      cluster.x0 = std::min(cluster.x0, at % width);
      cluster.x1 = std::max(cluster.x1, at % width);
      cluster.y0 = std::min(cluster.y0, at / width);
      cluster.y1 = std::max(cluster.y1, at / width);
    }
    cluster.middle /= cluster.pixels;
    if (counts) scene_.clusters.push_back(cluster);
  }

  void visit(int from, int to) {
    const auto i = static_cast<std::size_t>(to);
    if (todo_[i] == 0) return;
    const double q = scene_.inverse[static_cast<std::size_t>(from)];
    const double most = 6 * scene_.model.sigma + DepthModel::from_metres(jump_, q);
    if (std::abs(scene_.inverse[i] - q) > most) return;
    if (color_ != nullptr && hue_changes(*color_, static_cast<std::size_t>(from), i)) return;
    todo_[i] = 0;
    piece_.push_back(to);
  }

  DepthScene& scene_;
  double jump_;  ///< [m] and six sigma
  const render::Image* color_;
  std::vector<char> todo_;
  std::vector<int> piece_;
};

}  // namespace

DepthScene depth_scene(const render::RgbdFrame& frame, const DepthModel& model,
                       const std::optional<Plane>& table, Rng& rng) {
  DepthScene scene{.lens = frame.intrinsics,
                   .X_WC = frame.X_WC,
                   .model = model,
                   .inverse = std::vector<float>(frame.depth.size()),
                   .label = std::vector<std::int16_t>(frame.depth.size(), kNothing),
                   .table = table,
                   .clusters = {}};
  std::transform(frame.depth.begin(), frame.depth.end(), scene.inverse.begin(), inverse_depth);
  if (table) {
    scene.table_a = in_camera(*table, frame.X_WC);
  } else if (const std::optional<Eigen::Vector3d> a = level_plane(scene, rng)) {
    scene.table_a = *a;
    scene.table = in_world(*a, frame.X_WC);
  }
  label_pixels(scene);
  gather(scene, kSmoothJump);
  return scene;
}

void leave_out(DepthScene& scene, const std::vector<float>& known) {
  std::size_t i = 0;
  for (int y = 0; y < scene.lens.height; ++y) {
    for (int x = 0; x < scene.lens.width; ++x, ++i) {
      const double q = known[i];
      const double band = 4 * scene.model.sigma + DepthModel::from_metres(kAbove, q);
      const bool stands = q > scene.table_at(scene.lens.ray({x, y})) + band;
      if (stands && std::abs(scene.inverse[i] - q) <= band) scene.label[i] = kBeyond;
    }
  }
  gather(scene, kSmoothJump);
}

void take_out(DepthScene& scene, const std::vector<float>& drawn) {
  constexpr int kRim = 2;         // [px]
  constexpr double kOff = 0.006;  // [m] and six sigma
  const int width = scene.lens.width;
  const int height = scene.lens.height;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const auto at = static_cast<std::size_t>(y * width + x);
      const double q = drawn[at];
      const double gate = 6 * scene.model.sigma + DepthModel::from_metres(kOff, q);
      if (q <= 0 || scene.label[at] < 0 || std::abs(scene.inverse[at] - q) > gate) continue;
      for (int v = std::max(0, y - kRim); v <= std::min(height - 1, y + kRim); ++v) {
        for (int u = std::max(0, x - kRim); u <= std::min(width - 1, x + kRim); ++u) {
          const auto near = static_cast<std::size_t>(v * width + u);
          const bool beside = scene.label[near] >= 0 && drawn[near] <= 0;
          if (beside && std::abs(scene.inverse[near] - q) < 2 * gate) scene.label[near] = kBeyond;
        }
      }
    }
  }
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    const double q = drawn[i];
    const double gate = 6 * scene.model.sigma + DepthModel::from_metres(kOff, q);
    if (scene.label[i] < 0) continue;
    if (q > 0 && std::abs(scene.inverse[i] - q) <= gate) scene.label[i] = kBeyond;
  }
}

void gather(DepthScene& scene, double jump, const render::Image* color) {
  scene.clusters.clear();
  Gatherer(scene, jump, color).run();
}

}  // namespace mjarm::perception
