#include <algorithm>
#include <utility>

#include "mjarm/planning/cell_tree_internal.hpp"

namespace mjarm::detail {
namespace {

constexpr double kSlack = 1e-6;   // [m] more than the rounding of all that is computed here
constexpr double kFinest = 0.03;  // of the radius: width of the smallest cells
constexpr double kTooWide = 2;    // of the radius: half the diagonal of cells that nothing blocks
constexpr int kMaxLevel = 20;

}  // namespace

CellTree::CellTree(const BallScene& scene, std::size_t ball, BallReach reach)
    : scene_(scene),
      reach_(std::move(reach)),
      radius_(scene.balls[ball].radius - kSlack),
      half_(reach_.radius + 2 * kSlack) {
  std::vector<bool> ignored;
  for (const IgnoredPair& pair : scene.ignored) {
    if (pair.link != scene.balls[ball].link) continue;
    const auto obstacle = static_cast<std::size_t>(pair.obstacle);
    if (ignored.size() <= obstacle) ignored.resize(obstacle + 1);
    ignored[obstacle] = true;
  }
  for (std::size_t k = 0; k < scene.pieces.size(); ++k) {
    const auto obstacle = static_cast<std::size_t>(scene.pieces[k].obstacle);
    if (obstacle >= ignored.size() || !ignored[obstacle]) near_.push_back(static_cast<int>(k));
  }
  cells_.push_back({.place = {0, 0, 0}, .end = near_.size()});
  while (finest_ < kMaxLevel && width_at(finest_) > kFinest * radius_) ++finest_;
}

bool CellTree::is_beyond_reach(const Eigen::Vector3d& middle, double wide) const {
  const double off = wide * std::numbers::sqrt3 / 2;
  if ((middle - reach_.middle).norm() > reach_.radius + kSlack + off) return true;
  return std::ranges::any_of(reach_.sides, [&](const BallReach::Side& side) {
    const double nearest = side.normal.dot(middle) - side.normal.cwiseAbs().sum() * wide / 2;
    return nearest > side.offset + kSlack;
  });
}

/// A ball whose centre is in the cell is no farther from one in its middle than half its diagonal.
/// @param first, end  the pieces near the cell that it is a part of, in near_.
void CellTree::classify(Cell& cell, std::size_t first, std::size_t end) {
  const double wide = width_at(cell.level), off = wide * std::numbers::sqrt3 / 2 * (1 + 1e-9);
  Eigen::Vector3d middle = reach_.middle - Eigen::Vector3d::Constant(half_);
  for (int k = 0; k < 3; ++k) middle[k] += wide * (cell.place[static_cast<std::size_t>(k)] + 0.5);
  cell.kind = Kind::blocked;
  if (is_beyond_reach(middle, wide)) return;
  const double enough = radius_ + off;
  cell.first = near_.size();
  work_ += static_cast<std::int64_t>(end - first);
  double nearest = enough;  // comes first: it blocks the most parts
  for (std::size_t k = first; k < end; ++k) {
    const StandingPiece& piece = scene_.pieces[static_cast<std::size_t>(near_[k])];
    const Eigen::Vector3d outside =
        (piece.low - middle).cwiseMax(middle - piece.high).cwiseMax(Eigen::Vector3d::Zero());
    if (outside.squaredNorm() > enough * enough) continue;
    if (off > kTooWide * radius_) {  // what is exactly near will show in its parts
      near_.push_back(near_[k]);
      continue;
    }
    work_ += kPieceWork;
    const double distance = piece.distance(middle, enough);
    if (distance <= radius_ - off) {
      near_.resize(cell.first);
      return;
    }
    if (distance > enough) continue;
    near_.push_back(near_[k]);
    if (distance < nearest) std::swap(near_[cell.first], near_.back());
    nearest = std::min(nearest, distance);
  }
  cell.end = near_.size();
  cell.kind = cell.end > cell.first ? Kind::mixed : Kind::open;
}

bool CellTree::cut(int cell) {
  const auto index = static_cast<std::size_t>(cell);
  if (cells_[index].level >= finest_) return false;
  cells_[index].children = static_cast<int>(cells_.size());
  for (int k = 0; k < 8; ++k) {
    const Cell& whole = cells_[index];
    Cell part{.place = {}, .level = whole.level + 1};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      part.place[axis] = 2 * whole.place[axis] + ((k >> axis) & 1);
    }
    classify(part, whole.first, whole.end);
    cells_.push_back(part);
  }
  return true;
}

int CellTree::find(const Eigen::Vector3d& p_W) const {
  int cell = 0;
  Eigen::Vector3d low = reach_.middle - Eigen::Vector3d::Constant(half_);
  while (at(cell).children >= 0) {
    const double half = width_at(at(cell).level + 1);
    int part = 0;
    for (int axis = 0; axis < 3; ++axis) {
      if (p_W[axis] < low[axis] + half) continue;
      part |= 1 << axis;
      low[axis] += half;
    }
    cell = at(cell).children + part;
  }
  return cell;
}

/// The cell across a face of a cell, no smaller than that; -1: the end of the cube.
int CellTree::across(int cell, int face) const {
  const Cell& from = at(cell);
  std::array<int, 3> place = from.place;
  const auto axis = static_cast<std::size_t>(face / 2);
  place[axis] += face % 2 == 0 ? -1 : 1;
  if (place[axis] < 0 || place[axis] >= (1 << from.level)) return -1;
  int out = 0;
  for (int down = from.level - 1; down >= 0 && at(out).children >= 0; --down) {
    int part = 0;
    for (std::size_t k = 0; k < 3; ++k) part |= ((place[k] >> down) & 1) << k;
    out = at(out).children + part;
  }
  return out;
}

/// Whether one of two cells at a face of the other covers it there.
bool CellTree::shares_face(int part, const Beside& beside) const {
  const Cell &a = at(part), &b = at(beside.from);
  const int level = std::min(a.level, b.level);
  for (int axis = 0; axis < 3; ++axis) {
    if (axis == beside.face / 2) continue;
    const auto k = static_cast<std::size_t>(axis);
    if (a.place[k] >> (a.level - level) != b.place[k] >> (b.level - level)) return false;
  }
  return true;
}

}  // namespace mjarm::detail
