#include <algorithm>
#include <cmath>
#include <utility>

#include "mjarm/core/linear_algebra.hpp"
#include "mjarm/perception/image_fit_internal.hpp"

namespace mjarm::perception {
namespace {

FitView::Kind kind_of(std::int16_t label, int cluster) {
  if (label == kNothing || label == kSpeck) return FitView::none;
  if (label == kTable) return FitView::table;
  return label == cluster ? FitView::cluster : FitView::other;
}

/// Half a millimetre near 1/z = `inverse` beside the noise.
double sigma_near(const DepthScene& scene, double inverse) {
  constexpr double kModel = 0.0005;  // [m]
  return std::hypot(scene.model.sigma, DepthModel::from_metres(kModel, inverse));
}

}  // namespace

FitView view_of(const DepthScene& scene, int cluster, const Cluster& box, int max_side) {
  const int side = std::max(box.x1 - box.x0, box.y1 - box.y0) + 1;
  const int stride = std::max(1, (side + max_side - 1) / max_side);
  FitView view;
  view.scale = stride;
  view.lens = {.width = (box.x1 - box.x0) / stride + 1,
               .height = (box.y1 - box.y0) / stride + 1,
               .fx = scene.lens.fx / stride,
               .fy = scene.lens.fy / stride,
               .cx = (scene.lens.cx - box.x0) / stride,
               .cy = (scene.lens.cy - box.y0) / stride};
  for (int y = box.y0; y <= box.y1; y += stride) {
    for (int x = box.x0; x <= box.x1; x += stride) {
      const bool inside = x >= 0 && y >= 0 && x < scene.lens.width && y < scene.lens.height;
      const auto at = inside ? static_cast<std::size_t>(y * scene.lens.width + x) : 0;
      const FitView::Kind kind = inside ? kind_of(scene.label[at], cluster) : FitView::outside;
      view.kind.push_back(kind);
      view.inverse.push_back(inside ? scene.inverse[at] : 0);
      view.table_inverse.push_back(scene.table_at(scene.lens.ray({x, y})));
      view.cluster_pixels += kind == FitView::cluster ? 1 : 0;
    }
  }
  view.middle = cluster >= 0 ? scene.clusters[static_cast<std::size_t>(cluster)].middle : 0;
  view.sigma = sigma_near(scene, view.middle);
  return view;
}

void residuals_of(const FitView& view, const std::vector<float>& drawn, float limit,
                  std::vector<float>& out) {
  const std::size_t n = view.kind.size();
  out.resize(n);
  const auto weight = static_cast<float>(1 / view.sigma);
  for (std::size_t i = 0; i < n; ++i) {
    const float table = view.table_inverse[i];
    const float expected = std::max(drawn[i], table);
    const float off = std::clamp((expected - view.inverse[i]) * weight, -limit, limit);
    const bool shown = drawn[i] > table;
    switch (view.kind[i]) {
      case FitView::outside:
      case FitView::none:
        out[i] = 0;
        break;
      case FitView::other:  // what is behind it is hidden, what is before it should have been seen
        out[i] = shown ? std::max(off, 0.0F) : 0;
        break;
      default:
        out[i] = off;
    }
  }
}

double cost_of(const std::vector<float>& residuals) {
  double sum = 0;
  for (const float r : residuals) sum += r * r;
  return sum / 2;
}

namespace {

/// Residuals of a drawing; keeps its memory.
class Trial {
 public:
  Trial(const FitView& view, const DrawWith& draw, float limit, Raster& raster)
      : view_(view), draw_(draw), limit_(limit), raster_(raster) {}
  void residuals(const Eigen::VectorXd& x, std::vector<float>& out) {
    raster_.clear(view_.lens);
    const float rule = draw_(x, raster_);
    residuals_of(view_, raster_.inverse(), limit_, out);
    out.push_back(rule);
  }

 private:
  const FitView& view_;
  const DrawWith& draw_;
  float limit_;
  Raster& raster_;
};

/// Slopes of the residuals by steps to both sides; H = J^T J, g = J^T r.
void normal_equations(Trial& trial, const Eigen::VectorXd& x, const Eigen::VectorXd& step,
                      const std::vector<float>& r, Eigen::MatrixXd& H, Eigen::VectorXd& g) {
  const Eigen::Index n = x.size();
  Eigen::MatrixXf J(static_cast<Eigen::Index>(r.size()), n);
  std::vector<float> more, less;
  for (Eigen::Index k = 0; k < n; ++k) {
    Eigen::VectorXd at = x;
    at[k] = x[k] + step[k];
    trial.residuals(at, more);
    at[k] = x[k] - step[k];
    trial.residuals(at, less);
    const auto whole = static_cast<Eigen::Index>(r.size());
    J.col(k) = (Eigen::Map<const Eigen::VectorXf>(more.data(), whole) -
                Eigen::Map<const Eigen::VectorXf>(less.data(), whole)) /
               static_cast<float>(2 * step[k]);
  }
  const Eigen::Map<const Eigen::VectorXf> residuals(r.data(), static_cast<Eigen::Index>(r.size()));
  H = (J.transpose() * J).cast<double>();
  g = (J.transpose() * residuals).cast<double>();
}

}  // namespace

ImageFit fit_image(const FitView& view, const DrawWith& draw, Eigen::VectorXd x,
                   const FitLevel& level, Raster& raster) {
  constexpr int kTries = 4;
  Trial trial(view, draw, level.limit, raster);
  std::vector<float> r, r_next;
  trial.residuals(x, r);
  ImageFit fit{std::move(x), cost_of(r), {}};
  Eigen::VectorXd g;
  double damping = 1e-3;
  for (int i = 0; i < level.steps; ++i) {
    normal_equations(trial, fit.x, level.step, r, fit.information, g);
    bool better = false;
    for (int k = 0; k < kTries && !better; ++k) {
      Eigen::MatrixXd H = fit.information;
      H.diagonal() *= 1 + damping;
      H.diagonal() += level.step.cwiseAbs2().cwiseInverse();  // a sigma for a step: no blind leaps
      const Eigen::VectorXd next = fit.x - solve_symmetric(H, g);
      trial.residuals(next, r_next);
      const double cost = cost_of(r_next);
      better = cost < fit.cost - 1e-6 * fit.cost;
      damping *= better ? 0.3 : 10;
      if (!better) continue;
      fit.x = next;
      fit.cost = cost;
      std::swap(r, r_next);
    }
    if (!better) break;
  }
  if (level.steps == 0) normal_equations(trial, fit.x, level.step, r, fit.information, g);
  return fit;
}

}  // namespace mjarm::perception
