#pragma once

#include <memory>
#include <string_view>

#include "mjarm/core/pose.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/core/stop.hpp"
#include "mjarm/model/robot.hpp"

namespace mjarm {

/// How far a part moved between the fingers that hold it.
struct Creep {
  double moved = 0;    ///< [m] its origin in the tool's frame, the farthest at any time
  double turned = 0;   ///< [rad] likewise
  double fastest = 0;  ///< [m/s] speed of the part in the world, the highest
};

/// A trial of what holds and how well: a part between the fingers of a robot in a simulation of its
/// own, in which nothing but contact keeps it there. The arm follows by computed torque, which does
/// not know the part.
class HeldPart {
 public:
  /// From the robot's home, where the fingers are open: closes the gripper on the part, which is
  /// kept at its place in the tool's frame meanwhile, then lets go of it and waits for a second.
  /// @param part  name of a body that can be carried (scene_bodies()).
  /// @param X_TB  its place there.
  /// @param stop  ends this and what is asked later.
  /// @return bad_input where there is no such body or no gripper, where the part touches something
  ///         before the fingers close; fails as Controller::create() does, and where the simulation
  ///         breaks down or is stopped.
  [[nodiscard]] static Result<HeldPart> grip(const Robot& robot, std::string_view part,
                                             const Pose& X_TB = {}, StopCheck stop = {});
  ~HeldPart();
  HeldPart(HeldPart&&) noexcept;
  HeldPart& operator=(HeldPart&&) noexcept;

  /// X_TB now; about what grip() was given as long as it is held.
  [[nodiscard]] Pose in_tool() const;
  /// The arm stands still.
  /// @param seconds  [s] > 0 of simulated time.
  /// @return an error where the simulation breaks down or is stopped.
  [[nodiscard]] Result<Creep> rest(double seconds);
  /// The arm carries it to and fro along the world's y, 0.15 m to either side and as fast as 0.5
  /// m/s in the middle; from rest, as fast as that after a second.
  /// @param seconds  [s] > 0 of simulated time.
  /// @return like rest(), and where the arm cannot reach along this way.
  [[nodiscard]] Result<Creep> carry(double seconds);

 private:
  struct Impl;
  explicit HeldPart(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace mjarm
