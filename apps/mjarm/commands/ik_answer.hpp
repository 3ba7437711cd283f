#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "mjarm/core/joint_vec.hpp"
#include "mjarm/core/json_writer.hpp"
#include "mjarm/core/pose.hpp"
#include "mjarm/kinematics/branch.hpp"
#include "mjarm/kinematics/ik.hpp"
#include "mjarm/kinematics/self_motion.hpp"
#include "mjarm/model/robot.hpp"

namespace mjarm::app {

/// What stays the same for all requests of `mjarm ik`.
struct IkJob {
  IkOptions ik = {};
  bool contact = false;               ///< answers that touch something are none
  std::optional<PostureGoal> prefer;  ///< where to go with joints to spare
  Branch branch = {};                 ///< what answers must be
  bool all = false, windings = false;
  bool timing = true;
  /// One request by itself: its answer tells its branch, and where neither a seed nor `prefer` says
  /// more the best posture is taken. Else the answer nearest to the seed, or to home.
  bool single = false;
};

struct IkRequest {
  Pose X_WT;
  std::vector<double> q_seed;  ///< home where none was given
  bool has_seed = false;
};

/// Answers requests, from several threads at once if need be.
class IkDesk {
 public:
  IkDesk(const Robot& robot, IkJob job);
  ~IkDesk();

  [[nodiscard]] const IkSolver& geometry() const noexcept { return geometry_; }
  /// Solves one request and appends the answer. Where there is none, returns why.
  std::optional<std::string> answer(const IkRequest& request, std::string& out);

 private:
  class Worker;
  using WorkerPtr = std::unique_ptr<Worker>;
  [[nodiscard]] WorkerPtr take();
  void put_back(WorkerPtr worker);
  void append_states(Worker& worker, const std::vector<JointVec>& branches, JsonWriter& json) const;

  const Robot& robot_;
  IkJob job_;
  IkSolver geometry_;  ///< contact left aside
  std::mutex mutex_;
  std::vector<WorkerPtr> idle_;
};

}  // namespace mjarm::app
