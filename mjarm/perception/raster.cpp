#include <algorithm>
#include <cmath>
#include <utility>

#include "mjarm/perception/raster_internal.hpp"

namespace mjarm::perception {

void Raster::clear(const render::CameraIntrinsics& lens) {
  lens_ = lens;
  inverse_.assign(static_cast<std::size_t>(lens.width) * static_cast<std::size_t>(lens.height), 0);
}

void Raster::draw(const Surface& surface, const Pose& X_CO) {
  constexpr double kNearest = 1e-3;  // [m]
  corners_.clear();
  for (const Eigen::Vector3d& vertex : surface.vertices) {
    const Eigen::Vector3d p = X_CO * vertex;
    const double q = p.z() > kNearest ? 1 / p.z() : 0;
    corners_.emplace_back(
        Eigen::Vector3d(lens_.fx * p.x() * q + lens_.cx, lens_.fy * p.y() * q + lens_.cy, q)
            .cast<float>());
  }
  for (const auto& [i, j, k] : surface.triangles) {
    const Corner& a = corners_[static_cast<std::size_t>(i)];
    const Corner& b = corners_[static_cast<std::size_t>(j)];
    const Corner& c = corners_[static_cast<std::size_t>(k)];
    if (a.z() > 0 && b.z() > 0 && c.z() > 0) draw_triangle(a, b, c);
  }
}

void Raster::draw_triangle(const Corner& p, const Corner& q, const Corner& r) {
  // From top to bottom: a, b, c.
  const Corner* a = &p;
  const Corner* b = &q;
  const Corner* c = &r;
  if (a->y() > b->y()) std::swap(a, b);
  if (b->y() > c->y()) std::swap(b, c);
  if (a->y() > b->y()) std::swap(a, b);
  const float first_row = std::max(0.0F, std::ceil(a->y()));
  const float last_row = std::min(static_cast<float>(lens_.height - 1), std::floor(c->y()));
  const Corner ab = *b - *a;
  const Corner ac = *c - *a;
  const float area = ab.x() * ac.y() - ac.x() * ab.y();
  if (first_row > last_row || area == 0) return;
  // 1/z is linear in the picture.
  const float across = (ab.z() * ac.y() - ac.z() * ab.y()) / area;
  const float down = (ab.x() * ac.z() - ac.x() * ab.z()) / area;
  const float long_side = ac.x() / ac.y();
  const float upper = ab.y() > 0 ? ab.x() / ab.y() : 0;
  const float lower = c->y() > b->y() ? (c->x() - b->x()) / (c->y() - b->y()) : 0;
  const auto width = static_cast<float>(lens_.width);
  for (float y = first_row; y <= last_row; ++y) {
    const float on_long = a->x() + (y - a->y()) * long_side;
    const float on_short =
        y < b->y() ? a->x() + (y - a->y()) * upper : b->x() + (y - b->y()) * lower;
    const float left = std::max(0.0F, std::ceil(std::min(on_long, on_short)));
    const float right = std::min(width - 1, std::floor(std::max(on_long, on_short)));
    if (left > right) continue;
    const float start = a->z() + across * (left - a->x()) + down * (y - a->y());
    float* pixel = inverse_.data() + static_cast<std::ptrdiff_t>(y) * lens_.width +
                   static_cast<std::ptrdiff_t>(left);
    const int count = static_cast<int>(right - left) + 1;
    for (int i = 0; i < count; ++i) {
      pixel[i] = std::max(pixel[i], start + across * static_cast<float>(i));
    }
  }
}

}  // namespace mjarm::perception
