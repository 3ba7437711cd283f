#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mjarm/core/pose.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/core/stop.hpp"
#include "mjarm/model/robot.hpp"

namespace mjarm::python {

/// What a push of the user does to a body, as MuJoCo's xfrc_applied has it; zeros end it.
struct Push {
  int body = -1;
  Eigen::Vector3d force_W = Eigen::Vector3d::Zero();   ///< [N]
  Eigen::Vector3d torque_W = Eigen::Vector3d::Zero();  ///< [N m]
};

/// `mjarm.Window`: shows what a loop of the caller's simulates. A thread of its own draws, so that
/// a slow picture never slows the loop.
class BoundWindow {
 public:
  /// Waits until it is open.
  [[nodiscard]] static Result<BoundWindow> open(const Robot& robot, const std::string& title,
                                                bool trail, bool real_time);
  ~BoundWindow();
  BoundWindow(BoundWindow&&) noexcept;
  BoundWindow& operator=(BoundWindow&&) noexcept;

  /// False once the user closed it, or close() was called.
  [[nodiscard]] bool is_open() const;
  void close();
  /// From now on a path is drawn as one that is planned.
  void add_path(std::span<const Pose> X_WT);
  /// One step was made. Keeps real time, and waits while the user has it paused.
  /// @param qpos, qvel  (nq,), (nv,)
  /// @param time        [s] of the simulation
  /// @param stop        ends the waiting.
  /// @return what the user does to bodies from now on; nothing where that has not changed.
  std::vector<Push> sync(std::span<const double> qpos, std::span<const double> qvel, double time,
                         const StopCheck& stop);

 private:
  struct Impl;
  explicit BoundWindow(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace mjarm::python
