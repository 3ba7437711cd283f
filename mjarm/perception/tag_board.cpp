#include "mjarm/perception/tag_board.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "mjarm/core/linear_algebra.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/perception/fit_poses_internal.hpp"
#include "mjarm/perception/tag_pose.hpp"

namespace mjarm::perception {
namespace {

/// The rotation nearest to a matrix.
Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& M) {
  const SingularValues svd = singular_values(M);
  Eigen::Matrix3d U = svd.U;
  if ((U * svd.V.transpose()).determinant() < 0) U.col(2) = -U.col(2);
  return U * svd.V.transpose();
}

/// A pose of the board from the four corners of its first tag, by the homography between them.
Pose pose_of_first(std::span<const BoardCorner> corners, const render::CameraIntrinsics& lens) {
  // The tag's own frame on the board.
  const Eigen::Vector3d& origin = corners[0].p_B;
  const Eigen::Vector3d x = (corners[1].p_B - origin).normalized();
  const Eigen::Vector3d along = corners[3].p_B - origin;
  const Eigen::Vector3d y = (along - along.dot(x) * x).normalized();
  Pose X_BT{.p = origin};
  X_BT.R << x, y, x.cross(y);
  Eigen::MatrixXd A(8, 8);
  Eigen::VectorXd b(8);
  for (Eigen::Index i = 0; i < 4; ++i) {
    const Eigen::Vector3d p_T = X_BT.inverse() * corners[static_cast<std::size_t>(i)].p_B;
    const Eigen::Vector3d ray = lens.ray(corners[static_cast<std::size_t>(i)].pixel);
    A.row(2 * i) << p_T.x(), p_T.y(), 1, 0, 0, 0, -ray.x() * p_T.x(), -ray.x() * p_T.y();
    A.row(2 * i + 1) << 0, 0, 0, p_T.x(), p_T.y(), 1, -ray.y() * p_T.x(), -ray.y() * p_T.y();
    b.segment<2>(2 * i) = ray.head<2>();
  }
  const Eigen::VectorXd h = least_squares(A, b);
  Eigen::Matrix3d H;
  H << h[0], h[1], h[2], h[3], h[4], h[5], h[6], h[7], 1;
  const double scale = (H.col(0).norm() + H.col(1).norm()) / 2;
  H /= scale;
  Eigen::Matrix3d R;
  R << H.col(0), H.col(1), H.col(0).cross(H.col(1));
  const Pose X_CT{.p = H.col(2), .R = nearest_rotation(R)};
  return X_CT * X_BT.inverse();
}

/// The pose that a small flat board has when it is tilted the other way: its normal mirrored at the
/// line of sight (G. Schweighofer and A. Pinz, 2006).
Pose flipped(const Pose& X_CB, const Eigen::Vector3d& middle_B, const Eigen::Vector3d& normal_B) {
  const Eigen::Vector3d middle_C = X_CB * middle_B;
  const Eigen::Vector3d sight = middle_C.normalized();
  const Eigen::Vector3d normal_C = X_CB.R * normal_B;
  const Eigen::Vector3d other = 2 * normal_C.dot(sight) * sight - normal_C;
  const Eigen::Matrix3d R = rotation_between(normal_C, other) * X_CB.R;
  return {.p = middle_C - R * middle_B, .R = R};
}

}  // namespace

std::vector<BoardCorner> board_corners(std::span<const BoardTag> board,
                                       std::span<const SeenTag> seen) {
  std::vector<BoardCorner> out;
  for (const BoardTag& tag : board) {
    const auto is_it = [&](const SeenTag& other) { return other.id == tag.id; };
    if (std::count_if(seen.begin(), seen.end(), is_it) != 1) continue;
    const SeenTag& at = *std::find_if(seen.begin(), seen.end(), is_it);
    const std::array<Eigen::Vector3d, 4> p_T = tag_corners(tag.size);
    for (std::size_t i = 0; i < 4; ++i) out.push_back({tag.X_BT * p_T[i], at.corners[i]});
  }
  return out;
}

Result<BoardPose, FindErrc> board_pose(std::span<const BoardCorner> corners,
                                       const render::CameraIntrinsics& lens) {
  constexpr double kClearly = 2;  // times the squares of the other pose
  if (corners.size() < 4) return fail(FindErrc::not_seen);
  const auto residuals = [&](std::span<const Pose> at) {
    Eigen::VectorXd r(static_cast<Eigen::Index>(2 * corners.size()));
    for (std::size_t i = 0; i < corners.size(); ++i) {
      r.segment<2>(static_cast<Eigen::Index>(2 * i)) =
          lens.project(at[0] * corners[i].p_B) - corners[i].pixel;
    }
    return r;
  };
  const Eigen::Vector3d normal_B =
      (corners[1].p_B - corners[0].p_B).cross(corners[3].p_B - corners[0].p_B).normalized();
  const PoseFit first = fit_poses({pose_of_first(corners, lens)}, residuals);
  const PoseFit second = fit_poses({flipped(first.poses[0], corners[0].p_B, normal_B)}, residuals);
  const PoseFit& best = first.squares <= second.squares ? first : second;
  const PoseFit& other = first.squares <= second.squares ? second : first;
  constexpr double kSame = 0.01;   // [rad]
  constexpr double kNoise = 0.01;  // [px^2] a corner: what a detector may be off
  const bool differ = angle_between(best.poses[0].R, other.poses[0].R) > kSame;
  const double noise = kNoise * static_cast<double>(corners.size());
  if (differ && other.squares + noise < kClearly * (best.squares + noise)) {
    return fail(FindErrc::ambiguous);
  }
  return BoardPose{.X_CB = best.poses[0],
                   .residual = std::sqrt(best.squares / static_cast<double>(corners.size()))};
}

}  // namespace mjarm::perception
