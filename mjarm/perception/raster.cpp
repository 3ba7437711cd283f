#include <algorithm>
#include <utility>

#include "mjarm/perception/raster_internal.hpp"

namespace mjarm::perception {
namespace {

/// The whole numbers next to x, of 0 to size - 1 or next to these; std::ceil is a call where the
/// baseline of the processor is all there is.
int ceil_within(float x, int size) {
  const float inside = std::clamp(x, 0.0F, static_cast<float>(size));
  const int whole = static_cast<int>(inside);
  return static_cast<float>(whole) < inside ? whole + 1 : whole;
}
int floor_within(float x, int size) {
  return x < 0 ? -1 : static_cast<int>(std::min(x, static_cast<float>(size - 1)));
}

}  // namespace

void Raster::clear(const render::CameraIntrinsics& lens) {
  lens_ = lens;
  inverse_.assign(static_cast<std::size_t>(lens.width) * static_cast<std::size_t>(lens.height), 0);
}

void Raster::draw(const Surface& surface, const Pose& X_CO, Sides sides) {
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
    if (a.z() > 0 && b.z() > 0 && c.z() > 0) draw_triangle(a, b, c, sides);
  }
}

void Raster::draw_triangle(const Corner& p, const Corner& q, const Corner& r, Sides sides) {
  const float turn = (q.x() - p.x()) * (r.y() - p.y()) - (r.x() - p.x()) * (q.y() - p.y());
  if (turn == 0 || (sides == Sides::front && turn > 0)) return;  // y is down
  // From top to bottom: a, b, c.
  const Corner* a = &p;
  const Corner* b = &q;
  const Corner* c = &r;
  if (a->y() > b->y()) std::swap(a, b);
  if (b->y() > c->y()) std::swap(b, c);
  if (a->y() > b->y()) std::swap(a, b);
  const int first_row = ceil_within(a->y(), lens_.height);
  const int end_row = floor_within(c->y(), lens_.height) + 1;
  const Corner ab = *b - *a;
  const Corner ac = *c - *a;
  const float area = ab.x() * ac.y() - ac.x() * ab.y();
  if (first_row >= end_row || area == 0) return;
  // 1/z is linear in the picture.
  const float across = (ab.z() * ac.y() - ac.z() * ab.y()) / area;
  const float down = (ab.x() * ac.z() - ac.x() * ab.z()) / area;
  const float long_side = ac.x() / ac.y();
  const float upper = ab.y() > 0 ? ab.x() / ab.y() : 0;
  const float lower = c->y() > b->y() ? (c->x() - b->x()) / (c->y() - b->y()) : 0;
  for (int row = first_row; row < end_row; ++row) {
    const auto y = static_cast<float>(row);
    const float on_long = a->x() + (y - a->y()) * long_side;
    const float on_short =
        y < b->y() ? a->x() + (y - a->y()) * upper : b->x() + (y - b->y()) * lower;
    const int left = ceil_within(std::min(on_long, on_short), lens_.width);
    const int count = floor_within(std::max(on_long, on_short), lens_.width) + 1 - left;
    const float start = a->z() + across * (static_cast<float>(left) - a->x()) + down * (y - a->y());
    float* pixel = inverse_.data() + static_cast<std::ptrdiff_t>(row) * lens_.width + left;
    for (int i = 0; i < count; ++i) {
      pixel[i] = std::max(pixel[i], start + across * static_cast<float>(i));
    }
  }
}

}  // namespace mjarm::perception
