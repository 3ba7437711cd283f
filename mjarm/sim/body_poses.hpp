#pragma once

#include <memory>
#include <span>
#include <vector>

#include "mjarm/core/pose.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/model/model.hpp"
#include "mjarm/sim/sim.hpp"

namespace mjarm {

/// Where the bodies of a model stand in a snapshot, in the world: for whoever draws it beside the
/// simulation. Computes positions only, no contacts and no forces. One thread at a time.
class BodyPoses {
 public:
  /// A body, and where it would be.
  struct Moved {
    int body = 0;
    Pose X_WB = {};
  };

  /// Stands as the model starts.
  explicit BodyPoses(const Model& model);
  ~BodyPoses();
  BodyPoses(BodyPoses&&) noexcept;
  BodyPoses& operator=(BodyPoses&&) noexcept;

  /// Puts the model into a state; one without numbers is that in which it starts.
  /// @return bad_input where the snapshot belongs to another model.
  [[nodiscard]] Result<void> set(const Snapshot& snapshot);

  [[nodiscard]] int size() const noexcept;                      ///< bodies, the world included
  [[nodiscard]] Pose pose(int body) const;                      ///< X_WB
  [[nodiscard]] std::span<const double> p_W() const noexcept;   ///< [m] shape (3 n,)
  [[nodiscard]] std::span<const double> quat() const noexcept;  ///< (w, x, y, z), shape (4 n,)
  [[nodiscard]] std::span<const double> qpos() const noexcept;  ///< shape (nq,)

  /// The bodies that would be elsewhere with other values at some places of qpos; other places
  /// keep theirs. Changes nothing.
  /// @param index  shape (n,), places in qpos; others are ignored.
  /// @param values shape (n,) [rad or m]
  /// @return none where a value is not finite or the sizes differ.
  [[nodiscard]] std::vector<Moved> moved(std::span<const int> index,
                                         std::span<const double> values);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace mjarm
