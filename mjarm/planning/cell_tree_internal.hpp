#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "mjarm/collision/link_balls.hpp"
#include "mjarm/planning/ball_reach_internal.hpp"

namespace mjarm::detail {

/// Where the centre of a ball may be: a cube of the world that is cut into eight again and again,
/// where that is asked for.
class CellTree {
 public:
  enum class Kind : std::uint8_t {
    blocked,  ///< a ball whose centre is anywhere in it, its faces included, hits something
    open,     ///< nothing was found that a ball in it could hit
    mixed,    ///< neither, as far as is known
  };

  /// @param scene  must live as long.
  /// @param ball   of the scene, by index.
  CellTree(const BallScene& scene, std::size_t ball, BallReach reach);

  [[nodiscard]] std::size_t size() const { return cells_.size(); }
  [[nodiscard]] Kind kind(int cell) const { return at(cell).kind; }
  /// [m] of a cell.
  [[nodiscard]] double width(int cell) const { return width_at(at(cell).level); }
  /// Cuts a mixed cell that is not cut yet. @return false where it is as small as cells get.
  bool cut(int cell);
  /// The cell, not cut, round a place.
  [[nodiscard]] int find(const Eigen::Vector3d& p_W) const;

  /// Calls `look(other)` for all cells, not cut and not blocked, that share some of a face with
  /// this one.
  template <class Look>
  void each_beside(int cell, const Look& look) {
    for (int face = 0; face < 6; ++face) {
      const int other = across(cell, face);
      work_ += kVisitWork;
      if (other >= 0) each_part({cell, face ^ 1, other}, look);
    }
  }

  /// What was looked at so far: boxes of pieces, and what takes as long as several of them.
  [[nodiscard]] std::int64_t work() const { return work_; }

 private:
  static constexpr int kPieceWork = 16, kVisitWork = 8;
  struct Cell {
    std::array<int, 3> place;  ///< in widths of its level, from the low corner of the cube
    int level = 0;
    int children = -1;               ///< the first of eight; -1: it is not cut
    std::size_t first = 0, end = 0;  ///< pieces near a mixed one, in near_
    Kind kind = Kind::mixed;
  };
  /// A cell, and a cell at one of its faces.
  struct Beside {
    int from = 0, face = 0, cell = 0;
  };

  [[nodiscard]] const Cell& at(int cell) const { return cells_[static_cast<std::size_t>(cell)]; }
  [[nodiscard]] double width_at(int level) const { return std::ldexp(2 * half_, -level); }
  [[nodiscard]] int across(int cell, int face) const;
  [[nodiscard]] bool shares_face(int part, const Beside& beside) const;
  [[nodiscard]] bool is_beyond_reach(const Eigen::Vector3d& middle, double wide) const;
  void classify(Cell& cell, std::size_t first, std::size_t end);

  template <class Look>
  void each_part(const Beside& beside, const Look& look) {
    if (kind(beside.cell) == Kind::blocked) return;
    const int children = at(beside.cell).children;
    if (children < 0) return look(beside.cell);
    for (int k = 0; k < 8; ++k) {
      if (((k >> (beside.face / 2)) & 1) != beside.face % 2) continue;
      work_ += kVisitWork;
      if (shares_face(children + k, beside)) {
        each_part({beside.from, beside.face, children + k}, look);
      }
    }
  }

  const BallScene& scene_;
  BallReach reach_;
  double radius_;  // [m] of the ball, less what rounding may do
  double half_;    // [m] of the cube
  int finest_ = 0;
  std::vector<Cell> cells_;
  std::vector<int> near_;
  std::int64_t work_ = 0;
};

}  // namespace mjarm::detail
