#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "mjarm/core/joint_vec.hpp"
#include "mjarm/core/pose.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/model/arm.hpp"
#include "mjarm/model/model.hpp"

namespace mjarm {

/// Why two descriptions of one arm put the tool to different places.
enum class CauseCode {
  joint_order,  ///< the joints bear their names in another order along the chain
  base,         ///< the whole arm stands elsewhere in its world, or is turned
  link,         ///< a joint sits elsewhere on the link before it: a link length, a turned axis
  zero_offset,  ///< the zero of a joint is another one
  joint_sign,   ///< a joint turns (or slides) the other way
  tool,         ///< the tool frame sits elsewhere on the last link, or is turned
};
/// The code as a word, such as `zero_offset`.
[[nodiscard]] std::string_view name(CauseCode code) noexcept;

/// One change to the first arm that brings it nearer to the second.
struct Cause {
  CauseCode code = CauseCode::base;
  int joint = -1;  ///< index in the first arm; -1 for base, tool and joint_order
  /// [m] base: in the world; link: in the frame of the joint before (the world for the first one);
  /// tool: in the tool frame.
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();
  /// [rad] rotation vector in the same frame.
  Eigen::Vector3d turn = Eigen::Vector3d::Zero();
  double offset = 0;  ///< [rad or m] zero_offset: value that the first arm has where the other is 0
  /// Joint whose zero offset alone would look the same (base, tool); -1 where none.
  int same_as_zero_of = -1;
};

/// How to compare. Every default is usable as is.
struct CompareOptions {
  int configurations = 1000;  ///< random, uniform within the limits of the first arm, > 0
  std::uint64_t seed = 1;     ///< same arms and seed, same answer
};

/// How two arms differ in forward kinematics.
struct Comparison {
  bool by_name = false;       ///< joints are matched by name, else by their order in the chain
  double position = 0;        ///< [m] largest distance of the tools
  double rotation = 0;        ///< [rad] largest angle between the tools
  JointVec q;                 ///< [rad or m] where the distance (else the angle) is largest
  std::vector<Cause> causes;  ///< the shortest explanation that was found, from base to tool
  double position_left = 0;   ///< [m] what is left when the causes are mended
  double rotation_left = 0;   ///< [rad]
};

/// Compares where two descriptions put their tools, and finds out why they differ: once joint by
/// joint as written, and once by what is the same for all ways to place joint frames, the screw
/// axes at zero (K. M. Lynch, F. C. Park, Modern Robotics (2017), 4.1), after fitting base and tool
/// in closed form (F. C. Park, B. J. Martin, IEEE T-RA 10 (1994) 717). Each explanation is put into
/// the first arm and measured again; the one with the fewest parts is given.
/// @return an error (impossible) where the number or kind of joints differs.
[[nodiscard]] Result<Comparison> compare_arms(const Arm& first, const Arm& second,
                                              const CompareOptions& options = {});

/// `arm` with the causes put into it; joint_order changes nothing.
[[nodiscard]] Arm with_causes(const Arm& arm, const std::vector<Cause>& causes);

/// A figure of one joint that two descriptions give differently.
struct FigureDifference {
  std::string joint;      ///< name in the first description
  std::string_view what;  ///< "mass" [kg], "lower", "upper", "velocity", "torque" (SI)
  double first = 0;
  double second = 0;
};

/// Masses that the joints move directly (each up to the next joint) and limits that differ by more
/// than 1e-4 of their size; velocity and torque only where both files give them. Joints are matched
/// as in compare_arms; of arms with different joints nothing is compared.
[[nodiscard]] std::vector<FigureDifference> compare_figures(const Model& first,
                                                            const Arm& first_arm,
                                                            const Model& second,
                                                            const Arm& second_arm);

}  // namespace mjarm
