#include "mjarm/perception/hand_eye.hpp"

#include <Eigen/Core>
#include <cmath>
#include <utility>

#include "mjarm/core/linear_algebra.hpp"
#include "mjarm/core/messages/perception.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/perception/fit_poses_internal.hpp"

namespace mjarm::perception {
namespace {

constexpr double kMostOff = 3;  // [px] root mean square

/// A view that saw the board: X_PC^-1 X_PQ X_QB = X_CB, where Q is what the board is fixed to.
struct Sight {
  Pose X_PQ;
  Pose X_CB;
  const std::vector<BoardCorner>* corners;
};

/// Relative motions of two views: A X = X B with A = X_P1P2 as the carrier saw it, X = X_PC.
struct Motion {
  Pose A;
  Pose B;
};

std::vector<Motion> motions_of(const std::vector<Sight>& sights) {
  std::vector<Motion> out;
  for (std::size_t i = 0; i < sights.size(); ++i) {
    for (std::size_t k = i + 1; k < sights.size(); ++k) {
      // X_PQ X_QB = X_PC X_CB, for both: A = X_PQi X_PQk^-1, B = X_CBi X_CBk^-1.
      out.push_back(
          {sights[i].X_PQ * sights[k].X_PQ.inverse(), sights[i].X_CB * sights[k].X_CB.inverse()});
    }
  }
  return out;
}

/// True where the turns have two axes that differ by more than about 5 degrees.
bool turn_about_two_axes(const std::vector<Motion>& motions) {
  constexpr double kLeastTurn = 0.03;     // [rad]
  constexpr double kLeastShare = 0.0075;  // of the squares: sin(5 deg)^2
  Eigen::Matrix3d M = Eigen::Matrix3d::Zero();
  for (const Motion& motion : motions) {
    const Eigen::Vector3d turn = rotation_log(motion.A.R);
    if (turn.norm() > kLeastTurn) M += turn * turn.transpose();
  }
  const Eigen::VectorXd values = symmetric_eigen(M).values;
  return values[2] > 0 && values[1] > kLeastShare * values[2];
}

/// Park and Martin's closed form.
Pose closed_form(const std::vector<Motion>& motions) {
  Eigen::Matrix3d M = Eigen::Matrix3d::Zero();
  for (const Motion& motion : motions) {
    M += rotation_log(motion.B.R) * rotation_log(motion.A.R).transpose();
  }
  // (M^T M)^(-1/2) M^T is the orthogonal factor of M^T.
  const SingularValues svd = singular_values(M.transpose());
  Eigen::Matrix3d U = svd.U;
  if ((U * svd.V.transpose()).determinant() < 0) U.col(2) = -U.col(2);
  Pose X{.R = U * svd.V.transpose()};
  Eigen::MatrixXd C(static_cast<Eigen::Index>(3 * motions.size()), 3);
  Eigen::VectorXd d(C.rows());
  for (std::size_t i = 0; i < motions.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(3 * i);
    C.middleRows<3>(row) = motions[i].A.R - Eigen::Matrix3d::Identity();
    d.segment<3>(row) = X.R * motions[i].B.p - motions[i].A.p;
  }
  X.p = least_squares(C, d);
  return X;
}

/// Distances of all corners in all pictures, for X_PC and X_QB.
Eigen::VectorXd corner_residuals(const std::vector<Sight>& sights,
                                 const render::CameraIntrinsics& lens, std::span<const Pose> at) {
  std::vector<double> r;
  const Pose X_CP = at[0].inverse();
  for (const Sight& sight : sights) {
    const Pose X_CB = X_CP * sight.X_PQ * at[1];
    for (const BoardCorner& corner : *sight.corners) {
      const Eigen::Vector2d off = lens.project(X_CB * corner.p_B) - corner.pixel;
      r.insert(r.end(), {off.x(), off.y()});
    }
  }
  return Eigen::Map<Eigen::VectorXd>(r.data(), static_cast<Eigen::Index>(r.size()));
}

}  // namespace

std::string describe(HandEyeErrc code) {
  switch (code) {
    case HandEyeErrc::too_few_views:
      return text(msg::perception_views_too_few);
    case HandEyeErrc::board_not_seen:
      return text(msg::perception_views_no_board);
    case HandEyeErrc::one_axis:
      return text(msg::perception_views_one_axis);
    case HandEyeErrc::contradiction:
      return text(msg::perception_views_contradict);
  }
  return {};
}

Result<HandEye, HandEyeErrc> calibrate_hand_eye(std::span<const HandEyeView> views,
                                                CameraMount mount,
                                                const render::CameraIntrinsics& lens) {
  constexpr std::size_t kFewest = 3;
  if (views.size() < kFewest) return fail(HandEyeErrc::too_few_views);
  std::vector<Sight> sights;
  for (const HandEyeView& view : views) {
    const Result<BoardPose, FindErrc> board = board_pose(view.corners, lens);
    if (!board) continue;
    const Pose X_PQ = mount == CameraMount::wrist ? view.X_WT.inverse() : view.X_WT;
    sights.push_back({X_PQ, board->X_CB, &view.corners});
  }
  if (sights.size() < kFewest) return fail(HandEyeErrc::board_not_seen);
  const std::vector<Motion> motions = motions_of(sights);
  if (!turn_about_two_axes(motions)) return fail(HandEyeErrc::one_axis);
  const Pose X_PC = closed_form(motions);
  const Pose X_QB = sights[0].X_PQ.inverse() * X_PC * sights[0].X_CB;
  const PoseFit fit = fit_poses(
      {X_PC, X_QB}, [&](std::span<const Pose> at) { return corner_residuals(sights, lens, at); });
  std::size_t corners = 0;
  for (const Sight& sight : sights) corners += sight.corners->size();
  const HandEye out{.X_PC = fit.poses[0],
                    .X_QB = fit.poses[1],
                    .views = static_cast<int>(sights.size()),
                    .residual = std::sqrt(fit.squares / static_cast<double>(corners))};
  if (!(out.residual < kMostOff)) return fail(HandEyeErrc::contradiction);
  return out;
}

}  // namespace mjarm::perception
